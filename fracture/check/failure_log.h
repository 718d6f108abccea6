// Breaks that went wrong, kept so that they can be carried out again (case_file.h).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Counts convexes that were left whole because their parts did not add up, and writes the breaks
/// in question to files. Any thread may add.
class FailureLog {
 public:
  static constexpr std::size_t kMostFiles = 20;

  /// Writes up to `most_files` cases to `folder`, made when needed; none without a name.
  explicit FailureLog(std::string folder = {}, std::size_t most_files = kMostFiles);

  /// Notes a break that left `failed` convexes whole: to the file break-EVENT.case.
  void add(const Compound& compound, const BreakCommand& command, std::uint32_t failed);

  /// Convexes left whole so far.
  std::uint64_t failed() const { return failed_; }
  /// Files written so far.
  std::size_t files() const { return files_; }

 private:
  std::string folder_;
  std::size_t most_files_;
  std::atomic<std::uint64_t> failed_ = 0;
  std::atomic<std::size_t> asked_ = 0, files_ = 0;
};

}  // namespace sunder::fracture
