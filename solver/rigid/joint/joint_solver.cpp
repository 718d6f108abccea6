#include "solver/rigid/joint/joint_solver.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "solver/rigid/joint/plastic.h"

namespace sunder::solver {
namespace {

// Maximum size of a group's band, which one thread factors in each substep.
constexpr std::uint32_t kMostRows = 1500;
constexpr std::uint32_t kMostEntries = 20000;
constexpr std::uint32_t kNoRow = 0xffffffff;
constexpr std::uint8_t kMostColors = 64;  // groups without a colour run in one thread

/// Returns the maximum number of rows, including those that damp.
int most_rows(JointDesc::Kind kind) {
  return kind == JointDesc::Kind::kDistance || kind == JointDesc::Kind::kRope ? 1 : kMostJointRows;
}

/// Visits the awake bodies of a joint.
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
  driven_.clear();
  is_first_.clear();
  was_split_ = false;
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].holds()) continue;
    BodySlot first, last;
    for_moving(joints[i], bodies, [&](BodySlot body) {
      if (first.none()) first = body;
      last = body;
    });
    if (first.none()) continue;
    active_.push_back(i);
    joined_.emplace_back(first, last);
    const auto carries = [&](BodySlot body) {
      return !body.none() && bodies.is_moving_kinematic(body);
    };
    if (carries(joints[i].body_a) || carries(joints[i].body_b)) driven_.push_back(first);
  }
  works_.resize(active_.size());
  if (active_.empty()) return;
  mark_free(bodies, in_contact);
  order_joints(bodies, joints);
  group_joints(bodies, joints);
  color_groups(bodies, joints);
}

/// Marks free-hanging bodies, then all bodies in joints as in contact.
void JointSolver::mark_free(const Bodies& bodies, SpanByBody<std::uint8_t> in_contact) {
  DisjointSets islands(bodies.size());
  for (const auto& [a, b] : joined_) islands.join(a.value, b.value);
  ByBody<std::uint8_t> touches(bodies.size(), 0);
  for (const auto& [a, b] : joined_)
    if (in_contact[a] || in_contact[b]) touches[BodySlot(islands.root(a.value))] = 1;
  hangs_free_.assign(bodies.size(), 0);
  for (const auto& [a, b] : joined_) {
    hangs_free_[a] = hangs_free_[b] = !touches[BodySlot(islands.root(a.value))];
    in_contact[a] = in_contact[b] = 1;
  }
}

/// Orders connected joints from an end on, neighbours first, and reversed (reverse Cuthill-McKee):
/// any chain gets a narrow band, whatever the order of its joints.
void JointSolver::order_joints(const Bodies& bodies, const Joints& joints) {
  ByBody<std::vector<std::uint32_t>> of_body(bodies.size());
  for (const std::uint32_t i : active_)
    for_moving(joints[i], bodies, [&](BodySlot body) { of_body[body].push_back(i); });
  const auto neighbours = [&](std::uint32_t i) {
    std::size_t count = 0;
    for_moving(joints[i], bodies, [&](BodySlot body) { count += of_body[body].size(); });
    return count;
  };
  std::vector<std::uint32_t> ends = std::exchange(active_, {});
  std::ranges::stable_sort(ends, {}, neighbours);
  std::vector<std::uint8_t> seen(joints.size(), 0);
  for (const std::uint32_t end : ends) {
    if (std::exchange(seen[end], std::uint8_t{1})) continue;
    active_.push_back(end);
    for (std::size_t at = active_.size() - 1; at < active_.size(); ++at) {
      for_moving(joints[active_[at]], bodies, [&](BodySlot body) {
        for (const std::uint32_t next : of_body[body])
          if (!std::exchange(seen[next], std::uint8_t{1})) active_.push_back(next);
      });
    }
    is_first_.resize(active_.size(), 0);
    is_first_.back() = 1;  // reversed
  }
  std::ranges::reverse(active_);
  std::ranges::reverse(is_first_);
}

/// Splits the ordered joints into groups, at gaps and where a band would be too large.
void JointSolver::group_joints(const Bodies& bodies, const Joints& joints) {
  ByBody<std::uint32_t> row_of_body(bodies.size(), kNoRow);  // first row that moves a body
  std::uint32_t rows = 0, entries = 0, base = 0;
  for (std::uint32_t at = 0; at < active_.size(); ++at) {
    const Joint& joint = joints[active_[at]];
    const auto n = static_cast<std::uint32_t>(most_rows(joint.desc.kind));
    std::uint32_t width = 0;  // width of the envelope before the joint's own rows
    for_moving(joint, bodies, [&](BodySlot body) {
      const std::uint32_t first = row_of_body[body];
      if (first != kNoRow && first >= base) width = std::max(width, base + rows - first);
    });
    const std::uint32_t more = n * width + n * (n + 1) / 2;
    if (is_first_[at] || rows + n > kMostRows || entries + more > kMostEntries) {
      was_split_ |= !is_first_[at];
      base += rows;
      rows = entries = 0;
      groups_.emplace_back();
      groups_.back().first = at;
      for_moving(joint, bodies,
                 [&](BodySlot body) { groups_.back().hangs_free = hangs_free_[body]; });
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

void JointSolver::begin(std::uint32_t i, const StepContext& step, const Bodies& bodies,
                        const Joints& joints, const JointStep& step_bodies, const BodyRow* rows) {
  JointGroup& group = groups_[i];
  for (std::uint32_t at = group.first; at < group.first + group.count; ++at)
    works_[at] = begin_joint(joints[active_[at]], active_[at], bodies, step_bodies);
  begin_group(group, works(group), step, rows);
}

void JointSolver::solve_final(std::uint32_t i, const StepContext& step, const Bodies& bodies,
                              Joints& joints, const JointStep& step_bodies, BodyRow* rows) {
  for (JointWork& work : works(groups_[i])) {
    if (work.broken) continue;
    if (work.kind == JointKind::kPlastic) store_flow(work, joints[work.joint]);
    const JointWork solved =
        std::exchange(work, begin_joint(joints[work.joint], work.joint, bodies, step_bodies));
    work.impulse = solved.impulse;
    work.total = solved.total;
    work.bounds = solved.bounds;
    work.plastic = solved.plastic;
  }
  solve_group_final(groups_[i], works(groups_[i]), step, rows);
}

Vec3 JointSolver::finish(Bodies& bodies, Joints& joints) {
  Vec3 outside = Vec3::Zero();
  for (const JointWork& work : works_) {
    if (work.row_a <= 0) outside += work.total.linear_W;
    if (work.row_b <= 0) outside -= work.total.linear_W;
    joints[work.joint].impulse = work.impulse;
    joints[work.joint].total = work.total;
  }
  for (const JointWork& work : works_)
    if (work.broken) joints.break_off(work.joint, bodies);
  return outside;
}

}  // namespace sunder::solver
