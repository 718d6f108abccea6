// Errors of a point of a study: how its runs differ from those of the limit. Begin at
// RunDistances::compare().
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/trade/facts.h"
#include "scenes/trade/two_samples.h"

namespace sunder::scenes {

/// Probability of finding a difference between two groups of runs of equal settings.
inline constexpr double kFalsePositives = 0.05;

struct Interval {
  double low = 0, high = 0;
};

/// Difference of one measured quantity from the limit.
struct FigureError {
  std::string name;       ///< Name in Facts::samples.
  double difference = 0;  ///< As difference() in two_samples.h, in the unit of the quantity.
  double spread = 0;      ///< Mean distance of two runs of the limit, at least noise_floor().
  double error = 0;       ///< difference / spread.
  double p = 1;           ///< Probability if nothing differs, corrected for the number of figures.

  bool differs() const { return p <= kFalsePositives; }
};

/// Difference of a point from the limit.
struct PointError {
  /// Mean of the errors of the figures. Its own mean is 0 for a point that equals the limit.
  double error = 0;
  Interval interval;  ///< 90 % confidence interval of the error.
  /// Probability of such differences, of any figure or of all together, if nothing differs.
  double p = 1;
  std::vector<FigureError> figures;

  bool differs() const { return p <= kFalsePositives; }
  /// Returns the figure of the largest error; null if there is none.
  const FigureError* largest() const;
};

/// Returns ∫ |F − G| of the distribution functions of sorted samples, that is, the mean distance by
/// which samples must be moved to become the others (1-Wasserstein). Neither list is empty; all
/// samples are finite.
double distance_between(std::span<const double> a, std::span<const double> b);

/// Returns the least difference that counts: the larger of 1 % of the mean magnitude and a value by
/// the unit that ends the name: 1 mm (a tenth of a pixel in a picture of ten metres), but 1 cm for
/// the deepest penetration (of one frame); 0.01 m/s, rad/s, share or J/kg (a rise of 1 mm); one
/// piece.
double noise_floor(std::string_view name, double mean_magnitude);

/// The runs of one scene, and the distances between them. A run has one distribution of each
/// quantity, over its bodies; the distance of two runs is that of these distributions.
class RunDistances {
 public:
  using Group = std::span<const std::size_t>;

  explicit RunDistances(std::span<const Facts> runs);

  /// Compares a group of at least two runs with another, that of the limit, and leaves out the
  /// confidence interval. A quantity counts if all of these runs have samples of it; p is 1 for one
  /// in which all of these runs are equal but for the noise floor.
  PointError compare(Group point, Group limit) const;
  /// Returns the confidence interval of the error, by runs drawn with replacement.
  Interval interval(Group point, Group limit) const;

 private:
  struct Figure {
    std::string name;
    DistanceMatrix distances;
    std::vector<double> magnitudes;  ///< Mean magnitude of the samples by run; negative: none.
  };
  /// Returns the spread in a group, at least the noise floor.
  static double scale(const Figure& figure, Group group);
  /// Returns the figures that all of these runs have.
  std::vector<const Figure*> shared_figures(Group point, Group limit) const;

  std::vector<Figure> figures_;
};

/// Compares the runs of a point with those of the limit. Both have at least two.
PointError point_error(std::span<const Facts> point, std::span<const Facts> limit);

}  // namespace sunder::scenes
