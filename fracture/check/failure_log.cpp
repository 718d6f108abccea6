#include "fracture/check/failure_log.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>

#include "fracture/check/case_file.h"

namespace sunder::fracture {

FailureLog::FailureLog(std::string folder, std::size_t most_files)
    : folder_(std::move(folder)), most_files_(most_files) {}

void FailureLog::keep(const Compound& compound, const BreakCommand& command) {
  if (folder_.empty() || asked_++ >= most_files_) return;
  const std::string name = folder_ + "/break-" + std::to_string(command.event) + ".case";
  const std::string unfinished = name + ".part";
  std::error_code no_folder;
  std::filesystem::create_directories(folder_, no_folder);
  {
    std::ofstream file(unfinished);
    write_case(file, {compound, command});
    if (!file.flush()) return;  // a full disk must not stop the simulation
  }
  if (std::rename(unfinished.c_str(), name.c_str()) == 0) ++files_;
}

}  // namespace sunder::fracture
