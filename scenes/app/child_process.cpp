#include "scenes/app/child_process.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "engine/base/check.h"
#include "scenes/app/run.h"

namespace sunder::app {

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
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      _exit(getppid() == parent ? work() : 1);
    }
    children.push_back(child);
  }
  std::vector<ProcessResult> ended;
  for (std::size_t i = 0; i < children.size(); ++i) {
    int status = 0;
    while (waitpid(children[i], &status, 0) < 0 && errno == EINTR) {
      for (std::size_t k = i; stop_signal() != 0 && k < children.size(); ++k)
        kill(children[k], SIGKILL);
    }
    if (WIFSIGNALED(status)) {
      ended.push_back({0, WTERMSIG(status)});
    } else {
      ended.push_back({WEXITSTATUS(status), 0});
    }
  }
  return ended;
}

}  // namespace sunder::app
