// Tests of the impact probe by hand calculation: impacts that are passed on, shared, or follow one
// another.
#include "solver/impact/event_probe.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "engine/base/rotation.h"

namespace sunder::solver {
namespace {

constexpr double kStep_s = 1.0 / 60;
constexpr double kStill_m_s = 0.01;

ProbeBody ball(double mass_kg, const Vec3& velocity_W) {
  ProbeBody body;
  body.inverse_mass = 1 / mass_kg;
  body.inverse_inertia_W = Mat3::Identity() * (100 / mass_kg);
  body.velocity_W = velocity_W;
  return body;
}

/// Fixed to the world.
ProbeBody pane(double safe_work_J = 0) {
  ProbeBody body;
  body.breakable = true;
  body.safe_work_J = safe_work_J;
  return body;
}

ProbeContact contact(std::uint32_t a, std::uint32_t b, double separation_m = 0,
                     const Vec3& arm_W = Vec3::Zero()) {
  ProbeContact c;
  c.a = a, c.b = b;
  c.arm_a_W = arm_W;
  c.normal_W = -Vec3::UnitY();
  c.separation_m = separation_m;
  return c;
}

double kinetic_J(const std::vector<ProbeBody>& bodies, const std::vector<ProbeMotion>& motions) {
  double sum = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].inverse_mass <= 0) continue;
    sum += 0.5 / bodies[b].inverse_mass * motions[b].velocity_W.squaredNorm();
    const Vec3& w = motions[b].angular_velocity_W;
    sum += 0.5 * w.dot(bodies[b].inverse_inertia_W.inverse() * w);
  }
  return sum;
}

std::vector<ProbeContact> four_corners(std::uint32_t a, std::uint32_t b) {
  std::vector<ProbeContact> contacts;
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) contacts.push_back(contact(a, b, 0, Vec3(x, 0, z)));
  }
  return contacts;
}

TEST(EventProbe, FindsTheWorkOfABlowPassedOnByAPlate) {
  const double m = 2, plate_kg = 6, v = 8;
  std::vector<ProbeContact> contacts = four_corners(1, 0);
  contacts.push_back(contact(2, 1));
  EventProbe probe({pane(), ball(plate_kg, Vec3::Zero()), ball(m, Vec3(0, -v, 0))}, contacts,
                   kStep_s, kStill_m_s);
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  const double work_J = 0.5 * m * m * v * v / (m + plate_kg);
  EXPECT_NEAR(loads[0].work_J, work_J, 0.02 * work_J);
  EXPECT_NEAR(loads[0].impulse_Ns, m * v, 0.02 * m * v);
  EXPECT_EQ(loads[0].body, 0u);
  EXPECT_LT((loads[0].direction_W + Vec3::UnitY()).norm(), 1e-9);
}

TEST(EventProbe, KnowsHowMuchItHasLookedAt) {
  EventProbe probe({ball(1, Vec3(0, -3, 0)), pane()}, {contact(0, 1)}, kStep_s, kStill_m_s);
  EXPECT_EQ(probe.evaluations(), 1u) << "its contact";
  ASSERT_EQ(probe.next().size(), 1u);
  const std::uint64_t once = probe.evaluations();
  EXPECT_GT(once, 2u) << "an event, and what it does";
  probe.keep_unbroken();
  EXPECT_TRUE(probe.next().empty());
  EXPECT_GT(probe.evaluations(), once);
}

TEST(EventProbe, TellsWhichWayABlowGoesWhicheverBodyComesFirst) {
  for (const bool first : {false, true}) {
    const Vec3 way = first ? Vec3(Vec3::UnitY()) : Vec3(-Vec3::UnitY());
    std::vector<ProbeBody> bodies = {pane(), ball(2, 8 * way)};
    EventProbe probe(bodies, {first ? contact(0, 1) : contact(1, 0)}, kStep_s, kStill_m_s);
    const auto loads = probe.next();
    ASSERT_EQ(loads.size(), 1u);
    EXPECT_EQ(loads[0].body, 0u);
    EXPECT_LT((loads[0].direction_W - way).norm(), 1e-9);
  }
}

