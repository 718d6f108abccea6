// How much of each cell of the air is solid, and how that solid moves.
#pragma once

#include <array>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/grid.h"

namespace sunder::solver {

/// Solid parts are those of the boxes that obstacles fill, exact where a box stands along the
/// grid; so thin walls and crumbs smaller than a cell count for what they are.
class Solids {
 public:
  void rasterize(const Grid& grid, const Obstacles& obstacles);

  Field fraction;                 ///< Per cell, 0 to 1 (more where obstacles overlap).
  std::array<Field, 3> momentum;  ///< Per cell: fraction times velocity.

 private:
  /// A box in cells' units, with its corner (cell 1, 1, 1) at the origin.
  struct Block {
    std::uint32_t shape = 0;
    Vec3f center, half;
    Mat3f rotation;
    float fill = 1;  ///< Part of the box that is solid.
    Vec3i first, last;
    VelocityField motion;  ///< Metres, in W.
  };

  void place(const Grid& grid, const Obstacles& obstacles);
  void add(const Grid& grid, const Block& block, int first_layer, int last_layer);

  std::vector<Block> blocks_;
};

}  // namespace sunder::solver
