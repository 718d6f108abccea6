#include "engine/world/actors/check_state.h"

#include <algorithm>
#include <set>
#include <vector>

#include "engine/base/state_checks.h"
#include "engine/model/checks/item_check.h"

namespace sunder {
namespace {

/// Returns true if a force acts on a convex of the structure.
bool act_on(const Structure& structure, std::span<const AppliedForce> forces) {
  return std::ranges::all_of(
      forces, [&](const AppliedForce& force) { return structure.has(force.convex); });
}

bool have_materials(const Structure& structure, std::size_t materials) {
  bool all = true;
  structure.for_each([&](ConvexSlot, const Convex& convex) {
    all = all && convex.material.value < materials &&
          convex.solid.volume_m3 > 0;  // which masses and strengths are divided by
  });
  return all;
}

const char* wrong_field(const WorldState& world, const Actor& actor, const BodyStates& states) {
  if (!states.holds(actor.body)) return "actors: body";
  const BodyMode mode = states.mode[actor.body.slot];
  if (mode != BodyMode::kFrozen) {
    const bool is_static = mode == BodyMode::kStatic || mode == BodyMode::kKinematic;
    if (actor.is_static != is_static) return "actors: is_static";
    if (actor.is_kinematic != (mode == BodyMode::kKinematic)) return "actors: is_kinematic";
  }
  if (actor.name != kNoName && actor.name >= world.names->size()) return "actors: name";
  if (!have_materials(actor.structure, world.materials->size())) return "actors: structure";
  if (actor.materials.empty() || !all_below(actor.materials, world.materials->size()))
    return "actors: materials";
  if (!(actor.weight.mass_kg > 0)) return "actors: weight";
  if (!(actor.volume_m3 > 0)) return "actors: volume_m3";
  if (actor.born_step > world.clock.step) return "actors: born_step";
  const bool is_ball = actor.structure.empty();
  if (actor.meshes.size() != (is_ball ? 1 : actor.structure.slot_count())) return "actors: meshes";
  for (const MeshIndex mesh : actor.meshes)
    if (!mesh.none() && !(mesh == kMeshPending && !is_ball) && !world.meshes.has(mesh))
      return "actors: meshes";
  if (!is_ball && actor.hidden.size() != actor.structure.slot_count()) return "actors: hidden";
  const StressState& stress = actor.stress;
  if (!act_on(actor.structure, stress.mean_forces) ||
      !act_on(actor.structure, stress.evaluated_forces))
    return "actors: stress";
  return nullptr;
}

/// Compares the bodies and joints of the physics with the actors and joints of the world.
const char* wrong_contents(const WorldState& world) {
  const PhysicsContents contents = world.physics->contents();
  std::size_t of_actors = 0;
  for (const PhysicsContents::Body& body : contents.bodies) {
    if (body.tag == kGroundKey) {
      for (const std::uint32_t tag : body.shape_tags)
        if (tag != kGroundPlaneTag && tag >= world.landscape.facets->size())
          return "physics: tags of the ground";
      continue;
    }
    const Actor* actor = world.actors.find(body.tag);
    if (!actor || actor->body != body.id) return "physics: tags of bodies";
    ++of_actors;
    std::vector<std::uint32_t> slots;
    for (const ConvexSlot slot : actor->structure.slots()) slots.push_back(slot.value);
    if (actor->structure.empty()) slots = {0};
    if (body.shape_tags != slots) return "physics: tags of shapes";
  }
  if (of_actors != world.actors.size()) return "actors: body";
  std::set<JointId> known;
  for (const PhysicsContents::Joint& joint : contents.joints) {
    const auto is_it = [&](const Joints::Live& live) { return live.id == joint.id; };
    const auto live = std::ranges::find_if(world.joints.live(), is_it);
    if (live == world.joints.live().end() || live->desc.kind != joint.kind) return "joints: id";
    known.insert(joint.id);
  }
  return known.size() == world.joints.live().size() ? nullptr : "joints: id";
}

bool is_side(const HingeSide& side, const Actor* actor, std::size_t bonds) {
  if (!have_size(bonds, side.convexes, side.faces, side.slots) || !actor) return false;
  for (std::size_t i = 0; i < bonds; ++i) {
    if (!side.convexes[i] || side.faces[i] >= side.convexes[i]->polyhedron.faces.size())
      return false;
    if (!actor->structure.has(ConvexSlot(side.slots[i]))) return false;
  }
  return std::ranges::count(side.redrawn, nullptr) == 0;
}

const char* wrong_joint(const WorldState& world) {
  for (const Joints::Live& joint : world.joints.live()) {
    for (const Joints::End& end : {joint.a, joint.b})
      if (end.key != kGroundKey && !world.actors.find(end.key)) return "joints: key";
    if (joint.hinge.has_value() != (joint.desc.kind == JointKind::kPlastic)) return "joints: hinge";
    if (!joint.hinge) continue;
    const Hinge& hinge = *joint.hinge;
    const SectionStrength& strength = hinge.section.strength;
    if (!(strength.axial_N > 0 && strength.shear_N > 0 && strength.moment_Nm.minCoeff() > 0) ||
        !(hinge.section.reach_m.minCoeff() >= 0) || !(hinge.section.gauge_m > 0) ||
        !(hinge.section.yield_Pa > 0))
      return "joints: section";
    const std::size_t bonds = hinge.areas_m2.size();
    if (!is_side(hinge.a, world.actors.find(joint.a.key), bonds) ||
        !is_side(hinge.b, world.actors.find(joint.b.key), bonds))
      return "joints: hinge";
  }
  return nullptr;
}

const char* wrong_material(const WorldState& world) {
  if (!world.materials || world.materials->size() < world.scene.materials.size())
    return "materials";
  const ItemCheck check("a saved state: ", *world.materials);
  for (std::size_t i = 0; i < world.materials->size(); ++i)
    check.material((*world.materials)[i], item("materials", i));
  return nullptr;
}

const char* wrong_drawing(const WorldState& world) {
  const std::size_t materials = world.materials->size();
  if (!world.landscape.facets || !all_below(*world.landscape.facets, materials, &Facet::material))
    return "landscape: facets";
  for (const MeshIndex mesh : world.landscape.meshes)
    if (!world.meshes.has(mesh)) return "landscape: meshes";
  const std::size_t appearances = world.appearances ? world.appearances->size() : 0;
  bool all = true;
  world.meshes.for_each([&](const Mesh& mesh) {
    all = all && mesh.material.value < materials &&
          all_below(mesh.vertices, Mesh::kFirstAppearance + appearances, &Mesh::Vertex::look);
  });
  return all ? nullptr : "meshes: store_";
}

}  // namespace

bool is_possible(const WorldState& world, const ActorImpact& impact) {
  const Actor* actor = world.actors.find(impact.key);
  return !actor ||
         (actor->structure.has(impact.convex) && act_on(actor->structure, impact.impulses));
}

const char* wrong_field(const WorldState& world) {
  if (const char* field = wrong_material(world)) return field;
  if (!world.names) return "names";
  if (world.clock.substeps != world.scene.accuracy.substeps) return "clock: substeps";
  if (const char* field = wrong_drawing(world)) return field;
  const BodyStates states = world.physics->states();
  for (const Actor& actor : world.actors)
    if (const char* field = wrong_field(world, actor, states)) return field;
  if (const char* field = wrong_contents(world)) return field;
  if (const char* field = wrong_joint(world)) return field;
  if (const char* field = world.meshes.wrong_field(world.actors)) return field;
  if (!(world.smallest_piece_factor > 0)) return "smallest_piece_factor";
  if (world.exposed) {
    const std::size_t materials = world.materials->size();
    if (!all_below(world.exposed->faces, materials, &Exposed::Face::material) ||
        !all_below(world.exposed->chips, materials, &DebrisPiece::material))
      return "exposed: material";
  }
  return nullptr;
}

}  // namespace sunder