TEST(EventProbe, FindsTheWorkOfABlowPassedAlongARow) {
  // A row of twenty has more impacts in sequence than the probe evaluates one by one.
  for (const auto& [n, gap_m] : {std::pair(6, 0.0), {6, 1e-3}, {20, 1e-3}}) {
    const double m = 3, v = 20;
    std::vector<ProbeBody> bodies = {pane()};
    std::vector<ProbeContact> contacts;
    for (int i = 0; i < n; ++i) {
      bodies.push_back(ball(m, Vec3(0, i == n - 1 ? -v : 0, 0)));
      const auto self = static_cast<std::uint32_t>(i + 1);
      contacts.push_back(contact(self, self - 1, i == n - 1 ? 0 : gap_m));
    }
    EventProbe probe(bodies, contacts, kStep_s, kStill_m_s);
    const auto loads = probe.next();
    ASSERT_EQ(loads.size(), 1u) << n << ", " << gap_m;
    const double work_J = 0.5 * m * v * v / n;
    EXPECT_NEAR(loads[0].work_J, work_J, 0.05 * work_J) << n << ", " << gap_m;
  }
}

TEST(EventProbe, NamesWhatGoesWithTheStriker) {
  // Body 1 strikes. 2 follows it at its velocity, 3 rests against 2, 4 drives 1 on from the side,
  // and 5 strikes by itself.
  const Vec3 fall(0, -8, 0);
  std::vector<ProbeBody> bodies = {
      pane(), ball(2, fall), ball(3, fall), ball(1, Vec3::Zero()), ball(4, fall), ball(5, fall)};
  EventProbe probe(bodies,
                   {contact(1, 0), contact(2, 1, 1e-3), contact(3, 2, 0, Vec3(1, 0, 0)),
                    contact(4, 2), contact(5, 0)},
                   kStep_s, kStill_m_s);
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_EQ(loads[0].striker, 5u) << "the heaviest";
  EXPECT_TRUE(loads[0].riders.empty());
  EXPECT_NEAR(loads[0].work_J, 0.5 * (2 + 5) * 64, 1e-2);
  EXPECT_NEAR(loads[0].striker_J, 0.5 * 5 * 64, 1e-2);
  bodies.pop_back();
  EventProbe without(
      bodies, {contact(1, 0), contact(2, 1, 1e-3), contact(3, 2, 0, Vec3(1, 0, 0)), contact(4, 2)},
      kStep_s, kStill_m_s);
  const auto alone = without.next();
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_EQ(alone[0].striker, 1u);
  EXPECT_EQ(alone[0].riders, (std::vector<std::uint32_t>{2, 4}));
}

TEST(EventProbe, KnowsThatTheSecondEndOfABarStrikesNoFasterThanTheBar) {
  // A bar has fallen on its left end, and turns about it.
  ProbeBody bar = ball(1, Vec3(0, -7.5, 0));
  bar.inverse_inertia_W = Mat3::Identity() * 12;  // of length 1
  bar.angular_velocity_W = Vec3(0, 0, -15);
  bar.breakable = true;
  ProbeBody ground;
  ProbeContact end = contact(0, 1, 0, Vec3(0.5, 0, 0));
  end.arm_b_W = end.arm_a_W;
  EventProbe probe({bar, ground}, {end}, kStep_s, kStill_m_s);
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_NEAR(loads[0].speed_m_s, 15, 1e-6);
  EXPECT_NEAR(loads[0].whole_m_s, std::sqrt(7.5 * 7.5 + 15 * 15 / 12.), 1e-6);
}

TEST(EventProbe, GoesOnToTheHardestOnceADozenHaveMet) {
  std::vector<ProbeBody> bodies = {pane(), ball(100, Vec3(0, -5, 0)), pane(),
                                   ball(0.01, Vec3(0, -10, 0))};
  std::vector<ProbeContact> contacts = {contact(1, 0, 0.05), contact(3, 2, 0.06)};
  for (int i = 0; i < 13; ++i) {
    bodies.push_back(ball(1, Vec3(0, i == 0 ? -20 : 0, 0)));
    const auto self = static_cast<std::uint32_t>(bodies.size() - 1);
    if (i > 0) contacts.push_back(contact(self - 1, self, 1e-3));
  }
  // Without the broken body, the light ball would arrive first.
  const auto loads = EventProbe(bodies, contacts, kStep_s, kStill_m_s).next();
  ASSERT_FALSE(loads.empty());
  EXPECT_EQ(loads[0].body, 0u);
  EXPECT_NEAR(loads[0].work_J, 0.5 * 100 * 25, 1);
}

TEST(EventProbe, TellsIfMoreMeetThanItsEvents) {
  const std::vector<ProbeBody> bodies = {ball(1, Vec3(0, -20, 0)), ball(1, Vec3::Zero()),
                                         ball(1, Vec3::Zero()), pane()};
  const std::vector<ProbeContact> contacts = {contact(0, 1, 0.01), contact(1, 2, 0.01)};
  for (const std::uint32_t events : {1u, 2u}) {
    EventProbe probe(bodies, contacts, kStep_s, kStill_m_s, Vec3::Zero(), {}, events);
    EXPECT_TRUE(probe.next().empty());
    EXPECT_EQ(probe.reached_limit(), events == 1);
  }
}

