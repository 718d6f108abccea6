// Runs the program under test.
#pragma once

#include <filesystem>
#include <string>

namespace sunder::tests {

struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs `sunder ARGUMENTS` in a shell, with the text `before` in front of the command.
Outcome sunder(const std::string& arguments, const std::string& before = "");

/// A new empty folder, removed with its object.
class Folder {
 public:
  Folder();
  ~Folder();
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace sunder::tests
