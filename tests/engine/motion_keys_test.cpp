// Tests that the keys of a motion, as a reader of the file interpolates them, stay within the
// tolerance of every sample.
#include "engine/io/scene_export/motion_keys.h"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/base/random.h"

namespace sunder {
namespace {

constexpr std::uint32_t kFirstFrame = 7;

/// A motion of rest, flight, drift and jumps, of random lengths.
std::vector<Vec3> random_walk(Random& random, double scale_m) {
  std::vector<Vec3> samples;
  Vec3 at = scale_m * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  while (samples.size() < 200) {
    const auto length = static_cast<int>(random.uniform(1, 80));
    const int kind = static_cast<int>(random.uniform(0, 4));
    Vec3 velocity = Vec3::Zero();
    if (kind > 0) {
      velocity = std::pow(10, random.uniform(-4, 0)) *
                 Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    for (int i = 0; i < length; ++i) {
      if (kind == 2) velocity.y() -= 9.81 / 3600;
      if (kind == 3) velocity *= -1;
      at += velocity;
      samples.push_back(at);
    }
  }
  return samples;
}

/// Returns the position that a reader finds at a frame.
Vec3 read_position(const KeyReducer<PositionKeys>& keys, std::uint32_t frame) {
  const auto& frames = keys.frames();
  std::size_t k = 0;
  while (k + 1 < frames.size() && frames[k + 1] <= frame) ++k;
  const Vec3 from = keys.keys()[k].cast<double>();
  if (k + 1 == frames.size()) return from;
  const double share =
      static_cast<double>(frame - frames[k]) / static_cast<double>(frames[k + 1] - frames[k]);
  return from + share * (keys.keys()[k + 1].cast<double>() - from);
}

/// Returns the rotation that a reader finds at a frame, by Eigen's slerp or by a linear
/// interpolation that is normalized.
Quat read_rotation(const KeyReducer<RotationKeys>& keys, std::uint32_t frame, bool is_linear) {
  const auto quat = [&](std::size_t k) {
    const RotationKeys::Key& key = keys.keys()[k];
    return Quat(key[3] / 32767.0, key[0] / 32767.0, key[1] / 32767.0, key[2] / 32767.0)
        .normalized();
  };
  const auto& frames = keys.frames();
  std::size_t k = 0;
  while (k + 1 < frames.size() && frames[k + 1] <= frame) ++k;
  if (k + 1 == frames.size()) return quat(k);
  const double share =
      static_cast<double>(frame - frames[k]) / static_cast<double>(frames[k + 1] - frames[k]);
  if (!is_linear) return quat(k).slerp(share, quat(k + 1));
  return Quat(Eigen::Vector4d((1 - share) * quat(k).coeffs() + share * quat(k + 1).coeffs()))
      .normalized();
}

RC_GTEST_PROP(MotionKeys, KeepPositionsWithinTheTolerance, (std::uint64_t seed)) {
  Random random(seed);
  const double tolerance_m = std::pow(10, random.uniform(-4, -1));
  const std::vector<Vec3> samples = random_walk(random, std::pow(10, random.uniform(-1, 2)));
  KeyReducer<PositionKeys> keys{PositionKeys(tolerance_m)};
  for (std::uint32_t i = 0; i < samples.size(); ++i) keys.add(kFirstFrame + i, samples[i]);
  keys.finish();
  RC_ASSERT(keys.frames().front() == kFirstFrame);
  RC_ASSERT(keys.frames().size() == keys.keys().size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    const double error_m = (read_position(keys, kFirstFrame + i) - samples[i]).norm();
    RC_ASSERT(error_m <= tolerance_m);
  }
}

RC_GTEST_PROP(MotionKeys, KeepRotationsWithinTheTolerance, (std::uint64_t seed)) {
  Random random(seed);
  const double tolerance_rad = std::pow(10, random.uniform(-3.7, -1));
  const std::vector<Vec3> walk = random_walk(random, 1);
  KeyReducer<RotationKeys> keys{RotationKeys(tolerance_rad)};
  const auto rotation = [&](std::uint32_t i) {
    const Vec3& v = walk[i];
    const double angle = v.norm();
    return Quat(Eigen::AngleAxisd(angle, angle > 0 ? Vec3(v / angle) : Vec3(Vec3::UnitX())));
  };
  for (std::uint32_t i = 0; i < walk.size(); ++i) {
    Quat q = rotation(i);
    if (i % 3 == 0) q.coeffs() *= -1;  // the same rotation
    keys.add(kFirstFrame + i, q);
  }
  keys.finish();
  for (std::uint32_t i = 0; i < walk.size(); ++i) {
    for (const bool is_linear : {false, true}) {
      const Quat found = read_rotation(keys, kFirstFrame + i, is_linear);
      RC_ASSERT(found.angularDistance(rotation(i)) <= tolerance_rad);
    }
  }
}

TEST(MotionKeys, AreFewWhereTheMotionIsSimple) {
  KeyReducer<PositionKeys> still{PositionKeys(1e-3)}, straight{PositionKeys(1e-3)},
      stopping{PositionKeys(1e-3)};
  for (std::uint32_t i = 0; i <= 600; ++i) {
    still.add(i, Vec3(1, 2, 3));
    straight.add(i, Vec3(0.01 * i, 0, 0));
    stopping.add(i, Vec3(0.5 * std::min(i, 10u), 0, 0));
  }
  for (auto* keys : {&still, &straight, &stopping}) keys->finish();
  EXPECT_EQ(still.keys().size(), 1u);
  EXPECT_LE(straight.keys().size(), 11u);  // a key for every 64 samples at the most
  EXPECT_EQ(stopping.frames(), (std::vector<std::uint32_t>{0, 10, 600}));
}

TEST(MotionKeys, OfOneSampleAreOneKey) {
  KeyReducer<RotationKeys> keys{RotationKeys(1e-3)};
  keys.add(3, Quat::Identity());
  keys.finish();
  EXPECT_EQ(keys.frames(), std::vector<std::uint32_t>{3});
  EXPECT_EQ(keys.keys()[0], (RotationKeys::Key{0, 0, 0, 32767}));
}

}  // namespace
}  // namespace sunder
