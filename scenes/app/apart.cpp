#include "scenes/app/apart.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "engine/base/check.h"

namespace sunder::app {

bool Ended::crashed() const {
  return signal == SIGABRT || signal == SIGSEGV || signal == SIGBUS || signal == SIGFPE ||
         signal == SIGILL;
}

std::string Ended::how() const {
  if (signal == 0) return "exit code " + std::to_string(exit_code);
  return (crashed() ? "crashed: " : "ended by ") + std::string(strsignal(signal));
}

Ended run_apart(const std::function<int()>& work) {
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw FileError(std::string("no process can be started: ") + std::strerror(errno));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    _exit(getppid() == parent ? work() : 1);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return {0, WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

}  // namespace sunder::app
