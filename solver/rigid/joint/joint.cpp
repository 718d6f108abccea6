#include "solver/rigid/joint/joint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/state_checks.h"

namespace sunder::solver {
namespace {

// Stands for a pair of bodies: any static body.
constexpr std::uint64_t kAnyStatic = ~std::uint64_t{0};

std::uint64_t body_pair(BodySlot a, BodySlot b) {
  return std::uint64_t{std::min(a, b).value} << 32 | std::max(a, b).value;
}

BodySlot slot_of(BodyId id, const Bodies& bodies) {
  return id.none() ? BodySlot() : bodies.slot(id);
}

bool has_strength(const SectionStrength& strength) {
  return strength.axial_N > 0 && strength.shear_N > 0 && strength.moment_Nm.minCoeff() > 0;
}

void wake_body(BodySlot body, Bodies& bodies) {
  if (body.none()) return;
  bodies.wake(body);
  bodies.changed[body] = 1;
  bodies.restart_rest(body);
}

}  // namespace

const char* Joints::wrong_field(const Bodies& bodies) const {
  std::size_t present = 0;
  for (const Joint& joint : items_) {
    if (!joint.present) continue;
    ++present;
    const JointDesc& desc = joint.desc;
    for (const auto& [id, slot] :
         {std::pair(desc.a, joint.body_a), std::pair(desc.b, joint.body_b)}) {
      if (slot.none() && !joint.lost && !id.none()) return "items_";
      if (slot.none()) continue;
      if (!bodies.contains(id) || id.slot != slot.value) return "items_";
    }
    if (joint.body_a == joint.body_b && !joint.lost) return "items_";
    if (!is_unit(desc.axis_a_R) || !is_unit(desc.axis_b_R)) return "items_";
    if (!(desc.length_m >= 0 && desc.breaking_N >= 0 && desc.breaking_Nm >= 0)) return "items_";
    if (desc.kind == JointKind::kPlastic && !has_strength(desc.strength)) return "items_";
  }
  if (!are_different_below(free_slots_, size()) || free_slots_.size() + present != size())
    return "free_slots_";
  for (const std::uint32_t slot : free_slots_)
    if (items_[slot].present) return "free_slots_";
  Joints same = *this;
  same.find_ignored_pairs(bodies);
  if (ignored_pairs_ != same.ignored_pairs_) return "ignored_pairs_";
  return ignored_shapes_ == same.ignored_shapes_ ? nullptr : "ignored_shapes_";
}

Joint& Joints::at(JointId id) {
  SUNDER_CHECK(id.slot < size() && items_[id.slot].present &&
               items_[id.slot].generation == id.generation);
  return items_[id.slot];
}

void Joints::wake_ends(const Joint& joint, Bodies& bodies) const {
  wake_body(joint.body_a, bodies);
  wake_body(joint.body_b, bodies);
}

void Joints::list(std::uint32_t joint, BodySlot body) {
  if (body.none()) return;
  if (body.value >= of_body_.size()) of_body_.resize(std::size_t{body.value} + 1);
  std::vector<std::uint32_t>& joints = of_body_[body];
  joints.insert(std::ranges::lower_bound(joints, joint), joint);
}

void Joints::unlist(std::uint32_t joint, BodySlot body) {
  if (body.none()) return;
  std::vector<std::uint32_t>& joints = of_body_[body];
  joints.erase(std::ranges::lower_bound(joints, joint));
}

void Joints::list_by_body() {
  of_body_.clear();
  for (std::uint32_t i = 0; i < size(); ++i)
    for (const BodySlot body : {items_[i].body_a, items_[i].body_b}) list(i, body);
}

void Joints::update_ignored_pairs(const Bodies& bodies) {
  if (std::exchange(ignored_pairs_are_stale_, false)) find_ignored_pairs(bodies);
}

void Joints::find_ignored_pairs(const Bodies& bodies) {
  ignored_pairs_.clear();
  ignored_shapes_.clear();
  for (const Joint& joint : items_) {
    if (!joint.holds() || joint.body_a.none() || joint.body_b.none()) continue;
    const std::uint64_t pair = body_pair(joint.body_a, joint.body_b);
    if (joint.desc.kind == JointKind::kPlastic) {
      const auto add = [&](BodySlot body, BodySlot other, const std::vector<std::uint32_t>& tags) {
        const bool is_static = bodies.motion[other] == Motion::kStatic;
        for (const std::uint32_t tag : tags)
          ignored_shapes_.push_back({is_static ? kAnyStatic : pair, body, tag});
      };
      add(joint.body_a, joint.body_b, joint.desc.quiet_a);
      add(joint.body_b, joint.body_a, joint.desc.quiet_b);
    } else if (!joint.desc.collide) {
      ignored_pairs_.push_back(pair);
    }
  }
  std::ranges::sort(ignored_pairs_);
  std::ranges::sort(ignored_shapes_);
}

JointId Joints::add(const JointDesc& desc, Bodies& bodies) {
  if (free_slots_.empty()) {
    free_slots_.push_back(size());
    items_.emplace_back();
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  Joint& joint = items_[slot];
  joint = Joint{desc, true, joint.generation};
  joint.body_a = slot_of(desc.a, bodies);
  joint.body_b = slot_of(desc.b, bodies);
  SUNDER_CHECK(joint.body_a != joint.body_b);
  SUNDER_CHECK(desc.kind != JointKind::kPlastic || has_strength(desc.strength));
  list(slot, joint.body_a);
  list(slot, joint.body_b);
  wake_ends(joint, bodies);
  ignored_pairs_are_stale_ = true;
  return {slot, joint.generation};
}

void Joints::attach(JointId id, bool end_a, BodyId body, std::span<const std::uint32_t> quiet_tags,
                    Bodies& bodies) {
  Joint& joint = at(id);
  (end_a ? joint.desc.quiet_a : joint.desc.quiet_b).assign(quiet_tags.begin(), quiet_tags.end());
  const BodySlot slot = slot_of(body, bodies);
  (end_a ? joint.desc.a : joint.desc.b) = body;
  BodySlot& end = end_a ? joint.body_a : joint.body_b;
  unlist(id.slot, end);
  list(id.slot, slot);
  end = slot;
  const bool lost_a = joint.body_a.none() && !joint.desc.a.none();
  const bool lost_b = joint.body_b.none() && !joint.desc.b.none();
  joint.lost = lost_a || lost_b || joint.body_a == joint.body_b;
  wake_ends(joint, bodies);
  ignored_pairs_are_stale_ = true;
}

void Joints::strengthen(JointId id, const SectionStrength& strength) {
  SUNDER_CHECK(has_strength(strength));
  at(id).desc.strength = strength;
}

void Joints::cut(JointId id, Bodies& bodies) {
  Joint& joint = at(id);
  wake_ends(joint, bodies);
  unlist(id.slot, joint.body_a);
  unlist(id.slot, joint.body_b);
  joint = Joint{};
  joint.generation = id.generation + 1;
  free_slots_.push_back(id.slot);
  ignored_pairs_are_stale_ = true;
}

void Joints::detach(BodySlot body, Bodies& bodies) {
  if (of(body).empty()) return;
  for (const std::uint32_t i : std::exchange(of_body_[body], {})) {
    Joint& joint = items_[i];
    (joint.body_a == body ? joint.body_a : joint.body_b) = {};
    joint.lost = true;
    wake_ends(joint, bodies);
  }
  ignored_pairs_are_stale_ = true;
}

std::vector<BodySlot> Joints::joined_to(BodySlot body, const Bodies& bodies) const {
  std::vector<BodySlot> all;
  const auto add = [&](BodySlot other) {
    if (other.none() || !bodies.awake(other) || std::ranges::find(all, other) != all.end()) return;
    all.push_back(other);
  };
  add(body);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const BodySlot known = all[i];
    for (const std::uint32_t joint_index : of(known)) {
      const Joint& joint = items_[joint_index];
      if (!joint.holds()) continue;
      if (joint.body_a == known) add(joint.body_b);
      if (joint.body_b == known) add(joint.body_a);
    }
  }
  return all;
}

void Joints::wake(Bodies& bodies) const {
  for (bool again = !items_.empty(); again;) {
    again = false;
    const auto pass_on = [&](const Joint& joint) {
      if (!joint.holds() || joint.body_a.none() || joint.body_b.none()) return;
      const BodySlot a = joint.body_a, b = joint.body_b;
      const auto moves = [&](BodySlot body) {
        return bodies.awake(body) || bodies.is_shifting_kinematic(body);
      };
      const BodySlot sleeper = moves(a) ? b : a;
      if (!moves(a) && !moves(b)) return;
      if (bodies.motion[sleeper] != Motion::kAsleep) return;
      bodies.wake(sleeper);
      again = true;
    };
    for (const Joint& joint : items_) pass_on(joint);
    for (std::size_t i = items_.size(); again && i-- > 0;) pass_on(items_[i]);
  }
}

bool Joints::ignores(const Pair& pair, const Shapes& shapes, const Bodies& bodies) const {
  if (ignored_pairs_.empty() && ignored_shapes_.empty()) return false;
  const std::uint64_t key = body_pair(pair.body_a, pair.body_b);
  const auto quiet = [&](BodySlot body, ShapeSlot shape, BodySlot other) {
    const std::uint32_t tag = shapes[shape].tag;
    return std::ranges::binary_search(ignored_shapes_, IgnoredShape{key, body, tag}) ||
           (bodies.motion[other] == Motion::kStatic &&
            std::ranges::binary_search(ignored_shapes_, IgnoredShape{kAnyStatic, body, tag}));
  };
  return std::ranges::binary_search(ignored_pairs_, key) ||
         quiet(pair.body_a, pair.shape_a, pair.body_b) ||
         quiet(pair.body_b, pair.shape_b, pair.body_a);
}

void Joints::break_off(std::uint32_t joint, Bodies& bodies) {
  const JointId id{joint, items_[joint].generation};
  broken_.push_back(id);
  cut(id, bodies);
}

std::vector<JointId> Joints::take_broken() {
  std::ranges::sort(broken_);
  return std::exchange(broken_, {});
}

std::vector<JointImpulse> Joints::loads(const Bodies& bodies) const {
  std::vector<JointImpulse> loads;
  const auto add = [&](BodySlot body, const Vec3& anchor_R, const AnchorImpulse& impulse) {
    if (body.none() || !bodies.reports_load[body]) return;
    const Vec3 arm = bodies.rotation[body] * (anchor_R - bodies.com_R[body]);
    loads.push_back(
        {bodies.tag[body], impulse.linear_W, bodies.position[body] + arm, impulse.angular_W});
  };
  for (const Joint& joint : items_) {
    if (!joint.holds()) continue;
    add(joint.body_a, joint.desc.anchor_a_R, -joint.total);
    add(joint.body_b, joint.desc.anchor_b_R, joint.total);
  }
  return loads;
}

std::vector<PlasticFlow> Joints::flows() const {
  std::vector<PlasticFlow> flows;
  for (std::uint32_t i = 0; i < size(); ++i) {
    if (!items_[i].holds() || !(items_[i].flow.work_J > 0)) continue;
    flows.push_back(items_[i].flow);
    flows.back().joint = {i, items_[i].generation};
  }
  return flows;
}

void Joints::clear_flows() {
  for (Joint& joint : items_) joint.flow = {};
}

}  // namespace sunder::solver
