// Implements Physics (engine/model/physics.h) for planar scenes: Box2D 2.4 in the plane z = 0.
//
// Read first: planar_physics.cpp, then planar_shapes.h for the mapping of three dimensions to two.
// Rationale: docs/decisions/018-planar-scenes.md.
#pragma once

#include <memory>

#include "engine/model/physics.h"

namespace sunder::solver {

struct PlanarOptions {
  Vec3 gravity_W = Vec3(0, -9.81, 0);  ///< In m/s²; its z must be 0.
  /// Size of a typical piece, in m, which is Box2D's unit of length. Box2D's tolerances are fixed
  /// in units: 0.005 for contacts, 0.01 units/s for sleeping.
  double piece_m = 1;
  bool sleeping = true;
};

/// Makes a planar physics. Bodies keep their z and turn about z alone. Shapes must be prisms along
/// z through z = 0, spheres centred on that plane, or half-spaces bounded along z; for others
/// replace() and edit() throw InputError and change nothing. Impulses along z and torques about
/// other axes are ignored. Single-threaded; results are bit-identical between runs on one machine,
/// but not between machines, because Box2D uses the sine of the C library.
std::unique_ptr<Physics> make_planar_physics(const PlanarOptions& options);

}  // namespace sunder::solver
