// Tests of plastic joints against plastic theory: limits, distances, work, momentum, energy.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/solver/chains.h"
#include "tests/solver/plastic_joints.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(PlasticJoint, AThrownBarStopsWhenItsEnergyIsDissipated) {
  const double tolerance[] = {0.05, 0.015, 0.004};
  for (int i = 0; i < 3; ++i) {
    const int substeps = 1 << 2 * i;
    Frame frame;
    BodyDesc bar =
        W::moving(W::box(Vec3(2, 0.2, 0.2), Vec3(1, 0, 0)), Vec3(0, 4, 0), Vec3(0, 0, 4));
    const BodyId id = frame.world.add(bar);
    frame.join({}, id, Vec3::Zero());
    const double wanted = frame.world.kinetic_energy() / kMoment_Nm;
    frame.run(2, substeps);
    const double turn = angle(frame.world, id);
    std::printf("thrown bar at 1/%d s: turns by %.4f of %.4f rad, W / (Mp turn) %.6f\n",
                60 * substeps, turn, wanted, frame.work_J / (kMoment_Nm * turn));
    EXPECT_NEAR(turn / wanted, 1, tolerance[i]);
    EXPECT_NEAR(frame.work_J / (kMoment_Nm * turn), 1, 0.4 / (60 * substeps));
    EXPECT_NEAR(frame.flowed[0].turn_R.z(), turn, 1e-5);
    frame.run(5, substeps);
    EXPECT_NEAR(angle(frame.world, id), turn, 1e-4) << "the bar must not spring back";
    EXPECT_LT((frame.world.state(id).X_WB.position.norm() - 1), 1e-4);
  }
}

/// Returns the distance that a body moves in one second, held to the world at the origin under
/// gravity of `share` times its limit load.
double travel_under(double share, const Vec3& center_W, const Vec3& down_W,
                    const SectionStrength& bears = strength()) {
  const BodyDesc body = W::box(Vec3(0.5, 0.5, 0.5), center_W);
  const auto load = [&](double g) {
    const Vec3 force = body.mass_kg * g * down_W;
    return utilisation(bears, {force, center_W.cross(force)});
  };
  double g = share / load(1);  // A shear or axial force alone scales with the load.
  g *= share / load(g);
  Frame frame(g * down_W);
  const BodyId id = frame.world.add(body);
  frame.join({}, id, Vec3::Zero(), bears);
  frame.run(1, 4);
  EXPECT_EQ(frame.work_J > 0, share > 1);
  return (frame.world.state(id).X_WB.position - center_W).norm();
}

TEST(PlasticJoint, ASectionHoldsBelowItsLimitLoadAndMovesAboveIt) {
  SectionStrength weak = strength();
  weak.shear_N = 100;
  SectionStrength aslant = strength();  // A section whose normal is not along x.
  aslant.axes_R = Quat(Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized())).toRotationMatrix();
  const struct {
    const char* what;
    Vec3 center_W, down_W;
    SectionStrength bears;
  } cases[] = {
      {"bent", Vec3(2, 0, 0), -Vec3::UnitY(), strength()},
      {"bent the other way", Vec3(2, 0, 0), Vec3::UnitZ(), strength()},
      {"bent about a diagonal", Vec3(2, 0, 0), Vec3(0, -1, 1).normalized(), strength()},
      {"bent about any axis", Vec3(2, 0, 0), Vec3(0, -1, 0.3).normalized(), strength()},
      {"twisted", Vec3(0, 0, 1.5), -Vec3::UnitY(), strength()},
      {"twisted and bent", Vec3(1, 0, 1), -Vec3::UnitY(), strength()},
      {"sheared", Vec3(0.1, 0, 0), -Vec3::UnitY(), weak},
      {"drawn", Vec3(1, 0, 0), Vec3::UnitX(), strength()},
      {"all of it, aslant", Vec3(1, 0.2, 1), -Vec3::UnitY(), aslant},
  };
  for (const auto& it : cases) {
    const double stands = travel_under(0.97, it.center_W, it.down_W, it.bears);
    const double moves = travel_under(1.03, it.center_W, it.down_W, it.bears);
    std::printf("%-22s at 0.97: %.1e m, at 1.03: %.3f m\n", it.what, stands, moves);
    EXPECT_LT(stands, 1e-5) << it.what;
    EXPECT_GT(moves, 0.01) << it.what;
  }
  EXPECT_LT(travel_under(0.97, Vec3(1, 0, 0), -Vec3::UnitX()), 1e-5) << "pressed";
}

