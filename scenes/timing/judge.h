// Judges the figures of two programs that were timed in pairs: which of them are slower. Begin at
// judge().
//
// All figures of all scenes of a command are judged together: the error of each is kJudgeError
// divided by their number (Bonferroni), so that a command on identical programs says "slower" of
// any figure with a probability of at most kJudgeError, and "faster" likewise.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/timing/pairs.h"
#include "scenes/timing/sign_test.h"
#include "scenes/timing/verdict.h"

namespace sunder::scenes {

/// Probability that a command on identical programs calls any figure slower.
inline constexpr double kJudgeError = 0.05;

/// Milliseconds per frame that noise may add to a stage: times below this value count as this value
/// when they are compared.
inline constexpr double kNoise_ms = 0.2;

/// Number of repeats for a judgement, unless the user gives one: one of them may disagree.
inline constexpr int kJudgedRepeats = 15;

/// Fraction by which each kind of figure may be slower, by its name in --fail-slower.
using Bounds = std::map<std::string, double>;

/// Parses --fail-slower, "5%" or "5%,max=50%,memory=2%". The first percentage P is the bound of
/// every figure; but p99 may be slower by 2 P and max by 4 P, as extremes vary more. Names set
/// others: mean, p50, p95, p99, max, memory, draw. Throws InputError for other texts.
Bounds parse_bounds(const std::string& flag, const std::string& text);

enum class Judgement { kTooFew, kSame, kSlower, kFaster };

/// Returns "too few repeats", "no difference", "slower" or "faster".
const char* name_of(Judgement judgement);

struct Judged {
  std::string scene;
  PairedFigure pair;
  double before = 0, now = 0;             ///< Medians over the repeats.
  std::optional<RatioInterval> interval;  ///< Of the ratio of now to before; none for stalls.
  double bound = 0;                       ///< Fraction by which it may be slower.
  Judgement judgement = Judgement::kTooFew;
  bool fails = false;  ///< Slower by more than the bound.

  /// Returns "-1.2 to +2.1 %", or for stalls "3 repeats have more, 0 fewer".
  std::string interval_text() const;
};

struct Judgements {
  std::vector<Judged> figures;
  std::vector<Verdict> verdicts;  ///< One per figure; one more if there are too few repeats.
  std::size_t repeats = 0;        ///< Fewest of any figure.
  std::size_t least_repeats = 0;  ///< Least number of repeats that can show a difference.

  bool has_too_few() const { return repeats < least_repeats; }
};

/// Returns the number of repeats that a judgement of this many figures takes at least.
std::size_t least_repeats(std::size_t figures);

/// A scene and its figures.
struct ScenePairs {
  std::string scene;
  std::vector<PairedFigure> figures;
};

/// Judges all figures of all scenes; one fails if it is slower by more than its bound. Without
/// bounds none fails.
Judgements judge(std::span<const ScenePairs> scenes, const std::optional<Bounds>& bounds);
/// Judges the figures that put_pairs() has written to the scenes.
Judgements judge(std::span<const Figures> scenes, const std::optional<Bounds>& bounds);

/// Writes the judgements to `against` of their scenes.
void put_judgements(const Judgements& judgements, std::span<Figures> scenes);

/// Returns the figures as a table, and below it what the judgement can tell; empty if there are
/// none.
std::string judgements_table(const Judgements& judgements);

}  // namespace sunder::scenes