TEST(EventProbe, SharesAFlatLandingAmongTenColumns) {
  const double m = 500, v = 3;
  std::vector<ProbeBody> bodies(10, pane());
  bodies.push_back(ball(m, Vec3(0, -v, 0)));
  std::vector<ProbeContact> contacts;
  for (std::uint32_t i = 0; i < 10; ++i) {
    contacts.push_back(contact(10, i, 0, Vec3(i % 5 - 2.0, 0, i < 5 ? -1 : 1)));
  }
  EventProbe probe(bodies, contacts, kStep_s, kStill_m_s);
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 10u);
  const double all_J = 0.5 * m * v * v;
  double sum_J = 0;
  for (const ImpactLoad& load : loads) {
    EXPECT_NEAR(load.work_J, all_J / 10, 0.1 * all_J / 10);
    sum_J += load.work_J;
  }
  EXPECT_NEAR(sum_J, all_J, 0.01 * all_J);

  std::vector<ProbeBreak> wanted;
  for (std::uint32_t i = 0; i < 10; ++i) wanted.push_back({i, 0.05 * all_J});
  EXPECT_EQ(probe.release(wanted).size(), 10u);
  EXPECT_NEAR(kinetic_J(probe.bodies(), probe.motions()), 0.5 * all_J, 1e-9 * all_J);
}

TEST(EventProbe, BreaksNoColumnThatTheOthersRelieve) {
  std::vector<ProbeBody> bodies(4, pane());
  bodies.push_back(ball(100, Vec3(0, -2, 0)));
  std::vector<ProbeContact> contacts;
  for (std::uint32_t i = 0; i < 4; ++i) {
    contacts.push_back(contact(4, i, 0, Vec3(i % 2 ? 1 : -1, 0, i < 2 ? 1 : -1)));
  }
  EventProbe probe(bodies, contacts, kStep_s, kStill_m_s);
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 4u);
  // One of four legs breaks: the slab still stands on a diagonal and one more leg and does not
  // move, so that the energy is not available.
  const std::vector<ProbeBreak> one = {{0, 0.9 * loads[0].work_J}};
  EXPECT_TRUE(probe.release(one).empty());
}

TEST(EventProbe, HasTheBallBehindItsDebrisBreakTheNextLayer) {
  const double m = 3, crumb_kg = 1e-3, v = 25;
  EventProbe probe({pane(), ball(crumb_kg, Vec3(0, -v, 0)), ball(m, Vec3(0, -v, 0))},
                   {contact(1, 0, 1e-3), contact(2, 1, 0)}, kStep_s, kStill_m_s);
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  const double work_J = 0.5 * (m + crumb_kg) * v * v;
  EXPECT_NEAR(loads[0].work_J, work_J, 0.05 * work_J);
}

TEST(EventProbe, TakesTheEnergyAtTheTimeOfTheHitAndLeavesTheBallThere) {
  const double m = 0.1, v = 200, energy_J = 40, distance_m = 0.5;
  for (const double dt_s : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    EventProbe probe({pane(), pane(), ball(m, Vec3(0, -v, 0))},
                     {contact(2, 0, distance_m), contact(2, 1, distance_m + 0.1)}, dt_s,
                     kStill_m_s);
    const auto loads = probe.next();
    ASSERT_EQ(loads.size(), 1u);
    EXPECT_EQ(loads[0].body, 0u);  // the nearer one first
    const std::vector<ProbeBreak> wanted = {{0, energy_J}};
    ASSERT_EQ(probe.release(wanted).size(), 1u);
    const ProbeMotion& motion = probe.motions()[2];
    EXPECT_NEAR(0.5 * m * motion.velocity_W.squaredNorm(), 0.5 * m * v * v - energy_J, 1e-9);
    const double hit_s = distance_m / v;
    EXPECT_NEAR(motion.shift_W.y() + hit_s * motion.velocity_W.y(), -distance_m, 1e-9);
  }
}

