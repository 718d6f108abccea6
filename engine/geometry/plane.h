// Planes with integer names: whether two faces lie in one plane is a comparison of integers.
#pragma once

#include <compare>
#include <cstdint>

#include "engine/base/types.h"

namespace sunder {

/// The half-space n·x + d <= 0; the normal has unit length and points out of it.
struct Plane {
  Vec3 normal = Vec3::UnitY();
  double d = 0;

  /// Signed, in metres: positive outside.
  double distance(const Vec3& point) const { return normal.dot(point) + d; }
  /// The other half-space.
  Plane flipped() const { return {-normal, -d}; }
  static Plane through(const Vec3& point, const Vec3& unit_normal) {
    return {unit_normal, -unit_normal.dot(point)};
  }
};

/// Names one side of a plane within a compound's lineage: faces a and b lie in one plane with
/// opposite normals iff a == b.opposite(). Zero is "not named yet".
struct PlaneId {
  std::uint64_t value = 0;

  constexpr PlaneId opposite() const { return {value ^ 1}; }
  constexpr bool none() const { return value == 0; }
  constexpr auto operator<=>(const PlaneId&) const = default;
};

/// Where a solid lies relative to a plane.
enum class PlaneSide { kInside, kOutside, kCut };

}  // namespace sunder
