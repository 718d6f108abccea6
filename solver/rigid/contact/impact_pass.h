// Impacts, before the sweeps of a substep: swept until they have passed through what touches. Their
// impulses are none that a later substep would begin with. Read first: run(), and
// docs/decisions/036.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/rigid/collide/impacts.h"
#include "solver/rigid/contact/contact_blocks.h"

namespace sunder::solver {

class ImpactPass {
 public:
  /// Most sweeps in a substep: who asks for as many of all sweeps has no need of it.
  static constexpr int kMostSweeps = 64;

  void clear();
  /// Blocks of so many manifolds of one colour, that are near an impact.
  void add(std::uint32_t first, std::uint32_t end, std::uint32_t manifolds);
  bool empty() const { return blocks_.empty(); }
  /// Once all blocks are added; `active` are the awake bodies in contact, of so
  /// many rows.
  void begin(const Impacts& impacts, std::span<const BodySlot> active, std::size_t rows,
             std::size_t kinematic, ContactBlocks& blocks);
  /// Once all blocks are prepared.
  void prepare(const ContactStep& step, ContactBlocks& blocks) const;
  /// Lets nothing close any more as fast as impacts do. Changes BodyRow::base, and `velocity` by as
  /// much.
  void run(const ContactStep& step, ContactBlocks& blocks);

 private:
  template <class Visit>
  void for_blocks(const Visit& visit) const {
    for (const auto& [first, end] : blocks_) visit(first, end);
  }
  template <class Visit>
  bool any_block(const Visit& visit) const {
    bool any = false;
    for (const auto& [first, end] : blocks_) any |= visit(first, end);
    return any;
  }
  void sweep(const ContactStep& step, ContactBlocks& blocks);
  /// Lets velocities be those before the impulses of the substep; lets them be those again; and
  /// adds the impulses back.
  void set_aside(BodyRow* rows);
  void take_back(BodyRow* rows) const;
  void put_back(BodyRow* rows) const;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> blocks_;  ///< First and end, by colour.
  std::vector<BodySlot> bodies_;                                 ///< That they may move.
  std::vector<Wide> velocity_;                                   ///< Of these, with all impulses.
  std::vector<std::uint8_t> moved_;                              ///< See ImpactSweep.
  std::size_t kinematic_ = 0;                                    ///< Rows below 0.
  int manifolds_ = 0;
};

}  // namespace sunder::solver
