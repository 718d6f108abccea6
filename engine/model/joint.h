// What holds things together: joints, and their kinds.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "engine/base/types.h"

namespace sunder {

enum class JointKind : std::uint8_t {
  kBall,      ///< The anchors stay in one place.
  kHinge,     ///< And the axes stay parallel.
  kFixed,     ///< And neither body turns against the other.
  kDistance,  ///< The anchors stay `length_m` apart.
  kRope,      ///< No farther than that.
  kPlastic,   ///< As kFixed, until the section between them flows; not for scenes.
};

/// What holds two things of the scene together, or one and the world, as they stand at the start.
struct Joint {
  JointKind kind = JointKind::kBall;
  /// Indices of solids, then of balls; none: the world.
  std::optional<std::uint32_t> a = std::nullopt, b = std::nullopt;
  Vec3 at_W = Vec3::Zero();  ///< On a; but for kDistance and kRope, on both.
  Vec3 to_W = Vec3::Zero();  ///< kDistance, kRope: on b.
  Vec3 axis_W = Vec3::UnitZ();
  double breaking_N = std::numeric_limits<double>::infinity();
  double breaking_Nm = std::numeric_limits<double>::infinity();
  bool collide = false;
};

}  // namespace sunder
