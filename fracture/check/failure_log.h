// Breaks that went wrong, kept so that they can be carried out again (case_file.h).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Counts convexes that were left whole because their parts did not add up, and writes the breaks
/// in question to files, those as well that were planned and not carried out.
class FailureLog {
 public:
  static constexpr std::size_t kMostFiles = 20;

  /// Writes up to `most_files` cases to `folder`, made when needed; none without a name.
  explicit FailureLog(std::string folder = {}, std::size_t most_files = kMostFiles);

  /// Writes a break that leaves convexes whole to the file break-EVENT.case. Any thread may.
  void keep(const Compound& compound, const BreakCommand& command);
  /// Notes what a break that has been carried out left whole.
  void count(std::uint32_t failed, double failed_m3) { failed_ += failed, failed_m3_ += failed_m3; }

  /// Convexes left whole so far, and their volume.
  std::uint64_t failed() const { return failed_; }
  double failed_m3() const { return failed_m3_; }
  /// Files written so far.
  std::size_t files() const { return files_; }

 private:
  std::string folder_;
  std::size_t most_files_;
  std::uint64_t failed_ = 0;
  double failed_m3_ = 0;
  std::atomic<std::size_t> asked_ = 0, files_ = 0;
};

}  // namespace sunder::fracture
