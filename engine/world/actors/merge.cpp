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

/// Motion of two merged bodies, and the kinetic energy lost by the merge.
struct MergedMotion {
  Motion motion;
  double lost_J = 0;
};

/// Returns the motion of two merged bodies, whose mass properties `both` are in the rest frame of
/// the first.
MergedMotion merged_motion(const WorldState& world, const Actor& a, const Actor& b,
                           const CompoundMass& both) {
  MergedMotion result;
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
    result.lost_J += 0.5 * momentum_W.dot(velocity_W) + 0.5 * own_W.dot(spin_W);
  }
  // Mitres have changed the centre of mass by rounding: the rest frame moves by the difference.
  const Quat& rotation_WR = states[0].X_WB.rotation;
  VelocityField& field = result.motion.field;
  result.motion.X_WR = {center_W - rotation_WR * both.com_R, rotation_WR};
  field = {center_W, momentum / mass_kg,
           rotation_WR * (both.inertia_R.inverse() * (rotation_WR.conjugate() * angular))};
  result.lost_J -= 0.5 * (momentum.dot(field.velocity_W) + angular.dot(field.angular_velocity_W));
  return result;
}

/// Applies the edit that adds the second actor to the first, and returns a new actor with both.
Actor make_merged_actor(WorldState& world, Actor& a, const Actor& b, const BreakEdit& edit) {
  DrawnConvexes drawn_before;
  a.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    drawn_before[&convex] = {a.meshes[slot.value], a.hidden[slot.value]};
  });
  a.structure.apply(edit);
  Actor both = make_actor(world, a.structure.compound());
  both.inherit(a);
  both.born_step = world.clock.step + 1;
  set_least(world, both);  // recomputed, as it is a fragment
  world.meshes.add_to(std::span(&both, 1), drawn_before);
  world.log.debris_mass_kg +=
      a.weight.mass_kg + b.weight.mass_kg - both.weight.mass_kg;  // rounding
  const auto [motion, lost_J] = merged_motion(world, a, b, both.weight);
  world.log.add_plastic_work(lost_J);
  const BodyDesc body = make_body_desc(world, both, motion);
  const std::array<BodyId, 2> gone{a.body, b.body};
  both.body = world.physics->replace(gone, std::span(&body, 1))[0];
  return both;
}

}  // namespace

void merge(WorldState& world, std::uint32_t key, std::uint32_t other, const Rejoined& rejoined,
           const Pose& X_AB) {
  std::vector<ConvexSlot> slot_of_b = rejoined.slot_of_b;
  if (world.actors.find(key)->is_static) {
    BreakEdit edit = rejoined.edit;
    apply_break(world, key, edit);
    const Actor& b = *world.actors.find(other);
    world.log.debris_mass_kg += b.weight.mass_kg;
    world.log.add_plastic_work(kinetic_J(b, world.physics->state(b.body)));
    world.physics->replace(std::span(&b.body, 1), {});
  } else {
    Actor& a = *world.actors.find(key);
    Actor both = make_merged_actor(world, a, *world.actors.find(other), rejoined.edit);
    const std::vector<ConvexSlot> slots = a.structure.slots();
    for (ConvexSlot& slot : slot_of_b) {
      const auto at = std::ranges::lower_bound(slots, slot);
      if (!slot.none()) slot = ConvexSlot(at - slots.begin());
    }
    world.log.report.joints_lost +=
        world.joints.reassign_ends(*world.physics, a, false, std::span(&both, 1));
    world.actors.erase(world.actors.place_of(a));
    key = both.key;
    world.actors.add(std::move(both));
  }
  Actor& both = *world.actors.find(key);
  both.rejoined = 1 + std::max(both.rejoined, world.actors.find(other)->rejoined);
  world.joints.transfer(*world.physics, world.actors, other, both, X_AB, slot_of_b);
  world.actors.erase(world.actors.place_of(*world.actors.find(other)));
}

}  // namespace sunder
