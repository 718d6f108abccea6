// Compounds: convexes that move as one body, and the bonds between them (paper 3.1).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/model/material.h"

namespace sunder {

struct PolygonMesh;

/// One convex of a compound. Immutable and shared: a break keeps the convexes it does not cut, bit
/// for bit. A surface convex has a piece of visual mesh inside its polyhedron; an internal convex
/// is drawn as its polyhedron (paper 3.3).
struct Convex {
  ConvexPolyhedron polyhedron;  ///< Collision geometry, and the faces that touch neighbours.
  std::shared_ptr<const PolygonMesh> visual;  ///< Watertight; null for an internal convex.
  MaterialIndex material;
  /// Mass properties at unit density, of `visual` if set, else of `polyhedron`.
  MassProperties solid;
  Box box;  ///< Bounding box of `polyhedron`.
  /// Pose of the texture frame T in R: R as it was before the solid was bent.
  Pose X_RT;

  /// Returns true if the convex is drawn as its polyhedron.
  bool is_internal() const { return !visual; }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const { return polyhedron.empty() ? "polyhedron" : nullptr; }
};
using ConvexPtr = std::shared_ptr<const Convex>;

/// Makes a convex and computes its mass properties and box.
ConvexPtr make_convex(ConvexPolyhedron polyhedron, MaterialIndex material,
                      std::shared_ptr<const PolygonMesh> visual = nullptr, const Pose& X_RT = {});

/// Returns twice the volume over the surface area: the thickness of a plate or shell.
double mean_thickness_m(const Convex& convex);
/// Returns true for plates and shells, which bend: four times as long and wide as thick, about.
bool is_thin(const Convex& convex);

/// A pair of convexes of a compound with coplanar touching faces (property (c) of paper 3.1).
struct Bond {
  std::uint32_t a = 0, b = 0;            ///< Convexes, a < b: indices, or slots of a structure.
  std::uint32_t face_a = 0, face_b = 0;  ///< Indices of the touching faces.
  double area_m2 = 0;                    ///< Area of the overlap.
};

/// The overlap of several convexes of a compound (paper 4.3). A ghost connects its convexes. Volume
/// and mass count it with its sign, so that sums are those of the union (inclusion-exclusion). It
/// is neither drawn nor collided. A ghost of sign −1 is the paper's convex of negative volume; its
/// faces point outward as those of any convex.
struct Ghost {
  ConvexPtr convex;  ///< The intersection.
  /// Ascending; indices, or slots of a structure. Two or more when made; a break may leave one.
  std::vector<std::uint32_t> of;
  /// −1 for two convexes, +1 for three, −1 for four. 0: the ghost connects, but does not count in
  /// sums, because one of its convexes is a surface convex, whose visual mesh may not reach into
  /// the overlap.
  std::int8_t sign = -1;
};

/// Returns the bit in Compound::anchored of one side of a convex's box (axis 0 to 2, low or high).
/// The low side of y, from below, is bit 1.
constexpr std::uint8_t anchor_side(int axis, bool high) {
  return static_cast<std::uint8_t>(1u << (2 * ((axis + 2) % 3) + (high ? 1 : 0)));
}
/// Anchored by all six sides.
inline constexpr std::uint8_t kAnchoredAllSides = 0x3f;
/// Returns the anchored sides of `parent` that a part of it still reaches.
std::uint8_t inherited_anchors(std::uint8_t anchored, const Box& parent, const Box& part);

/// Convexes that move as one body, in the rest frame R of the solid they were cut from.
struct Compound {
  std::vector<ConvexPtr> convexes;
  /// For each convex, the sides of its box that are fixed to the world (anchor_side()); 0: none.
  /// Parts of a convex inherit the sides that they still reach.
  std::vector<std::uint8_t> anchored;
  std::vector<Bond> bonds;    ///< Sorted by (a, b, face_a, face_b).
  std::vector<Ghost> ghosts;  ///< Sorted by `of`; empty if nothing overlaps.

  /// True if any convex is anchored.
  bool is_anchored() const;
};

/// Input for one convex of a compound.
struct Part {
  ConvexPolyhedron polyhedron;
  MaterialIndex material;
  std::uint8_t anchored = 0;  ///< As in Compound::anchored; 1 (`true`) is anchored from below.
  std::shared_ptr<const PolygonMesh> visual = nullptr;  ///< As in Convex.
};

/// Mass, centre of mass and inertia about it, in the rest frame; overlaps count once.
struct CompoundMass {
  double mass_kg = 0;
  Vec3 com_R = Vec3::Zero();
  Mat3 inertia_R = Mat3::Zero();  ///< In kg m²; adjusted by bounded_inertia().
};
/// Returns the sum over convexes and ghosts; `materials` are by MaterialIndex.
CompoundMass mass_of(const Compound& compound, std::span<const Material> materials);
/// Returns the volume of the union of the convexes, in m³.
double volume(const Compound& compound);
/// Returns the bounding box of all convexes.
Box bounds(const Compound& compound);
/// Returns the largest signed distance from a point to a convex's face planes; 0 inside.
double distance_to(const Convex& convex, const Vec3& point_R);

/// Sorts ghosts as in Compound::ghosts; ghosts of the same convexes by position.
void sort_ghosts(std::vector<Ghost>& ghosts);

}  // namespace sunder
