// Contacts of convexes (property (c) of paper 3.1): faces in one plane, opposite normals, overlap.
//
// The paper sorts faces by |d|. Planes have ids here, so faces are sorted by plane id and compared
// within a plane by a sweep: a grid of bricks, with many equal |d|, costs no more than any other
// solid.
//
// An internal convex touches with the faces of its polyhedron; a surface convex with the caps of
// its visual mesh, of which the face is only the fitted outline. Two fitted faces may overlap
// although their caps do not; then there is no bond.
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
  bool known = false;  ///< Contacts with other known faces are omitted: the caller has them.
  /// Face of the visual mesh in the plane of `face`; kNoCap for an internal convex.
  std::uint32_t cap = kNoCap;
};

/// Sorts bonds in the order of Compound::bonds.
void sort_bonds(std::vector<Bond>& bonds);
/// Appends all faces with which the convex at `index` may touch others.
void add_faces(const Convex& convex, std::uint32_t index, std::vector<FaceEntry>& entries);
/// Returns the entry of a face that is in contact already.
FaceEntry face_in_contact(const Convex& convex, std::uint32_t index, std::uint32_t face);
/// Returns all contacts among `faces` of `convexes`, sorted as Compound::bonds.
std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes,
                                std::span<const FaceEntry> faces);
/// Returns all contacts among `convexes`, sorted as Compound::bonds.
std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes);

}  // namespace sunder::fracture
