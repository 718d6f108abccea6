// Basic types of all modules: vectors, rotations and poses (Eigen types under short names), boxes,
// typed indices and ids, and the appearance of a face as its mesh file defines it.
//
// Geometry and body positions use double; inner loops of solvers and rendering use float (suffix
// f). Poses follow monogram notation: X_WB is the pose of B in W, and X_WB * point_B == point_W.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

// Layouts of Eigen's types, and the bits of inline functions, depend on these settings.
#ifndef EIGEN_DONT_VECTORIZE
#error \
    "Sunder is compiled with EIGEN_DONT_VECTORIZE and -ffp-contract=off, and so must be what \
includes its headers: link the CMake target sunder::sunder, which has these options"
#endif
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

/// A rigid transform: rotation, then translation.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();

  Vec3 operator*(const Vec3& point) const { return rotation * point + position; }
  Pose operator*(const Pose& inner) const {
    return {*this * inner.position, rotation * inner.rotation};
  }
  /// Returns the transform back.
  Pose inverse() const {
    const Quat back = rotation.conjugate();
    return {back * -position, back};
  }
  bool operator==(const Pose& other) const {
    return position == other.position && rotation.coeffs() == other.rotation.coeffs();
  }
};

static_assert(sizeof(Pose) == 7 * sizeof(double) && alignof(Pose) == alignof(double),
              "Eigen was included before with other options than those of Sunder's library");

/// An axis-aligned bounding box; empty (min > max) until extended.
struct Box {
  Vec3 min = Vec3::Constant(1e300);
  Vec3 max = Vec3::Constant(-1e300);

  /// Makes the box large enough for a point.
  void extend(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  /// Makes the box large enough for another.
  void extend(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// Returns true if no point is in the box.
  bool empty() const { return (min.array() > max.array()).any(); }
  /// Returns the middle of a box that is not empty.
  Vec3 center() const { return 0.5 * (min + max); }
  /// Returns the lengths of the sides of a box that is not empty.
  Vec3 extent() const { return max - min; }
  /// Returns true if the boxes have a point in common.
  bool overlaps(const Box& other) const {
    return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
  }
};

/// An index into arrays of one kind, which `Tag` identifies, so that an index of another kind does
/// not compile. A default-constructed index is `none()`.
template <class Tag>
struct Index {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t value = kNone;

  constexpr Index() = default;
  /// Makes the index of element `v`.
  constexpr explicit Index(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
  /// Returns true for the index of no element.
  constexpr bool none() const { return value == kNone; }
  constexpr auto operator<=>(const Index&) const = default;
  /// Returns the fields, for saved states.
  static constexpr auto fields(auto& self) { return std::tie(self.value); }
};

/// The number of a slot and its generation when the id was issued. The id of a removed object is
/// not equal to the id of the object that reuses its slot.
template <class Tag>
struct Id {
  std::uint32_t slot = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation = 0;

  /// Returns true for the id of no object.
  constexpr bool none() const { return slot == std::numeric_limits<std::uint32_t>::max(); }
  constexpr auto operator<=>(const Id&) const = default;
};

/// An image as the PNG or JPEG bytes of its file, repeated beyond its edges; null if there is none.
using EncodedImage = std::shared_ptr<const std::vector<std::byte>>;

/// Metallic-roughness parameters of a surface, as in glTF.
struct MetallicRoughness {
  float roughness = 1;             ///< From 0 (mirror) to 1 (rough).
  float metallic = 0;              ///< From 0 (dielectric) to 1 (metal).
  EncodedImage picture = nullptr;  ///< Green scales roughness, blue scales metallic.
};

/// The appearance of a face as its mesh file defines it: base colour, textures and gloss.
struct Appearance {
  Vec3f color = Vec3f::Ones();  ///< Linear RGB.
  EncodedImage picture;         ///< Base colour texture, multiplied by `color`.
  /// True if v = 0 is the bottom row of an image (as in OBJ), false if the top row (glTF).
  bool v_from_bottom = false;
  /// Normal map (red: right in the image, green: up, blue: outward), or a bump map if it is grey.
  EncodedImage relief = nullptr;
  float normal_scale = 1;                                 ///< Factor on the slopes of `relief`.
  std::optional<MetallicRoughness> gloss = std::nullopt;  ///< None: diffuse colour only.
};

}  // namespace sunder
