// Compounds: convexes that move as one, and which of them touch (paper 3.1).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/model/material.h"

namespace sunder {

struct PolygonMesh;

/// One convex of a compound: immutable and shared, so that what a break does not touch stays the
/// same object, bit for bit. A surface convex owns a piece of visual mesh inside its polyhedron; an
/// internal convex is seen as the polyhedron that it is (paper 3.3).
struct Convex {
  ConvexPolyhedron polyhedron;                ///< What collides, and what neighbours touch.
  std::shared_ptr<const PolygonMesh> visual;  ///< Watertight; null: an internal convex.
  MaterialIndex material;
  MassProperties solid;  ///< Of `visual` if there is one, else of `polyhedron`; unit density.
  Box box;               ///< Of `polyhedron`.
  /// Where the rest frame is now that it was painted in: a solid that is bent has a new one.
  Pose X_RT;

  bool is_internal() const { return !visual; }
};
using ConvexPtr = std::shared_ptr<const Convex>;

/// A convex with its mass properties and box worked out.
ConvexPtr make_convex(ConvexPolyhedron polyhedron, MaterialIndex material,
                      std::shared_ptr<const PolygonMesh> visual = nullptr, const Pose& X_RT = {});

/// Twice the volume over the surface: of a plate or shell, how thick it is.
double mean_thickness_m(const Convex& convex);
/// Returns true if a convex is a plate or shell, which bends: it is more than about four times as
/// long and wide as thick.
bool is_thin(const Convex& convex);

/// Two convexes of a compound that share part of a plane (property (c) of paper 3.1).
struct Bond {
  std::uint32_t a = 0, b = 0;            ///< Convexes, a < b: indices, or slots of a structure.
  std::uint32_t face_a = 0, face_b = 0;  ///< The faces that touch.
  double area_m2 = 0;                    ///< Of the overlap.
};

/// Where convexes of a compound overlap (paper 4.3). It holds them together, and takes part in sums
/// of volume and mass with its sign, so that they are those of the union (inclusion-exclusion); it
/// is neither drawn nor collided. With sign −1 it is the paper's convex of negative volume; its
/// faces are stored as any convex's, outward.
struct Ghost {
  ConvexPtr convex;  ///< What they have in common.
  /// Convexes, ascending: indices, or slots of a structure. Two or more as made; breaks may leave
  /// one.
  std::vector<std::uint32_t> of;
  /// −1 for two convexes, +1 for three, −1 for four; 0 holds together and weighs nothing: one of
  /// its convexes is a surface convex, whose visual mesh need not reach into the overlap.
  std::int8_t sign = -1;
};

/// One side of a convex's box (axis 0 to 2, low or high) as a bit of Compound::anchored. Below, the
/// low side of y, is 1.
constexpr std::uint8_t anchor_side(int axis, bool high) {
  return static_cast<std::uint8_t>(1u << (2 * ((axis + 2) % 3) + (high ? 1 : 0)));
}
/// By every side.
inline constexpr std::uint8_t kAnchoredAllRound = 0x3f;
/// The sides of `parent` by which the world holds it that a part of it still reaches.
std::uint8_t inherited_anchors(std::uint8_t anchored, const Box& parent, const Box& part);

/// Convexes that move as one, in the rest frame R of the solid they were cut from.
struct Compound {
  std::vector<ConvexPtr> convexes;
  /// Per convex: the sides of its box by which the world holds it (anchor_side()), 0 where free. A
  /// part of it stays anchored by those of them that it still reaches.
  std::vector<std::uint8_t> anchored;
  std::vector<Bond> bonds;    ///< Sorted by (a, b, face_a, face_b).
  std::vector<Ghost> ghosts;  ///< Sorted by `of`; empty where nothing overlaps.

  /// Whether the world holds any of its convexes.
  bool is_anchored() const;
};

/// A convex on its way into a compound.
struct Part {
  ConvexPolyhedron polyhedron;
  MaterialIndex material;
  std::uint8_t anchored = 0;  ///< As in Compound: `true` is anchored from below.
  std::shared_ptr<const PolygonMesh> visual = nullptr;  ///< As in Convex.
};

/// Mass, centre of mass and inertia about it, in the rest frame; overlaps count once.
struct Weight {
  double mass_kg = 0;
  Vec3 com_R = Vec3::Zero();
  Mat3 inertia_R = Mat3::Zero();  ///< kg·m²; spinnable().
};
/// Sums over the convexes, less what ghosts say is counted twice; `materials` by MaterialIndex.
Weight weigh(const Compound& compound, std::span<const Material> materials);
/// Of the union of the convexes, in m³.
double volume(const Compound& compound);
/// The least box around its convexes.
Box bounds(const Compound& compound);
/// How far a point is beyond the farthest of a convex's faces; 0 inside.
double distance_outside(const Convex& convex, const Vec3& point_R);

/// Puts ghosts in the order of Compound::ghosts; those of the same convexes by where they are.
void sort_ghosts(std::vector<Ghost>& ghosts);

}  // namespace sunder
