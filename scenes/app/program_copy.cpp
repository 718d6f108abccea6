#include "scenes/app/program_copy.h"

#include <cstdlib>
#include <fstream>
#include <system_error>

#include "engine/base/check.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;

bool is_script(const fs::path& program) {
  std::ifstream in(program, std::ios::binary);
  return in.get() == '#' && in.get() == '!';
}

void copy_program(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::copy_file(from, to, error))
    throw FileError(to.string() + ": " + error.message() +
                    "; set TMPDIR to a folder with free space");
}

}  // namespace

ProgramCopy::ProgramCopy(const fs::path& program) : program_(fs::canonical(program)) {
  if (is_script(program_)) return;
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "sunder-XXXXXX").string();
  if (error || !mkdtemp(name.data()))
    throw FileError("no temporary folder can be made; set TMPDIR to a folder with free space");
  folder_ = name;
  fs::create_directory(folder_ / "bin");
  copy_program(program_, folder_ / "program");  // which stays the same if the program is built anew
  const fs::path share = program_.parent_path().parent_path() / "share";
  if (fs::exists(share)) fs::create_symlink(share, folder_ / "share");  // scenes, if installed
}

ProgramCopy::~ProgramCopy() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string ProgramCopy::renew() {
  if (folder_.empty()) return program_.string();
  const fs::path to = folder_ / "bin/sunder";
  std::error_code ignored;
  fs::remove(to, ignored);
  copy_program(folder_ / "program", to);
  return to.string();
}

}  // namespace sunder::app
