// Tests of the bounding volume hierarchy against brute force.
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/geometry/bvh.h"
#include "tests/engine/geometry_fixtures.h"

namespace sunder {
namespace {

using namespace test;

std::vector<Box> random_boxes(Random& random, std::size_t count) {
  std::vector<Box> boxes(count);
  const bool repeat = random.below(4) == 0;
  for (Box& box : boxes) {
    box.extend(repeat ? Vec3(Vec3::Ones()) : random_point(random, 10));
    box.extend(Vec3(box.min + Vec3(random.uniform(), random.uniform(0, 4), 0)));
  }
  return boxes;
}

RC_GTEST_PROP(Bvh, FindsWhatBruteForceFinds, (std::uint64_t seed)) {
  Random random(seed);
  const std::vector<Box> boxes = random_boxes(random, random.below(300));
  const Bvh bvh(boxes);
  EXPECT_EQ(bvh.empty(), boxes.empty());
  for (int query = 0; query < 10; ++query) {
    Box box;
    box.extend(random_point(random, 10));
    box.extend(Vec3(box.min + random_point(random, 4)));
    const Vec3 center = random_point(random, 12);
    const double radius =
        query == 0 ? std::numeric_limits<double>::infinity() : random.uniform(0, 8);
    std::vector<std::uint32_t> overlapping, near, expected_overlapping, expected_near;
    bvh.overlaps(box, overlapping);
    bvh.within(center, radius, near);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].overlaps(box)) expected_overlapping.push_back(i);
      const Vec3 closest = center.cwiseMax(boxes[i].min).cwiseMin(boxes[i].max);
      if ((center - closest).norm() <= radius) expected_near.push_back(i);
    }
    EXPECT_EQ(overlapping, expected_overlapping);
    EXPECT_EQ(near, expected_near);
  }
}

TEST(Bvh, AppendsToWhatWasFoundBefore) {
  const std::vector<Box> boxes(3, Box{Vec3::Zero(), Vec3::Ones()});
  std::vector<std::uint32_t> hits = {7};
  Bvh(boxes).overlaps(boxes[0], hits);
  EXPECT_EQ(hits, (std::vector<std::uint32_t>{7, 0, 1, 2}));
}

}  // namespace
}  // namespace sunder
