#include "engine/world/actors/joints.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/roots.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

/// Returns the actor that contains a point, or the nearest within tolerance; null if there is none.
const Actor* actor_at(std::span<const Actor* const> actors, const Vec3& point_R) {
  const Actor* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Actor* actor : actors) {
    const double distance = distance_to(actor->structure, point_R);
    if (distance >= least || distance > kAnchorTolerance * cube_root(actor->volume_m3)) continue;
    least = distance;
    nearest = actor;
  }
  return nearest;
}

/// Returns the actor that has all convexes of a hinge side; null if there is none.
const Actor* actor_with(std::span<const Actor* const> actors, HingeSide& side) {
  const auto has =
      std::ranges::find_if(actors, [&](const Actor* a) { return side.find_slots(*a); });
  return has == actors.end() ? nullptr : *has;
}

}  // namespace

bool HingeSide::find_slots(const Actor& actor) {
  const Structure& structure = actor.structure;
  const auto is_at = [&](std::size_t i, ConvexSlot slot) {
    return structure.has(slot) && structure.convex(slot) == convexes[i];
  };
  std::vector<std::uint32_t> found = slots;  // static actors keep their slots
  bool as_before = found.size() == convexes.size();
  for (std::size_t i = 0; as_before && i < found.size(); ++i)
    as_before = is_at(i, ConvexSlot(found[i]));
  if (as_before) return true;
  std::size_t left = convexes.size();
  found.assign(convexes.size(), 0);
  structure.for_each([&](ConvexSlot slot, const Convex&) {
    for (std::size_t i = 0; i < convexes.size(); ++i) {
      if (!is_at(i, slot)) continue;
      found[i] = slot.value;
      --left;
    }
  });
  if (left > 0) return false;
  slots = std::move(found);
  return true;
}

Pose relative_rest(const Physics& physics, const Actor& a, const Actor& b) {
  const Pose X_WA = rest_pose(a, physics.state(a.body).X_WB);
  return X_WA.inverse() * rest_pose(b, physics.state(b.body).X_WB);
}

SectionStrength Hinge::strength() const {
  const double grown = 1 + section.hardening_Pa * strain / section.yield_Pa;
  SectionStrength all = section.strength;
  all.axial_N *= grown, all.shear_N *= grown, all.moment_Nm *= grown;
  return all;
}

std::uint32_t Joints::add(Physics& physics, const Actors& actors, const Joint& joint) {
  Live live;
  live.key = next_key_++;
  JointDesc& desc = live.desc;
  desc.kind = joint.kind;
  const bool apart =
      joint.kind == JointDesc::Kind::kDistance || joint.kind == JointDesc::Kind::kRope;
  const Vec3 end_W = apart ? joint.to_W : joint.at_W;
  Quat rotation_WR[2];
  const auto set_end = [&](std::optional<std::uint32_t> key, const Vec3& anchor_W, End& end,
                           BodyId& body, Vec3& anchor_R, Vec3& axis_R, Quat& q) {
    end = {key.value_or(kGroundKey), anchor_W};
    Pose X_WR;
    if (key) {
      const Actor& actor = *actors.find(*key);
      X_WR = rest_pose(actor, physics.state(actor.body).X_WB);
      body = actor.body;
    }
    anchor_R = end.anchor_R = X_WR.inverse() * anchor_W;
    axis_R = X_WR.rotation.conjugate() * joint.axis_W.normalized();
    q = X_WR.rotation;
  };
  set_end(joint.a, joint.at_W, live.a, desc.a, desc.anchor_a_R, desc.axis_a_R, rotation_WR[0]);
  set_end(joint.b, end_W, live.b, desc.b, desc.anchor_b_R, desc.axis_b_R, rotation_WR[1]);
  desc.rotation_RaRb = rotation_WR[0].conjugate() * rotation_WR[1];
  desc.length_m = (end_W - joint.at_W).norm();
  desc.breaking_N = joint.breaking_N;
  desc.breaking_Nm = joint.breaking_Nm;
  desc.collide = joint.collide;
  live.id = physics.join(desc);
  live_.push_back(live);
  return live.key;
}

