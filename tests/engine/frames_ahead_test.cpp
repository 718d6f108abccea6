// Tests of FramesAhead: its frames and exceptions are those of the source, in the source's order.
#include "engine/io/frames_ahead.h"

#include <atomic>
#include <stdexcept>

#include <gtest/gtest.h>

namespace sunder {
namespace {

/// Returns `frames` frames and then null, or throws an exception.
class CountingSource final : public FrameSource {
 public:
  explicit CountingSource(std::uint64_t frames, bool throws = false)
      : frames_(frames), throws_(throws) {}
  FramePtr next() override {
    if (made >= frames_ && throws_) throw std::runtime_error("no more");
    if (made >= frames_) return nullptr;
    auto frame = std::make_shared<Frame>();
    frame->index = made++;
    return frame;
  }
  std::atomic<std::uint64_t> made{0};

 private:
  std::uint64_t frames_;
  bool throws_;
};

TEST(FramesAhead, AreTheSameInTheSameOrderAndEndAtTheSamePlace) {
  CountingSource source(50);
  FramesAhead ahead(source);
  for (std::uint64_t i = 0; i < 50; ++i) ASSERT_EQ(ahead.next()->index, i);
  EXPECT_EQ(ahead.next(), nullptr);
  EXPECT_EQ(ahead.next(), nullptr);
}

TEST(FramesAhead, AnExceptionIsThrownAfterTheFramesBeforeIt) {
  CountingSource source(3, true);
  FramesAhead ahead(source);
  for (std::uint64_t i = 0; i < 3; ++i) ASSERT_EQ(ahead.next()->index, i);
  EXPECT_THROW(ahead.next(), std::runtime_error);
  EXPECT_EQ(ahead.next(), nullptr);
}

TEST(FramesAhead, OnlyAFewAreMadeBeforeTheyAreRequested) {
  CountingSource source(1000);
  {
    FramesAhead ahead(source);
    for (std::uint64_t i = 0; i < 10; ++i) ahead.next();
    while (source.made < 12) std::this_thread::yield();
  }
  EXPECT_LE(source.made, 13u);
}

}  // namespace
}  // namespace sunder
