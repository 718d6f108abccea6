// The threads that share loops: a team that is started once, by OpenMP, and then waits for work at
// a door of our own. An OpenMP region for each loop would end only when every thread has come to
// its end: a thread that lost its processor, or sleeps, would hold up those that are done.
#include "engine/base/parallel.h"

#include <cstdint>
#include <thread>

#include <omp.h>

namespace sunder {
namespace {

int thread_count = 0;               // the one process-wide setting: 0 until set
thread_local bool is_busy = false;  // with a loop: those within it are not shared

/// Lets another thread of this processor go first.
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

class Team {
 public:
  void run(void (*call)(const void*), const void* work);

 private:
  // How long a thread looks out for work before it sleeps: the time it would take to wake it.
  static constexpr int kLooks = 1000;

  void enlist(int helpers);
  void serve(int rank);
  std::uint32_t wait_while(std::uint32_t door) const;

  std::mutex in_use_;
  int enlisted_ = 0;
  // Odd while open; one more each time it opens or closes.
  std::atomic<std::uint32_t> door_{0};
  std::atomic<int> inside_{0};
  // Of the loop behind the open door.
  int helpers_ = 0;
  void (*call_)(const void*) = nullptr;
  const void* work_ = nullptr;
};

void Team::run(void (*call)(const void*), const void* work) {
  const std::unique_lock lock(in_use_, std::try_to_lock);
  if (!lock) return call(work);  // another thread's loop has the team
  helpers_ = threads() - 1;
  enlist(helpers_);
  call_ = call;
  work_ = work;
  ++door_;
  door_.notify_all();
  is_busy = true;
  call(work);
  is_busy = false;
  ++door_;
  // Whoever came in before it closed is at work on the rest.
  for (int looks = 0; inside_ > 0; ++looks) looks < kLooks ? pause() : std::this_thread::yield();
}

/// They serve until the process ends.
void Team::enlist(int helpers) {
  if (helpers <= enlisted_) return;
  const int first = enlisted_, count = helpers - enlisted_;
  std::thread([this, first, count] {
#pragma omp parallel num_threads(count)
    serve(first + omp_get_thread_num());
  }).detach();
  enlisted_ = helpers;
}

void Team::serve(int rank) {
  is_busy = true;
  for (std::uint32_t door = 0;;) {
    door = wait_while(door);
    if (door % 2 == 0) continue;
    ++inside_;
    // Still open after we are counted: it cannot end without us.
    if (door_ == door && rank < helpers_) call_(work_);
    --inside_;
  }
}

std::uint32_t Team::wait_while(std::uint32_t door) const {
  for (int looks = 0; looks < kLooks; ++looks) {
    if (const std::uint32_t now = door_; now != door) return now;
    pause();
  }
  door_.wait(door);
  return door_;
}

Team& team() {
  static Team* const one = new Team;  // never destroyed: its threads may outlive main()
  return *one;
}

}  // namespace

void set_threads(int count) { thread_count = count > 0 ? count : omp_get_num_procs(); }

int threads() {
  if (thread_count == 0) set_threads(0);
  return thread_count;
}

bool may_share_work() { return !is_busy && threads() > 1; }

void detail::work_together(void (*call)(const void*), const void* work) { team().run(call, work); }

}  // namespace sunder
