#include "tests/scenes/program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace sunder::tests {
namespace {

std::string contents(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

Outcome sunder(const std::string& arguments, const std::string& before) {
  const Folder folder;
  const std::string out = folder / "out", err = folder / "err";
  const std::string line =
      before + "\"" SUNDER_PROGRAM "\" " + arguments + " >" + out + " 2>" + err;
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
}

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "sunder-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace sunder::tests