Joints::Live Joints::make_hinge(Physics& physics, const Actor& a, const Actor& b, Hinge hinge) {
  const Pose X_AB = relative_rest(physics, a, b);
  Live live;
  JointDesc& desc = live.desc;
  desc.kind = JointKind::kPlastic;
  desc.a = a.body, desc.b = b.body;
  desc.anchor_a_R = hinge.section.centroid_R;
  desc.anchor_b_R = X_AB.inverse() * desc.anchor_a_R;
  desc.rotation_RaRb = X_AB.rotation;
  desc.strength = hinge.strength();
  hinge.a.find_slots(a), hinge.b.find_slots(b);
  desc.quiet_a = hinge.a.slots, desc.quiet_b = hinge.b.slots;
  live.id = physics.join(desc);
  live.a = {a.key, desc.anchor_a_R}, live.b = {b.key, desc.anchor_b_R};
  live.hinge = std::move(hinge);
  return live;
}

void Joints::add(Physics& physics, const Actor& a, const Actor& b, Hinge hinge) {
  live_.push_back(make_hinge(physics, a, b, std::move(hinge)));
}

Joints::Live Joints::transferred(Physics& physics, const Actors& actors, Live joint, bool is_a,
                                 const Actor& into, const Pose& X_IF,
                                 std::span<const ConvexSlot> slot_of) {
  if (joint.hinge) {
    Hinge& hinge = *joint.hinge;
    HingeSide& side = is_a ? hinge.a : hinge.b;
    for (std::size_t i = 0; i < side.slots.size(); ++i) {
      const ConvexSlot slot = slot_of[side.slots[i]];
      side.slots[i] = slot.value;
      side.convexes[i] = into.structure.convex(slot);
    }
    PlasticSection& section = hinge.section;
    hinge.X_AB = is_a ? X_IF * hinge.X_AB : hinge.X_AB * X_IF.inverse();
    hinge.drawn_X_AB = hinge.X_AB;  // the new convexes are not drawn bent
    side.redrawn.clear();
    if (is_a) section.centroid_R = X_IF * section.centroid_R;
    if (is_a) section.strength.axes_R = X_IF.rotation * section.strength.axes_R;
    const Actor& other = *actors.find((is_a ? joint.b : joint.a).key);
    return make_hinge(physics, is_a ? into : other, is_a ? other : into, std::move(hinge));
  }
  End& end = is_a ? joint.a : joint.b;
  end = {into.key, X_IF * end.anchor_R};
  JointDesc& desc = joint.desc;
  const auto body_of = [&](const End& one) {
    const Actor* actor = actors.find(one.key);
    return actor ? actor->body : BodyId();
  };
  desc.a = body_of(joint.a), desc.b = body_of(joint.b);  // either end may have moved to a piece
  (is_a ? desc.anchor_a_R : desc.anchor_b_R) = end.anchor_R;
  Vec3& axis_R = is_a ? desc.axis_a_R : desc.axis_b_R;
  axis_R = X_IF.rotation * axis_R;
  desc.rotation_RaRb =
      is_a ? X_IF.rotation * desc.rotation_RaRb : desc.rotation_RaRb * X_IF.rotation.conjugate();
  joint.id = physics.join(desc);
  return joint;
}

void Joints::reattach(Physics& physics, const Actor& actor) {
  for (const Live& joint : live_) {
    for (const bool is_a : {true, false}) {
      if ((is_a ? joint.a : joint.b).key != actor.key) continue;
      const HingeSide* side = !joint.hinge ? nullptr : is_a ? &joint.hinge->a : &joint.hinge->b;
      physics.attach(joint.id, is_a, actor.body,
                     side ? side->slots : std::span<const std::uint32_t>());
    }
  }
}

