// The thread team of parallel loops. OpenMP starts the threads once; an epoch counter then tells
// them when a loop is open to join. An OpenMP region for each loop would end only when all threads
// have reached its end, so a preempted or sleeping thread would delay the others.
#include "engine/base/parallel.h"

#include <cstdint>
#include <thread>

#include <omp.h>

namespace sunder {
namespace {

std::atomic<int> thread_count = 0;  // process-wide; 0 until set
thread_local int own_count = 0;     // of a ThreadScope; 0: none
thread_local bool is_busy = false;  // in a parallel loop: nested loops are serial

/// Yields the core to its other hardware thread in a spin loop.
void spin_pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

class ThreadTeam {
 public:
  void run(void (*call)(const void*), const void* work);

 private:
  // Number of polls before a waiting thread sleeps: about the time that waking it takes.
  static constexpr int kMaxSpins = 1000;

  void start_helpers(int helpers);
  void run_worker(int rank);
  std::uint32_t wait_for_new_epoch(std::uint32_t epoch) const;

  std::mutex mutex_;
  int started_ = 0;
  // Odd while a loop is open to join; incremented when a loop opens and when it closes.
  std::atomic<std::uint32_t> epoch_{0};
  std::atomic<int> active_{0};  // workers in the open loop, or about to test whether it is open
  // The open loop.
  int helper_count_ = 0;
  void (*call_)(const void*) = nullptr;
  const void* work_ = nullptr;
};

void ThreadTeam::run(void (*call)(const void*), const void* work) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return call(work);  // another thread's loop has the team
  helper_count_ = threads() - 1;
  start_helpers(helper_count_);
  call_ = call;
  work_ = work;
  ++epoch_;
  epoch_.notify_all();
  is_busy = true;
  call(work);
  is_busy = false;
  ++epoch_;
  // Workers that joined before the loop closed may still be at work.
  for (int spins = 0; active_ > 0; ++spins)
    spins < kMaxSpins ? spin_pause() : std::this_thread::yield();
}

/// Starts threads until there are `helpers`; they run until the process ends.
void ThreadTeam::start_helpers(int helpers) {
  if (helpers <= started_) return;
  const int first = started_, count = helpers - started_;
  std::thread([this, first, count] {
#pragma omp parallel num_threads(count)
    run_worker(first + omp_get_thread_num());
  }).detach();
  started_ = helpers;
}

void ThreadTeam::run_worker(int rank) {
  is_busy = true;
  for (std::uint32_t epoch = 0;;) {
    epoch = wait_for_new_epoch(epoch);
    if (epoch % 2 == 0) continue;
    ++active_;
    // If the loop is still open after the increment, its owner waits for this worker.
    if (epoch_ == epoch && rank < helper_count_) call_(work_);
    --active_;
  }
}

std::uint32_t ThreadTeam::wait_for_new_epoch(std::uint32_t epoch) const {
  for (int spins = 0; spins < kMaxSpins; ++spins) {
    if (const std::uint32_t now = epoch_; now != epoch) return now;
    spin_pause();
  }
  epoch_.wait(epoch);
  return epoch_;
}

ThreadTeam& team() {
  // Never destroyed: its threads may outlive main().
  static ThreadTeam* const instance = new ThreadTeam;
  return *instance;
}

}  // namespace

void set_threads(int count) { thread_count = count > 0 ? count : omp_get_num_procs(); }

int threads() {
  if (own_count > 0) return own_count;
  if (thread_count == 0) set_threads(0);
  return thread_count;
}

ThreadScope::ThreadScope(int count) : before_(own_count) {
  if (count > 0) own_count = count;
}

ThreadScope::~ThreadScope() { own_count = before_; }

bool can_run_parallel() { return !is_busy && threads() > 1; }

void detail::run_on_free_threads(void (*call)(const void*), const void* work) {
  team().run(call, work);
}

}  // namespace sunder
