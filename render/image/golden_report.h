// The page that shows what golden-image tests saw.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/page.h"
#include "render/image/compare.h"

namespace sunder::render {

/// One golden test: its baseline, what is drawn now, how they differ, and what was simulated.
struct GoldenPicture {
  std::string name;
  bool passed = false;
  std::string verdict;  ///< In words.
  Image reference;      ///< Empty if there is no baseline yet.
  Image actual;
  Difference difference;
  Thresholds thresholds;
  std::string remade_by;  ///< The command that makes the subject and its baseline.
  std::string accept_by;  ///< The command that makes `actual` the baseline.
  std::string renderer;   ///< That drew `actual`.
  std::vector<std::vector<Cell>> runs = {};  ///< What was simulated, and what came of it.
};

/// One self-contained HTML page, failures first: both pictures and the map of the FLIP error side
/// by side, under a slider, or swapped in place; a magnifier; figures against their thresholds.
std::string golden_report(std::span<const GoldenPicture> pictures);

}  // namespace sunder::render
