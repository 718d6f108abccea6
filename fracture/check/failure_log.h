// Failed breaks, counted and stored so that they can be repeated (case_file.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "fracture/check/case_file.h"

namespace sunder::fracture {

/// Counts convexes that were left whole because the volumes of their parts did not add up, and
/// writes such breaks to files, including breaks that were planned but not carried out. A separate
/// thread writes, so that the simulation does not wait.
class FailureLog {
 public:
  static constexpr std::size_t kMostFiles = 20;

  /// Writes up to `most_files` cases to `folder`, created when needed; none if the name is empty.
  explicit FailureLog(std::string folder = {}, std::size_t most_files = kMostFiles);
  /// Waits until all files are written.
  ~FailureLog();

  /// Writes a break that leaves convexes whole to break-EVENT.case, unless `most_files` have been
  /// written. May be called from any thread.
  void keep(const Compound& compound, const BreakCommand& command);
  /// Counts the failures of a break that has been carried out.
  void count(std::uint64_t failed, double failed_m3) { failed_ += failed, failed_m3_ += failed_m3; }

  /// Return the number of convexes left whole so far, and their volume.
  std::uint64_t failed() const { return failed_; }
  double failed_m3() const { return failed_m3_; }
  /// Returns the number of files written, after waiting for those in progress.
  std::size_t files();

 private:
  void write_all();
  void write(const BreakCase& example);

  std::string folder_;
  std::size_t most_files_;
  std::uint64_t failed_ = 0;
  double failed_m3_ = 0;
  std::mutex mutex_;  ///< Guards all members below.
  std::deque<BreakCase> waiting_;
  std::size_t kept_ = 0, files_ = 0;
  bool is_writing_ = false;
  std::thread writer_;
};

}  // namespace sunder::fracture
