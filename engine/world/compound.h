// Compounds: convexes that move as one, and which of them touch (paper 3.1).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/world/material.h"

namespace sunder {

/// One convex of a compound: immutable and shared, so that what a break does not touch stays the
/// same object, bit for bit.
struct Convex {
  ConvexPolyhedron polyhedron;
  MassProperties mass;  ///< Of `polyhedron`, unit density.
  Box box;              ///< Of `polyhedron`.
};
using ConvexPtr = std::shared_ptr<const Convex>;

/// A polyhedron with its mass and box worked out.
ConvexPtr make_convex(ConvexPolyhedron polyhedron);

/// Two convexes of a compound that share part of a plane (property (c) of paper 3.1).
struct Bond {
  std::uint32_t a = 0, b = 0;            ///< Convexes, a < b.
  std::uint32_t face_a = 0, face_b = 0;  ///< The faces that touch.
  double area_m2 = 0;                    ///< Of the overlap.
};

/// Convexes that move as one, in the rest frame R of the solid they were cut from.
struct Compound {
  std::vector<ConvexPtr> convexes;
  std::vector<std::uint8_t> anchored;  ///< Per convex: 1 where it is held by the world.
  std::vector<Bond> bonds;             ///< Sorted by (a, b, face_a, face_b).
  MaterialIndex material;

  bool is_anchored() const;
};

MassProperties mass_properties(const Compound& compound);
Box bounds(const Compound& compound);

}  // namespace sunder
