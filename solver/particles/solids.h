// Solid fraction of each cell of the air, and the velocity of that solid.
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/grid.h"

namespace sunder::solver {

/// Rasterizes obstacles as boxes with a fill factor; exact for boxes aligned with the grid, and
/// proportional to the volume also for thin walls and pieces smaller than a cell.
class Solids {
 public:
  void rasterize(const Grid& grid, const Obstacles& obstacles);

  Field fraction;                 ///< Solid fraction of each cell; above 1 where obstacles overlap.
  std::array<Field, 3> momentum;  ///< Solid fraction times velocity of each cell, in m/s.

  static auto fields(auto& self) { return std::tie(self.fraction, self.momentum); }

 private:
  /// A box in units of cells, relative to the lower corner of the grid.
  struct Block {
    Vec3f center, half;
    Mat3f rotation;
    float fill = 1;        ///< Solid fraction of the box.
    Vec3i first, last;     ///< Range of cells that the box may overlap.
    VelocityField motion;  ///< In m/s, in W.
  };

  void place(const Grid& grid, const Obstacles& obstacles);
  void add(const Grid& grid, const Block& block, int first_layer, int last_layer);

  std::vector<Block> blocks_;
};

}  // namespace sunder::solver
