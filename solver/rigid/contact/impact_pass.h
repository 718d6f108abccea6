// Propagates impacts through touching bodies, by many sweeps before those of a substep. Their
// impulses do not warm start later substeps. Read first: run(), and docs/decisions/036.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/collide/impacts.h"
#include "solver/rigid/contact/contact_blocks.h"

namespace sunder::solver {

class ImpactPass {
 public:
  /// Maximum number of sweeps in a substep. A solver with as many sweeps of its own needs no
  /// propagation.
  static constexpr int kMostSweeps = 64;

  void clear();
  /// Adds the manifolds of a colour near an impact: `manifolds` from index `manifold` of the list
  /// to solve, in blocks [first, end).
  void add(std::uint32_t first, std::uint32_t end, std::uint32_t manifold, std::uint32_t manifolds);
  bool empty() const { return colors_.empty(); }
  /// Must be called after all blocks are added. `active` are the awake bodies in contact; `rows` is
  /// the number of rows, `kinematic` that of kinematic ones.
  void begin(const Impacts& impacts, std::span<const BodySlot> active, std::size_t rows,
             std::size_t kinematic, ContactBlocks& blocks);
  /// Must be called after all blocks are prepared.
  void prepare(const ContactStep& step, ContactBlocks& blocks) const;
  /// Propagates impacts until no contact closes as fast as an impact. Changes BodyRow::base and
  /// `velocity` by the same amount.
  void run(const ContactStep& step, ContactBlocks& blocks);
  /// Returns true if a run() since clear() ended at its most sweeps, while contacts still closed as
  /// fast as an impact.
  bool was_cut_off() const { return was_cut_off_; }

 private:
  struct Color {
    std::uint32_t first, end;  ///< Range of blocks.
    /// First manifold in the list to solve, and number of manifolds.
    std::uint32_t manifold, manifolds;
  };
  template <class Visit>
  void for_blocks(const Visit& visit) const {
    for (const Color& color : colors_) visit(color.first, color.end);
  }
  void sweep(const ContactStep& step, ContactBlocks& blocks);
  /// Subtracts the substep's impulses from the velocities.
  void subtract_impulses(BodyRow* rows);
  /// Restores the velocities without the substep's impulses.
  void restore_velocities(BodyRow* rows) const;
  /// Adds the substep's impulses to the velocities.
  void add_impulses(BodyRow* rows) const;

  std::vector<Color> colors_;
  std::vector<BodySlot> bodies_;     ///< Bodies that impacts may move.
  std::vector<Wide> velocity_;       ///< Velocities of these bodies with all impulses.
  std::vector<std::uint8_t> moved_;  ///< ImpactSweep::moved, with rows below 0 first.
  std::size_t kinematic_ = 0;        ///< Number of rows below 0.
  int manifolds_ = 0;
  bool was_cut_off_ = false;
};

}  // namespace sunder::solver
