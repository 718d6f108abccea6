// Breaks that went wrong, kept so that they can be carried out again (case_file.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "fracture/check/case_file.h"

namespace sunder::fracture {

/// Counts convexes that were left whole because their parts did not add up, and writes the breaks
/// in question to files, those as well that were planned and not carried out. A thread of its own
/// writes, so that the run does not wait.
class FailureLog {
 public:
  static constexpr std::size_t kMostFiles = 20;

  /// Writes up to `most_files` cases to `folder`, made when needed; none without a name.
  explicit FailureLog(std::string folder = {}, std::size_t most_files = kMostFiles);
  /// Waits until all files are written.
  ~FailureLog();

  /// Writes a break that leaves convexes whole to the file break-EVENT.case. Any thread may.
  void keep(const Compound& compound, const BreakCommand& command);
  /// Notes what a break that has been carried out left whole.
  void count(std::uint32_t failed, double failed_m3) { failed_ += failed, failed_m3_ += failed_m3; }

  /// Convexes left whole so far, and their volume.
  std::uint64_t failed() const { return failed_; }
  double failed_m3() const { return failed_m3_; }
  /// Files written so far. Waits for those under way.
  std::size_t files();

 private:
  void write_all();
  void write(const BreakCase& example);

  std::string folder_;
  std::size_t most_files_;
  std::uint64_t failed_ = 0;
  double failed_m3_ = 0;
  std::mutex mutex_;  ///< Of all below.
  std::deque<BreakCase> waiting_;
  std::size_t kept_ = 0, files_ = 0;
  bool is_writing_ = false;
  std::thread writer_;
};

}  // namespace sunder::fracture
