// Which nodes of a level of springs move as one on the next coarser level: the way between the two
// (unsmoothed aggregation).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fracture/stress/spring_level.h"

namespace sunder::fracture {

/// Groups of the nodes of one level, the fine one, which are the nodes of the coarse one.
class SpringGroups {
 public:
  /// Groups of about `size` nodes that hold each other strongly.
  SpringGroups(const SpringLevel<float>& fine, std::size_t size);

  /// How many groups there are.
  std::size_t count() const { return count_; }
  /// The coarse level: springs between groups.
  SpringLevel<float> coarsen(const SpringLevel<float>& fine);
  /// The same after an edit that has made the fine level what it is: groups that it does not reach
  /// stay as they are, and what is new joins those beside it. `edit` becomes what it does to the
  /// coarse level, which was `old_coarse`.
  SpringLevel<float> coarsen(const SpringLevel<float>& fine, const SpringLevel<float>& old_coarse,
                             SpringEdit& edit);
  /// Forces on nodes as forces on groups.
  void restrict_to(const Nodal<float>& forces, Nodal<float>& sums) const;
  /// Adds `factor` times the groups' rigid motions to the nodes.
  void prolong(float factor, const Nodal<float>& motions, Nodal<float>& x) const;

 private:
  std::optional<Spring> between_groups(Spring spring) const;
  void place_arms(const SpringLevel<float>& fine, const SpringLevel<float>& coarse);
  SpringEdit edit_of_groups(const SpringLevel<float>& fine, const SpringEdit& edit);
  void join_groups(const SpringEdit& edit);

  std::size_t count_ = 0;
  std::vector<std::uint32_t> group_;  ///< Per node of the fine level.
  std::vector<Simd4<float>> arms_;    ///< Per node: from the place of its group.
};

}  // namespace sunder::fracture
