// Tests of engine/base: indices, hashes, random numbers, trigonometry, poses, parallel loops.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/exponential.h"
#include "engine/base/hash.h"
#include "engine/base/loop_count.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/base/roots.h"
#include "engine/base/rotation.h"
#include "engine/base/trace.h"
#include "engine/base/trigonometry.h"
#include "engine/base/types.h"

namespace sunder::base_test {
namespace {

struct AppleTag;
struct PearTag;
using Apple = Index<AppleTag>;

TEST(Index, IsNoneUntilItIsGivenAValue) {
  EXPECT_TRUE(Apple().none());
  EXPECT_FALSE(Apple(0).none());
  EXPECT_EQ(Apple(7).value, 7u);
}

TEST(Index, OfOneArrayCannotBeUsedInAnother) {
  static_assert(!std::is_convertible_v<Apple, Index<PearTag>>);
  static_assert(!std::is_convertible_v<std::size_t, Apple>);
}

TEST(Index, IsOrderedByItsValue) {
  EXPECT_LT(Apple(1), Apple(2));
  EXPECT_EQ(Apple(2), Apple(2));
}

TEST(Id, OfAnEarlierGenerationIsUnequal) {
  const Id<AppleTag> old{3, 0}, now{3, 1};
  EXPECT_NE(old, now);
  EXPECT_TRUE(Id<AppleTag>().none());
  EXPECT_FALSE(old.none());
}

TEST(CheckDeathTest, AFailedCheckNamesItsConditionAndFile) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  SUNDER_CHECK(1 + 1 == 2);
  EXPECT_DEATH(SUNDER_CHECK(1 + 1 == 3), "base_test.cpp:[0-9]+: check failed: 1 \\+ 1 == 3");
}

TEST(Hash, CombineDependsOnOrder) { EXPECT_NE(combine(1, 2), combine(2, 1)); }

TEST(Hash, MixHasNoCollisionAmongNeighbours) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t i = 0; i < 100000; ++i) seen.insert(mix(i));
  EXPECT_EQ(seen.size(), 100000u);
}

TEST(Random, ADrawDependsOnlyOnSeedStreamAndCounter) {
  Random first(42, 7), second(42, 7);
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t alone = first.bits();
    Random(1, 2).bits();  // a draw elsewhere changes nothing
    EXPECT_EQ(second.bits(), alone);
  }
}

TEST(Random, SeedsAndStreamsGiveDifferentNumbers) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (std::uint64_t stream = 0; stream < 30; ++stream) {
      Random random(seed, stream);
      for (int i = 0; i < 10; ++i) seen.insert(random.bits());
    }
  }
  EXPECT_EQ(seen.size(), 30u * 30 * 10);
}

TEST(Random, UniformFillsTheUnitIntervalEvenly) {
  Random random(1);
  std::array<int, 10> buckets{};
  for (int i = 0; i < 100000; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    ++buckets[static_cast<std::size_t>(x * 10)];
  }
  for (const int count : buckets) EXPECT_NEAR(count, 10000, 400);  // 4 sigma
}

TEST(Random, BelowReachesEveryNumberBelowAndNoOther) {
  Random random(3);
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(random.below(7));
  EXPECT_EQ(seen, (std::set<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(Random, DirectionsAreUnitVectorsWithoutPreference) {
  Random random(5);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 10000; ++i) {
    const Vec3 direction = random.direction();
    ASSERT_NEAR(direction.norm(), 1, 1e-15);
    sum += direction;
  }
  EXPECT_LT(sum.norm(), 300);  // 3 sigma: sqrt(10000) each way
}

TEST(SinCos, AgreesWithTheCLibraryTo1e15) {
  Random random(9);
  for (const double range : {0.8, 7.0, 1000.0, 1e6}) {
    for (int i = 0; i < 100000; ++i) {
      const double angle = random.uniform(-range, range);
      const SinCos ours = sin_cos(angle);
      ASSERT_NEAR(ours.sin, static_cast<double>(std::sin(static_cast<long double>(angle))), 1e-15);
      ASSERT_NEAR(ours.cos, static_cast<double>(std::cos(static_cast<long double>(angle))), 1e-15);
    }
  }
}

TEST(SinCos, OfZeroIsExact) {
  EXPECT_EQ(sin_cos(0).sin, 0);
  EXPECT_EQ(sin_cos(0).cos, 1);
}

TEST(CubeRoot, AgreesWithTheCLibraryTo3e16) {
  Random random(10);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::exp(random.uniform(-700, 700)) * (i % 2 == 0 ? 1 : -1);
    const long double exact = std::cbrt(static_cast<long double>(x));
    ASSERT_LT(std::abs(static_cast<double>(cube_root(x) / exact - 1)), 3e-16) << x;
  }
  for (const double x : {1.0, 2.0, -3.0, 0.5}) EXPECT_EQ(cube_root(x * x * x), x);
}

TEST(CubeRoot, OfZeroAndInfinityIsTheSame) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {0.0, infinity, -infinity}) EXPECT_EQ(cube_root(x), x);
  EXPECT_NEAR(cube_root(5e-324) / std::cbrt(5e-324), 1, 1e-15);
}

