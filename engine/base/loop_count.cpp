#include "engine/base/loop_count.h"

#include <algorithm>
#include <span>

namespace sunder {

thread_local LoopCount* detail::LoopTimer::current_ = nullptr;

LoopCount::LoopCount() { detail::LoopTimer::current_ = this; }

LoopCount::~LoopCount() { detail::LoopTimer::current_ = nullptr; }

LoopTimes LoopCount::times() {
  const LoopCount* const current = detail::LoopTimer::current_;
  return current ? current->times_ : LoopTimes{};
}

void LoopCount::add(double ms) {
  times_.work_ms += ms;
  longest_ms_ = std::max(longest_ms_, ms);
  for (std::size_t i = 0; i < kLoopThreads.size(); ++i) {
    *std::ranges::min_element(std::span(busy_ms_[i]).first(kLoopThreads[i])) += ms;
  }
}

void LoopCount::end_loop() {
  times_.span_ms += std::exchange(longest_ms_, 0);
  for (std::size_t i = 0; i < kLoopThreads.size(); ++i) {
    times_.threads_ms[i] += std::ranges::max(busy_ms_[i]);
    busy_ms_[i] = {};
  }
}

}  // namespace sunder