TEST(EventProbe, MeetsAtTheSpeedThatGravityHasGivenByThen) {
  const double m = 5, v = 1, gap_m = 0.01, energy_J = 2;
  const Vec3 gravity_W(0, -10, 0);
  const double work_J = 0.5 * m * v * v + m * 10 * gap_m;
  EventProbe probe({pane(), ball(m, Vec3(0, -v, 0))}, {contact(1, 0, gap_m)}, kStep_s, kStill_m_s,
                   gravity_W);
  const auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_NEAR(loads[0].work_J, work_J, 1e-4 * work_J);
  const std::vector<ProbeBreak> wanted = {{0, energy_J}};
  ASSERT_EQ(probe.release(wanted).size(), 1u);
  // From the start of the step on gravity is the solver's.
  const ProbeMotion& motion = probe.motions()[1];
  const double meet_s = 2 * gap_m / (v + std::sqrt(v * v + 2 * 10 * gap_m));
  const Vec3 then_W = motion.velocity_W + meet_s * gravity_W;
  EXPECT_NEAR(0.5 * m * then_W.squaredNorm(), work_J - energy_J, 1e-9);
  const Vec3 way_W = motion.shift_W + meet_s * (motion.velocity_W + 0.5 * meet_s * gravity_W);
  EXPECT_NEAR(way_W.y(), -gap_m, 1e-12);
}

TEST(EventProbe, KeepsAngularMomentumOfAGlancingBlowBetweenSpinningBodies) {
  const double gap_m = 0.2;
  ProbeBody stone = ball(2, Vec3(0, -20, 0)), plank = ball(5, Vec3(10, 0, 3));
  stone.position_W = Vec3(1, 0.5 + gap_m, 0.3);
  plank.inverse_inertia_W = Vec3(10, 2, 1).asDiagonal();
  plank.angular_velocity_W = Vec3(3, 5, 20);
  plank.breakable = true;
  ProbeContact blow = contact(0, 1, gap_m);
  blow.arm_a_W = Vec3(0, -0.4, 0);
  blow.arm_b_W = Vec3(1, 0.1, 0.3);
  const auto spin = [](const ProbeBody& body, const Vec3& shift_W, const Vec3& rotation_W,
                       const Vec3& velocity_W, const Vec3& w_W) -> Vec3 {
    const Mat3 turn(rotation_by(rotation_W));
    const Mat3 inertia_W = turn * body.inverse_inertia_W.inverse() * turn.transpose();
    return (body.position_W + shift_W).cross(velocity_W) / body.inverse_mass + inertia_W * w_W;
  };
  EventProbe probe({stone, plank}, {blow}, kStep_s, kStill_m_s);
  ASSERT_EQ(probe.next().size(), 1u);
  const std::vector<ProbeBreak> wanted = {{0, 5}};
  ASSERT_EQ(probe.release(wanted).size(), 1u);
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  for (std::size_t b = 0; b < 2; ++b) {
    const ProbeBody& body = probe.bodies()[b];
    const ProbeMotion& motion = probe.motions()[b];
    ASSERT_TRUE(motion.changed);
    before += spin(body, Vec3::Zero(), Vec3::Zero(), body.velocity_W, body.angular_velocity_W);
    after +=
        spin(body, motion.shift_W, motion.rotation_W, motion.velocity_W, motion.angular_velocity_W);
  }
  EXPECT_LT((after - before).norm(), 1e-9 * before.norm());
}

TEST(EventProbe, LetsNothingFallThatStandsOrLeans) {
  // Gravity as strong as it takes to break the pane, were it felt.
  for (const bool is_supported : {false, true}) {
    ProbeBody stands = ball(5, Vec3::Zero());
    stands.is_supported = is_supported;
    EventProbe probe({pane(0.1), stands, pane(0.1)},
                     {contact(1, 0, 0.05), contact(1, 2, is_supported ? 1 : 0)}, kStep_s,
                     kStill_m_s, Vec3(0, -1000, 0));
    EXPECT_TRUE(probe.next().empty());
  }
}

TEST(EventProbe, LoadsWhatIsBehindASolidThatHolds) {
  // A ball on a loose brick on a pane: if the brick holds, the pane has to bear the rest.
  ProbeBody brick = ball(4, Vec3::Zero());
  brick.breakable = true;
  brick.safe_work_J = 0.01;
  EventProbe probe({pane(0.01), brick, ball(2, Vec3(0, -10, 0))}, {contact(1, 0), contact(2, 1)},
                   kStep_s, kStill_m_s);
  auto loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_EQ(loads[0].body, 1u);
  EXPECT_TRUE(probe.release({}).empty());
  probe.keep_unbroken();
  loads = probe.next();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_EQ(loads[0].body, 0u);
  EXPECT_NEAR(loads[0].work_J, 0.5 * 2 * 2 * 100 / 6.0, 1.0);
  probe.keep_unbroken();
  EXPECT_TRUE(probe.next().empty());
}

}  // namespace
}  // namespace sunder::solver
