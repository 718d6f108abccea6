// How far runs at one point of a study are from the reference, in parts of what nobody can tell
// apart.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/trade/facts.h"

namespace sunder::bench {

/// One quantity: how far it is from the reference's, over seeds.
struct TradeError {
  std::string name;     ///< Of the facts' samples.
  double distance = 0;  ///< In the unit of the quantity.
  double noise = 0;     ///< What as many seeds of the reference scatter by, or, of a scene without
                        ///< chaos, the floor below which a difference means nothing.
  double over_noise = 0;  ///< distance / noise: 1 is not to be told from another seed.
};

/// ∫ |F − G|: how far samples have to be moved, on average, to become the other (1-Wasserstein).
/// Neither is empty; of what is not finite, infinite.
double distance_between(std::vector<double> a, std::vector<double> b);

/// The difference that nobody would notice: 1 % of what there is, or, by the unit that ends the
/// name, what is too small to see: 1 mm, which is a tenth of a pixel where a picture shows ten
/// metres, or 1 cm for the deepest of all overlaps, which is there for one frame; 1 cm/s; a
/// hundredth of a share, of a radian a second, of a joule a kilogram (all of it 1 mm higher); one
/// piece.
double noise_floor(std::string_view name, std::span<const double> reference);

/// Of every quantity that both have samples of: the distance between all samples of the point and
/// all of the reference. Each span holds the facts of one run a seed, the reference's at least one.
/// Its noise is what nine in ten pairs of sets of as many seeds of the reference differ by less
/// than, judged by its halves and scaled by the root of the seeds.
std::vector<TradeError> trade_errors(std::span<const Facts> point,
                                     std::span<const Facts> reference);
/// The largest over its noise; 0 of nothing.
double worst(std::span<const TradeError> errors);

}  // namespace sunder::bench
