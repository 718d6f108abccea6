// Errors of a point of a study, relative to the noise of the reference. Begin at trade_errors().
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/trade/facts.h"

namespace sunder::scenes {

/// Distance of one measured quantity from the reference, over all seeds.
struct TradeError {
  std::string name;       ///< Name in Facts::samples.
  double distance = 0;    ///< In the unit of the quantity.
  double noise = 0;       ///< Difference of seeds of the reference, at least noise_floor().
  double over_noise = 0;  ///< distance / noise; up to 1 is within the scatter of seeds.
};

/// Returns ∫ |F − G| of the distribution functions, that is, the mean distance by which samples
/// must be moved to become the others (1-Wasserstein). Neither list is empty. The result is
/// infinite if a sample is not finite.
double distance_between(std::vector<double> a, std::vector<double> b);

/// Returns the least difference that counts: the larger of 1 % of the mean magnitude and a value by
/// the unit that ends the name: 1 mm (a tenth of a pixel in a picture of ten metres), but 1 cm for
/// the deepest penetration (of one frame); 0.01 m/s, rad/s, share or J/kg (a rise of 1 mm); one
/// piece.
double noise_floor(std::string_view name, std::span<const double> reference);

/// Returns an error for every quantity with samples in both lists: the distance between all samples
/// of the point and all of the reference. Each list has the facts of one run per seed; that of the
/// reference is not empty. Noise is the difference that nine in ten pairs of sets with as many
/// seeds of the reference do not exceed, estimated from random halves of the reference and scaled
/// by the square root of the number of seeds.
std::vector<TradeError> trade_errors(std::span<const Facts> point,
                                     std::span<const Facts> reference);
/// Returns the largest error over its noise; 0 for no errors.
double worst(std::span<const TradeError> errors);

}  // namespace sunder::scenes
