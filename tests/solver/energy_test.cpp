// Tests of a solve's energy accounting against closed forms, at every preset.
#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

/// Sums of energy flows over several steps, and the gain of kinetic energy in them.
struct EnergyAccount {
  EnergyFlows flows;
  double gained_J = 0;
};
EnergyAccount run(PresetWorld& world, const Preset& preset, double time_s) {
  EnergyAccount account;
  const double before_J = world.kinetic_energy();
  const auto steps = static_cast<int>(std::lround(time_s / preset.dt_s));
  for (int i = 0; i < steps; ++i) account.flows += world.step().energy;
  account.gained_J = world.kinetic_energy() - before_J;
  return account;
}

TEST(Energy, OfAFallingBodyIsTheWorkOfGravity) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    const BodyDesc box = W::box(Vec3(1, 1, 1), Vec3(0, 100, 0));
    const BodyId id = world.add(box);
    const EnergyAccount account = run(world, preset, 2);
    const double fall_m = 100 - world.state(id).X_WB.position.y();
    EXPECT_NEAR(account.flows.gravity, box.mass_kg * kG * fall_m, 1e-6 * account.flows.gravity);
    EXPECT_NEAR(account.flows.gravity, account.gained_J, 1e-9 * account.gained_J);
    EXPECT_NEAR(account.flows.contacts, 0, 1e-12 * account.gained_J) << preset.name;
    EXPECT_EQ(account.flows.friction, 0) << preset.name;
  }
}

TEST(Energy, OfASlidingBlockIsLostToFriction) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    world.add(W::with_friction(W::ground(), 0.5));
    const BodyDesc slab = W::with_friction(W::box(Vec3(2, 0.2, 2), Vec3(0, 0.1, 0)), 0.5);
    world.add(slab);
    run(world, preset, 0.5);  // The slab comes to rest.
    BodyState state = world.state(world.id(1));
    state.velocity_W.x() = 3;
    world.physics().set_state(world.id(1), state);
    const EnergyAccount account = run(world, preset, 1);
    const double moved_J = 0.5 * slab.mass_kg * 9;
    EXPECT_NEAR(account.flows.friction, moved_J, 0.02 * moved_J) << preset.name;
    EXPECT_NEAR(account.flows.contacts, 0, 0.02 * moved_J) << preset.name;
  }
}

TEST(Energy, OfAPlasticCollisionIsLostToContacts) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset, Vec3::Zero());
    const BodyDesc light = W::box(Vec3(1, 1, 1), Vec3(-1.2, 0, 0));
    const BodyDesc heavy = W::box(Vec3(2, 2, 2), Vec3(1, 0, 0));
    world.add(W::moving(light, Vec3(4, 0, 0)));
    world.add(heavy);
    const EnergyAccount account = run(world, preset, 0.5);
    const double reduced_kg = light.mass_kg * heavy.mass_kg / (light.mass_kg + heavy.mass_kg);
    EXPECT_NEAR(account.flows.contacts, 0.5 * reduced_kg * 16, 0.01 * account.flows.contacts);
    EXPECT_NEAR(account.flows.friction, 0, 1e-3 * account.flows.contacts) << preset.name;
  }
}

TEST(Energy, OfALiftedLoadIsTheWorkOfDrives) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    BodyDesc lift = W::box(Vec3(4, 0.5, 4), Vec3(0, -0.25, 0));
    lift.is_kinematic = true;
    lift.velocity_W = Vec3(0, 1, 0);
    world.add(lift);
    const BodyDesc load = W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0));
    world.add(W::moving(load, Vec3(0, 1, 0)));
    const EnergyAccount account = run(world, preset, 2);
    const double lifted_J = load.mass_kg * kG * 2;
    EXPECT_NEAR(account.flows.gravity, -lifted_J, 0.01 * lifted_J) << preset.name;
    EXPECT_NEAR(account.flows.drives, lifted_J, 0.01 * lifted_J) << preset.name;
  }
}

// With joints, the solver measures the work of contacts and takes the rest as the work of joints. A
// joint that bears no load must leave the work of joints near zero; a difference remains, because
// bodies rotate within a step while an impulse acts.
TEST(Energy, LostToContactsIsMeasuredWithinSixPerCent) {
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
    const EnergyAccount account = run(world, preset, 3);
    EXPECT_NEAR(account.flows.joints, 0, 0.06 * account.flows.moved()) << preset.name;
    EXPECT_NEAR(account.flows.sum(), account.gained_J, 1e-9 * account.flows.moved()) << preset.name;
    EXPECT_GT(account.flows.contacts, 0) << preset.name;
    EXPECT_GT(account.flows.friction, 0) << preset.name;
  }
}

}  // namespace
}  // namespace sunder::solver
