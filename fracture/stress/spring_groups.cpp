#include "fracture/stress/spring_groups.h"

#include <algorithm>
#include <map>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "fracture/stress/spring_math.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Neighbours of every node and the stiffness to each, as begin offsets and flat lists.
struct Couplings {
  std::vector<std::uint32_t> first, other;
  std::vector<double> strength;
  std::vector<double> strongest;  ///< Per node.

  template <class Real>
  explicit Couplings(const SpringLevel<Real>& level)
      : first(level.size() + 2, 0), strongest(level.size(), 0) {
    const auto each = [&](auto&& visit) {
      level.for_each_spring([&](const Spring& s) {
        if (s.a == Spring::kWorld || s.b == Spring::kWorld) return;
        visit(s.a, s.b, s.stretch_N_m);
        visit(s.b, s.a, s.stretch_N_m);
      });
    };
    each([&](std::uint32_t node, std::uint32_t, double) { ++first[node + 2]; });
    for (std::size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];
    other.resize(first.back());
    strength.resize(first.back());
    each([&](std::uint32_t node, std::uint32_t neighbour, double stretch) {
      other[first[node + 1]] = neighbour;
      strength[first[node + 1]++] = stretch;
      strongest[node] = std::max(strongest[node], stretch);
    });
  }
};

/// Groups of neighbouring nodes, numbered in the order of their first nodes.
class GrowingGroups {
 public:
  GrowingGroups(const Couplings& couplings, std::size_t nodes)
      : couplings_(couplings), group_(nodes, kFree), links_to_group_(nodes, 0) {}

  /// Grows groups by the most strongly connected node, up to `size` nodes; returns their number.
  template <class IsThere>
  std::uint32_t grow(std::size_t size, const IsThere& is_there) {
    std::uint32_t groups = 0;
    for (std::uint32_t seed = 0; seed < group_.size(); ++seed) {
      if (!is_there(seed)) group_[seed] = 0;
      if (group_[seed] != kFree) continue;
      boundary_.clear();
      add(seed, groups);
      std::size_t members = 1;
      for (; members < size; ++members) {
        const auto best = most_linked();
        if (best == kFree) break;
        add(best, groups);
      }
      for (const std::uint32_t node : boundary_) links_to_group_[node] = 0;
      if (members > 1 || !join_neighbour(seed)) ++groups;
    }
    return groups;
  }

  std::vector<std::uint32_t> take() { return std::move(group_); }

 private:
  static constexpr std::uint32_t kFree = 0xffffffff;

  void add(std::uint32_t node, std::uint32_t group) {
    group_[node] = group;
    for (std::uint32_t k = couplings_.first[node]; k < couplings_.first[node + 1]; ++k) {
      const std::uint32_t other = couplings_.other[k];
      if (group_[other] != kFree ||
          couplings_.strength[k] < kWeakSpring * couplings_.strongest[other]) {
        continue;
      }
      if (links_to_group_[other] == 0) boundary_.push_back(other);
      links_to_group_[other] += 1;
    }
  }

  std::uint32_t most_linked() const {
    std::uint32_t best = kFree;
    for (const std::uint32_t node : boundary_) {
      if (group_[node] == kFree && (best == kFree || links_to_group_[node] > links_to_group_[best]))
        best = node;
    }
    return best;
  }

  /// Moves a single node to the group with the stiffest spring to it; returns false if it has none.
  bool join_neighbour(std::uint32_t node) {
    double most = 0;
    const std::uint32_t alone = group_[node];
    for (std::uint32_t k = couplings_.first[node]; k < couplings_.first[node + 1]; ++k) {
      const std::uint32_t other = group_[couplings_.other[k]];
      if (other == kFree || other == alone || couplings_.strength[k] <= most) continue;
      most = couplings_.strength[k];
      group_[node] = other;
    }
    return most > 0;
  }

  const Couplings& couplings_;
  std::vector<std::uint32_t> group_;
  std::vector<std::uint32_t> boundary_;  ///< Ungrouped nodes beside the growing group.
  std::vector<double>
      links_to_group_;  ///< Per node: number of its strong springs to the growing group.
};

