// Where two bodies touch at many points, which of them bears how much follows from how they give,
// and a solve of rigid bodies leaves it open. Internal to engine/world.
#pragma once

#include <cstdint>
#include <span>

#include "engine/base/types.h"

namespace sunder {

/// A point where one body presses on another.
struct PressedPoint {
  std::uint32_t shape = 0;    ///< Opaque.
  Vec3 arm_W = Vec3::Zero();  ///< From the centre of mass of what is pressed.
  Vec3 along_W = Vec3::UnitY();
  double impulse_Ns = 0;
};

/// Spreads what a body does at all the points where it touches as evenly as sum and moment let it:
/// the least squares of all. The impulses stay as they are if some would have to pull.
void spread_evenly(std::span<PressedPoint> points);

}  // namespace sunder
