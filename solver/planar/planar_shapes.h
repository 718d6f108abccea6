// Conversion of shapes in three dimensions to Box2D shapes.
//
// Box2D gives each shape a skin (radius) of two slops and lets contacts settle at one slop within
// both skins. All shapes get a skin of half a slop here, so that resting faces meet exactly and
// corners stay sharp. Box2D's continuous collision needs thicker skins and is not used.
#pragma once

#include <memory>
#include <vector>

#include <box2d/box2d.h>

#include "engine/model/physics.h"

namespace sunder::solver {

inline constexpr float kSkin = 0.5f * b2_linearSlop;  ///< Skin of every shape, in units.

/// Conversion between metres in three dimensions and Box2D units in the plane.
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

/// Converts one shape of a body at pose `X_WB` to Box2D shapes: a polygon of more than eight
/// corners becomes several. The result is in B, rotated by the rotation of `X_WB`. Throws
/// InputError if the shape is not planar.
std::vector<std::unique_ptr<b2Shape>> planar_shapes(const ShapeDesc& shape, const Vec3& com_R,
                                                    const Pose& X_WB, const Plane2& plane);

/// Returns the least width of a shape in units; b2_maxFloat for the edge of a half-space.
float width_of(const b2Shape& shape);

}  // namespace sunder::solver
