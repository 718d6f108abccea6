// Tests that a step of another length changes no force between bodies at rest, and moves none.
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/planar/planar_physics.h"
#include "tests/fixtures/piles.h"
#include "tests/fixtures/presets.h"
#include "tests/solver/chains.h"

namespace sunder::solver::changed_step_test {
namespace {

using W = RigidWorld;

struct StepOf {
  double dt_s;
  int substeps;
};
constexpr StepOf kBefore = {1.0 / 120, 4};
constexpr std::array<StepOf, 6> kAfter = {
    {{1.0 / 480, 4}, {1.0 / 240, 4}, {1.0 / 109, 4}, {1.0 / 60, 4}, {1.0 / 30, 4}, {1.0 / 120, 8}}};

/// Bodies that come to rest, all of which report their loads.
struct Case {
  std::string name;
  std::function<std::vector<BodyId>(RigidWorld&)> add;
  /// Change of forces, as a fraction of all, and of places, m, by waking alone.
  double force = 1e-3, place_m = 5e-5;
};

BodyDesc reporting(BodyDesc desc, std::uint32_t tag) {
  desc.reports_load = true;
  desc.tag = tag;
  return desc;
}

BodyId add(RigidWorld& world, const BodyDesc& desc) {
  return world.add(reporting(desc, static_cast<std::uint32_t>(world.size())));
}

std::vector<BodyId> add_stack(RigidWorld& world, int count) {
  world.add(W::ground());
  std::vector<BodyId> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(add(world, W::box(Vec3(0.5, 0.25, 0.5), Vec3(0, 0.125 + 0.25 * i, 0), 2000)));
  return boxes;
}

std::vector<BodyId> add_wall(RigidWorld& world) {
  world.add(W::ground());
  std::vector<BodyId> bricks;
  const Vec3 size(0.4, 0.2, 0.2);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) {
      const double along = column + 0.5 * (row % 2);
      const Vec3 at(along * size.x(), (row + 0.5) * size.y(), 0);
      bricks.push_back(add(world, W::box(size, at, 2000)));
    }
  return bricks;
}

std::vector<BodyId> add_on_slope(RigidWorld& world) {
  const Vec3 normal = Vec3(0.3, 1, 0).normalized();
  world.add(W::with_friction(W::ground(normal), 0.8));
  std::vector<BodyId> boxes;
  for (int i = 0; i < 2; ++i) {
    BodyDesc box = W::box(Vec3(0.6, 0.2, 0.4), (0.1 + 0.2 * i) * normal, 2000);
    box.X_WB.rotation = Quat::FromTwoVectors(Vec3::UnitY(), normal);
    boxes.push_back(add(world, W::with_friction(box, 0.8)));
  }
  return boxes;
}

/// A pile that was dropped: its contacts bear their loads by overlaps.
std::vector<BodyId> add_pile(RigidWorld& world) {
  world.add(W::ground());
  std::vector<BodyId> pile;
  for (const BodyDesc& box : boxes_of({40, 3, 0.35, 0.15, 3})) pile.push_back(add(world, box));
  return pile;
}

/// A post on a foot in the world, and a beam that leaves it sideways: a cantilever of two joints.
std::vector<BodyId> add_cantilever(RigidWorld& world) {
  world.add(W::ground());
  const BodyId post = add(world, W::box(Vec3(0.2, 2, 0.2), Vec3(0, 1.5, 0), 2000));
  const BodyId beam = add(world, W::box(Vec3(1.5, 0.2, 0.2), Vec3(0.85, 2.4, 0), 2000));
  const auto fix = [&](BodyId a, BodyId b, const Vec3& at_W) {
    JointDesc joint = joint_at(world, JointDesc::Kind::kFixed, a, b, at_W);
    world.physics().join(joint);
  };
  fix({}, post, Vec3(0, 0.5, 0));
  fix(post, beam, Vec3(0.1, 2.4, 0));
  return {post, beam};
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"one box", [](RigidWorld& world) { return add_stack(world, 1); }},
      {"stack", [](RigidWorld& world) { return add_stack(world, 8); }},
      {"wall", add_wall},
      {"slope", add_on_slope},
      {"pile", add_pile, 1e-2, 4e-3},
      {"cantilever", add_cantilever}};
  return all;
}

/// Forces on bodies: by contact, by contact over the step, and by joint over the step.
struct Forces {
  std::vector<Vec3> by_contact, by_contact_step, by_joint;
};

Forces forces(RigidWorld& world, double dt_s) {
  Forces all;
  for (const ContactForce& contact : world.physics().contact_forces())
    all.by_contact.push_back(contact.force_W);
  for (const ContactImpulse& contact : world.physics().contact_impulses())
    all.by_contact_step.push_back(contact.impulse_W / dt_s);
  for (const JointImpulse& joint : world.physics().joint_impulses()) {
    all.by_joint.push_back(joint.impulse_W / dt_s);
    all.by_joint.push_back(joint.angular_impulse_W / dt_s);
  }
  return all;
}

