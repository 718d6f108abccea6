// Shows the progress of a command on stderr.
#pragma once

#include <chrono>
#include <string>

namespace sunder::app {

/// Shows, after 0.5 s, a bar with the remaining time on a terminal, otherwise a line every 2 s.
class WorkProgress {
 public:
  WorkProgress(std::string title, bool quiet);
  ~WorkProgress();
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// Reports the current step, and the fraction of all work that is done.
  void operator()(const char* step, double share);

 private:
  double elapsed_s() const;

  std::string title_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  double next_s_;  ///< Elapsed time of the next update.
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sunder::app
