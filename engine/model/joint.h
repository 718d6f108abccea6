// Joints of a scene, and their kinds.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "engine/base/types.h"

namespace sunder {

/// Relative motion that a joint permits.
enum class JointKind : std::uint8_t {
  kBall,      ///< The anchors coincide.
  kHinge,     ///< The anchors coincide and the axes stay parallel.
  kFixed,     ///< The bodies do not move relative to each other.
  kDistance,  ///< The anchors stay `length_m` apart.
  kRope,      ///< The anchors are at most `length_m` apart.
  kPlastic,   ///< As kFixed, until the section between the bodies yields; not for scenes.
};

/// A joint between two things of the scene, or to the world, in their poses at the start.
struct Joint {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  JointKind kind = JointKind::kBall;
  /// Indices of solids, then of balls; none: the world.
  std::optional<std::uint32_t> a = std::nullopt, b = std::nullopt;
  Vec3 at_W = Vec3::Zero();  ///< Anchor on a; on b as well, except for kDistance and kRope.
  Vec3 to_W = Vec3::Zero();  ///< kDistance, kRope: anchor on b.
  Vec3 axis_W = Vec3::UnitZ();
  /// The joint breaks when its force would exceed this.
  double breaking_N = std::numeric_limits<double>::infinity();
  /// The joint breaks when its torque would exceed this.
  double breaking_Nm = std::numeric_limits<double>::infinity();
  bool collide = false;  ///< True if the two bodies collide with each other.
};

}  // namespace sunder
