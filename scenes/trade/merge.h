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
  std::vector<TradeError> errors;
  /// Largest error over its noise; infinite if a run failed; nothing if there is no reference.
  std::optional<double> error;
  std::string failed;  ///< Reason of the first failure; empty if no run failed.
  bool on_front = false;
  std::optional<double> over_front;  ///< Cost divided by that of the front at equal error.
};

struct SceneTrade {
  std::string scene;
  std::vector<PointTrade> points;  ///< Points with runs, in the order of the study.
};

struct Trade {
  std::vector<SceneTrade> scenes;
  std::vector<std::string> missing;  ///< Names of missing runs, with the reason if a file exists.
  std::size_t runs = 0;              ///< Number of runs of the study.
};

/// Reads the runs of a study from its folder.
Trade merge(const std::vector<StudyRun>& runs, const std::filesystem::path& folder);

}  // namespace sunder::scenes
