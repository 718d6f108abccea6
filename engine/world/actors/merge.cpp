#include "engine/world/actors/merge.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "engine/world/actors/make_actor.h"
#include "engine/world/actors/replace.h"

namespace sunder {
namespace {

/// How two bodies move as one, and what is left of their energy for bending to take.
struct Together {
  Motion motion;
  double taken_J = 0;
};

/// Its weight is given in the rest frame of the first.
Together together(const World& world, const Actor& a, const Actor& b, const Weight& both) {
  Together result;
  const std::array<const Actor*, 2> actors{&a, &b};
  std::array<BodyState, 2> states;
  Vec3 moment = Vec3::Zero(), momentum = Vec3::Zero();
  for (std::size_t i = 0; i < 2; ++i) {
    states[i] = world.physics->state(actors[i]->body);
    moment += actors[i]->weight.mass_kg * states[i].X_WB.position;
    momentum += actors[i]->weight.mass_kg * states[i].velocity_W;
  }
  const double mass_kg = a.weight.mass_kg + b.weight.mass_kg;
  const Vec3 center_W = moment / mass_kg;
  Vec3 angular = Vec3::Zero();
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [X_WB, velocity_W, spin_W, asleep] = states[i];
    const Vec3 own_W =
        X_WB.rotation * (actors[i]->weight.inertia_R * (X_WB.rotation.conjugate() * spin_W));
    const Vec3 momentum_W = actors[i]->weight.mass_kg * velocity_W;
    angular += own_W + (X_WB.position - center_W).cross(momentum_W);
    result.taken_J += 0.5 * momentum_W.dot(velocity_W) + 0.5 * own_W.dot(spin_W);
  }
  // Mitres have moved the centre by what they have rounded: the rest frame moves by that.
  const Quat& rotation_WR = states[0].X_WB.rotation;
  VelocityField& field = result.motion.field;
  result.motion.X_WR = {center_W - rotation_WR * both.com_R, rotation_WR};
  field = {center_W, momentum / mass_kg,
           rotation_WR * (both.inertia_R.inverse() * (rotation_WR.conjugate() * angular))};
  result.taken_J -= 0.5 * (momentum.dot(field.velocity_W) + angular.dot(field.angular_velocity_W));
  return result;
}

/// The first takes in the second, and gives way to an actor that has both.
Actor made_of_both(World& world, Actor& a, const Actor& b, const BreakEdit& edit) {
  DrawnBefore looks;
  a.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    looks[&convex] = {a.meshes[slot.value], a.hidden[slot.value]};
  });
  a.structure.apply(edit);
  Actor both = make_actor(world, a.structure.compound());
  both.root_key = a.root_key;
  both.shown_key = a.shown_key;
  both.name = a.name;
  both.rejoined = a.rejoined;
  both.born_step = world.clock.step + 1;
  set_least(world, both);  // of a fragment
  world.meshes.add_to(std::span(&both, 1), looks);
  world.ledger.debris_mass_kg +=
      a.weight.mass_kg + b.weight.mass_kg - both.weight.mass_kg;  // rounding
  const auto [motion, taken_J] = together(world, a, b, both.weight);
  world.ledger.note_bending(taken_J);
  const BodyDesc body = describe(world, both, motion);
  const std::array<BodyId, 2> gone{a.body, b.body};
  both.body = world.physics->replace(gone, std::span(&body, 1))[0];
  return both;
}

}  // namespace

void merge(World& world, std::uint32_t key, std::uint32_t other, const Rejoined& rejoined,
           const Pose& X_AB) {
  std::vector<ConvexSlot> slot_of_b = rejoined.slot_of_b;
  if (world.actors.find(key)->is_static) {
    BreakEdit edit = rejoined.edit;
    carry_out(world, key, edit);
    const Actor& b = *world.actors.find(other);
    world.ledger.debris_mass_kg += b.weight.mass_kg;
    world.ledger.note_bending(kinetic_J(b, world.physics->state(b.body)));
    world.physics->replace(std::span(&b.body, 1), {});
  } else {
    Actor& a = *world.actors.find(key);
    Actor both = made_of_both(world, a, *world.actors.find(other), rejoined.edit);
    const std::vector<ConvexSlot> slots = a.structure.slots();
    for (ConvexSlot& slot : slot_of_b) {
      const auto at = std::ranges::lower_bound(slots, slot);
      if (!slot.none()) slot = ConvexSlot(at - slots.begin());
    }
    world.ledger.report.joints_lost +=
        world.joints.follow(*world.physics, a, false, std::span(&both, 1));
    world.actors.erase(world.actors.place_of(a));
    key = both.key;
    world.actors.add(std::move(both));
  }
  Actor& both = *world.actors.find(key);
  both.rejoined = 1 + std::max(both.rejoined, world.actors.find(other)->rejoined);
  world.joints.move(*world.physics, world.actors, other, both, X_AB, slot_of_b);
  world.actors.erase(world.actors.place_of(*world.actors.find(other)));
}

}  // namespace sunder