TEST(PlasticJoint, CompressionDoesNotFlow) {
  SectionStrength bears = strength();
  Frame frame(Vec3(-3 * bears.axial_N / W::box(Vec3::Ones(), Vec3::Zero()).mass_kg, 0, 0));
  const BodyId id = frame.world.add(W::box(Vec3::Ones(), Vec3(1, 0, 0)));
  frame.join({}, id, Vec3::Zero(), bears);
  frame.run(1, 4);
  EXPECT_LT((frame.world.state(id).X_WB.position - Vec3(1, 0, 0)).norm(), 1e-3);
}

TEST(PlasticJoint, ABeamFixedAtBothEndsBearsSixteenPlasticMomentsOverItsLengthSquared) {
  constexpr int kParts = 8;
  const BodyDesc part = W::box(Vec3(1, 0.2, 0.2), Vec3::Zero());
  for (const double share : {0.95, 1.05}) {
    for (const int substeps : {1, 4, 8}) {
      const double g = share * 16 * kMoment_Nm / (kParts * kParts) / part.mass_kg;
      Frame frame(Vec3(0, -g, 0));
      BodyId last;
      for (int i = 0; i <= kParts; ++i) {
        const BodyId next =
            i < kParts ? frame.world.add(W::box(Vec3(1, 0.2, 0.2), Vec3(i + 0.5, 0, 0))) : BodyId();
        frame.join(last, next, Vec3(i, 0, 0));
        last = next;
      }
      frame.run(0.1, substeps);
      const auto turn = [&](std::size_t joint) { return frame.flowed[joint].turn_R.z(); };
      const double ends = turn(0), other = turn(8) / ends;
      const double middle = (turn(3) + turn(4) + turn(5)) / ends;
      frame.run(2, substeps);
      const double sag = -frame.world.state(frame.world.id(kParts / 2)).X_WB.position.y();
      std::printf(
          "fixed beam at %.2f of 16 Mp/L2, %d substeps: hinges 1 : %.3f : %.3f, sags %.1e m\n",
          share, substeps, middle, other, sag);
      if (share < 1) {
        EXPECT_LT(sag, 1e-5);
        continue;
      }
      // A beam held at both ends sags only as far as its joints allow it to lengthen.
      EXPECT_GT(sag, 1e-3);
      EXPECT_NEAR(middle, -2, 0.02);
      EXPECT_NEAR(other, 1, 0.02);
      double fallen_J = 0;
      for (std::size_t i = 0; i < kParts; ++i)
        fallen_J -= part.mass_kg * g * frame.world.state(frame.world.id(i)).X_WB.position.y();
      EXPECT_NEAR(frame.work_J / fallen_J, 1, 0.1);
      frame.run(1, substeps);
      EXPECT_NEAR(-frame.world.state(frame.world.id(kParts / 2)).X_WB.position.y(), sag, 1e-4);
    }
  }
}

/// Adds a free chain of boxes in plastic joints.
void add_free_chain(Frame& frame, int links, double length_m, const SectionStrength& bears) {
  BodyId last;
  for (int i = 0; i < links; ++i) {
    const BodyId next = frame.world.add(
        with_tiny_shape(W::box(Vec3(length_m, 0.2, 0.2), Vec3(length_m * (i + 0.5), 0, 0))));
    if (i > 0) frame.join(last, next, Vec3(length_m * i, 0, 0), bears);
    last = next;
  }
}

