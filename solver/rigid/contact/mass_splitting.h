// Mass splitting: manifolds without a colour are solved in parallel, each with its own part of its
// bodies. The changes of a body's parts are summed in the order of the parts. For the motion of a
// part see constraint_block.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/body_row.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Part of each body that a split manifold changes, and number of parts of the body.
struct SplitSides {
  std::uint32_t part_a = 0, part_b = 0;
  std::uint32_t parts_a = 1, parts_b = 1;
};

class MassSplitting {
 public:
  /// Splits each awake body into one part per manifold, in the order of the manifolds.
  void split(std::span<const ManifoldSlot> manifolds, const Bodies& bodies,
             const Contacts& contacts);
  /// True if nothing is split.
  bool empty() const { return sides_.empty(); }
  /// Sides by manifold.
  std::span<const SplitSides> sides() const { return sides_; }
  /// Changes of the parts, which sweeps write.
  Wide* parts() { return parts_.data(); }
  /// Adds the changes of a body's parts to its row.
  void join(BodySlot body, BodyRow& row) const;

 private:
  std::vector<SplitSides> sides_;
  ByBody<std::uint32_t> count_;  ///< Number of parts.
  ByBody<std::uint32_t> end_;    ///< End of a body's parts in `parts_`.
  std::vector<Wide> parts_;
};

}  // namespace sunder::solver