void expect_equal(const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((after[i] - before[i]).norm(), 1e-5 * before[i].norm() + 1e-9) << i;
}

bool all_asleep(const RigidWorld& world, const std::vector<BodyId>& bodies) {
  return std::ranges::all_of(bodies, [&](BodyId id) { return world.state(id).asleep; });
}

/// Runs a world until all of these bodies sleep.
void fall_asleep(RigidWorld& world, const std::vector<BodyId>& bodies) {
  for (int i = 0; i < 20 && !all_asleep(world, bodies); ++i)
    world.run(0.5, kBefore.dt_s, kBefore.substeps);
  ASSERT_TRUE(all_asleep(world, bodies));
}

/// Calls visit(case, world, bodies, step) for each case, asleep, and each step that follows.
template <class Visit>
void for_all_asleep(const Visit& visit) {
  for (const Case& of : cases()) {
    for (const StepOf& after : kAfter) {
      SCOPED_TRACE(of.name + ", dt 1/" + std::to_string(1 / after.dt_s));
      RigidWorld world;
      const std::vector<BodyId> bodies = of.add(world);
      fall_asleep(world, bodies);
      visit(of, world, bodies, after);
    }
  }
}

TEST(ChangedStep, LeavesTheForcesOfSleepingBodiesAsTheyAre) {
  for_all_asleep(
      [](const Case&, RigidWorld& world, const std::vector<BodyId>&, const StepOf& after) {
        const Forces before = forces(world, kBefore.dt_s);
        ASSERT_FALSE(before.by_contact.empty() && before.by_joint.empty());
        world.step(after.dt_s, after.substeps);
        world.step(after.dt_s, after.substeps);
        const Forces now = forces(world, after.dt_s);
        expect_equal(before.by_contact, now.by_contact);
        expect_equal(before.by_contact_step, now.by_contact_step);
        expect_equal(before.by_joint, now.by_joint);
      });
}

/// Returns the force on the ground and in joints to the world, upwards.
double support_N(RigidWorld& world) {
  double sum = 0;
  for (const ContactForce& contact : world.physics().contact_forces())
    if (contact.body_tag_a == 0) sum += contact.force_W.y();
  return sum;
}

TEST(ChangedStep, MovesNoBodyThatWakesLater) {
  for_all_asleep([](const Case& of, RigidWorld& world, const std::vector<BodyId>& bodies,
                    const StepOf& after) {
    std::vector<Vec3> places;
    for (const BodyId id : bodies) places.push_back(world.state(id).X_WB.position);
    const double bears_N = support_N(world);
    world.run(10 * after.dt_s, after.dt_s, after.substeps);
    for (const BodyId id : bodies)
      world.physics().apply_impulse(id, Vec3::Zero(), world.state(id).X_WB.position);
    const int steps = static_cast<int>(0.25 / after.dt_s);
    for (int i = 0; i < steps; ++i) {
      world.step(after.dt_s, after.substeps);
      if (of.name != "cantilever") {
        EXPECT_NEAR(support_N(world), bears_N, of.force * bears_N) << i;
      }
    }
    for (std::size_t i = 0; i < bodies.size(); ++i)
      EXPECT_LT((world.state(bodies[i]).X_WB.position - places[i]).norm(), of.place_m) << i;
  });
}

TEST(ChangedStep, LeavesTheForcesOfSleepingPlanarBodiesAsTheyAre) {
  for (const StepOf& after : kAfter) {
    SCOPED_TRACE("dt 1/" + std::to_string(1 / after.dt_s));
    RigidWorld world(make_planar_physics({}));
    const std::vector<BodyId> bodies = add_stack(world, 4);
    fall_asleep(world, bodies);
    const Forces before = forces(world, kBefore.dt_s);
    ASSERT_FALSE(before.by_contact.empty());
    world.step(after.dt_s, after.substeps);
    world.step(after.dt_s, after.substeps);
    const Forces now = forces(world, after.dt_s);
    expect_equal(before.by_contact, now.by_contact);
    expect_equal(before.by_contact_step, now.by_contact_step);
    world.physics().apply_impulse(bodies[0], Vec3::Zero(), world.state(bodies[0]).X_WB.position);
    for (int i = 0; i < 30; ++i) world.step(after.dt_s, after.substeps);
    for (std::size_t i = 0; i < bodies.size(); ++i)
      EXPECT_NEAR(world.state(bodies[i]).X_WB.position.y(), 0.125 + 0.25 * static_cast<double>(i),
                  0.01);
  }
}

}  // namespace
}  // namespace sunder::solver::changed_step_test
