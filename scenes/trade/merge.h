// Costs and errors of a study's points, from the files of its runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/trade/errors.h"
#include "scenes/trade/study.h"

namespace sunder::scenes {

/// Result of a point on one scene.
struct PointTrade {
  StudyPoint point;
  int runs = 0;        ///< Number of runs that exist, with failed ones.
  double cost_ms = 0;  ///< Processor time per frame, median over seeds.
  double wall_ms = 0;  ///< Wall time per frame, median over seeds.
  /// Difference from the limit; nothing for the limit, or if it or the point has fewer than two
  /// runs.
  std::optional<PointError> compared;
  /// Error of `compared`; infinite if a run failed; nothing without either.
  std::optional<double> error;
  std::string failed;  ///< Reason of the first failure; empty if no run failed.
  bool on_front = false;
  std::optional<double> over_front;  ///< Cost divided by that of the front at equal error.

  /// Returns the error, at least kLeastError, by which points are plotted and the front is found.
  /// There must be an error.
  double counted_error() const;
};

/// Verdict on whether the limit depends on its step, by the error of the limit with steps of twice
/// the length.
enum class Convergence {
  kUnknown,    ///< There are no such runs.
  kConverged,  ///< The error is at most kConvergedError, at a confidence of 95 %.
  kNoLimit,    ///< The two differ, and the error may be larger.
  kUndecided,  ///< The error may be larger, or may be none: there are too few seeds.
};
/// Returns "unknown", "converged", "no limit" or "undecided".
const char* name_of(Convergence convergence);

/// Largest error of a limit against itself with twice the step, for which it counts as converged.
inline constexpr double kConvergedError = 0.25;
/// Smaller errors are no advantage: they are below the noise of eight seeds.
inline constexpr double kLeastError = 0.05;

struct SceneTrade {
  std::string scene;
  Convergence limit = Convergence::kUnknown;
  std::vector<PointTrade> points;  ///< Points with runs, in the order of the study.
};

struct Trade {
  std::vector<SceneTrade> scenes;
  std::vector<std::string> missing;  ///< Names of missing runs, with the reason if a file exists.
  std::size_t runs = 0;              ///< Number of runs of the study.
};

/// Existing runs of a point on one scene.
struct PointRuns {
  StudyPoint point;
  std::vector<Facts> facts;  ///< Facts of the runs that did not fail.
  std::vector<double> cpu_ms, wall_ms;
  std::string failed;  ///< Reason of the first failure; empty if no run failed.
};

struct SceneRuns {
  std::string scene;
  std::vector<PointRuns> points;
};

struct StudyRuns {
  std::vector<SceneRuns> scenes;
  std::vector<std::string> missing;  ///< As in Trade.
};

/// Reads the runs of a study from its folder.
StudyRuns read_runs(const std::vector<StudyRun>& runs, const std::filesystem::path& folder);
/// Reads the runs of a study from its folder, and compares each point with the limit.
Trade merge(const std::vector<StudyRun>& runs, const std::filesystem::path& folder);

}  // namespace sunder::scenes
