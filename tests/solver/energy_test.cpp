// What a solve says about where kinetic energy went, against closed forms, at every preset.
#include <gtest/gtest.h>

#include "bench/truths/presets.h"
#include "engine/base/random.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

/// Sum of the flows of all steps of that time, and the kinetic energy that the world gained.
struct Book {
  EnergyFlows flows;
  double gained_J = 0;
};
Book run(PresetWorld& world, const Preset& preset, double time_s) {
  Book book;
  const double before_J = world.kinetic_energy();
  const auto steps = static_cast<int>(std::lround(time_s / preset.dt_s));
  for (int i = 0; i < steps; ++i) book.flows += world.step().energy;
  book.gained_J = world.kinetic_energy() - before_J;
  return book;
}

TEST(Energy, OfAFallIsTheWorkOfGravity) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    const BodyDesc box = W::box(Vec3(1, 1, 1), Vec3(0, 100, 0));
    const BodyId id = world.add(box);
    const Book book = run(world, preset, 2);
    const double way_m = 100 - world.state(id).X_WB.position.y();
    EXPECT_NEAR(book.flows.gravity, box.mass_kg * kG * way_m, 1e-6 * book.flows.gravity);
    EXPECT_NEAR(book.flows.gravity, book.gained_J, 1e-9 * book.gained_J);
    EXPECT_NEAR(book.flows.contacts, 0, 1e-12 * book.gained_J) << preset.name;
    EXPECT_EQ(book.flows.friction, 0) << preset.name;
  }
}

TEST(Energy, OfABlockThatBrakesGoesIntoFriction) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    world.add(W::with_friction(W::ground(), 0.5));
    const BodyDesc slab = W::with_friction(W::box(Vec3(2, 0.2, 2), Vec3(0, 0.1, 0)), 0.5);
    world.add(slab);
    run(world, preset, 0.5);  // it settles
    BodyState state = world.state(world.id(1));
    state.velocity_W.x() = 3;
    world.physics().set_state(world.id(1), state);
    const Book book = run(world, preset, 1);
    const double moved_J = 0.5 * slab.mass_kg * 9;
    EXPECT_NEAR(book.flows.friction, moved_J, 0.02 * moved_J) << preset.name;
    EXPECT_NEAR(book.flows.contacts, 0, 0.02 * moved_J) << preset.name;
  }
}

TEST(Energy, OfAPlasticCollisionGoesIntoContacts) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset, Vec3::Zero());
    const BodyDesc light = W::box(Vec3(1, 1, 1), Vec3(-1.2, 0, 0));
    const BodyDesc heavy = W::box(Vec3(2, 2, 2), Vec3(1, 0, 0));
    world.add(W::moving(light, Vec3(4, 0, 0)));
    world.add(heavy);
    const Book book = run(world, preset, 0.5);
    const double reduced_kg = light.mass_kg * heavy.mass_kg / (light.mass_kg + heavy.mass_kg);
    EXPECT_NEAR(book.flows.contacts, 0.5 * reduced_kg * 16, 0.01 * book.flows.contacts);
    EXPECT_NEAR(book.flows.friction, 0, 1e-3 * book.flows.contacts) << preset.name;
  }
}

TEST(Energy, ThatACarrierGivesIsThatOfADrive) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    BodyDesc lift = W::box(Vec3(4, 0.5, 4), Vec3(0, -0.25, 0));
    lift.is_kinematic = true;
    lift.velocity_W = Vec3(0, 1, 0);
    world.add(lift);
    const BodyDesc load = W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0));
    world.add(W::moving(load, Vec3(0, 1, 0)));
    const Book book = run(world, preset, 2);
    const double lifted_J = load.mass_kg * kG * 2;
    EXPECT_NEAR(book.flows.gravity, -lifted_J, 0.01 * lifted_J) << preset.name;
    EXPECT_NEAR(book.flows.drives, lifted_J, 0.01 * lifted_J) << preset.name;
  }
}

// With joints, contacts are what was measured of them, and joints what is left: without any, and
// with one that bears nothing, the book is the same but for what turning within a step makes of
// an impulse.
TEST(Energy, MeasuredOfContactsIsThatWhichTheMotionShows) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    world.add(W::with_friction(W::ground(), 0.6));
    Random random(7, 1);
    for (int i = 0; i < 40; ++i) {
      const Vec3 at_W(random.uniform(-1, 1), 0.6 + 0.6 * i, random.uniform(-1, 1));
      world.add(W::with_friction(W::box(Vec3(0.5, 0.4, 0.3), at_W), 0.6));
    }
    const BodyId a = world.add(W::box(Vec3(1, 1, 1), Vec3(50, 0.5, 0)));
    const BodyId b = world.add(W::box(Vec3(1, 1, 1), Vec3(52, 0.5, 0)));
    JointDesc joint;
    joint.a = a, joint.b = b;
    joint.kind = JointDesc::Kind::kBall;
    joint.anchor_a_R = Vec3(1, 0, 0), joint.anchor_b_R = Vec3(-1, 0, 0);
    world.physics().join(joint);
    const Book book = run(world, preset, 3);
    EXPECT_NEAR(book.flows.joints, 0, 0.06 * book.flows.moved()) << preset.name;
    EXPECT_NEAR(book.flows.sum(), book.gained_J, 1e-9 * book.flows.moved()) << preset.name;
    EXPECT_GT(book.flows.contacts, 0) << preset.name;
    EXPECT_GT(book.flows.friction, 0) << preset.name;
  }
}

}  // namespace
}  // namespace sunder::solver
