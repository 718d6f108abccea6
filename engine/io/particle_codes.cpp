#include "engine/io/particle_codes.h"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

// Steps per unit; positions and radii per metre.
constexpr float kDebrisPositionSteps = 128;  // resolution 8 mm
constexpr float kDustPositionSteps = 32;     // resolution 31 mm
constexpr float kDebrisRadiusSteps = 4096;   // resolution 0.2 mm
constexpr float kDustRadiusSteps = 64;       // resolution 16 mm
constexpr float kRotationSteps = 15;
constexpr float kOpacitySteps = 63;

/// Returns the nearest integer number of steps, clamped to ±2^22, up to which floats are exact both
/// ways; 0 if `value` is not finite.
std::int32_t code(float value, float steps) {
  const float scaled = value * steps;
  if (!std::isfinite(scaled)) return 0;
  return static_cast<std::int32_t>(std::rint(std::clamp(scaled, -4194304.0f, 4194304.0f)));
}

float value(std::int32_t code, float steps) { return static_cast<float>(code) / steps; }

void encode_pose(ParticleCode& codes, const Vec3f& position, float steps, const Quatf& rotation) {
  for (std::size_t i = 0; i < 3; ++i) {
    codes[i] = code(position[static_cast<Eigen::Index>(i)], steps);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    codes[3 + i] = code(rotation.coeffs()[static_cast<Eigen::Index>(i)], kRotationSteps);
  }
}

Vec3f position_of(const ParticleCode& codes, float steps) {
  return Vec3f(value(codes[0], steps), value(codes[1], steps), value(codes[2], steps));
}

Quatf rotation_of(const ParticleCode& codes) {
  return Quatf(value(codes[6], kRotationSteps), value(codes[3], kRotationSteps),
               value(codes[4], kRotationSteps), value(codes[5], kRotationSteps));
}

}  // namespace

ParticleCode encode(const FrameDebris& chip) {
  ParticleCode codes{};
  encode_pose(codes, chip.position_W, kDebrisPositionSteps, chip.rotation_WD);
  codes[7] = code(chip.radius_m, kDebrisRadiusSteps);
  codes[8] = static_cast<std::int32_t>(chip.material.value);
  codes[9] = chip.variant;
  return codes;
}

ParticleCode encode(const FrameDust& puff) {
  ParticleCode codes{};
  encode_pose(codes, puff.position_W, kDustPositionSteps, puff.rotation_WD);
  codes[7] = code(puff.radius_m, kDustRadiusSteps);
  codes[8] = static_cast<std::int32_t>(puff.material.value);
  codes[9] = code(puff.opacity, kOpacitySteps);
  return codes;
}

FrameDebris decode_debris(const ParticleCode& codes) {
  return {position_of(codes, kDebrisPositionSteps), rotation_of(codes),
          value(codes[7], kDebrisRadiusSteps), MaterialIndex(static_cast<std::uint32_t>(codes[8])),
          static_cast<std::uint8_t>(codes[9])};
}

FrameDust decode_dust(const ParticleCode& codes) {
  return {position_of(codes, kDustPositionSteps), rotation_of(codes),
          value(codes[7], kDustRadiusSteps), value(codes[9], kOpacitySteps),
          MaterialIndex(static_cast<std::uint32_t>(codes[8]))};
}

}  // namespace sunder
