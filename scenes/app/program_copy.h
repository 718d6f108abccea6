// Copies of a program that are run in its place. Two identical programs differ in speed and in peak
// memory by where in memory the system keeps their files, which stays as it is from run to run; a
// new copy for each run makes that a matter of chance.
#pragma once

#include <filesystem>
#include <string>

namespace sunder::app {

class ProgramCopy {
 public:
  /// Makes a temporary folder for copies. A script is not copied, as it may need its folder.
  explicit ProgramCopy(const std::filesystem::path& program);
  ~ProgramCopy();
  ProgramCopy(const ProgramCopy&) = delete;
  ProgramCopy& operator=(const ProgramCopy&) = delete;

  /// Replaces the copy by a new one. Returns its path, or that of the script.
  std::string renew();

 private:
  std::filesystem::path program_, folder_;
};

}  // namespace sunder::app
