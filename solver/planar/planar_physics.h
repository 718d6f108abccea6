// Scenes without a third dimension behind the Physics seam: Box2D 2.4 in the plane z = 0.
//
// Read first: planar_physics.cpp; planar_shapes.h says what becomes of three dimensions, and
// docs/decisions/018-planar-scenes.md why.
#pragma once

#include <memory>

#include "engine/model/physics.h"

namespace sunder::solver {

struct PlanarOptions {
  Vec3 gravity_W = Vec3(0, -9.81, 0);  ///< In the plane.
  /// The size of a usual piece: Box2D's unit of length. Its tolerances are shares of that: 0.005
  /// for what touches, 0.01 units a second for what rests.
  double piece_m = 1;
  bool sleeping = true;
};

/// Bodies keep their z and turn about z alone. Shapes are prisms along z through z = 0, spheres
/// about a point of that plane, and half-spaces bounded along z; replace() and edit() throw
/// InputError, and change nothing, if something else is given. What pushes a body along z, or turns
/// it about another axis, is ignored. One thread; the same bits in every run on a machine, but the
/// sine is that of the C library, which may differ on another.
std::unique_ptr<Physics> make_planar_physics(const PlanarOptions& options);

}  // namespace sunder::solver
