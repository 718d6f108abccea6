// Runs a list of stages on all threads. A thread claims blocks of its own part of the current stage
// first, then blocks of other parts, so that the same items stay in the cache of one processor from
// stage to stage. A stage begins when all blocks of the previous stage are done, not when all
// threads have arrived: a preempted thread delays the others only while it holds a block.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/base/parallel.h"

namespace sunder::solver {

/// `count` items from `first` on, in blocks of `grain` items, whatever the number of threads.
struct StageItems {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t grain = 1;

  std::uint32_t blocks() const { return (count + grain - 1) / grain; }
};

/// Number of blocks in the widest stage below which one thread is as fast as many.
inline constexpr std::uint32_t kMinParallelBlocks = 16;

/// Calls work(stage, begin, end) for every block of every stage, one stage after another. `Stage`
/// must have the members of StageItems. `work` must not throw.
template <class Stage, class Work>
void run_stages(const std::vector<Stage>& stages, const Work& work) {
  std::uint32_t widest = 0;
  for (const Stage& stage : stages) widest = std::max(widest, stage.blocks());
  auto run = [&](const Stage& stage, std::uint32_t block) {
    const std::uint32_t begin = block * stage.grain;
    work(stage, stage.first + begin, stage.first + std::min(stage.count, begin + stage.grain));
  };
  if (widest < kMinParallelBlocks) {
    for (const Stage& stage : stages)
      for (std::uint32_t block = 0; block < stage.blocks(); ++block) run(stage, block);
    return;
  }
  sunder::detail::LoopTimer timer;
  if (timer.counts() || !can_run_parallel()) {
    for (const Stage& stage : stages) {
      for (std::uint32_t block = 0; block < stage.blocks(); ++block)
        timer.run_chunk([&] { run(stage, block); });
      timer.end_loop();
    }
    return;
  }
  struct alignas(64) Count {
    std::atomic<std::uint32_t> value{0};
  };
  const auto parts = static_cast<std::uint32_t>(threads());
  const std::unique_ptr<Count[]> claimed(new Count[stages.size() * parts]);
  const std::unique_ptr<Count[]> done(new Count[stages.size()]);
  std::atomic<std::uint32_t> arrived{0};
  run_on_free_threads([&] {
    const std::uint32_t rank = arrived.fetch_add(1, std::memory_order_relaxed);
    for (std::size_t s = 0; s < stages.size(); ++s) {
      const std::uint64_t blocks = stages[s].blocks();
      for (std::uint32_t i = 0; i < parts; ++i) {
        const std::uint32_t part = (rank + i) % parts;
        const auto first = static_cast<std::uint32_t>(blocks * part / parts);
        const auto end = static_cast<std::uint32_t>(blocks * (part + 1) / parts);
        std::atomic<std::uint32_t>& next = claimed[s * parts + part].value;
        for (std::uint32_t block;
             (block = first + next.fetch_add(1, std::memory_order_relaxed)) < end;) {
          run(stages[s], block);
          if (done[s].value.fetch_add(1, std::memory_order_release) + 1 == blocks)
            done[s].value.notify_all();
        }
      }
      int spins = 0;
      for (std::uint32_t now; (now = done[s].value.load(std::memory_order_acquire)) < blocks;)
        ++spins < kMaxSpins ? spin_pause() : done[s].value.wait(now, std::memory_order_acquire);
    }
  });
}

}  // namespace sunder::solver
