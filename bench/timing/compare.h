// Timings beside older ones: which stages are slower.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/timing/ratio.h"
#include "bench/timing/verdict.h"
#include "engine/io/figures.h"

namespace sunder::bench {

/// Milliseconds a frame that noise alone may add to a stage: a stage is slower than before by a
/// threshold if it is slower by that than it was, or than this, where it took less.
inline constexpr double kNoise_ms = 0.2;

/// "10%", or "10": 0.1. Throws InputError for anything else.
double parse_percent(const std::string& flag, const std::string& text);

/// A stage, or "frame" for all of them, then and now.
struct Change {
  std::string scene, stage;
  std::string figure;  ///< "mean" or "p50" of frames.
  bool is_cpu = true;  ///< Processor time; else wall time, as one of the two files has no other.
  double before_ms = 0, after_ms = 0;
  RatioInterval ratio = {};  ///< Of now to before, by the means of the repeats.

  /// By more than this part, at the low end of the interval, too.
  bool is_slower(double part) const;
  /// "-1.2 to +2.1 % (97 % confidence)"; "one run each" if that is all there are.
  std::string interval() const;
};

struct Comparison {
  std::vector<Change> changes;
  std::vector<Verdict> verdicts;  ///< By scene, that it is the same run, and by stage.
};

/// Every scene of `now` beside the one of its name in `old`, from the file of that name. A scene
/// that is not there, is another run or comes to another state fails; so does a stage that is
/// slower by more than `fail_slower`, if that is given. Times are compared of other states, too,
/// and fail nothing. `paired`: each repeat was timed at the same time as that of its number.
Comparison compare(std::span<const Figures> now, std::span<const Figures> old,
                   const std::string& old_file, std::optional<double> fail_slower, bool paired);

/// For the terminal; empty if there are none.
std::string changes_table(std::span<const Change> changes);

}  // namespace sunder::bench
