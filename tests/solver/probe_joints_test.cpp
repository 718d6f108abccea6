// Tests of the impact probe with joints by hand calculation: the striking mass includes the jointed
// bodies, as far as the joints transmit the impact.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/base/rotation.h"
#include "solver/impact/event_probe.h"

namespace sunder::solver {
namespace {

constexpr double kStill_m_s = 1e-3;
constexpr double kSteps_s[] = {1.0 / 60, 1.0 / 240, 1.0 / 960};

ProbeBody joined_body(double mass_kg, const Vec3& inertia_kgm2, const Vec3& position_W,
                      const Vec3& velocity_W, const Vec3& angular_velocity_W = Vec3::Zero()) {
  ProbeBody body;
  body.inverse_mass = 1 / mass_kg;
  body.inverse_inertia_W = inertia_kgm2.cwiseInverse().asDiagonal();
  body.position_W = position_W;
  body.velocity_W = velocity_W;
  body.angular_velocity_W = angular_velocity_W;
  return body;
}

/// Returns an immovable body; a breakable one breaks at any energy.
ProbeBody fixed_body(bool breakable) {
  ProbeBody body;
  body.breakable = breakable;
  return body;
}

/// Between points of two bodies: its ends, or twice the same.
ProbeJoint joint_between(const std::vector<ProbeBody>& bodies, JointKind kind, std::uint32_t a,
                         std::uint32_t b, const Vec3& a_W, const Vec3& b_W) {
  return {kind, a, b, a_W - bodies[a].position_W, b_W - bodies[b].position_W};
}

ProbeContact contact_at(const std::vector<ProbeBody>& bodies, std::uint32_t a, std::uint32_t b,
                        const Vec3& point_W, const Vec3& normal_W, double gap_m = 0) {
  ProbeContact contact{a, b};
  contact.arm_a_W = point_W - bodies[a].position_W;
  contact.arm_b_W = point_W + gap_m * normal_W - bodies[b].position_W;
  contact.normal_W = normal_W;
  contact.separation_m = gap_m;
  return contact;
}

ProbeContact rope_between(const std::vector<ProbeBody>& bodies, std::uint32_t a, std::uint32_t b,
                          const Vec3& a_W, const Vec3& b_W, double slack_m = 0) {
  ProbeContact rope{a, b};
  rope.arm_a_W = a_W - bodies[a].position_W;
  rope.arm_b_W = b_W - bodies[b].position_W;
  rope.normal_W = (a_W - b_W).normalized();
  rope.separation_m = slack_m;
  rope.rope = true;
  return rope;
}

struct Sums {
  double kinetic_J = 0;
  Vec3 momentum = Vec3::Zero(), spin = Vec3::Zero();  ///< About the origin.
};

void add(Sums& sums, const ProbeBody& body, const ProbeMotion& motion) {
  if (body.inverse_mass <= 0) return;
  const Mat3 turn(rotation_by(motion.rotation_W));
  const Mat3 inertia_W = turn * body.inverse_inertia_W.inverse() * turn.transpose();
  const Vec3 p = motion.velocity_W / body.inverse_mass,
             spin = inertia_W * motion.angular_velocity_W;
  sums.kinetic_J += 0.5 * p.dot(motion.velocity_W) + 0.5 * spin.dot(motion.angular_velocity_W);
  sums.momentum += p;
  sums.spin += (body.position_W + motion.shift_W).cross(p) + spin;
}

Sums sums_before(const std::vector<ProbeBody>& bodies) {
  Sums sums;
  for (const ProbeBody& body : bodies) add(sums, body, {body.velocity_W, body.angular_velocity_W});
  return sums;
}

Sums sums_after(const EventProbe& probe) {
  Sums sums;
  for (std::size_t b = 0; b < probe.bodies().size(); ++b) {
    const ProbeBody& body = probe.bodies()[b];
    const ProbeMotion still{body.velocity_W, body.angular_velocity_W};
    add(sums, body, probe.motions()[b].changed ? probe.motions()[b] : still);
  }
  return sums;
}

/// The only load there is has that work; half of that breaks it, and is all that is lost.
void expect_work(EventProbe probe, double work_J) {
  const double before_J = sums_before(probe.bodies()).kinetic_J;
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_NEAR(loads[0].work_J, work_J, 2e-4 * work_J);
  const std::vector<ProbeBreak> wanted = {{0, 0.5 * work_J}};
  ASSERT_EQ(probe.release(wanted).size(), 1u);
  EXPECT_NEAR(before_J - sums_after(probe).kinetic_J, 0.5 * work_J, 1e-4 * work_J);
}

TEST(ProbeJoints, ABallStrikesWithTheMassOfWhatItIsFixedTo) {
  const double v = 3;
  for (const double dt_s : kSteps_s) {
    for (const JointKind kind : {JointKind::kFixed, JointKind::kDistance, JointKind::kBall}) {
      const Vec3 velocity_W(v, 0, 0), behind_W(-0.5, 0, 0);
      const std::vector<ProbeBody> bodies = {
          fixed_body(true), joined_body(1, Vec3::Constant(0.01), Vec3::Zero(), velocity_W),
          joined_body(9, Vec3::Constant(0.1), behind_W, velocity_W)};
      const ProbeJoint bar = joint_between(bodies, kind, 1, 2, Vec3::Zero(), behind_W);
      const ProbeContact hit =
          contact_at(bodies, 1, 0, Vec3(0.1, 0, 0), Vec3::UnitX(), 0.5 * v * dt_s);
      expect_work({bodies, {hit}, dt_s, kStill_m_s, Vec3::Zero(), {bar}}, 0.5 * 10 * v * v);
    }
  }
}

TEST(ProbeJoints, APendulumStrikesAtTheBottomWithItsBall) {
  const double m = 4, v = 5;
  const Vec3 pivot_W(0, 8, 0);
  for (const double dt_s : kSteps_s) {
    for (const bool rope : {false, true}) {
      const std::vector<ProbeBody> bodies = {
          fixed_body(true), joined_body(m, Vec3::Constant(0.1), Vec3::Zero(), Vec3(v, 0, 0)),
          fixed_body(false)};
      std::vector<ProbeContact> contacts = {
          contact_at(bodies, 1, 0, Vec3(0.2, 0, 0), Vec3::UnitX(), 0.5 * v * dt_s)};
      std::vector<ProbeJoint> joints;
      if (rope) {
        contacts.push_back(rope_between(bodies, 1, 2, Vec3::Zero(), pivot_W));
      } else {
        joints.push_back(joint_between(bodies, JointKind::kDistance, 1, 2, Vec3::Zero(), pivot_W));
      }
      expect_work({bodies, contacts, dt_s, kStill_m_s, Vec3(0, -9.81, 0), joints}, 0.5 * m * v * v);
    }
  }
}

TEST(ProbeJoints, ARopeBearsAlongItselfOnlyOnceItIsTaut) {
  const double v = 2;
  for (const double slack_m : {0.0, 0.5}) {
    const Vec3 velocity_W(v, 0, 0), before_W(0.5, 0, 0);
    // The first has passed beside the pane; the rope has the second follow it.
    std::vector<ProbeBody> bodies = {fixed_body(true),
                                     joined_body(1, Vec3::Constant(0.01), Vec3::Zero(), velocity_W),
                                     joined_body(9, Vec3::Constant(0.1), before_W, velocity_W)};
    const ProbeContact hit = contact_at(bodies, 2, 0, Vec3(0.7, 0, 0), -Vec3::UnitX());
    bodies[1].velocity_W = bodies[2].velocity_W = -velocity_W;
    const ProbeContact rope = rope_between(bodies, 1, 2, Vec3::Zero(), before_W, slack_m);
    expect_work({bodies, {hit, rope}, kSteps_s[0], kStill_m_s},
                0.5 * (slack_m > 0 ? 9 : 10) * v * v);
  }
}

/// A free chain of rods along x with ball joints, all at one velocity, whose first rod hits with
/// its tip at the origin.
EventProbe chain_that_hits(int rods, const Vec3& velocity_W, double dt_s) {
  std::vector<ProbeBody> bodies = {fixed_body(true)};
  for (int i = 0; i < rods; ++i) {
    bodies.push_back(
        joined_body(2, Vec3(0.01, 2.0 / 12, 2.0 / 12), Vec3(-0.5 - i, 0, 0), velocity_W));
  }
  std::vector<ProbeJoint> joints;
  for (std::uint32_t i = 1; i < bodies.size() - 1; ++i) {
    const Vec3 at_W(-1.0 * i, 0, 0);
    joints.push_back(joint_between(bodies, JointKind::kBall, i, i + 1, at_W, at_W));
  }
  const Vec3 way = velocity_W.normalized();
  const ProbeContact hit =
      contact_at(bodies, 1, 0, Vec3::Zero(), way, 0.3 * velocity_W.norm() * dt_s);
  return {bodies, {hit}, dt_s, kStill_m_s, Vec3::Zero(), joints};
}

TEST(ProbeJoints, AChainStrikesWithAllOfItAlongAndWithItsEndAcross) {
  const double v = 6;
  for (const double dt_s : kSteps_s) {
    double across_kg = 0;  // of what hangs at the far end of a rod
    for (int rods = 1; rods <= 12; ++rods) {
      expect_work(chain_that_hits(rods, Vec3(v, 0, 0), dt_s), 0.5 * 2 * rods * v * v);
      const double mass = 2 + across_kg, center_m = (2 * 0.5 + across_kg) / mass;
      const double inertia = 2.0 / 12 + 2 * (center_m - 0.5) * (center_m - 0.5) +
                             across_kg * (1 - center_m) * (1 - center_m);
      across_kg = 1 / (1 / mass + center_m * center_m / inertia);
      expect_work(chain_that_hits(rods, Vec3(0, -v, 0), dt_s), 0.5 * across_kg * v * v);
    }
  }
}

TEST(ProbeJoints, ADoorGivesAtItsFreeEdgeAsItTurns) {
  const double kg = 30, ball_kg = 2, v = 4;
  const Vec3 inertia(kg / 12, kg / 6, kg / 12), center_W(0.5, 0, 0);
  const double door_kg = inertia.y() + kg * 0.25;  // at 1 m from its hinge
  for (const double dt_s : kSteps_s) {
    const std::vector<ProbeBody> bodies = {
        joined_body(kg, inertia, center_W, Vec3::Zero()), fixed_body(false),
        joined_body(ball_kg, Vec3::Constant(0.01), Vec3(1, 0, -0.1), Vec3(0, 0, v)),
        fixed_body(true)};
    ProbeJoint hinge = joint_between(bodies, JointKind::kHinge, 0, 1, Vec3::Zero(), Vec3::Zero());
    hinge.axis_W = Vec3::UnitY();
    std::vector<ProbeBody> struck = bodies;
    struck[0].breakable = true;
    struck[3].breakable = false;
    const ProbeContact blow =
        contact_at(bodies, 2, 0, Vec3(1, 0, 0), Vec3::UnitZ(), 0.3 * v * dt_s);
    expect_work({struck, {blow}, dt_s, kStill_m_s, Vec3::Zero(), {hinge}},
                0.5 * v * v * ball_kg * door_kg / (ball_kg + door_kg));
    // And what it strikes itself, wherever that is on it.
    std::vector<ProbeBody> turning = bodies;
    turning[0].velocity_W = Vec3(0, 0, 0.5 * v);
    turning[0].angular_velocity_W = Vec3(0, -v, 0);
    for (const double arm_m : {0.2, 1.0}) {
      const ProbeContact stop = contact_at(bodies, 0, 3, Vec3(arm_m, 0, 0), Vec3::UnitZ());
      turning[2].velocity_W.setZero();
      expect_work({turning, {stop}, dt_s, kStill_m_s, Vec3::Zero(), {hinge}},
                  0.5 * door_kg * v * v);
    }
  }
}

TEST(ProbeJoints, WhatJointsHoldBearsAsWhatIsFixed) {
  const double m = 3, v = 7;
  // A breakable block on a bracket on the world.
  const Vec3 at_W(0.5, 0, 0);
  std::vector<ProbeBody> bodies = {
      joined_body(2, Vec3::Constant(0.1), Vec3(0.2, 0, 0), Vec3::Zero()),
      joined_body(2, Vec3::Constant(0.1), Vec3(0.7, 0, 0), Vec3::Zero()), fixed_body(false),
      joined_body(m, Vec3::Constant(0.1), Vec3(-0.1, 0, 0), Vec3(v, 0, 0))};
  bodies[0].breakable = true;
  EventProbe probe(bodies, {contact_at(bodies, 3, 0, Vec3::Zero(), Vec3::UnitX())}, kSteps_s[0],
                   kStill_m_s, Vec3::Zero(),
                   {joint_between(bodies, JointKind::kFixed, 0, 1, at_W, at_W),
                    joint_between(bodies, JointKind::kFixed, 1, 2, at_W, at_W)});
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_NEAR(loads[0].work_J, 0.5 * m * v * v, 1e-4 * m * v * v);
}

TEST(ProbeJoints, WhatHangsDoesNotFallAndWhatSwingsFallsAsItMay) {
  // Gravity as strong as it takes to break the pane, were it felt.
  const Vec3 gravity_W(0, -1000, 0);
  for (const bool hangs : {true, false}) {
    const std::vector<ProbeBody> bodies = {
        fixed_body(true), joined_body(5, Vec3::Constant(0.1), Vec3::Zero(), Vec3::Zero()),
        fixed_body(false)};
    const Vec3 pivot_W = hangs ? Vec3(0, 2, 0) : Vec3(2, 0, 0);
    const ProbeJoint rod = joint_between(bodies, JointKind::kDistance, 1, 2, Vec3::Zero(), pivot_W);
    EventProbe probe(bodies, {contact_at(bodies, 1, 0, Vec3::Zero(), -Vec3::UnitY(), 0.02)},
                     kSteps_s[0], kStill_m_s, gravity_W, {rod});
    const auto loads = probe.next();
    ASSERT_EQ(loads.size(), hangs ? 0u : 1u);
    if (hangs) continue;
    EXPECT_NEAR(loads[0].work_J, 5 * 1000 * 0.02, 0.2);
  }
}

/// Bodies joined at random, rings among them, that fly and turn as one towards a plate.
struct Throw {
  std::vector<ProbeBody> bodies;
  std::vector<ProbeContact> contacts;
  std::vector<ProbeJoint> joints;
};

Throw random_throw(Random& random, bool at_once) {
  Throw thrown;
  std::vector<ProbeBody>& bodies = thrown.bodies;
  const std::uint32_t count = 2 + random.below(8);
  const Vec3 velocity_W = 10 * random.direction(), w_W = 5 * random.uniform() * random.direction();
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double kg = std::pow(10, random.uniform(-2, 3));
    const Vec3 at_W = 2 * random.uniform() * random.direction();
    Vec3 shape = Vec3::Ones();  // which turns alike about any axis
    if (at_once) shape += 0.5 * random.direction();
    bodies.push_back(joined_body(kg, 0.05 * kg * shape, at_W, velocity_W + w_W.cross(at_W), w_W));
  }
  for (std::uint32_t i = 1; i < count; ++i) {
    for (std::uint32_t left = 1 + random.below(2); left > 0; --left) {
      const std::uint32_t to = random.below(i);
      const Vec3 a_W = bodies[i].position_W + 0.3 * random.direction();
      const Vec3 b_W = bodies[to].position_W + 0.3 * random.direction();
      const auto kind = static_cast<JointKind>(random.below(5));
      if (kind == JointKind::kRope) {
        thrown.contacts.push_back(rope_between(bodies, i, to, a_W, b_W));
      } else {
        const bool apart = kind == JointKind::kDistance;
        thrown.joints.push_back(joint_between(bodies, kind, i, to, a_W, apart ? b_W : a_W));
        thrown.joints.back().axis_W = random.direction();
      }
    }
  }
  ProbeBody& plate = bodies.back();
  plate.breakable = true;
  plate.velocity_W.setZero();
  const std::uint32_t first = random.below(count);
  const Vec3 point_W = bodies[first].position_W + 0.3 * random.direction();
  thrown.contacts.push_back(contact_at(bodies, first, count, point_W, velocity_W.normalized(),
                                       at_once ? 0 : random.uniform(0, 0.1)));
  return thrown;
}

TEST(ProbeJoints, KeepMomentumAndMakeNoEnergyHoweverTheyHangTogether) {
  Random random(5, 17);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool at_once = i % 2 == 0;
    const Throw thrown = random_throw(random, at_once);
    EventProbe probe(thrown.bodies, thrown.contacts, 1.0 / 60, kStill_m_s, Vec3::Zero(),
                     thrown.joints);
    const auto loads = probe.next();
    if (loads.empty()) continue;
    const double energy_J = random.uniform(0.1, 0.9) * loads[0].work_J;
    const std::vector<ProbeBreak> wanted = {{0, energy_J}};
    ASSERT_EQ(probe.release(wanted).size(), 1u) << i;
    ++hits;
    const Sums before = sums_before(thrown.bodies), after = sums_after(probe);
    const double lost_J = before.kinetic_J - after.kinetic_J;
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-9 * before.momentum.norm()) << i;
    EXPECT_LT((after.spin - before.spin).norm(),
              1e-9 * (before.spin.norm() + before.momentum.norm()))
        << i;
    EXPECT_GE(lost_J, energy_J - 1e-9 * before.kinetic_J) << i;
    if (!at_once) continue;  // or joints turn what turned on its way, and take some of it
    EXPECT_NEAR(lost_J, energy_J, 1e-8 * before.kinetic_J) << i;
  }
  EXPECT_GT(hits, 1500);
}

}  // namespace
}  // namespace sunder::solver