/// Merges springs between the same two nodes into one.
std::vector<Spring> merge(std::vector<Spring> springs) {
  std::sort(springs.begin(), springs.end(),
            [](const Spring& x, const Spring& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  std::vector<Spring> merged;
  for (std::size_t begin = 0, end = 0; begin < springs.size(); begin = end) {
    Spring one = springs[begin];
    one.stretch_N_m = 0;
    Vec3 moment = Vec3::Zero();
    for (; end < springs.size() && springs[end].a == one.a && springs[end].b == one.b; ++end) {
      one.stretch_N_m += springs[end].stretch_N_m;
      moment += springs[end].stretch_N_m * springs[end].place;
    }
    one.place = moment / one.stretch_N_m;
    one.rotation_Nm.setZero();
    for (std::size_t i = begin; i < end; ++i) {
      one.rotation_Nm += springs[i].rotation_Nm +
                         springs[i].stretch_N_m * parallel_axis(springs[i].place - one.place);
    }
    merged.push_back(one);
  }
  return merged;
}

}  // namespace

const char* SpringGroups::wrong_field() const {
  if (count_ > group_.size()) return "count_";
  if (!all_below(group_, count_)) return "group_";
  return arms_.size() == group_.size() ? nullptr : "arms_";
}

SpringGroups::SpringGroups(const SpringLevel<float>& fine, std::size_t size) {
  const Couplings couplings(fine);
  GrowingGroups growing(couplings, fine.size());
  count_ = growing.grow(size, [&](std::uint32_t node) { return fine.has_springs(node); });
  group_ = growing.take();
}

SpringLevel<float> SpringGroups::coarsen(const SpringLevel<float>& fine) {
  std::vector<Spring> between;
  fine.for_each_spring([&](const Spring& spring) {
    if (const std::optional<Spring> one = between_groups(spring)) between.push_back(*one);
  });
  SpringLevel<float> coarse(count_, merge(std::move(between)));
  place_arms(fine, coarse);
  return coarse;
}

SpringLevel<float> SpringGroups::coarsen(const SpringLevel<float>& fine,
                                         const SpringLevel<float>& old_coarse, SpringEdit& edit) {
  edit = edit_of_groups(fine, edit);
  SpringLevel<float> coarse(old_coarse, edit);
  place_arms(fine, coarse);
  return coarse;
}

/// Returns the spring between groups; none if both ends are in one group.
std::optional<Spring> SpringGroups::between_groups(Spring spring) const {
  spring.a = spring.a == Spring::kWorld ? Spring::kWorld : group_[spring.a];
  spring.b = spring.b == Spring::kWorld ? Spring::kWorld : group_[spring.b];
  if (spring.a == spring.b) return std::nullopt;
  if (spring.a > spring.b) std::swap(spring.a, spring.b);
  return spring;
}

/// Computes the vectors from groups to their nodes.
void SpringGroups::place_arms(const SpringLevel<float>& fine, const SpringLevel<float>& coarse) {
  arms_.resize(group_.size());
  for (std::size_t i = 0; i < group_.size(); ++i) {
    const Vec3 from_group = fine.place(i) - coarse.place(group_[i]);
    arms_[i] = rounded<float>(from_group, from_group.norm());
  }
}

/// Returns the edit of the coarse level that follows from an edit of the fine level.
SpringEdit SpringGroups::edit_of_groups(const SpringLevel<float>& fine, const SpringEdit& edit) {
  SpringEdit of_groups;
  of_groups.changes.assign(count_, SpringEdit::Change::kNone);
  const auto mark = [&] {
    for (std::uint32_t i = 0; i < group_.size(); ++i) {
      if (edit.is_at(i)) of_groups.changes[group_[i]] = SpringEdit::Change::kSprings;
    }
  };
  mark();
  assign_new_nodes(edit);
  mark();
  std::vector<Spring> between;
  fine.for_springs_near([&](std::uint32_t node) { return of_groups.is_at(group_[node]); },
                        [&](const Spring& spring) {
                          const std::optional<Spring> one = between_groups(spring);
                          if (one && of_groups.is_at(*one)) between.push_back(*one);
                        });
  of_groups.springs = merge(std::move(between));
  return of_groups;
}

/// Assigns new nodes to the group with the stiffest spring to them.
void SpringGroups::assign_new_nodes(const SpringEdit& edit) {
  std::vector<std::uint8_t> ungrouped(group_.size(), 0);
  std::size_t left = 0;
  for (std::uint32_t i = 0; i < group_.size(); ++i) {
    ungrouped[i] = edit.changes[i] == SpringEdit::Change::kNew;
    left += ungrouped[i];
  }
  while (left > 0) {
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> best;  // Stiffness and group.
    for (const Spring& spring : edit.springs) {
      if (spring.a == Spring::kWorld || spring.b == Spring::kWorld) continue;
      if (ungrouped[spring.a] == ungrouped[spring.b]) continue;
      const std::uint32_t node = ungrouped[spring.a] ? spring.a : spring.b;
      const std::uint32_t other = ungrouped[spring.a] ? spring.b : spring.a;
      auto& strongest = best[node];
      if (spring.stretch_N_m > strongest.first) strongest = {spring.stretch_N_m, group_[other]};
    }
    // Nodes without a neighbour keep the groups of their previous bodies.
    if (best.empty()) return;
    for (const auto& [node, strongest] : best) {
      group_[node] = strongest.second;
      ungrouped[node] = 0;
      --left;
    }
  }
}

void SpringGroups::restrict_to(const Nodal<float>& forces, Nodal<float>& sums) const {
  std::fill(sums.begin(), sums.end(), Six<float>{});
  for (std::size_t i = 0; i < group_.size(); ++i) {
    Six<float>& sum = sums[group_[i]];
    sum.linear += forces[i].linear;
    sum.angular += forces[i].angular + cross(arms_[i], forces[i].linear);
  }
}

void SpringGroups::prolong(float factor, const Nodal<float>& motions, Nodal<float>& x) const {
  for_chunks(group_.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Six<float>& motion = motions[group_[i]];
      x[i].linear += splat<float>(factor) * (motion.linear + cross(motion.angular, arms_[i]));
      x[i].angular += splat<float>(factor) * motion.angular;
    }
  });
}

}  // namespace sunder::fracture