void Joints::transfer(Physics& physics, const Actors& actors, std::uint32_t from, const Actor& into,
                      const Pose& X_IF, std::span<const ConvexSlot> slot_of) {
  std::vector<JointId> inner;
  for (Live& joint : live_) {
    const bool is_a = joint.a.key == from;
    if (!is_a && joint.b.key != from) continue;
    physics.cut(joint.id);
    if ((is_a ? joint.b : joint.a).key == into.key) {
      inner.push_back(joint.id);
    } else {
      joint = transferred(physics, actors, std::move(joint), is_a, into, X_IF, slot_of);
    }
  }
  erase(inner);
}

std::uint32_t Joints::reassign_ends(Physics& physics, const Actor& parent, bool stays,
                                    std::span<const Actor> pieces) {
  std::vector<const Actor*> actors;
  if (stays) actors.push_back(&parent);
  for (const Actor& piece : pieces) actors.push_back(&piece);
  std::vector<JointId> lost;
  for (Live& joint : live_) {
    bool whole = true;
    for (End* end : {&joint.a, &joint.b}) {
      if (end->key != parent.key) continue;
      const bool is_a = end == &joint.a;
      HingeSide* side = !joint.hinge ? nullptr : is_a ? &joint.hinge->a : &joint.hinge->b;
      const Actor* actor = side ? actor_with(actors, *side) : actor_at(actors, end->anchor_R);
      whole = whole && actor;
      if (!actor || actor == &parent) continue;
      end->key = actor->key;
      physics.attach(joint.id, is_a, actor->body,
                     side ? side->slots : std::span<const std::uint32_t>());
    }
    if (whole) continue;
    physics.cut(joint.id);
    lost.push_back(joint.id);
  }
  return erase(lost);
}

void Joints::cut(Physics& physics, JointId joint) {
  physics.cut(joint);
  erase({joint});
}

std::vector<ConvexSlot> Joints::hinged_convexes(std::uint32_t key) const {
  std::vector<ConvexSlot> slots;
  for (const Live& joint : live_) {
    if (!joint.hinge) continue;
    for (const auto& [end, side] :
         {std::pair(&joint.a, &joint.hinge->a), std::pair(&joint.b, &joint.hinge->b)}) {
      if (end->key != key) continue;
      for (const std::uint32_t slot : side->slots) slots.emplace_back(slot);
    }
  }
  std::ranges::sort(slots);
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return slots;
}

Joints::Live& Joints::at(JointId joint) { return *std::ranges::find(live_, joint, &Live::id); }

std::uint32_t Joints::cut(Physics& physics, std::uint32_t key) {
  std::vector<JointId> lost;
  for (auto joint = live_.rbegin(); joint != live_.rend(); ++joint) {
    if (joint->a.key != key && joint->b.key != key) continue;
    physics.cut(joint->id);
    lost.push_back(joint->id);
  }
  return erase(lost);
}

std::uint32_t Joints::take_broken(Physics& physics) {
  return live_.empty() ? 0 : erase(physics.take_broken());
}

std::vector<std::uint32_t> Joints::take_lost() {
  std::ranges::sort(lost_);
  return std::exchange(lost_, {});
}

const Joints::Live* Joints::find(std::uint32_t key) const {
  const auto at = std::ranges::find(live_, key, &Live::key);
  return at != live_.end() && key != kNoKey ? &*at : nullptr;
}

/// Erases joints and returns their number.
std::uint32_t Joints::erase(const std::vector<JointId>& gone) {
  for (const JointId id : gone) {
    std::erase_if(live_, [&](const Live& joint) {
      if (joint.id != id) return false;
      if (joint.key != kNoKey) lost_.push_back(joint.key);
      return true;
    });
  }
  return static_cast<std::uint32_t>(gone.size());
}

}  // namespace sunder
