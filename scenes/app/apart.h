// Work in a process of its own, so that a crash is a result of it and takes nothing else with it,
// and its memory and its time are its own.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace sunder::app {

/// How a process ended.
struct Ended {
  int exit_code = 0;
  int signal = 0;  ///< That ended it; 0: none did.

  /// By a mistake of its own, and not because somebody ended it.
  bool crashed() const;
  /// "crashed: ...", "ended by ..." or "exit code ...".
  std::string how() const;
};

/// Does the work, which answers an exit code, in a copy of this process, which must have begun no
/// threads; the copy ends with this one, and when this one has caught a stop signal (run.h). Waits
/// for it. Throws FileError if there can be none.
Ended run_apart(const std::function<int()>& work);
/// Does all of it at once.
std::vector<Ended> run_apart(std::span<const std::function<int()>> works);

}  // namespace sunder::app
