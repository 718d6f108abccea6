// Which convexes touch (property (c) of paper 3.1): faces of one plane with opposite normals that
// overlap.
//
// The paper sorts faces by |d|. Planes have names here, so faces are sorted by name, and within a
// plane found by a sweep: a grid of bricks, where all |d| are alike, costs no more than any other
// solid.
//
// What touches is what can be seen: the face of an internal convex, but of a surface convex the cap
// of its visual mesh in that plane, of which the face is only the fitted outline. Two fitted faces
// may well overlap where the meshes in them do not; then there is no bond.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// A face that may touch another.
struct FaceEntry {
  static constexpr std::uint32_t kNoCap = 0xffffffff;

  PlaneId id;
  std::uint32_t convex = 0;
  std::uint32_t face = 0;
  bool known = false;  ///< Its contacts with other known faces are known already: leave them out.
  /// Of a surface convex: the face of its visual mesh that lies there.
  std::uint32_t cap = kNoCap;
};

/// Convexes that overlap by no more do not touch: so small an area is rounding.
double least_overlap(const Convex& a, const Convex& b);

/// Puts bonds in the order of Compound::bonds.
void sort_bonds(std::vector<Bond>& bonds);
/// Adds all faces by which convex number `index` may touch others.
void add_faces(const Convex& convex, std::uint32_t index, std::vector<FaceEntry>& entries);
/// A face that touches something already.
FaceEntry known_face(const Convex& convex, std::uint32_t index, std::uint32_t face);
/// All contacts among `faces` of `convexes`, sorted as Compound::bonds is.
std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes,
                                std::span<const FaceEntry> faces);
/// All contacts among `convexes`.
std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes);

}  // namespace sunder::fracture
