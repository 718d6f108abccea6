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

/// `sunder ARGUMENTS`, as in a shell that has run `before`.
Outcome sunder(const std::string& arguments, const std::string& before = "");

/// A new empty folder, removed at the end.
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
