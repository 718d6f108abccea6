#include "solver/rigid/joint/joint.h"

#include <algorithm>
#include <utility>

namespace sunder::solver {
namespace {

std::uint64_t body_pair(BodySlot a, BodySlot b) {
  return std::uint64_t{std::min(a, b).value} << 32 | std::max(a, b).value;
}

BodySlot slot_of(BodyId id, const Bodies& bodies) {
  return id.none() ? BodySlot() : bodies.slot(id);
}

void wake_body(BodySlot body, Bodies& bodies) {
  if (body.none()) return;
  bodies.wake(body);
  bodies.changed[body] = 1;
  bodies.slow_s[body] = 0;
}

}  // namespace

Joint& Joints::at(JointId id) {
  SUNDER_CHECK(id.slot < size() && items_[id.slot].present &&
               items_[id.slot].generation == id.generation);
  return items_[id.slot];
}

void Joints::wake_ends(const Joint& joint, Bodies& bodies) const {
  wake_body(joint.body_a, bodies);
  wake_body(joint.body_b, bodies);
}

void Joints::note_pairs() {
  apart_.clear();
  for (const Joint& joint : items_) {
    if (joint.holds() && !joint.desc.collide && !joint.body_a.none() && !joint.body_b.none())
      apart_.push_back(body_pair(joint.body_a, joint.body_b));
  }
  std::ranges::sort(apart_);
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
  wake_ends(joint, bodies);
  note_pairs();
  return {slot, joint.generation};
}

void Joints::attach(JointId id, bool end_a, BodyId body, Bodies& bodies) {
  Joint& joint = at(id);
  const BodySlot slot = slot_of(body, bodies);
  (end_a ? joint.desc.a : joint.desc.b) = body;
  (end_a ? joint.body_a : joint.body_b) = slot;
  const bool lost_a = joint.body_a.none() && !joint.desc.a.none();
  const bool lost_b = joint.body_b.none() && !joint.desc.b.none();
  joint.lost = lost_a || lost_b || joint.body_a == joint.body_b;
  wake_ends(joint, bodies);
  note_pairs();
}

void Joints::cut(JointId id, Bodies& bodies) {
  Joint& joint = at(id);
  wake_ends(joint, bodies);
  joint = Joint{};
  joint.generation = id.generation + 1;
  free_slots_.push_back(id.slot);
  note_pairs();
}

void Joints::lose(BodySlot body, Bodies& bodies) {
  for (Joint& joint : items_) {
    if (!joint.present || (joint.body_a != body && joint.body_b != body)) continue;
    (joint.body_a == body ? joint.body_a : joint.body_b) = {};
    joint.lost = true;
    wake_ends(joint, bodies);
  }
  note_pairs();
}

void Joints::wake(Bodies& bodies) const {
  for (bool again = !items_.empty(); again;) {
    again = false;
    const auto pass_on = [&](const Joint& joint) {
      if (!joint.holds() || joint.body_a.none() || joint.body_b.none()) return;
      const BodySlot a = joint.body_a, b = joint.body_b;
      const BodySlot sleeper = bodies.awake(a) ? b : a;
      if (!bodies.awake(a) && !bodies.awake(b)) return;
      if (bodies.motion[sleeper] != Motion::kAsleep) return;
      bodies.wake(sleeper);
      again = true;
    };
    for (const Joint& joint : items_) pass_on(joint);
    for (std::size_t i = items_.size(); again && i-- > 0;) pass_on(items_[i]);
  }
}

bool Joints::apart(BodySlot body_a, BodySlot body_b) const {
  return !apart_.empty() && std::ranges::binary_search(apart_, body_pair(body_a, body_b));
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

std::vector<JointLoad> Joints::loads(const Bodies& bodies) const {
  std::vector<JointLoad> loads;
  const auto add = [&](BodySlot body, const Vec3& anchor_R, const JointImpulse& impulse) {
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

}  // namespace sunder::solver
