// The solver with a rule turned off, measured against reference behaviour and in piles.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/ablation/rules.h"

namespace sunder::ablation {

/// What a pile came to; of several seeds, the mean.
struct PileFigures {
  double mean_mm = 0, deepest_mm = 0;  ///< Of penetrations.
  double rms_m_s = 0;
  double awake = 0;  ///< Share of the bodies.
  double cost = 1;   ///< Processor time, of that of the solver as it is, run in turns.
};

/// By number in all_truths() and in kPresets; what is missing broke down.
using TruthFigures = std::map<std::pair<std::size_t, std::size_t>, double>;

struct Trial {
  TruthFigures truths;
  std::vector<PileFigures> piles;  ///< As pile_names(); what is missing broke down.
};

std::vector<std::string> pile_names();

/// Each in a process of its own, so many at once, since some break down. `presets` are numbers in
/// kPresets.
std::vector<Trial> try_all(const std::vector<Rule>& rules, const std::vector<std::size_t>& presets,
                           int jobs);

}  // namespace sunder::ablation
