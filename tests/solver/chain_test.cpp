// Tests of chains, trees and rings of joints at every preset, and of equal bits for any threads.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "tests/fixtures/presets.h"
#include "tests/solver/chains.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
using Kind = JointDesc::Kind;

/// Prints the result of measure(preset) for each preset, and returns that of `accurate`.
double at_each_preset(const char* what, const std::function<double(const Preset&)>& measure) {
  double accurate = 0;
  std::printf("%-44s", what);
  for (const Preset& preset : kPresets) {
    const double value = measure(preset);
    std::printf("  %s %.4g", preset.name, value);
    if (&preset == &kPresets[2]) accurate = value;
  }
  std::printf("\n");
  return accurate;
}

int steps(double time_s, const Preset& preset) {
  return static_cast<int>(std::lround(time_s / preset.dt_s));
}

/// Returns the maximum stretch of a chain within five seconds, as a fraction of its length.
double worst_stretch(const Preset& preset, const ChainDesc& desc) {
  PresetWorld world(preset);
  const Chain chain = add_chain(world, desc);
  double worst = 0;
  for (int i = 0; i < steps(5, preset); ++i) {
    world.step();
    worst = std::max(worst, chain.stretch(world));
  }
  return worst;
}

TEST(Chain, HoldsABallOfTenThousandLinksAtEveryPreset) {
  const Vec3 hanging = Vec3(0.1, -1, 0.05).normalized();
  for (const Kind kind : {Kind::kBall, Kind::kHinge}) {
    for (const double ratio : {100.0, 1000.0, 10000.0}) {
      for (const Vec3& along : {Vec3(Vec3::UnitX()), hanging}) {
        char what[80];
        std::snprintf(what, sizeof what, "20 %s, ball x %.0f, %s: stretch",
                      kind == Kind::kBall ? "balls" : "hinges", ratio,
                      along.x() == 1 ? "released level" : "hanging");
        at_each_preset(what, [&](const Preset& preset) {
          const double stretch =
              worst_stretch(preset, {.ball_ratio = ratio, .along = along, .kind = kind});
          EXPECT_LT(stretch, 5e-3) << preset.name;
          return stretch;
        });
      }
    }
  }
}

TEST(Chain, HoldsForAnyOrderOfItsJoints) {
  const Vec3 along = Vec3(0.1, -1, 0.05).normalized();
  at_each_preset("100 links in leaps of 8, ball x 1000: stretch", [&](const Preset& preset) {
    PresetWorld world(preset);
    const Chain chain =
        add_chain(world, {.links = 100, .ball_ratio = 1000, .along = along, .stride = 8});
    world.run(1);
    EXPECT_LT(chain.stretch(world), 1e-4) << preset.name;
    return chain.stretch(world);
  });
}

TEST(Chain, OfRopesHoldsAsOneOfRodsDoes) {
  for (const Kind kind : {Kind::kDistance, Kind::kRope}) {
    at_each_preset(
        kind == Kind::kRope ? "6 ropes, ball x 100: stretch" : "6 rods, ball x 100: stretch",
        [&](const Preset& preset) {
          PresetWorld world(preset);
          std::vector<JointDesc> joints;
          for (int i = 0; i < 6; ++i) {
            JointDesc joint;
            joint.kind = kind;
            joint.length_m = 0.2;
            joint.a = joints.empty() ? BodyId() : joints.back().b;
            joint.b = world.add(W::sphere(0.05, Vec3(0.2 * (i + 1), 0, 0), i == 5 ? 100000 : 1000));
            world.physics().join(joint);
            joints.push_back(joint);
          }
          double worst = 0;
          for (int i = 0; i < steps(5, preset); ++i) {
            world.step();
            double sum = 0;
            for (const JointDesc& joint : joints)
              sum += std::max(0.0, gap(world, joint) - joint.length_m);
            worst = std::max(worst, sum / 1.2);
          }
          EXPECT_LT(worst, 1e-2) << preset.name;
          return worst;
        });
  }
}

TEST(Chain, ADoublePendulumKeepsItsEnergy) {
  const double accurate =
      at_each_preset("double pendulum, 20 s: energy, of m·g·1 m", [](const Preset& preset) {
        PresetWorld world(preset);
        const BodyDesc upper = W::box(Vec3(1, 0.1, 0.1), Vec3(0.5, 0, 0));
        const BodyId a = world.add(upper);
        const BodyId b = world.add(W::box(Vec3(1, 0.1, 0.1), Vec3(1.5, 0, 0)));
        world.physics().join(joint_at(world, Kind::kHinge, {}, a, Vec3::Zero()));
        world.physics().join(joint_at(world, Kind::kHinge, a, b, Vec3(1, 0, 0)));
        double worst = 0;
        for (int i = 0; i < steps(20, preset); ++i) {
          world.step();
          const double energy = world.kinetic_energy() + world.potential_energy(kG);
          worst = std::max(worst, std::abs(energy) / (upper.mass_kg * kG));
        }
        EXPECT_LT(worst, 0.05) << preset.name;
        return worst;
      });
  EXPECT_LT(accurate, 5e-3);
}

