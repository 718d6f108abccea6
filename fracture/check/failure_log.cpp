#include "fracture/check/failure_log.h"

#include <filesystem>
#include <fstream>
#include <utility>

#include "engine/base/check.h"
#include "engine/io/unfinished_file.h"

namespace sunder::fracture {

FailureLog::FailureLog(std::string folder, std::size_t most_files)
    : folder_(std::move(folder)), most_files_(most_files) {}

FailureLog::~FailureLog() {
  if (writer_.joinable()) writer_.join();
}

void FailureLog::keep(const Compound& compound, const BreakCommand& command) {
  if (folder_.empty()) return;
  const std::lock_guard lock(mutex_);
  if (kept_ == most_files_) return;
  ++kept_;
  waiting_.push_back({compound, command});
  if (is_writing_) return;
  is_writing_ = true;
  if (writer_.joinable()) writer_.join();  // The thread has ended.
  writer_ = std::thread([this] { write_all(); });
}

std::size_t FailureLog::files() {
  if (writer_.joinable()) writer_.join();
  return files_;
}

void FailureLog::write_all() {
  for (;;) {
    BreakCase next;
    {
      const std::lock_guard lock(mutex_);
      is_writing_ = !waiting_.empty();
      if (!is_writing_) return;
      next = std::move(waiting_.front());
      waiting_.pop_front();
    }
    write(next);
  }
}

void FailureLog::write(const BreakCase& example) {
  const std::string name = folder_ + "/break-" + std::to_string(example.command.event) + ".case";
  UnfinishedFile unfinished(name);
  std::error_code no_folder;
  std::filesystem::create_directories(folder_, no_folder);
  {
    std::ofstream file(unfinished.path());
    write_case(file, example);
    if (!file.flush()) return;  // A full disk must not stop the simulation.
  }
  try {
    unfinished.publish();
  } catch (const FileError&) {
    return;
  }
  const std::lock_guard lock(mutex_);
  ++files_;
}

}  // namespace sunder::fracture
