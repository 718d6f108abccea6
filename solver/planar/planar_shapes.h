// Three dimensions become two: shapes of the seam as Box2D's.
//
// Box2D keeps shapes apart by a skin of two slops each, and lets contacts close to one slop within
// both skins. All shapes get a skin of half a slop here, so that resting faces meet exactly and
// corners stay sharp; Box2D's continuous collision needs thicker skins, and is not used.
#pragma once

#include <memory>
#include <vector>

#include <box2d/box2d.h>

#include "engine/model/physics.h"

namespace sunder::solver {

inline constexpr float kSkin = 0.5f * b2_linearSlop;  ///< Of every shape, in units.

/// Between metres in three dimensions and units in the plane.
struct Plane2 {
  double units_per_m = 1;

  b2Vec2 units(const Vec3& metres) const {
    return {static_cast<float>(units_per_m * metres.x()),
            static_cast<float>(units_per_m * metres.y())};
  }
  Vec3 metres(const b2Vec2& units, double z = 0) const {
    return {static_cast<double>(units.x) / units_per_m, static_cast<double>(units.y) / units_per_m,
            z};
  }
};

/// The shapes in the plane that one shape of a body becomes: a polygon of more than eight corners
/// is several. Throws InputError if it cannot be planar. B is placed in W as `X_WB`; the result is
/// in B turned by `X_WB`'s rotation.
std::vector<std::unique_ptr<b2Shape>> planar_shapes(const ShapeDesc& shape, const Vec3& com_R,
                                                    const Pose& X_WB, const Plane2& plane);

/// The least width of a shape in units; infinite for the edge of a half-space.
float width_of(const b2Shape& shape);

}  // namespace sunder::solver
