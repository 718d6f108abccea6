// A node of the tree of cuts: a piece, the volume of its hull, and the parts it was cut into.
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/vacd/best_cut.h"
#include "fracture/vacd/regions.h"

namespace sunder::fracture {

/// A piece as a node of the tree of cuts (tree.h).
struct Branch {
  VacdPiece piece;
  Outline outline;
  double solid_m3 = 0;
  double hull_m3 = 0;                   ///< At least solid_m3.
  std::vector<std::uint32_t> children;  ///< Indices of the parts in the tree.
  bool tried = false;                   ///< True once a cut has been tried.

  double slack() const { return hull_m3 - solid_m3; }
};

/// Returns the branch of a piece, with the volumes of piece and hull computed.
Branch make_branch(VacdPiece piece);
/// Returns the islands on both sides of the plane, with id `id`, that minimizes the volume of their
/// hulls or, if no plane reduces it much, the volume after one more cut of each. Returns none if
/// the piece cannot be cut.
std::vector<Branch> cut_branch(const Branch& branch, PlaneId id);

}  // namespace sunder::fracture
