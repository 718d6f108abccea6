#include "engine/base/parallel.h"

namespace sunder {
namespace {
int thread_count = 0;  // the one process-wide setting: 0 until set
}

void set_threads(int count) { thread_count = count > 0 ? count : omp_get_num_procs(); }

int threads() {
  if (thread_count == 0) set_threads(0);
  return thread_count;
}

}  // namespace sunder
