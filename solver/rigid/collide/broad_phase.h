// Which shapes are near each other. Movers have a tree, statics a forest; every shape has a fat
// box, and only shapes that leave theirs look for new neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/box_forest.h"
#include "solver/rigid/collide/box_tree.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Two shapes that came near: as in Pair, a is the half-space, or the hull, or the facet, or the
/// lesser slot.
struct FoundPair {
  ShapeSlot shape_a, shape_b;

  std::uint64_t key() const { return pair_key(shape_a, shape_b); }
};

class BroadPhase {
 public:
  /// Takes shapes in; they are found by the next update().
  void add(std::span<const ShapeSlot> added, const Shapes& shapes, const Bodies& bodies);
  /// The slots of all pairs that have one of these shapes, each once, ascending. To be asked before
  /// the shapes are removed.
  std::vector<PairSlot> pairs_with(std::span<const ShapeSlot> of, const Shapes& shapes,
                                   const Contacts& contacts) const;
  /// Takes shapes out.
  void remove(std::span<const ShapeSlot> removed);
  /// Boxes of what changed, swept over the step; adds pairs that came near, in the same order for
  /// any number of threads.
  void update(const StepContext& step, const Shapes& shapes, const Bodies& bodies,
              Contacts& contacts);
  /// Shapes that the last update() looked for neighbours of.
  std::size_t moved() const { return moved_list_.size(); }
  /// Whether the pair's shapes may touch within the step.
  bool near(const Pair& pair) const;
  /// Whether the pair is worth keeping: one that is not cannot be found by its shapes any more.
  bool keep(const Pair& pair) const;
  /// Whether it ceased to be so in this update.
  bool strayed(const Pair& pair) const {
    return (moved_[pair.shape_a] || moved_[pair.shape_b]) && !keep(pair);
  }
  /// The fat boxes of shapes that have one, in order of slots.
  std::vector<ShapeBox> boxes(const Shapes& shapes, const Bodies& bodies) const;

 private:
  enum class Role : std::uint8_t { kAbsent, kMover, kStatic, kHalfSpace };
  struct HalfSpace {
    ShapeSlot shape;
    Vec3f normal_W;
    float d;
  };
  void add_half_space(ShapeSlot shape, const Shapes& shapes, const Bodies& bodies);
  void remove_half_space(ShapeSlot shape);
  void update_boxes(const StepContext& step, const Shapes& shapes, const Bodies& bodies);
  void update_trees();
  void find_pairs(ShapeSlot shape, const Shapes& shapes, const Bodies& bodies,
                  const Contacts& contacts, std::vector<FoundPair>& found);
  void thin_out(ShapeSlot shape, std::size_t neighbours, const Shapes& shapes, const Bodies& bodies,
                std::vector<FoundPair>& found, std::size_t first);
  bool overlaps(const Pair& pair, const ByShape<FloatBox>& boxes) const;

  ByShape<Role> role_;
  ByShape<FloatBox> swept_, fat_;
  ByShape<std::uint8_t> moved_;    ///< Left its fat box in this update.
  ByShape<std::uint8_t> crowded_;  ///< Has neighbours that were not looked at.
  std::vector<ShapeSlot> movers_, new_statics_, moved_list_;
  std::vector<std::vector<FoundPair>> found_;  ///< By chunk of moved shapes.
  std::vector<HalfSpace> half_spaces_;
  ByShape<std::int32_t> half_space_of_;  ///< −1: not one.
  BoxTree mover_tree_;
  BoxForest static_forest_;
  bool movers_changed_ = true;
  bool look_again_ = false;  ///< A half-space came: it has no box that others would find.
  int refits_ = 0;
};

}  // namespace sunder::solver
