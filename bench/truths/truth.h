// Reference behaviour that nobody in this project invented, measured at every preset: asserted by
// tests/truths, printed by truths_bench, and tabled in docs/truths.md.
//
// Read first: Truth. The lists are by theme, one a file.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/truths/presets.h"

namespace sunder::truths {

using solver::kG;
using solver::kPi;
using solver::kPresets;
using solver::Preset;
using solver::PresetWorld;
using solver::RigidWorld;
using W = RigidWorld;
using Measure = std::function<double(const Preset&)>;
using Bounds = std::array<double, kPresets.size()>;

/// A truth holds as far as |measure(preset)| is small.
struct Truth {
  int row;             ///< Of the table; truths of one row belong together.
  const char* what;    ///< What is measured. Unique.
  const char* unit;    ///< "": a share of what it is compared with.
  const char* source;  ///< Of the closed form, or whose figure it is.
  double mark;         ///< What |measure| should not exceed.
  Measure measure;
  Bounds bounds;  ///< What it does not exceed, by preset: what is reached and half as much.
  /// What a user is told who asks for this; none: no user can.
  std::function<std::string(const Preset&)> told = {};
  bool is_timing = false;  ///< Of the machine, too: reported by the bench, asserted by no test.
};
using Truths = std::vector<Truth>;

inline Truth truth(int row, const char* what, const char* unit, const char* source, double mark,
                   Measure measure, const Bounds& bounds) {
  return {row, what, unit, source, mark, std::move(measure), bounds};
}

inline Truth timing(Truth truth) {
  truth.is_timing = true;
  return truth;
}

Truths friction_truths();
Truths rolling_truths();
Truths impact_truths();
Truths meeting_truths();
Truths flight_truths();
Truths joint_truths();
Truths stack_truths();
Truths balance_truths();
Truths planar_truths();
Truths grain_truths();
Truths silo_truths();
Truths sphere_truths();
Truths energy_truths();
Truths break_truths();
Truths load_truths();
Truths blow_truths();
Truths steel_truths();
Truths through_truths();
Truths perforation_truths();
Truths blast_truths();

/// All of these, in the order of their rows.
Truths all_truths();

/// The x in [low, high] where yes(x) turns from false to true.
double threshold(double low, double high, int rounds, const std::function<bool(double)>& yes);

}  // namespace sunder::truths
