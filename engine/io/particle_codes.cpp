#include "engine/io/particle_codes.h"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

// Steps per unit; positions and radii per metre.
constexpr float kDebrisSteps_m = 128;  // resolution 8 mm
constexpr float kDustSteps_m = 32;     // resolution 31 mm
constexpr float kChipSteps_m = 4096;   // resolution 0.2 mm
constexpr float kPuffSteps_m = 64;     // resolution 16 mm
constexpr float kTurnSteps = 15;
constexpr float kOpacitySteps = 63;

/// Returns the nearest integer number of steps, clamped to ±2^22, up to which floats are exact both
/// ways; 0 if `value` is not finite.
std::int32_t code(float value, float steps) {
  const float scaled = value * steps;
  if (!std::isfinite(scaled)) return 0;
  return static_cast<std::int32_t>(std::rint(std::clamp(scaled, -4194304.0f, 4194304.0f)));
}

float value(std::int32_t code, float steps) { return static_cast<float>(code) / steps; }

void encode_place(ParticleCode& codes, const Vec3f& position, float steps_m,
                  const Quatf& rotation) {
  for (std::size_t i = 0; i < 3; ++i) {
    codes[i] = code(position[static_cast<Eigen::Index>(i)], steps_m);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    codes[3 + i] = code(rotation.coeffs()[static_cast<Eigen::Index>(i)], kTurnSteps);
  }
}

Vec3f position_of(const ParticleCode& codes, float steps_m) {
  return Vec3f(value(codes[0], steps_m), value(codes[1], steps_m), value(codes[2], steps_m));
}

Quatf rotation_of(const ParticleCode& codes) {
  return Quatf(value(codes[6], kTurnSteps), value(codes[3], kTurnSteps),
               value(codes[4], kTurnSteps), value(codes[5], kTurnSteps));
}

}  // namespace

ParticleCode encode(const FrameDebris& chip) {
  ParticleCode codes{};
  encode_place(codes, chip.position_W, kDebrisSteps_m, chip.rotation_WD);
  codes[7] = code(chip.radius_m, kChipSteps_m);
  codes[8] = static_cast<std::int32_t>(chip.material.value);
  codes[9] = chip.variant;
  return codes;
}

ParticleCode encode(const FrameDust& puff) {
  ParticleCode codes{};
  encode_place(codes, puff.position_W, kDustSteps_m, puff.rotation_WD);
  codes[7] = code(puff.radius_m, kPuffSteps_m);
  codes[8] = static_cast<std::int32_t>(puff.material.value);
  codes[9] = code(puff.opacity, kOpacitySteps);
  return codes;
}

FrameDebris decode_debris(const ParticleCode& codes) {
  return {position_of(codes, kDebrisSteps_m), rotation_of(codes), value(codes[7], kChipSteps_m),
          MaterialIndex(static_cast<std::uint32_t>(codes[8])), static_cast<std::uint8_t>(codes[9])};
}

FrameDust decode_dust(const ParticleCode& codes) {
  return {position_of(codes, kDustSteps_m), rotation_of(codes), value(codes[7], kPuffSteps_m),
          value(codes[9], kOpacitySteps), MaterialIndex(static_cast<std::uint32_t>(codes[8]))};
}

}  // namespace sunder
