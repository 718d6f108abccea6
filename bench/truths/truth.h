// Validation cases: quantities with a published or closed-form reference, measured at every preset.
// Asserted by tests/truths, printed by `validation_bench truths`, listed in docs/truths.md.
//
// Begin at Truth. Each file of the folder has the cases of one theme.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/fixtures/presets.h"

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

/// A validation case. measure() returns the deviation from the reference.
struct Truth {
  int row;             ///< Row of the table; related cases share a row.
  const char* what;    ///< Name of the measured quantity; unique.
  const char* unit;    ///< Unit of measure(); "" for a relative deviation.
  const char* source;  ///< Publication or formula of the reference.
  double mark;         ///< Target: |measure| should not exceed it.
  Measure measure;
  /// Accepted |measure| by preset: the mark or less; above it where the mark is missed: a known
  /// failure, with the value reached and at most a tenth more.
  Bounds bounds;
  /// Returns the warnings that a user gets for the scene; empty if the case has no scene file.
  std::function<std::string(const Preset&)> told = {};
  bool is_timing = false;  ///< True if machine-dependent: printed, not tested.
};
using Truths = std::vector<Truth>;

/// Kind of the source of a reference. A formula that Sunder computes by itself is no truth, nor is
/// a comparison of Sunder with itself (kOwn).
enum class SourceKind : std::uint8_t { kClosedForm, kMeasured, kOtherEngine, kOwn };
/// Returns the kind of the case's source.
SourceKind source_kind(const Truth& truth);
/// Returns "closed form", "measured", "other engine" or "own".
const char* name_of(SourceKind kind);

/// Returns a case without warnings.
inline Truth truth(int row, const char* what, const char* unit, const char* source, double mark,
                   Measure measure, const Bounds& bounds) {
  return {row, what, unit, source, mark, std::move(measure), bounds};
}

/// Returns the case, marked as dependent on the machine.
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
Truths wall_truths();
Truths pane_truths();
Truths drop_truths();
Truths outside_truths();

/// Returns all cases of these lists, sorted by row; those whose source is our own are last.
Truths all_truths();

/// Returns the x in [low, high] where yes(x) turns from false to true, after `rounds` bisections.
double threshold(double low, double high, int rounds, const std::function<bool(double)>& yes);

}  // namespace sunder::truths
