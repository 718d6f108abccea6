// Symptom: jointed bodies that were hit gained energy, up to a twentieth of all energy. Cause:
// groups of bodies in contact were limited to the energy that they had, but joints belonged to no
// group. Fixed in 2a51bc1. The tests run with and without restitution. They also check momentum,
// and angular momentum when a joint breaks.
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
using Kind = JointDesc::Kind;

/// A row of boxes in joints of random kinds, some of them breakable, and balls that hit the boxes.
/// No body is joined to the world, and there is no gravity.
class Tangle {
 public:
  Tangle(std::uint64_t seed, double restitution) : random_(seed, 1), restitution_(restitution) {
    const int links = 3 + static_cast<int>(random_.below(8));
    BodyId last;
    Vec3 end_W = Vec3::Zero();
    for (int i = 0; i < links; ++i) {
      const Vec3 size(random_.uniform(0.2, 0.6), random_.uniform(0.05, 0.4), 0.2);
      const Vec3 center_W = end_W + Vec3(0.5 * size.x(), 0, 0);
      const BodyId next = add(W::box(size, center_W, random_.uniform(500, 8000)));
      if (i > 0) join(last, next, end_W);
      last = next;
      end_W.x() += size.x() + 0.02;
    }
    for (int i = 0; i < 6; ++i) {
      const Vec3 target_W(random_.uniform(0, end_W.x()), 0, 0);
      const Vec3 from_W = target_W + (0.8 + i) * direction_across();
      BodyDesc ball = W::sphere(random_.uniform(0.05, 0.2), from_W, random_.uniform(500, 8000));
      const double speed_m_s = random_.uniform(2, 20);
      ball.velocity_W = speed_m_s * (target_W - from_W).normalized();
      thrown_Ns += ball.mass_kg * speed_m_s;
      add(ball);
    }
  }

  RigidWorld world{awake(Vec3::Zero())};
  double thrown_Ns = 0;

 private:
  BodyId add(BodyDesc desc) { return world.add(W::with_friction(desc, 0.5, restitution_)); }

  Vec3 direction_across() {
    Vec3 across = random_.direction();
    across.x() *= 0.2;
    across.y() += across.y() > 0 ? 0.5 : -0.5;
    return across.normalized();
  }

  void join(BodyId a, BodyId b, const Vec3& at_W) {
    const Pose X_WA = world.state(a).X_WB, X_WB = world.state(b).X_WB;
    JointDesc joint;
    joint.kind = static_cast<Kind>(random_.below(5));
    joint.a = a, joint.b = b;
    joint.anchor_a_R = X_WA.inverse() * at_W, joint.anchor_b_R = X_WB.inverse() * at_W;
    if (joint.kind == Kind::kDistance || joint.kind == Kind::kRope) {
      joint.anchor_a_R = joint.anchor_b_R = Vec3::Zero();
      joint.length_m = (X_WB.position - X_WA.position).norm();
    }
    joint.collide = random_.uniform() < 0.5;
    if (random_.uniform() < 0.4) joint.breaking_N = std::pow(10.0, random_.uniform(2, 5));
    world.physics().join(joint);
  }

  Random random_;
  double restitution_;
};

/// Largest errors of a hundred tangles.
struct Worst {
  double rise = 0;  ///< Increase of energy over its minimum so far, relative to the initial energy.
  double momentum = 0;  ///< Change of momentum, relative to that of the balls thrown.
  double spin = 0;      ///< Change of angular momentum when a joint breaks and nothing touches,
                        ///< relative to that of the balls thrown at a distance of 1 m.
  int broken = 0;
};

Worst run_tangles(double restitution) {
  Worst worst;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Tangle tangle(seed, restitution);
    RigidWorld& world = tangle.world;
    const double first_J = world.kinetic_energy();
    const Vec3 p = world.momentum();
    double least_J = first_J;
    for (int i = 0; i < 120; ++i) {
      const Vec3 L = world.angular_momentum();
      const bool touch = world.step(1.0 / 120, 4).contacts > 0;
      const std::size_t broken = world.physics().take_broken().size();
      worst.broken += static_cast<int>(broken);
      if (broken > 0 && !touch) {
        const double spin = (world.angular_momentum() - L).norm();
        worst.spin = std::max(worst.spin, spin / tangle.thrown_Ns);
      }
      const double now_J = world.kinetic_energy();
      worst.rise = std::max(worst.rise, (now_J - least_J) / first_J);
      least_J = std::min(least_J, now_J);
    }
    worst.momentum = std::max(worst.momentum, (world.momentum() - p).norm() / tangle.thrown_Ns);
  }
  std::printf("restitution %.1f: energy rises by %.1e, p changes by %.1e, L by %.1e; %d torn\n",
              restitution, worst.rise, worst.momentum, worst.spin, worst.broken);
  EXPECT_GT(worst.broken, 50);
  return worst;
}

TEST(RegressJoints, JointedBodiesGainNoEnergyInAnImpact) {
  const Worst worst = run_tangles(0);
  EXPECT_LT(worst.rise, 1e-3)
      << "error of fast rotation in a substep; 5e-2 without the limit on energy";
  EXPECT_LT(worst.momentum, 1e-5);
  EXPECT_LT(worst.spin, 1e-4);
}

TEST(RegressJoints, JointedBodiesGainHardlyAnyEnergyWithRestitution) {
  const Worst worst = run_tangles(0.9);
  EXPECT_LT(worst.rise, 1e-2) << "of one tangle; all others rise by less than 3e-3";
  EXPECT_LT(worst.momentum, 1e-5);
}

}  // namespace
}  // namespace sunder::solver
