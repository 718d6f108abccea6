// Impacts, before the sweeps of a substep: swept until they have passed through what touches. Their
// impulses are none that a later substep would begin with. Read first: run(), and
// docs/decisions/036.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/rigid/contact/contact_blocks.h"
#include "solver/rigid/contact/impacts.h"

namespace sunder::solver {

class ImpactPass {
 public:
  void clear();
  /// Blocks of so many manifolds of one colour, that are near an impact.
  void add(std::uint32_t first, std::uint32_t end, std::uint32_t manifolds);
  bool empty() const { return blocks_.empty(); }
  /// Once all blocks are added; `active` are the awake bodies in contact.
  void begin(const Impacts& impacts, std::span<const BodySlot> active, ContactBlocks& blocks);
  /// Lets nothing close any more, but for a small share of the energy with which all did. Moves
  /// BodyRow::base, and `velocity` with it.
  void run(const ContactStep& step, ContactBlocks& blocks);
  /// Sweeps of a manifold in this step.
  std::uint64_t work() const { return work_; }

 private:
  template <class Visit>
  void for_blocks(const Visit& visit) const {
    for (const auto& [first, end] : blocks_) visit(first, end);
  }
  double closing_J(const ContactStep& step, const ContactBlocks& blocks) const;
  void sweep(const ContactStep& step, ContactBlocks& blocks);
  /// Lets velocities be those before the impulses of the substep, and back.
  void set_aside(BodyRow* rows);
  void put_back(BodyRow* rows) const;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> blocks_;  ///< First and end, by colour.
  std::vector<BodySlot> bodies_;                                 ///< That they may move.
  std::vector<Wide> velocity_;                                   ///< Of these, with all impulses.
  double impact_J_ = 0;  ///< Energy of what closed when the step began.
  std::uint64_t work_ = 0;
  std::uint32_t manifolds_ = 0;
};

}  // namespace sunder::solver
