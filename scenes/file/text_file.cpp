#include "scenes/file/text_file.h"

#include <fstream>
#include <sstream>

#include "engine/base/check.h"

namespace sunder::scenes {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file, const FileKind& kind) {
  check_file_size(file, kind);
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  if (!fs::is_regular_file(file) || !in || !(text << in.rdbuf())) {
    throw InputError(file.string() + ": cannot be read" +
                     (fs::exists(file) ? ", or is empty" : ": there is no such file"));
  }
  return text.str();
}

}  // namespace sunder::scenes
