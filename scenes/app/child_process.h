// Runs work in child processes, which isolates its crashes, and its memory and time.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace sunder::app {

/// The exit code or signal that ended a process.
struct ProcessResult {
  int exit_code = 0;
  int signal = 0;  ///< Signal that ended it; 0 if none did.

  /// Returns true if the signal is that of a fault in the process, such as SIGSEGV or SIGABRT.
  bool crashed() const;
  /// Returns "crashed: ...", "ended by ..." or "exit code ...".
  std::string description() const;
};

/// Runs `work`, which returns an exit code, in a fork of this process and waits for it. This
/// process must have started no threads. The child gets SIGTERM if this process ends or has caught
/// a stop signal (run.h), and is killed a second after the signal. Throws FileError if no process
/// can be started.
ProcessResult run_in_child(const std::function<int()>& work);
/// Runs all of `works` at the same time, each in a fork of this process. Otherwise as above.
std::vector<ProcessResult> run_in_child(std::span<const std::function<int()>> works);

}  // namespace sunder::app
