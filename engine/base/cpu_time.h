// Processor time, which depends little on the load from other processes.
#pragma once

#include <ctime>

namespace sunder {

/// Returns the processor time that all threads of this process have used so far, in ms.
inline double cpu_ms() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

}  // namespace sunder
