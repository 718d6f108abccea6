#include "engine/io/scene_export/motion_keys.h"

#include <cmath>

#include "engine/base/check.h"
#include "engine/base/trigonometry.h"

namespace sunder {
namespace {

/// Fraction of the tolerance that interpolation may take; the rest is for the rounding of a reader
/// that computes in single precision.
constexpr double kUsedTolerance = 0.97;
constexpr double kQuaternionSteps = 32767;
/// Distance of two quaternions below which both interpolations differ by less than 4e-6 rad, which
/// is less than the fraction of any tolerance that is left for rounding.
constexpr double kAlikeChord = 0.05;

}  // namespace

PositionKeys::PositionKeys(double tolerance_m) {
  SUNDER_CHECK(tolerance_m > 0);
  const double used = kUsedTolerance * tolerance_m;
  squared_tolerance_ = used * used;
}

RotationKeys::RotationKeys(double tolerance_rad) {
  SUNDER_CHECK(tolerance_rad >= kLeastTolerance_rad);
  // Quaternions of rotations that differ by an angle differ by a quarter of it on either side.
  const double chord = 2 * sin_cos(0.25 * kUsedTolerance * tolerance_rad).sin;
  squared_chord_ = chord * chord;
}

RotationKeys::Key RotationKeys::store(const Value& value, const Key* before) {
  Eigen::Vector4d q = value.coeffs();
  if (before && q.dot(read(*before)) < 0) q = -q;
  Key key;
  for (int i = 0; i < 4; ++i) {
    const double scaled = std::clamp(q[i], -1.0, 1.0) * kQuaternionSteps;
    key[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(std::rint(scaled));
  }
  return key;
}

RotationKeys::Read RotationKeys::read(const Key& key) {
  return Eigen::Vector4d(key[0], key[1], key[2], key[3]).normalized();
}

RotationKeys::Segment::Segment(const RotationKeys& keys, const Read& from, const Read& to)
    : keys_(keys), from_(from), to_(to) {
  if ((to - from).squaredNorm() < kAlikeChord * kAlikeChord) return;
  angle_ = 2 * arc_tangent((to - from).norm(), (to + from).norm());
  sine_ = sin_cos(angle_).sin;
}

bool RotationKeys::Segment::is_close(double share, const Value& value) const {
  const Read linear = ((1 - share) * from_ + share * to_).normalized();
  if (!is_close(linear, value)) return false;
  if (sine_ == 0) return true;
  const Read spherical = (sin_cos((1 - share) * angle_).sin * from_ +  //
                          sin_cos(share * angle_).sin * to_) /
                         sine_;
  return is_close(spherical, value);
}

bool RotationKeys::Segment::is_close(const Read& at, const Value& value) const {
  const double distance = std::min((at - value.coeffs()).squaredNorm(),  //
                                   (at + value.coeffs()).squaredNorm());
  return distance <= keys_.squared_chord_;
}

}  // namespace sunder
