#include "engine/world/actors/replace.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "engine/world/actors/hinges.h"
#include "engine/world/actors/make_actor.h"

namespace sunder {
namespace {

Vec3 momentum_of(const WorldState& world, std::span<const Actor> actors) {
  const BodyStates states = world.physics->states();
  Vec3 sum = Vec3::Zero();
  for (const Actor& actor : actors) {
    if (!actor.is_static) sum += actor.weight.mass_kg * states[actor.body].velocity_W;
  }
  return sum;
}

double kinetic_J_of(const WorldState& world, std::span<const Actor> actors) {
  const BodyStates states = world.physics->states();
  double sum = 0;
  for (const Actor& actor : actors) sum += kinetic_J(actor, states[actor.body]);
  return sum;
}

/// Returns true if a hinge of the edit holds a piece, numbered as in exposed faces.
bool is_hinged(const BreakEdit& edit, std::uint32_t piece) {
  return std::ranges::any_of(edit.hinges, [&](const PlasticHinge& hinge) {
    return hinge.piece_a == piece || hinge.piece_b == piece;
  });
}

/// Returns true if a piece, numbered as in exposed faces, becomes a body: if it is anchored, held
/// by a hinge, or large enough, and not crushed.
bool is_body(const WorldState& world, const BreakEdit& edit, std::uint32_t number,
             const Compound& piece) {
  if (number > 0 && !edit.loose.crushed.empty() && edit.loose.crushed[number - 1]) return false;
  if (piece.is_anchored() || is_hinged(edit, number)) return true;
  return volume(piece) >= world.smallest_piece_factor *
                              world.material(piece.convexes[0]->material).smallest_piece_m3;
}

/// Returns the momentum of the debris: the parent without the pieces, moving as the parent did.
Vec3 debris_momentum(const Actor& parent, std::span<const Actor> pieces, const Motion& motion) {
  double mass = parent.weight.mass_kg;
  Vec3 moment_R = Vec3::Zero();
  for (const Actor& piece : pieces) {
    mass -= piece.weight.mass_kg;
    moment_R -= piece.weight.mass_kg * (piece.weight.com_R - parent.weight.com_R);
  }
  return mass * motion.field.velocity_W +
         motion.field.angular_velocity_W.cross(motion.X_WR.rotation * moment_R);
}

/// Calls `visit` with the convexes and ghosts that leave a structure (times the ghost's sign) and
/// with those added to it (times −1).
template <class Visit>
void for_each_change(const Structure& structure, const BreakEdit& edit, const Visit& visit) {
  std::vector<std::uint32_t> ghosts;
  for (const ConvexSlot slot : edit.removed) {
    visit(*structure.convex(slot), 1.0);
    const auto of_slot = structure.ghost_indices(slot);
    ghosts.insert(ghosts.end(), of_slot.begin(), of_slot.end());
  }
  std::ranges::sort(ghosts);
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  for (const std::uint32_t number : ghosts) {
    const Ghost& ghost = structure.ghost(number);
    visit(*ghost.convex, static_cast<double>(ghost.sign));
  }
  for (const ConvexPtr& convex : edit.added) visit(*convex, -1.0);
  for (const Ghost& ghost : edit.ghosts) visit(*ghost.convex, -static_cast<double>(ghost.sign));
}

/// Returns the slots whose faces may change visibility by the edit: neighbours of removed convexes
/// and of convexes that overlap these, and the new slots.
std::vector<ConvexSlot> slots_to_redraw(const Structure& structure, const BreakEdit& edit) {
  std::vector<ConvexSlot> slots, overlapping;
  const auto add_neighbours = [&](ConvexSlot slot) {
    for (const Link& link : structure.links(slot)) slots.push_back(link.other);
  };
  const auto add_overlapped = [&](ConvexSlot slot) {
    for (const std::uint32_t number : structure.ghost_indices(slot)) {
      for (const std::uint32_t other : structure.ghost(number).of) overlapping.emplace_back(other);
    }
  };
  for (const ConvexSlot slot : edit.removed) {
    add_neighbours(slot);
    add_overlapped(slot);
  }
  for (const Bond& bond : edit.cut)
    slots.insert(slots.end(), {ConvexSlot(bond.a), ConvexSlot(bond.b)});
  std::unordered_set<std::uint32_t> known;
  for (std::size_t i = 0; i < overlapping.size(); ++i) {
    if (!known.insert(overlapping[i].value).second) continue;
    slots.push_back(overlapping[i]);
    add_neighbours(overlapping[i]);
    add_overlapped(overlapping[i]);
  }
  std::ranges::sort(slots);
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  std::erase_if(slots,
                [&](ConvexSlot slot) { return std::ranges::binary_search(edit.removed, slot); });
  for (std::size_t i = 0; i < edit.added.size(); ++i) {
    slots.emplace_back(structure.slot_count() + i);
  }
  return slots;
}

/// Pieces that are being added to the world.
struct Pieces {
  std::vector<Actor> actors;
  std::vector<BodyDesc> bodies;