/// Largest rises of the kinetic energy and of kinetic energy plus plastic work, over the initial
/// kinetic energy, and relative changes of momentum and angular momentum.
struct ConservationErrors {
  double motion = 0, energy = 0, momentum = 0, spin = 0;
};
ConservationErrors measure_conservation(Frame& frame, double time_s, int substeps) {
  ConservationErrors errors;
  const Vec3 p = frame.world.momentum(), L = frame.world.angular_momentum();
  const double before = frame.world.kinetic_energy();
  double least_motion = before, least = before;
  for (int i = 0; i < std::lround(time_s / kPlasticDt_s); ++i) {
    frame.step(substeps);
    const double motion = frame.world.kinetic_energy();
    errors.motion = std::max(errors.motion, (motion - least_motion) / before);
    errors.energy = std::max(errors.energy, (motion + frame.work_J - least) / before);
    least_motion = std::min(least_motion, motion);
    least = std::min(least, motion + frame.work_J);
  }
  errors.momentum = (frame.world.momentum() - p).norm() / p.norm();
  errors.spin = (frame.world.angular_momentum() - L).norm() / L.norm();
  return errors;
}

TEST(PlasticJoint, AThrownChainKeepsItsMomentaAndGainsNoEnergy) {
  for (const int substeps : {1, 4, 16}) {
    Frame frame;
    add_free_chain(frame, 12, 0.5, strength());
    for (std::size_t i = 0; i < 4; ++i) {
      BodyState state = frame.world.state(frame.world.id(i));
      state.velocity_W = Vec3(0, 8, 3);
      frame.world.physics().set_state(frame.world.id(i), state);
    }
    const double energy = frame.world.kinetic_energy();
    const ConservationErrors errors = measure_conservation(frame, 1.5, substeps);
    std::printf(
        "chain of 12, %2d substeps: W %.4f, with motion %.4f of E0, rises by %.1e at most; p %.1e, "
        "L %.1e\n",
        substeps, frame.work_J / energy, (frame.work_J + frame.world.kinetic_energy()) / energy,
        errors.energy, errors.momentum, errors.spin);
    EXPECT_LT(errors.motion, 1e-5);
    EXPECT_LT(errors.energy, 1e-5);
    EXPECT_LT(errors.momentum, 1e-6);
    EXPECT_LT(errors.spin, 1e-5);
  }
}

TEST(PlasticJoint, ManyThrownChainsKeepTheirMomentaAndGainNoEnergy) {
  Random random(7);
  ConservationErrors worst;
  const auto between = [&](double least, double most) { return random.uniform(least, most); };
  for (int run = 0; run < 200; ++run) {
    Frame frame;
    SectionStrength bears = strength(std::pow(10, between(1, 4)));
    bears.shear_N *= between(0.02, 1), bears.axial_N *= between(0.02, 1);
    const double share_y = between(0.2, 1), share_x = between(0.2, 1);
    bears.moment_Nm = bears.moment_Nm.cwiseProduct(Vec3(share_x, share_y, 1));
    bears.axes_R = Quat(Eigen::AngleAxisd(between(0, 1), Vec3::UnitY())).toRotationMatrix();
    add_free_chain(frame, 2 + run % 9, between(0.3, 1), bears);
    for (std::size_t i = 0; i < frame.world.size(); ++i) {
      BodyState state = frame.world.state(frame.world.id(i));
      const auto any = [&] {
        const double z = between(-8, 8), y = between(-8, 8), x = between(-8, 8);
        return Vec3(x, y, z);
      };
      state.velocity_W = Vec3(5, 0, 0) + any(), state.angular_velocity_W = any();
      frame.world.physics().set_state(frame.world.id(i), state);
    }
    const ConservationErrors errors = measure_conservation(frame, 0.5, 4);
    worst.motion = std::max(worst.motion, errors.motion);
    worst.energy = std::max(worst.energy, errors.energy);
    worst.momentum = std::max(worst.momentum, errors.momentum);
    worst.spin = std::max(worst.spin, errors.spin);
  }
  std::printf("200 chains: motion rises by %.1e, with work by %.1e of E0 at most; p %.1e, L %.1e\n",
              worst.motion, worst.energy, worst.momentum, worst.spin);
  EXPECT_LT(worst.motion, 2e-3) << "the error of tumbling in any joint";
  EXPECT_LT(worst.energy, 0.01);
  EXPECT_LT(worst.momentum, 1e-5);
  EXPECT_LT(worst.spin, 1e-4);
}

}  // namespace
}  // namespace sunder::solver
