// Frames made ahead are those of the source, in its order, with what it throws.
#include "engine/io/frames_ahead.h"

#include <atomic>
#include <stdexcept>

#include <gtest/gtest.h>

namespace sunder {
namespace {

/// Gives so many frames and then null, or throws.
class Counted final : public FrameSource {
 public:
  explicit Counted(std::uint64_t frames, bool throws = false) : frames_(frames), throws_(throws) {}
  FramePtr next() override {
    if (asked >= frames_ && throws_) throw std::runtime_error("no more");
    if (asked >= frames_) return nullptr;
    auto frame = std::make_shared<Frame>();
    frame->index = asked++;
    return frame;
  }
  std::atomic<std::uint64_t> asked{0};

 private:
  std::uint64_t frames_;
  bool throws_;
};

TEST(FramesAhead, AreTheSameInTheSameOrderAndEndAtTheSamePlace) {
  Counted source(50);
  FramesAhead ahead(source);
  for (std::uint64_t i = 0; i < 50; ++i) ASSERT_EQ(ahead.next()->index, i);
  EXPECT_EQ(ahead.next(), nullptr);
  EXPECT_EQ(ahead.next(), nullptr);
}

TEST(FramesAhead, WhatIsThrownComesAfterTheFramesBeforeIt) {
  Counted source(3, true);
  FramesAhead ahead(source);
  for (std::uint64_t i = 0; i < 3; ++i) ASSERT_EQ(ahead.next()->index, i);
  EXPECT_THROW(ahead.next(), std::runtime_error);
  EXPECT_EQ(ahead.next(), nullptr);
}

TEST(FramesAhead, OnlyAFewAreMadeThatNobodyHasAskedFor) {
  Counted source(1000);
  {
    FramesAhead ahead(source);
    for (std::uint64_t i = 0; i < 10; ++i) ahead.next();
    while (source.asked < 12) std::this_thread::yield();
  }
  EXPECT_LE(source.asked, 13u);
}

}  // namespace
}  // namespace sunder
