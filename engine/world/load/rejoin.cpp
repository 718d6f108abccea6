#include "engine/world/load/rejoin.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/world/actors/merge.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

using Live = Joints::Live;

/// Returns the step from which on a hinge may be removed; none if that is later than now.
std::optional<std::uint64_t> rejoin_step(const WorldState& world, const Live& joint) {
  const Actor &a = *world.actors.find(joint.a.key), &b = *world.actors.find(joint.b.key);
  const std::uint32_t times = std::min(kMaxRejoinDoublings, std::max(a.rejoined, b.rejoined));
  const auto wait = static_cast<std::uint64_t>(std::ceil(kRejoinDelay_s / world.clock.dt_s) *
                                               std::ldexp(1.0, static_cast<int>(times)));
  const std::uint64_t ready = joint.hinge->flowed_step + wait;
  if (joint.hinge->rejoin_failed || ready > world.clock.step) return std::nullopt;
  return ready;
}

/// Returns the actor that takes in the other first: static before movable, then heavier, then
/// older.
std::pair<const Actor*, const Actor*> in_order(const Actor& x, const Actor& y) {
  const auto rank = [](const Actor& actor) {
    return std::tuple(actor.is_static, actor.weight.mass_kg, -static_cast<double>(actor.key));
  };
  return rank(x) > rank(y) ? std::pair(&x, &y) : std::pair(&y, &x);
}

BentSection section_of(const Hinge& hinge, bool a_first) {
  const SectionEnd end_a = hinge.end_a(), end_b = hinge.end_b();
  BentSection bent;
  bent.centroid_A = end_a.centroid, bent.normal_A = end_a.along;
  bent.centroid_B = end_b.centroid, bent.normal_B = end_b.along;
  bent.reach_m = hinge.reach_m();
  bent.areas_m2 = hinge.areas_m2;
  bent.slots_a = hinge.a.slots, bent.faces_a = hinge.a.faces;
  bent.slots_b = hinge.b.slots, bent.faces_b = hinge.b.faces;
  if (a_first) return bent;
  std::swap(bent.centroid_A, bent.centroid_B), std::swap(bent.normal_A, bent.normal_B);
  std::swap(bent.slots_a, bent.slots_b), std::swap(bent.faces_a, bent.faces_b);
  return bent;
}

/// Returns true if the convexes of a remaining hinge are part of the merged actor.
bool keeps_sides(const Live& joint, std::uint32_t key_a, std::uint32_t key_b,
                 const Rejoined& rejoined) {
  const auto finds = [&](const Joints::End& end, const HingeSide& side) {
    return std::ranges::all_of(side.slots, [&](std::uint32_t slot) {
      if (end.key == key_b) return !rejoined.slot_of_b[slot].none();
      return end.key != key_a ||
             !std::ranges::binary_search(rejoined.edit.removed, ConvexSlot(slot));
    });
  };
  return !joint.hinge || (finds(joint.a, joint.hinge->a) && finds(joint.b, joint.hinge->b));
}

/// Load case of the merged actor: the loads of both, without those on the convexes of the
/// hinges between the two, which become internal.
class MergedLoadCase {
 public:
  MergedLoadCase(const WorldState& world, const Actor& a, const Actor& b, const Rejoined& rejoined,
                 const Pose& X_AB)
      : rejoined_(rejoined), a_(a), b_(b), structure_(a.structure) {
    structure_.apply(rejoined.edit);
    add(world, a, Pose());
    add(world, b, X_AB);
    load_.materials = *world.materials;
    load_.loads = loads_;
    const Quat& rotation_WA = world.physics->state(a.body).X_WB.rotation;
    load_.gravity_R = rotation_WA.conjugate() * world.scene.gravity_W;
    load_.spin_R = a.stress.spin_R;
    load_.most_work = kRejoinEvaluationsPerBond * (structure_.bond_count() + 1);
    std::ranges::sort(load_.hinged);
  }

