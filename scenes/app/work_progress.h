// How far a command is, said on stderr while it works.
#pragma once

#include <chrono>
#include <string>

namespace sunder::app {

/// A bar with the time left on a terminal; elsewhere a line now and then, once it has taken a
/// while. Quick work says nothing.
class WorkProgress {
 public:
  WorkProgress(std::string title, bool quiet);
  ~WorkProgress();
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// What is done now, and the share of all work that is done.
  void operator()(const char* step, double share);

 private:
  double elapsed_s() const;

  std::string title_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  double next_s_;  ///< When there is something to say again.
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sunder::app