  /// Adds a piece, numbered as in exposed faces, as a body, or as debris if too small or crushed.
  /// Returns its key. `is_parent`: the piece is the parent without its anchors, which keeps its
  /// key, and its body if it is no fragment.
  std::uint32_t add(WorldState& world, const BreakEdit& edit, std::uint32_t number,
                    const Compound& compound, const Actor& parent, const Motion& motion,
                    bool is_parent = false) {
    const bool is_kept = is_parent && parent.key == parent.root_key;
    if (!is_kept && !is_body(world, edit, number, compound)) {
      note_chip(world, compound, motion);
      return kNoActorKey;
    }
    Actor& piece = actors.emplace_back(make_actor(world, compound));
    // A piece that a hinge holds can break again in this step, as its parent could.
    piece.born_step = is_hinged(edit, number) ? parent.born_step : world.clock.step + 1;
    piece.inherit(parent);
    if (is_parent) piece.key = parent.key;
    set_least(world, piece);  // recomputed, as it is a fragment
    count_limits(world, piece);
    world.log.debris_mass_kg -= piece.weight.mass_kg;
    bodies.push_back(make_body_desc(world, piece, motion));
    return piece.key;
  }
};

/// Passes the parent's memory of stress on to the pieces that load can break.
void share_stress_memory(const StressCachePtr& memory, std::span<Actor> pieces) {
  if (!memory) return;
  std::vector<Actor*> heirs;
  std::vector<const Structure*> structures;
  for (Actor& piece : pieces) {
    if (!piece.stress.breakable) continue;
    heirs.push_back(&piece);
    structures.push_back(&piece.structure);
  }
  std::vector<StressCachePtr> parts = memory->divide(structures);
  for (std::size_t i = 0; i < heirs.size(); ++i)
    heirs[i]->stress.memory = parts[i] ? std::move(parts[i]) : memory;
}

DrawnConvexes drawn_convexes(const Actor& actor, std::span<const ConvexSlot> slots) {
  DrawnConvexes drawn_before;
  for (const ConvexSlot slot : slots) {
    drawn_before[actor.structure.convex(slot).get()] = {actor.meshes[slot.value],
                                                        actor.hidden[slot.value]};
  }
  return drawn_before;
}

/// Removes the convexes of the edit from the body of an actor that stays, and resets its state.
void edit_remaining_body(WorldState& world, Actor& actor, const BreakEdit& edit,
                         std::span<const ConvexSlot> changed) {
  std::vector<std::uint32_t> removed_tags;
  for (const ConvexSlot slot : edit.removed) {
    removed_tags.push_back(slot.value);
    actor.meshes[slot.value] = {};
    actor.hidden[slot.value] = {};
  }
  std::vector<ShapeDesc> shapes;
  const std::uint32_t slots = actor.structure.slot_count();
  for (std::size_t slot = slots - edit.added.size(); slot < slots; ++slot) {
    shapes.push_back(shape_of(world, actor, ConvexSlot(slot)));
  }
  if (edit.changed) world.physics->edit({actor.body, removed_tags, shapes});
  world.meshes.update(actor, changed);
  set_least(world, actor);
  const auto is_gone = [&](const AppliedForce& press) {
    return !actor.structure.has(press.convex);
  };
  std::erase_if(actor.stress.mean_forces, is_gone);
  std::erase_if(actor.stress.evaluated_forces, is_gone);
  actor.stress.settled = false;
  actor.stress.since_step = world.clock.step;
}

}  // namespace

std::uint32_t pieces_after(const Structure& structure, const BreakEdit& edit) {
  const bool stays = structure.size() + edit.added.size() > edit.removed.size();
  const auto crushed = std::ranges::count(edit.loose.crushed, true);
  return static_cast<std::uint32_t>(edit.loose.pieces.size() - static_cast<std::size_t>(crushed)) +
         (stays ? 1 : 0);
}

bool fits_body_limit(const WorldState& world, const BreakEdit& edit, std::size_t pieces_planned) {
  return world.actors.size() + pieces_planned + edit.loose.pieces.size() <=
         world.scene.limits.bodies;
}

BreakEvent make_break_event(const WorldState& world, const Actor& actor, MaterialIndex material) {
  BreakEvent event;
  event.time_s = world.clock.time_s();
  event.parent_key = actor.key;
  event.child_keys = {actor.key};
  event.material = material;
  event.previous_key = actor.last_frame_key;
  event.name = actor.name;
  event.pieces = 1;
  return event;
}

std::vector<std::uint64_t> apply_break(WorldState& world, std::uint32_t key, BreakEdit& edit) {
  Actor& parent = *world.actors.find(key);
  const Motion motion = motion_of(parent, world.physics->state(parent.body));
  std::vector<ConvexSlot> changed;
  if (parent.is_static) changed = slots_to_redraw(parent.structure, edit);
  DrawnConvexes drawn_before = drawn_convexes(parent, edit.removed);
  double removed_kg = 0, removed_m3 = 0;
  for_each_change(parent.structure, edit, [&](const Convex& convex, double sign) {
    removed_m3 += sign * convex.solid.volume_m3;
    removed_kg += sign * convex.solid.volume_m3 * world.material(convex.material).density_kg_m3;
  });
  parent.structure.apply(edit);
  ++parent.edits;
  const bool stays = parent.is_static && parent.structure.is_anchored();
  const bool is_whole =
      edit.removed.empty() && edit.added.empty() && edit.cut.empty() && edit.loose.pieces.empty();
  const bool is_freed = parent.is_static && !stays && is_whole;  // it lost its anchors only

  Pieces pieces;
  std::vector<std::uint32_t> keys{stays ? parent.key : kNoActorKey};  // indexed as in exposed faces
  world.log.debris_mass_kg += stays ? removed_kg : parent.weight.mass_kg;
  if (!stays && !parent.structure.empty()) {
    const Compound rest = parent.structure.compound();
    parent.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
      if (slot.value >= parent.meshes.size()) return;  // new slots
      drawn_before[&convex] = {parent.meshes[slot.value], parent.hidden[slot.value]};
    });
    keys[0] = pieces.add(world, edit, 0, rest, parent, motion, is_freed);
  }
  for (const Compound& piece : edit.loose.pieces) {
    const auto number = static_cast<std::uint32_t>(keys.size());
    keys.push_back(pieces.add(world, edit, number, piece, parent, motion));
  }
  note_exposed(world, parent.structure, edit, motion, keys);
  share_stress_memory(parent.stress.memory, pieces.actors);
  world.meshes.add_to(pieces.actors, drawn_before);
  const Vec3 before = momentum_of(world, std::span(&parent, 1));
  const double before_J = kinetic_J_of(world, std::span(&parent, 1));
  std::vector<BodyId> ids;
  if (stays) {
    parent.weight.mass_kg -= removed_kg;
    parent.volume_m3 -= removed_m3;
    edit_remaining_body(world, parent, edit, changed);
    ids = world.physics->replace({}, pieces.bodies);
  } else {
    ids = world.physics->replace(std::span(&parent.body, 1), pieces.bodies);
  }
  for (std::size_t i = 0; i < ids.size(); ++i) pieces.actors[i].body = ids[i];
  world.log.report.joints_lost +=
      world.joints.reassign_ends(*world.physics, parent, stays, pieces.actors);
  EnergyFlows& energy = world.log.report.energy;
  const double lost_J = before_J - kinetic_J_of(world, pieces.actors);
  if (parent.is_static) {  // a kinematic parent moves on unchanged
    energy.script -= lost_J;
  } else {
    energy.debris += lost_J;
  }
  if (!parent.is_static) {
    const Vec3 after =
        momentum_of(world, pieces.actors) + debris_momentum(parent, pieces.actors, motion);
    world.log.momentum_error_Ns += (after - before).norm();
  }
  add_hinges(world, parent, edit, pieces.actors, keys);
  if (is_freed && !pieces.actors.empty()) {
    parent = std::move(pieces.actors[0]);
    return {key};
  }
  if (!stays) world.actors.erase(world.actors.place_of(parent));
  for (Actor& piece : pieces.actors) world.actors.add(std::move(piece));
  std::erase(keys, kNoActorKey);
  return {keys.begin(), keys.end()};
}

}  // namespace sunder
