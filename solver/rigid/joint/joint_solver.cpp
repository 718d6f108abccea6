#include "solver/rigid/joint/joint_solver.h"

#include <algorithm>
#include <bit>

#include "engine/base/disjoint_sets.h"

namespace sunder::solver {
namespace {

// A group's band: what one thread factors in every substep.
constexpr std::uint32_t kMostRows = 600;
constexpr std::uint32_t kMostEntries = 20000;
constexpr std::uint32_t kNoRow = 0xffffffff;
constexpr std::uint8_t kMostColors = 64;  // beyond: one thread for all

int row_count(JointDesc::Kind kind) {
  using Kind = JointDesc::Kind;
  if (kind == Kind::kDistance || kind == Kind::kRope) return 1;
  return kind == Kind::kBall ? 3 : kind == Kind::kHinge ? 5 : 6;
}

/// An inequality: no part of a band.
bool is_rope(const Joint& joint) { return joint.desc.kind == JointDesc::Kind::kRope; }

/// The bodies of a joint that move.
template <class Visit>
void for_moving(const Joint& joint, const Bodies& bodies, const Visit& visit) {
  if (!joint.body_a.none() && bodies.awake(joint.body_a)) visit(joint.body_a);
  if (!joint.body_b.none() && bodies.awake(joint.body_b)) visit(joint.body_b);
}

}  // namespace

void JointSolver::collect(const Bodies& bodies, const Joints& joints,
                          SpanByBody<std::uint8_t> in_contact) {
  active_.clear();
  groups_.clear();
  colors_.clear();
  joined_.clear();
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].holds()) continue;
    BodySlot first, last;
    for_moving(joints[i], bodies, [&](BodySlot body) {
      if (first.none()) first = body;
      last = body;
      in_contact[body] = 1;
    });
    if (first.none()) continue;
    active_.push_back(i);
    joined_.emplace_back(first, last);
  }
  works_.resize(active_.size());
  if (active_.empty()) return;
  group_joints(bodies, joints);
  color_groups(bodies, joints);
}

void JointSolver::group_joints(const Bodies& bodies, const Joints& joints) {
  DisjointSets islands(bodies.size());  // of what joints hold together
  const auto mover = [&](std::uint32_t i) {
    BodySlot found;
    for_moving(joints[i], bodies, [&](BodySlot body) { found = body; });
    return found;
  };
  for (const std::uint32_t i : active_)
    for_moving(joints[i], bodies, [&](BodySlot body) { islands.join(mover(i).value, body.value); });
  std::ranges::stable_sort(active_, {},
                           [&](std::uint32_t i) { return islands.root(mover(i).value); });

  ByBody<std::uint32_t> row_of_body(bodies.size(), kNoRow);  // first row that moves it
  BodySlot island;                                           // by its least body
  std::uint32_t rows = 0, entries = 0, base = 0;
  for (std::uint32_t at = 0; at < active_.size(); ++at) {
    const Joint& joint = joints[active_[at]];
    const auto n = static_cast<std::uint32_t>(row_count(joint.desc.kind));
    std::uint32_t width = 0;  // of the envelope before its own rows
    for_moving(joint, bodies, [&](BodySlot body) {
      const std::uint32_t first = row_of_body[body];
      if (first != kNoRow && first >= base) width = std::max(width, base + rows - first);
    });
    const std::uint32_t more = n * width + n * (n + 1) / 2;
    const bool after_rope = at > 0 && is_rope(joints[active_[at - 1]]);
    const BodySlot root(islands.root(mover(active_[at]).value));
    if (root != island || is_rope(joint) || after_rope || rows + n > kMostRows ||
        entries + more > kMostEntries) {
      island = root;
      base += rows;
      rows = entries = 0;
      groups_.emplace_back();
      groups_.back().first = at;
    }
    for_moving(joint, bodies, [&](BodySlot body) {
      if (row_of_body[body] == kNoRow || row_of_body[body] < base) row_of_body[body] = base + rows;
    });
    rows += n;
    entries += more;
    ++groups_.back().count;
  }
}

void JointSolver::color_groups(const Bodies& bodies, const Joints& joints) {
  ByBody<std::uint64_t> used(bodies.size(), 0);
  for (JointGroup& group : groups_) {
    std::uint64_t taken = 0;
    const auto each_body = [&](const auto& visit) {
      for (std::uint32_t i = group.first; i < group.first + group.count; ++i)
        for_moving(joints[active_[i]], bodies, visit);
    };
    each_body([&](BodySlot body) { taken |= used[body]; });
    group.color = static_cast<std::uint8_t>(std::countr_one(taken));
    if (group.color == kMostColors) continue;
    each_body([&](BodySlot body) { used[body] |= std::uint64_t{1} << group.color; });
  }
  std::ranges::stable_sort(groups_, {}, &JointGroup::color);
  for (std::uint32_t i = 0; i < groups_.size(); ++i) {
    if (i == 0 || groups_[i].color != groups_[i - 1].color) colors_.push_back({i, 0, 1});
    ++colors_.back().count;
    if (groups_[i].color == kMostColors) colors_.back().grain = colors_.back().count;
  }
}

void JointSolver::begin(std::uint32_t i, const Bodies& bodies, const Joints& joints,
                        SpanByBody<const Mat3f> root_W, const BodyRow* rows) {
  JointGroup& group = groups_[i];
  for (std::uint32_t at = group.first; at < group.first + group.count; ++at)
    works_[at] = begin_joint(joints[active_[at]], active_[at], bodies, root_W);
  begin_group(group, works(group), rows);
}

Vec3 JointSolver::finish(Bodies& bodies, Joints& joints) {
  Vec3 outside = Vec3::Zero();
  for (const JointWork& work : works_) {
    if (work.row_a == 0) outside += work.total_W;
    if (work.row_b == 0) outside -= work.total_W;
    joints[work.joint].impulse = work.impulse;
  }
  for (const JointWork& work : works_)
    if (work.broken) joints.break_off(work.joint, bodies);
  return outside;
}

}  // namespace sunder::solver
