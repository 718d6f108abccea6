// Impacts, before the sweeps of a substep: swept until they have passed through what touches. Their
// impulses are none that a later substep would begin with. Read first: run(), and
// docs/decisions/036.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/collide/impacts.h"
#include "solver/rigid/contact/contact_blocks.h"

namespace sunder::solver {

class ImpactPass {
 public:
  /// Most sweeps in a substep: who asks for as many of all sweeps has no need of it.
  static constexpr int kMostSweeps = 64;

  void clear();
  /// What of a colour is near an impact: `manifolds` from `manifold` of those to solve, in blocks
  /// from `first` to `end`.
  void add(std::uint32_t first, std::uint32_t end, std::uint32_t manifold, std::uint32_t manifolds);
  bool empty() const { return colors_.empty(); }
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
  struct Color {
    std::uint32_t first, end;           ///< Blocks.
    std::uint32_t manifold, manifolds;  ///< Of those to solve; how many.
  };
  template <class Visit>
  void for_blocks(const Visit& visit) const {
    for (const Color& color : colors_) visit(color.first, color.end);
  }
  void sweep(const ContactStep& step, ContactBlocks& blocks);
  /// Lets velocities be those before the impulses of the substep; lets them be those again; and
  /// adds the impulses back.
  void set_aside(BodyRow* rows);
  void take_back(BodyRow* rows) const;
  void put_back(BodyRow* rows) const;

  std::vector<Color> colors_;
  std::vector<BodySlot> bodies_;     ///< That they may move.
  std::vector<Wide> velocity_;       ///< Of these, with all impulses.
  std::vector<std::uint8_t> moved_;  ///< See ImpactSweep.
  std::size_t kinematic_ = 0;        ///< Rows below 0.
  int manifolds_ = 0;
};

}  // namespace sunder::solver
