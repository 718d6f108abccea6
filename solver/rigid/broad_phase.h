// Which shapes are near each other. Movers and statics have a tree each; every shape has a fat
// box, and only shapes that leave theirs look for new neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/bodies.h"
#include "solver/rigid/box_tree.h"
#include "solver/rigid/contacts.h"

namespace sunder::solver {

class BroadPhase {
 public:
  /// Tells of shapes that came or went; they are found again by the next update().
  void shapes_changed(std::span<const std::uint32_t> added, const Shapes& shapes,
                      const Bodies& bodies);
  /// Boxes of what changed, swept over dt_s; adds pairs that came near, in order of their keys.
  void update(const Shapes& shapes, const Bodies& bodies, const Vec3& gravity_W, double dt_s,
              Contacts& contacts);
  /// Whether the pair's shapes may touch within the step.
  bool near(const Pair& pair) const;
  /// Whether the pair is worth keeping.
  bool keep(const Pair& pair) const;

 private:
  struct HalfSpace {
    std::uint32_t shape;
    Vec3f normal_W;
    float d;
  };
  void update_boxes(const Shapes& shapes, const Bodies& bodies, const Vec3& gravity_W, double dt_s);
  void update_trees(const Shapes& shapes, const Bodies& bodies);
  void find_pairs(std::uint32_t shape, const Shapes& shapes, const Bodies& bodies,
                  const KeySet& keys, std::vector<Pair>& found) const;
  bool overlaps(const Pair& pair, const std::vector<FloatBox>& boxes) const;

  std::vector<FloatBox> swept_, fat_;  ///< By shape slot.
  std::vector<std::uint8_t> moved_;    ///< Left its fat box in this update.
  std::vector<std::uint32_t> movers_, statics_, moved_list_;
  std::vector<HalfSpace> half_spaces_;
  std::vector<std::int32_t> half_space_of_;  ///< By shape slot; −1: not one.
  BoxTree mover_tree_, static_tree_;
  bool sets_changed_ = true;
  bool look_again_ = false;  ///< A half-space came: it has no box that others would find.
  int refits_ = 0;
};

}  // namespace sunder::solver
