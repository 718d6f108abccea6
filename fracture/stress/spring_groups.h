// Groups of nodes that are the nodes of the next coarser level, and the transfer between the two
// levels (unsmoothed aggregation).
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "fracture/stress/spring_level.h"

namespace sunder::fracture {

/// Groups of the nodes of one level, the fine one, which are the nodes of the coarse one.
class SpringGroups {
 public:
  SpringGroups() = default;
  /// Makes groups of about `size` nodes with strong springs between them.
  SpringGroups(const SpringLevel<float>& fine, std::size_t size);

  /// Returns the number of groups.
  std::size_t count() const { return count_; }
  /// Returns the coarse level, which has the springs between groups.
  SpringLevel<float> coarsen(const SpringLevel<float>& fine);
  /// Returns the coarse level after an edit of the fine level. Groups outside the edit stay the
  /// same, and new nodes join neighbouring groups. `edit` is replaced by the edit of the coarse
  /// level, which was `old_coarse` before.
  SpringLevel<float> coarsen(const SpringLevel<float>& fine, const SpringLevel<float>& old_coarse,
                             SpringEdit& edit);
  /// Sums forces on nodes to forces on groups.
  void restrict_to(const Nodal<float>& forces, Nodal<float>& sums) const;
  /// Adds `factor` times the rigid motions of groups to the nodes.
  void prolong(float factor, const Nodal<float>& motions, Nodal<float>& x) const;

  static auto fields(auto& self) { return std::tie(self.count_, self.group_, self.arms_); }
  /// Returns the number of nodes of the fine level.
  std::size_t nodes() const { return group_.size(); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  std::optional<Spring> between_groups(Spring spring) const;
  void place_arms(const SpringLevel<float>& fine, const SpringLevel<float>& coarse);
  SpringEdit edit_of_groups(const SpringLevel<float>& fine, const SpringEdit& edit);
  void assign_new_nodes(const SpringEdit& edit);

  std::size_t count_ = 0;
  std::vector<std::uint32_t> group_;  ///< Per node of the fine level.
  std::vector<Simd4<float>> arms_;    ///< Per node: vector from the place of its group.
};

}  // namespace sunder::fracture
