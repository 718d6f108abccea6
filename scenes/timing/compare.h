// Comparison of timings with older ones: which stages became slower. Begin at compare().
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/timing/ratio.h"
#include "scenes/timing/verdict.h"

namespace sunder::scenes {

/// Milliseconds per frame that noise may add to a stage: an older time below this value counts as
/// this value when slower stages are found.
inline constexpr double kNoise_ms = 0.2;

/// Returns the fraction for a percentage, 0.1 for "10%" or "10". Throws InputError for other texts.
double parse_percent(const std::string& flag, const std::string& text);

/// Times of a stage, or of the "frame" as a whole, in both timings.
struct Change {
  std::string scene, stage;
  std::string figure;  ///< "mean" or "p50" over frames.
  bool is_cpu = true;  ///< Processor time; wall time if a file lacks processor time.
  double before_ms = 0, after_ms = 0;
  RatioInterval ratio = {};  ///< Ratio of the new time to the old one, by the means of the repeats.

  /// Returns true if the change and the low end of the interval are slower by more than `part`.
  bool is_slower(double part) const;
  /// Returns "-1.2 to +2.1 % (97 % confidence)", or "one run each" if there is no interval.
  std::string interval() const;
};

struct Comparison {
  std::vector<Change> changes;
  std::vector<Verdict> verdicts;  ///< By scene: one for the run, then one per stage.
};

/// Compares every scene of `now` with the scene of the same name in `old`, which was read from the
/// file `old_file`. The comparison fails for a scene that is missing in `old`, was run differently
/// or has another state, and for a stage that is slower by more than `fail_slower`, if given. If
/// states differ, times are compared as well but cannot fail. `paired`: repeats of one number were
/// timed at the same time.
Comparison compare(std::span<const Figures> now, std::span<const Figures> old,
                   const std::string& old_file, std::optional<double> fail_slower, bool paired);

/// Returns the changes as a table for the terminal; empty if there are none.
std::string changes_table(std::span<const Change> changes);

}  // namespace sunder::scenes
