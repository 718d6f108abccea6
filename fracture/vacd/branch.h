// A piece on its way to becoming convexes: how loose its hull is, and its parts once it is cut.
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/vacd/cut.h"
#include "fracture/vacd/regions.h"

namespace sunder::fracture {

/// A piece as a branch of the tree of cuts (tree.h).
struct Branch {
  VacdPiece piece;
  Outline outline;
  double solid_m3 = 0;
  double hull_m3 = 0;                   ///< At least solid_m3.
  std::vector<std::uint32_t> children;  ///< The parts, in the tree it belongs to.
  bool tried = false;                   ///< To be cut.

  double slack() const { return hull_m3 - solid_m3; }
};

/// The piece with its hull worked out.
Branch make_branch(VacdPiece piece);
/// The islands on both sides of the plane, named `id`, that makes their hulls smallest, or, where
/// none makes them much smaller, those of the next cuts. Empty if the piece cannot be cut.
std::vector<Branch> cut_branch(const Branch& branch, PlaneId id);

}  // namespace sunder::fracture