  /// Returns true if the merged actor withstands its loads.
  bool withstands(const Breaker& breaker, std::uint64_t& work) const {
    const StressResult answer = breaker.stress(structure_, load_);
    work += answer.work;
    return answer.settled && !answer.edit.changed && answer.edit.cut.empty();
  }

 private:
  /// Returns the slot in the merged actor; none() if the convex was cut.
  ConvexSlot merged_slot_of(const Actor& of, ConvexSlot slot) const {
    if (&of == &b_) return rejoined_.slot_of_b[slot.value];
    return structure_.has(slot) ? slot : ConvexSlot();
  }

  void add(const WorldState& world, const Actor& actor, const Pose& X_AR) {
    std::vector<ConvexSlot> between;
    for (const Live& joint : world.joints.live()) {
      if (!joint.hinge) continue;
      const bool is_a = joint.a.key == actor.key;
      if (!is_a && joint.b.key != actor.key) continue;
      const bool inner = joint.is_between(a_.key, b_.key);
      for (const std::uint32_t slot : (is_a ? joint.hinge->a : joint.hinge->b).slots) {
        if (inner) {
          between.emplace_back(slot);
        } else {
          load_.hinged.push_back(merged_slot_of(actor, ConvexSlot(slot)));
        }
      }
    }
    for (const AppliedForce& force : actor.stress.mean_forces) {
      if (std::ranges::find(between, force.convex) != between.end()) continue;
      const Vec3 at = X_AR * actor.structure.convex(force.convex)->solid.centroid;
      ConvexSlot slot = merged_slot_of(actor, force.convex);
      if (slot.none()) slot = nearest(structure_, at);
      loads_.push_back({slot, X_AR.rotation * force.force_N, at, X_AR.rotation * force.torque_Nm});
    }
  }

  const Rejoined& rejoined_;
  const Actor &a_, &b_;
  Structure structure_;
  std::vector<AppliedForce> loads_;
  LoadCase load_;
};

bool rejoin(WorldState& world, const Breaker& breaker, const Actor& a, const Actor& b,
            std::uint64_t& work) {
  BentPair bent{
      a.structure, b.structure, relative_rest(*world.physics, a, b), {}, world.next_event++};
  std::vector<JointId> hinges;
  for (const Live& joint : world.joints.live()) {
    if (!joint.hinge || !joint.is_between(a.key, b.key)) continue;
    bent.sections.push_back(section_of(*joint.hinge, joint.a.key == a.key));
    hinges.push_back(joint.id);
  }
  const Rejoined rejoined = breaker.rejoin(bent);
  if (!rejoined.edit.changed) return false;
  for (const Live& joint : world.joints.live()) {
    if (joint.is_between(a.key, b.key) && joint.hinge) continue;
    if (!keeps_sides(joint, a.key, b.key, rejoined)) return false;
  }
  if (!MergedLoadCase(world, a, b, rejoined, bent.X_AB).withstands(breaker, work)) return false;
  for (const JointId id : hinges) world.joints.cut(*world.physics, id);
  merge(world, a.key, b.key, rejoined, bent.X_AB);
  return true;
}

}  // namespace

std::uint64_t rejoin(WorldState& world, const Breaker& breaker) {
  const Live* oldest = nullptr;
  std::uint64_t since = 0;
  for (const Live& joint : world.joints.live()) {
    if (!joint.hinge) continue;
    const auto ready = rejoin_step(world, joint);
    if (!ready || (oldest && *ready >= since)) continue;
    const bool all = std::ranges::all_of(world.joints.live(), [&](const Live& other) {
      return !other.hinge || !other.is_between(joint.a.key, joint.b.key) ||
             rejoin_step(world, other);
    });
    if (!all) continue;
    oldest = &joint;
    since = *ready;
  }
  if (!oldest) return 0;
  const JointId id = oldest->id;
  const auto [a, b] =
      in_order(*world.actors.find(oldest->a.key), *world.actors.find(oldest->b.key));
  std::uint64_t work = 0;
  const bool can = !b->is_static && rejoin(world, breaker, *a, *b, work);
  if (!can) world.joints.at(id).hinge->rejoin_failed = true;
  return work;
}

}  // namespace sunder
