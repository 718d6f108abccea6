// Measures how often the statistic of a study tells equal settings apart, by comparing groups of
// runs of one point.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/trade/study.h"

namespace sunder::scenes {

/// Comparisons of equal settings: those of one point on one scene.
struct EqualPoint {
  std::string scene;
  StudyPoint point;
  int runs = 0;           ///< Number of runs without failed ones.
  int pairs = 0;          ///< Number of comparisons; 0 if there are too few runs.
  int differ = 0;         ///< Comparisons in which the groups differ.
  double mean_error = 0;  ///< Mean of the errors.
  double largest_error = 0;
  std::string failed;  ///< Reason of the first failure; empty if no run failed.
};

struct EqualStudy {
  int seeds = 0;  ///< Runs of a group.
  std::vector<EqualPoint> points;
  std::vector<std::string> missing;  ///< Names of missing runs, with the reason if a file exists.
  std::size_t runs = 0;              ///< Number of runs of the study.
};

/// Compares `pairs` pairs of groups of `seeds` runs at each point of each scene. A pair has no run
/// twice. No run is used again before all runs were: with at least 2·pairs·seeds runs, pairs are
/// independent.
EqualStudy compare_equal(const std::vector<StudyRun>& runs, const std::filesystem::path& folder,
                         int seeds, int pairs);

/// Returns the results as JSON.
std::string equal_json(const EqualStudy& study);
/// Returns a table for the terminal.
std::string equal_table(const EqualStudy& study);

}  // namespace sunder::scenes