TEST(Hypotenuse, AgreesWithTheCLibraryTo3e16) {
  Random random(11);
  for (int i = 0; i < 100000; ++i) {
    const double a = std::exp(random.uniform(-300, 300)), b = a * random.uniform(-10, 10);
    const long double exact = std::hypot(static_cast<long double>(a), static_cast<long double>(b));
    ASSERT_LT(std::abs(static_cast<double>(hypotenuse(a, b) / exact - 1)), 3e-16) << a << " " << b;
  }
}

TEST(PositivePower, AgreesWithTheCLibrary) {
  Random random(12);
  for (int i = 0; i < 100000; ++i) {
    const double base = std::exp(random.uniform(-10, 10)), exponent = random.uniform(-60, 60);
    const double exact = std::pow(base, exponent), bound = 3e-15 * (1 + std::abs(std::log(exact)));
    ASSERT_LT(std::abs(positive_power(base, exponent) / exact - 1), bound)
        << base << " " << exponent;
  }
  EXPECT_EQ(positive_power(3, 0), 1);
}

TEST(BinaryLogarithm, IsExactForPowersOfTwo) {
  for (int i = -1000; i <= 1000; ++i) EXPECT_EQ(binary_logarithm(std::ldexp(1, i)), i);
  EXPECT_NEAR(binary_logarithm(10), std::log2(10), 4e-15);
}

TEST(MathFunctions, HaveTheSameBitsOnEveryMachine) {
  Random random(13);
  std::uint64_t hash = 0;
  const auto take = [&](double x) { hash = combine(hash, std::bit_cast<std::uint64_t>(x)); };
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(-100, 100), y = random.uniform(-100, 100);
    const SinCos both = sin_cos(x);
    take(both.sin), take(both.cos), take(arc_tangent(y, x));
    take(exponential(x)), take(natural_logarithm(x * x)), take(binary_logarithm(y * y));
    take(cube_root(x)), take(hypotenuse(x, y)), take(positive_power(x * x, 0.1 * y));
    const Quat turn = rotation_by({x, y, 1});
    for (int k = 0; k < 4; ++k) take(turn.coeffs()[k]);
    for (int k = 0; k < 3; ++k) take(rotation_vector(turn)[k]);
  }
  EXPECT_EQ(hash, 0x07b4102584714eeeULL);
}

TEST(Pose, TimesItsInverseIsTheIdentity) {
  const Pose X_WB{Vec3(1, -2, 3), Quat(0.5, 0.5, -0.5, 0.5)};
  const Vec3 point(0.3, 4, -5);
  EXPECT_LT((X_WB.inverse() * (X_WB * point) - point).norm(), 1e-14);
  EXPECT_LT(((X_WB.inverse() * X_WB) * point - point).norm(), 1e-14);
}

TEST(Box, IsEmptyUntilExtendedAndThenHoldsItsPoints) {
  Box box;
  EXPECT_TRUE(box.empty());
  box.extend(Vec3(1, 2, 3));
  box.extend(Vec3(-1, 0, 3));
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.center(), Vec3(0, 1, 3));
  EXPECT_EQ(box.extent(), Vec3(2, 2, 0));
}

/// Sets the number of threads for a test and restores the default afterwards.
class ForChunks : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_threads(GetParam()); }
  void TearDown() override { set_threads(0); }
};

