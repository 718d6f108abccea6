// From the runs of a study to what its points cost and how wrong they are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/trade/errors.h"
#include "bench/trade/study.h"

namespace sunder::bench {

/// A point on one scene.
struct PointTrade {
  StudyPoint point;
  int runs = 0;        ///< That there are, the failed ones included.
  double cost_ms = 0;  ///< Of the processor a frame: the median over seeds.
  double wall_ms = 0;  ///< The same by the clock on the wall.
  std::vector<TradeError> errors;
  /// The largest over its noise; infinite where a run failed, none where there is nothing to hold
  /// it against, as for the limit itself.
  std::optional<double> error;
  std::string failed;  ///< Why a run did; empty if none.
  bool on_front = false;
  std::optional<double> over_front;  ///< Cost over that of the front at equal error.
};

struct SceneTrade {
  std::string scene;
  std::vector<PointTrade> points;  ///< Those with runs, in the order of the study.
};

struct Trade {
  std::vector<SceneTrade> scenes;
  std::vector<std::string> missing;  ///< Names of runs, and why in brackets unless not done.
  std::size_t runs = 0;              ///< That there should be.
};

/// What lies in the folder of a study with these runs.
Trade merge(const std::vector<StudyRun>& runs, const std::filesystem::path& folder);

}  // namespace sunder::bench