TEST(Chain, TwoBoxesInAFixedJointTumbleAsOne) {
  const double accurate =
      at_each_preset("fixed boxes at 20 rad/s, 10 s: energy lost", [](const Preset& preset) {
        PresetWorld world(preset, Vec3::Zero());
        const Vec3 spin(1, 20, 3);
        BodyDesc box = W::box(Vec3(0.9, 0.4, 0.3), Vec3(-0.5, 0, 0));
        BodyDesc other = W::box(Vec3(0.8, 0.3, 0.5), Vec3(0.5, 0.1, 0), 2000);
        for (BodyDesc* body : {&box, &other}) {
          body->velocity_W = spin.cross(body->X_WB.position);
          body->angular_velocity_W = spin;
        }
        const BodyId a = world.add(box), b = world.add(other);
        world.physics().join(joint_at(world, Kind::kFixed, a, b, Vec3::Zero()));
        const double energy = world.kinetic_energy();
        const Vec3 p = world.momentum(), L = world.angular_momentum();
        world.run(1);
        EXPECT_LT((world.momentum() - p).norm(), 1e-5 * p.norm()) << preset.name;
        EXPECT_LT((world.angular_momentum() - L).norm(), 1e-5 * L.norm()) << preset.name;
        world.run(9);
        EXPECT_LT((world.state(a).angular_velocity_W - world.state(b).angular_velocity_W).norm(),
                  1e-4);
        return 1 - world.kinetic_energy() / energy;
      });
  EXPECT_LT(std::abs(accurate), 1e-3);
}

TEST(Chain, KeepsItsMomentumWhenFreeAndDamped) {
  at_each_preset("20 links whirl about a ball, 1 s: change of L", [](const Preset& preset) {
    PresetWorld world(preset, Vec3::Zero());
    const Chain chain = add_chain(world, {.ball_ratio = 1000, .hangs = false});
    const Vec3 spin(0, 3, 30), ball = world.state(chain.bodies.back()).X_WB.position;
    for (const BodyId id : chain.bodies) {
      BodyState state = world.state(id);
      state.velocity_W = spin.cross(state.X_WB.position - ball);
      state.angular_velocity_W = spin;
      world.physics().set_state(id, state);
    }
    const Vec3 p = world.momentum(), L = world.angular_momentum();
    const double energy = world.kinetic_energy();
    world.run(1);
    EXPECT_LT((world.momentum() - p).norm(), 1e-5 * p.norm()) << preset.name;
    const double change = (world.angular_momentum() - L).norm() / L.norm();
    EXPECT_LT(change, 3e-5) << preset.name;
    EXPECT_NEAR(world.kinetic_energy() / energy, 1, 0.01) << preset.name;
    return change;
  });
}

TEST(Chain, ARingHoldsWhenOneOfItsJointsBreaks) {
  at_each_preset("a ring of 12 hangs, and tears: gap, m", [](const Preset& preset) {
    PresetWorld world(preset);
    std::vector<BodyId> links;
    std::vector<JointDesc> joints;
    const auto corner = [](int i) {
      const SinCos a = sin_cos(2 * kPi * i / 12);
      return Vec3(a.sin, a.cos, 0);
    };
    for (int i = 0; i < 12; ++i) {
      const Vec3 from = corner(i), to = corner(i + 1);
      BodyDesc link = W::box(Vec3((to - from).norm(), 0.05, 0.05), 0.5 * (from + to));
      link.X_WB.rotation = Quat::FromTwoVectors(Vec3::UnitX(), to - from);
      links.push_back(world.add(with_tiny_shape(link)));
    }
    const double weight_N = 12 * W::box(Vec3(0.5176, 0.05, 0.05), Vec3::Zero()).mass_kg * kG;
    for (std::size_t i = 0; i < 12; ++i) {
      JointDesc joint =
          joint_at(world, Kind::kBall, links[(i + 11) % 12], links[i], corner(static_cast<int>(i)));
      // The lowest joint, which bears horizontal forces only.
      if (i == 6) joint.breaking_N = 0.01 * weight_N;
      joints.push_back(joint);
      world.physics().join(joint);
    }
    joints.push_back(joint_at(world, Kind::kBall, {}, links[0], corner(0)));
    world.physics().join(joints.back());
    world.run(2);
    EXPECT_EQ(world.physics().take_broken().size(), 1u) << preset.name;
    double worst = 0;
    for (std::size_t i = 0; i < joints.size(); ++i)
      if (i != 6) worst = std::max(worst, gap(world, joints[i]));
    EXPECT_LT(worst, 0.01) << preset.name;
    EXPECT_GT(gap(world, joints[6]), 0.02) << preset.name;
    return worst;
  });
}

TEST(Chain, GivesTheSameBitsForAnyNumberOfThreads) {
  std::uint64_t hashes[3];
  const int before = threads();
  for (int run = 0; run < 3; ++run) {
    set_threads(run == 0 ? 1 : run == 1 ? 2 : 4);
    RigidWorld world(awake());
    world.add(W::ground());
    for (int i = 0; i < 8; ++i) {
      const Vec3 along = Vec3(0.1 * i, -1, 0.2).normalized();
      add_chain(world, {.links = 5 + 3 * i, .ball_ratio = 5000.0 * i + 1, .along = along});
    }
    world.run(1, 1.0 / 60, 4);
    hashes[run] = world.hash();
  }
  set_threads(before);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace sunder::solver
