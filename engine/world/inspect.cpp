#include "engine/world/inspect.h"

#include <vector>

#include "engine/base/disjoint_sets.h"
#include "engine/base/parallel.h"
#include "engine/world/actors/load_case.h"

namespace sunder {
namespace {

/// Returns the island of each actor: movable bodies connected by contact forces or joints.
std::vector<std::uint32_t> islands(const WorldState& world,
                                   const std::vector<ContactForce>& contact_forces) {
  DisjointSets sets(world.actors.size());
  const auto join = [&](std::uint32_t key_a, std::uint32_t key_b) {
    const Actor *a = world.actors.find(key_a), *b = world.actors.find(key_b);
    if (!a || !b || a->is_static || b->is_static) return;
    sets.join(static_cast<std::uint32_t>(world.actors.place_of(*a)),
              static_cast<std::uint32_t>(world.actors.place_of(*b)));
  };
  for (const ContactForce& press : contact_forces) join(press.body_tag_a, press.body_tag_b);
  for (const Joints::Live& joint : world.joints.live()) join(joint.a.key, joint.b.key);
  return sets.roots();
}

/// Returns the stresses of an actor by slot; empty if load cannot break it.
std::vector<float> stresses_of(const WorldState& world, const Breaker& breaker, const Actor& actor,
                               const Quat& rotation_WB) {
  const StressState& stress = actor.stress;
  if (!stress.breakable) return {};
  // In free fall, only spin causes stress.
  if (!actor.is_static && stress.mean_forces.empty() && stress.spin_R.isZero())
    return std::vector<float>(actor.structure.slot_count(), 0);
  std::vector<AppliedForce> loads;
  return breaker.utilisation(actor.structure, make_load_case(world, actor, rotation_WB, loads));
}

/// Returns stresses in the order of the frame's instances.
std::vector<float> stresses(const WorldState& world, const Breaker& breaker, const Frame& frame) {
  std::vector<std::vector<float>> by_actor(world.actors.size());
  for_chunks(by_actor.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    by_actor[i] = stresses_of(world, breaker, world.actors[i], frame.bodies[i].X_WB.rotation);
  });
  std::vector<float> all;
  for (std::size_t i = 0; i < by_actor.size(); ++i) {
    const std::vector<MeshIndex>& meshes = world.actors[i].meshes;
    for (std::size_t slot = 0; slot < meshes.size(); ++slot) {
      if (meshes[slot].none()) continue;
      all.push_back(slot < by_actor[i].size() ? by_actor[i][slot] : -1);
    }
  }
  return all;
}

}  // namespace

std::shared_ptr<const Inspection> inspect(const WorldState& world, const Breaker& breaker,
                                          const Frame& frame) {
  const PhysicsInspection physics = world.physics->inspect();
  const std::vector<ContactForce> contact_forces = world.physics->contact_forces();
  auto seen = std::make_shared<Inspection>();
  for (const ContactForce& press : contact_forces) {
    seen->contacts.push_back({press.point_W.cast<float>(), press.force_W.cast<float>(),
                              press.body_tag_a, press.body_tag_b});
  }
  for (const ShapeBox& box : physics.boxes) {
    const Actor* actor = world.actors.find(box.body_tag);
    if (!actor) continue;
    seen->boxes.push_back({box.box_W.min.cast<float>(), box.box_W.max.cast<float>(),
                           static_cast<std::uint32_t>(world.actors.place_of(*actor))});
  }
  seen->islands = islands(world, contact_forces);
  seen->stresses = stresses(world, breaker, frame);
  // Meshes of the ground come last.
  for (auto i = seen->islands.size(); i < frame.bodies.size(); ++i)
    seen->islands.push_back(static_cast<std::uint32_t>(i));
  seen->stresses.resize(frame.instances.size(), -1);
  return seen;
}

}  // namespace sunder
