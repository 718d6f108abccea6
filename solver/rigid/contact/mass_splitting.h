// Mass splitting: manifolds that found no colour are solved side by side, each with a part of its
// bodies to itself, and what they do to a body is summed in the order of its parts. How a part
// moves: constraint_block.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/body_row.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Where a split manifold's changes of its bodies go, and into how many parts those are cut.
struct SplitSides {
  std::uint32_t part_a = 0, part_b = 0;
  std::uint32_t parts_a = 1, parts_b = 1;
};

class MassSplitting {
 public:
  /// Cuts awake bodies into as many parts as they have of these manifolds, in the order of these.
  void split(std::span<const ManifoldSlot> manifolds, const Bodies& bodies,
             const Contacts& contacts);
  /// Nothing is split.
  bool empty() const { return sides_.empty(); }
  /// As the manifolds.
  std::span<const SplitSides> sides() const { return sides_; }
  /// What the parts did; for sweeps to write to.
  Wide* parts() { return parts_.data(); }
  /// Adds what a body's parts did since they were last written.
  void join(BodySlot body, BodyRow& row) const;

 private:
  std::vector<SplitSides> sides_;
  ByBody<std::uint32_t> count_;  ///< Of its parts.
  ByBody<std::uint32_t> end_;    ///< Of its parts in `parts_`.
  std::vector<Wide> parts_;
};

}  // namespace sunder::solver
