#include "engine/world/act/charge.h"

#include <algorithm>
#include <numbers>
#include <span>

#include "engine/base/exponential.h"
#include "engine/base/roots.h"

namespace sunder {
namespace {

constexpr double kMinScaledDistance = 0.0674, kMaxScaledDistance = 40;  // m/kg^(1/3)
// Mass of a charge in free air with the same wave as a unit mass on the ground. Both sets of fits
// by Kingery and Bulmash agree with it within 1.2 % from 0.1 to 32 m/kg^(1/3).
constexpr double kGroundReflection = 1.8;

/// Returns an impulse in Pa·s/kg^(1/3), whose log10 is a polynomial of U = shift + slope·log10(Z),
/// the form of all fits by Kingery and Bulmash.
double fit(double log_z, double shift, double slope, std::span<const double> coefficients) {
  const double u = shift + slope * log_z;
  double sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * u + coefficients[i];
  return exponential(std::numbers::ln10 * sum);
}

// Hemispherical surface burst, metric.
constexpr double kReflected[] = {2.70588058103, -0.949516092853, 0.112136118689, -0.0250659183287};
constexpr double kIncidentNear[] = {2.52455620925, -0.502992763686, 0.171335645235, 0.0450176963051,
                                    -0.0118964626402};
constexpr double kIncidentFar[] = {1.67281645863,     -0.384519026965, -0.0260816706301,
                                   0.00595798753822,  0.014544526107,  -0.00663289334734,
                                   -0.00284189327204, 0.0013644816227};
constexpr double kIncidentFitSplit = 0.955;  // m/kg^(1/3)

/// Returns the mass of the charge on the ground with the same wave.
double ground_kg(double tnt_kg, BurstKind burst) {
  return burst == BurstKind::kGround ? tnt_kg : tnt_kg / kGroundReflection;
}

}  // namespace

WaveImpulse wave_impulse(double tnt_kg, BurstKind burst, double distance_m) {
  const double scale = cube_root(ground_kg(tnt_kg, burst));
  const double z = std::max(kMinScaledDistance, distance_m / scale);
  if (z > kMaxScaledDistance) return {};
  const double log_z = natural_logarithm(z) / std::numbers::ln10;
  const double incident = z < kIncidentFitSplit
                              ? fit(log_z, 2.06761908721, 3.0760329666, kIncidentNear)
                              : fit(log_z, -1.94708846747, 2.40697745406, kIncidentFar);
  return {scale * fit(log_z, -0.246208804814, 1.33422049854, kReflected), scale * incident};
}

double wave_reach_m(double tnt_kg, BurstKind burst) {
  return kMaxScaledDistance * cube_root(ground_kg(tnt_kg, burst));
}

double reach_m(const Blast& blast) {
  return blast.tnt_kg ? wave_reach_m(*blast.tnt_kg, blast.burst) : blast.radius_m;
}

}  // namespace sunder
