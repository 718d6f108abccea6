// Tests of the contact points that a manifold keeps when it is built again.
#include <vector>

#include <gtest/gtest.h>

#include "solver/rigid/collide/manifold_build.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

constexpr float kSize_m = 0.5f, kReach_m = 0.03f;

/// A block of a metre on another; the narrow phase reports one edge of their contact at a time.
class TwoBlocks : public testing::Test {
 protected:
  TwoBlocks() {
    pair_.body_a = bodies_.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
    pair_.body_b = bodies_.add(W::box(Vec3(1, 1, 1), Vec3(0, 1.5, 0)));
    m_.size_m = kSize_m;
    m_.reusable = true;
    touch(-0.4f, 1, 0);
    m_.points[0].impulse_Ns = 7;
  }

  /// Builds the manifold of the pair in its pose, with one contact point on the edge at `x`, at
  /// `separation_m` along the normal.
  void touch(float x, std::uint32_t feature, float separation_m) {
    const Vec3f normal = Vec3f::UnitY(), on_a(x, 0.5f, 0);
    const std::vector<PatchPoint> points = {
        {on_a, on_a + separation_m * normal, separation_m, feature}};
    const PairMotion motion = pair_motion(pair_, bodies_);
    build_manifold(pair_, bodies_, motion, normal, points, present_moment(pair_, bodies_, motion),
                   kReach_m, m_);
  }
  void move_b(const Vec3& by) {
    const BodySlot b = pair_.body_b;
    bodies_.place(b, bodies_.position[b] + by, bodies_.rotation[b]);
  }

  Bodies bodies_;
  Pair pair_;
  Manifold m_;
};

TEST_F(TwoBlocks, ThatRockFromOneEdgeToAnotherKeepThePointsOfBoth) {
  touch(0.4f, 2, 0.001f);
  ASSERT_EQ(m_.count, 2);
  EXPECT_EQ(m_.points[0].feature, 2u);
  EXPECT_EQ(m_.points[1].feature, 1u);
  EXPECT_EQ(m_.points[0].impulse_Ns, 0);
  EXPECT_EQ(m_.points[1].impulse_Ns, 7);
  EXPECT_NEAR(m_.friction_anchor_A.x(), 0, 1e-6);
}

TEST_F(TwoBlocks, ThatSeparateAtAnEdgeKeepThePointOfTheOtherOnly) {
  move_b(Vec3(0, 2 * kReach_m, 0));
  touch(0.4f, 2, 0.001f);
  ASSERT_EQ(m_.count, 1);
  EXPECT_EQ(m_.points[0].feature, 2u);
}

TEST_F(TwoBlocks, ThatSlideKeepNoOldPoint) {
  move_b(Vec3(0, 0, 0.05));  // A tenth of the blocks' size.
  touch(0.4f, 2, 0.001f);
  EXPECT_EQ(m_.count, 1);
}

TEST_F(TwoBlocks, ThatTouchAtTheSamePlaceKeepOnePointWithItsImpulse) {
  touch(-0.39f, 2, 0.001f);
  ASSERT_EQ(m_.count, 1);
  EXPECT_EQ(m_.points[0].impulse_Ns, 7);
}

}  // namespace
}  // namespace sunder::solver
