// Vectors, rotations and poses: Eigen under the short names every room uses. Strong indices, so
// that an index into one array cannot be used in another, and ids that notice when what they named
// is gone. And what a mesh's file paints a face with, which every room hands on.
//
// double for geometry and body positions, float (suffix f) for solver inner loops and drawing.
// Poses follow monogram notation: X_WB is the pose of B in W, and X_WB * point_B == point_W.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sunder {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Vec3f = Eigen::Vector3f;
using Mat3f = Eigen::Matrix3f;
using Quatf = Eigen::Quaternionf;

/// A rigid placement: rotation, then translation.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();

  Vec3 operator*(const Vec3& point) const { return rotation * point + position; }
  Pose operator*(const Pose& inner) const {
    return {*this * inner.position, rotation * inner.rotation};
  }
  Pose inverse() const {
    const Quat back = rotation.conjugate();
    return {back * -position, back};
  }
  bool operator==(const Pose& other) const {
    return position == other.position && rotation.coeffs() == other.rotation.coeffs();
  }
};

/// An axis-aligned box; empty (min > max) until extended.
struct Box {
  Vec3 min = Vec3::Constant(1e300);
  Vec3 max = Vec3::Constant(-1e300);

  void extend(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void extend(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  bool empty() const { return (min.array() > max.array()).any(); }
  Vec3 center() const { return 0.5 * (min + max); }
  Vec3 extent() const { return max - min; }
  bool overlaps(const Box& other) const {
    return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
  }
};

/// An index into one kind of array; `Tag` tells which. Default-constructed: `none()`.
template <class Tag>
struct Index {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t value = kNone;

  constexpr Index() = default;
  constexpr explicit Index(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
  constexpr bool none() const { return value == kNone; }
  constexpr auto operator<=>(const Index&) const = default;
};

/// A slot and the generation it had when the id was handed out: stale ids compare unequal.
template <class Tag>
struct Id {
  std::uint32_t slot = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation = 0;

  constexpr bool none() const { return slot == std::numeric_limits<std::uint32_t>::max(); }
  constexpr auto operator<=>(const Id&) const = default;
};

/// PNG or JPEG, as it was in its file, repeated beyond its edges; null: none.
using Picture = std::shared_ptr<const std::vector<std::byte>>;

/// How smooth a surface is, and how much of a metal.
struct Gloss {
  float roughness = 1;        ///< From 0, which mirrors, to 1.
  float metallic = 0;         ///< From 0 to 1, which has colour only in what it mirrors.
  Picture picture = nullptr;  ///< Its green is multiplied into the one, its blue into the other.
};

/// A colour, a picture that it is multiplied by, and what is too small for the mesh.
struct Paint {
  Vec3f color = Vec3f::Ones();  ///< Linear RGB.
  Picture picture;
  /// Whether texture coordinates count from a picture's lowest row up, as in OBJ, or from its
  /// highest down, as in glTF.
  bool from_below = false;
  /// Normals as colours: red to the right of the picture, green up in it, blue off the face; or, if
  /// it is all grey, heights.
  Picture relief = nullptr;
  float relief_scale = 1;                     ///< How much steeper it is than the picture says.
  std::optional<Gloss> gloss = std::nullopt;  ///< None: light shows its colour alone.
};

}  // namespace sunder
