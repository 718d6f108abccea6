#include "scenes/app/child_process.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "engine/base/check.h"
#include "scenes/app/run.h"

namespace sunder::app {
namespace {

/// Returns true if a child has ended; it can still be waited for.
bool has_ended(pid_t child) {
  siginfo_t info = {};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == child;
}

/// Has children end, so that they remove files that are not complete; kills those that have not
/// ended after a second.
void end_all(std::span<const pid_t> children) {
  constexpr int kWaits = 100;
  constexpr useconds_t kWait_us = 10'000;
  for (const pid_t child : children) kill(child, SIGTERM);
  for (int i = 0; i < kWaits && !std::ranges::all_of(children, has_ended); ++i) usleep(kWait_us);
  for (const pid_t child : children) kill(child, SIGKILL);
}

}  // namespace

bool ProcessResult::crashed() const {
  return signal == SIGABRT || signal == SIGSEGV || signal == SIGBUS || signal == SIGFPE ||
         signal == SIGILL;
}

std::string ProcessResult::description() const {
  if (signal == 0) return "exit code " + std::to_string(exit_code);
  return (crashed() ? "crashed: " : "ended by ") + std::string(strsignal(signal));
}

ProcessResult run_in_child(const std::function<int()>& work) {
  return run_in_child(std::span(&work, 1)).front();
}

std::vector<ProcessResult> run_in_child(std::span<const std::function<int()>> works) {
  std::vector<pid_t> children;
  for (const std::function<int()>& work : works) {
    const pid_t parent = getpid(), child = fork();
    if (child < 0) {
      throw FileError(std::string("no process can be started: ") + std::strerror(errno));
    }
    if (child == 0) {
      release_stop_signals();
      prctl(PR_SET_PDEATHSIG, SIGTERM);
      _exit(getppid() == parent ? work() : 1);
    }
    children.push_back(child);
  }
  std::vector<ProcessResult> ended;
  for (std::size_t i = 0; i < children.size(); ++i) {
    int status = 0;
    while (waitpid(children[i], &status, 0) < 0 && errno == EINTR)
      if (stop_signal() != 0) end_all(std::span(children).subspan(i));
    if (WIFSIGNALED(status)) {
      ended.push_back({0, WTERMSIG(status)});
    } else {
      ended.push_back({WEXITSTATUS(status), 0});
    }
  }
  return ended;
}

}  // namespace sunder::app