TEST_P(ForChunks, CoversEveryElementOnceInChunksThatDoNotDependOnThreads) {
  for (const std::size_t n : {0u, 1u, 63u, 64u, 65u, 1000u}) {
    std::vector<int> visits(n, 0);
    for_chunks(n, 64, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      EXPECT_EQ(begin, chunk * 64);
      EXPECT_EQ(end, std::min<std::size_t>(n, begin + 64));
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(visits, std::vector<int>(n, 1));
  }
}

TEST_P(ForChunks, RethrowsWhatAChunkThrows) {
  auto work = [](std::size_t, std::size_t, std::size_t chunk) {
    if (chunk == 5) throw InputError("chunk five");
  };
  EXPECT_THROW(for_chunks(1000, 10, work), InputError);
}

TEST_P(ForChunks, MayBeNested) {
  std::vector<int> visits(100, 0);
  for_chunks(10, 1, [&](std::size_t outer, std::size_t, std::size_t) {
    for_chunks(10, 1,
               [&](std::size_t inner, std::size_t, std::size_t) { ++visits[outer * 10 + inner]; });
  });
  EXPECT_EQ(visits, std::vector<int>(100, 1));
}

TEST_P(ForChunks, MayRunOnSeveralThreadsOfTheCallersAtOnce) {
  std::vector<std::size_t> sums(3, 0);
  const auto loops = [&](std::size_t& sum) {
    for (int round = 0; round < 300; ++round) {
      std::vector<std::size_t> parts(8, 0);
      for_chunks(800, 100, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; ++i) parts[chunk] += i;
      });
      for (const std::size_t part : parts) sum += part;
    }
  };
  std::thread first(loops, std::ref(sums[0])), second(loops, std::ref(sums[1]));
  loops(sums[2]);
  first.join();
  second.join();
  EXPECT_EQ(sums, std::vector<std::size_t>(3, 300 * (799 * 800 / 2)));
}

TEST_P(ForChunks, ANestedLoopMayNotRunInParallel) {
  EXPECT_EQ(can_run_parallel(), GetParam() > 1);
  for_chunks(8, 1, [](std::size_t, std::size_t, std::size_t) {
    if (GetParam() > 1) {
      EXPECT_FALSE(can_run_parallel());
    }
  });
  EXPECT_EQ(can_run_parallel(), GetParam() > 1);
}

INSTANTIATE_TEST_SUITE_P(Threads, ForChunks, ::testing::Values(1, 2, 4));

/// Waits for a time without sleeping.
void be_busy(double ms) {
  const Stopwatch watch;
  while (watch.ms() < ms) {
  }
}

TEST(LoopCount, GivesTimesOfLoopsWithMoreThreads) {
  const LoopCount count;
  std::set<std::thread::id> threads;
  for_chunks(5, 1, [&](std::size_t begin, std::size_t, std::size_t) {
    threads.insert(std::this_thread::get_id());
    be_busy(begin == 0 ? 4 : 1);
    // A loop within a part runs on the thread of that part.
    for_chunks(2, 1, [&](std::size_t, std::size_t, std::size_t) { be_busy(0.1); });
  });
  EXPECT_EQ(threads.size(), 1u);
  const LoopTimes times = LoopCount::times();
  const auto& [two, four, eight, sixteen] = times.threads_ms;
  EXPECT_GE(times.work_ms, 8);
  EXPECT_GE(two, times.work_ms / 2);
  EXPECT_GE(times.span_ms, 3.8);
  // The first part takes four fifths of the time of all others: with two threads, the other one
  // does these, with four threads no other waits for it.
  EXPECT_LT(two, times.work_ms);
  EXPECT_LE(four, two);
  EXPECT_LE(eight, four);
  EXPECT_EQ(sixteen, times.span_ms) << "there are fewer parts than threads";
  EXPECT_EQ(eight, times.span_ms);
}

TEST(LoopCount, OfLoopsThatWaitForEachOtherIsTheirSum) {
  const LoopCount count;
  for (int i = 0; i < 3; ++i)
    for_chunks(2, 1, [&](std::size_t, std::size_t, std::size_t) { be_busy(1); });
  const LoopTimes times = LoopCount::times();
  EXPECT_GE(times.work_ms, 5.5);
  EXPECT_GE(times.span_ms, 2.7);
  EXPECT_LT(times.span_ms, times.work_ms);
}

TEST(LoopCount, LeavesOutLoopsOfOnePart) {
  {
    const LoopCount count;
    for_chunks(1, 1, [&](std::size_t, std::size_t, std::size_t) { be_busy(0.1); });
    EXPECT_EQ(LoopCount::times().work_ms, 0);
    for_chunks(2, 1, [&](std::size_t, std::size_t, std::size_t) { be_busy(0.1); });
    EXPECT_GE(LoopCount::times().work_ms, 0.15);
  }
  for_chunks(2, 1, [&](std::size_t, std::size_t, std::size_t) { be_busy(0.1); });
  EXPECT_EQ(LoopCount::times().work_ms, 0) << "there is no LoopCount";
}

}  // namespace
}  // namespace sunder::base_test
