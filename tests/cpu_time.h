// Processor time, for bounds on work that hold on a busy machine, too.
#pragma once

#include <sys/resource.h>

namespace sunder::test {

/// Seconds of processor time that this process, all its threads and the children it has waited for
/// have used so far.
inline double cpu_time_s() {
  const auto seconds = [](int who) {
    rusage usage{};
    getrusage(who, &usage);
    const auto sum = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return sum(usage.ru_utime) + sum(usage.ru_stime);
  };
  return seconds(RUSAGE_SELF) + seconds(RUSAGE_CHILDREN);
}

}  // namespace sunder::test
