// The HTML report of golden-image tests.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/image/compare.h"
#include "scenes/report/page.h"

namespace sunder::scenes {

/// One golden test: its reference image, the image drawn now, their difference and the runs.
struct GoldenResult {
  std::string name;
  bool passed = false;
  std::string verdict;      ///< Result as a sentence.
  render::Image reference;  ///< Empty if there is no reference yet.
  render::Image actual;
  render::Difference difference;
  render::Thresholds thresholds;
  std::string remake_command;   ///< Command that runs the test again and draws its reference.
  std::string accept_command;   ///< Command that makes `actual` the reference.
  std::string renderer;         ///< Description of the renderer that drew `actual`.
  render::Image original = {};  ///< Empty if `reference` is the original image.
  render::Difference from_original = {};  ///< Difference of `actual` from the original image.
  std::string rebased = {};  ///< Reason why the original image replaced an older one; may be empty.
  std::vector<std::vector<Cell>> runs = {};  ///< Simulations and their results, a row each.
};

/// Returns a self-contained HTML page, failures first: for each test both images and the FLIP error
/// map side by side, under a slider or alternating; a magnifier; figures and their thresholds; and
/// a table of the images that are not equal to their originals, the farthest first.
std::string golden_report(std::span<const GoldenResult> pictures);

}  // namespace sunder::scenes
