// What becomes of scenes that ask for too much: figures at every preset, as truths are, and what a
// user who asks is told. Printed by extremes_bench, asserted by tests/truths, tabled in
// docs/extremes.md.
//
// Read first: extreme(). The lists are by theme, one a file.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "bench/truths/truth.h"
#include "engine/model/frame.h"
#include "engine/model/scene.h"

namespace sunder::truths {

using SceneAt = std::function<Scene(const Preset&)>;

/// A scene from its first frame to its last, through the library, as a user runs it.
struct Run {
  FramePtr first, last;
  double energy_gained = 0;  ///< The most it rises above its start, over that.
  double deepest_m = 0;      ///< Overlap of any frame.
  double mass_off = 0;       ///< The most that mass is off its start, over that.
  double momentum_off = 0;   ///< The most that no force accounts for (FrameReport).

  /// At the end, of a body of the first frame; infinite if it is there no more.
  double speed_m_s(std::uint64_t key) const;
  /// The furthest that a body of the first frame is from its place in the last; infinite if it is
  /// there no more.
  double moved_m() const;
  double overlap_left_m() const;
};
/// Never finite in any figure if a body is not.
Run run(Scene scene);

/// A scene of a text and a duration; `set` as on the command line.
Scene scene_at(const Preset& preset, const std::string& text, double duration_s,
               std::vector<std::string> set = {});

/// Mean of a figure over runs of a scene with seeds 1 to 8: one run of rubble says little of the
/// next.
double mean_of_seeds(Scene scene, const std::function<double(const Run&)>& figure);

/// A truth about a scene.
Truth extreme(int row, const char* what, const char* unit, const char* source, double mark,
              const SceneAt& scene, const std::function<double(const Run&)>& figure,
              const Bounds& bounds);
/// A truth about something else that is done with the scene that a user would be told of.
Truth extreme(int row, const char* what, const char* unit, const char* source, double mark,
              const SceneAt& scene, Measure measure, const Bounds& bounds);

Truths mass_extremes();
Truths size_extremes();
Truths step_extremes();
Truths surface_extremes();
Truths speed_extremes();
Truths place_extremes();

/// All of these, in the order of their rows.
Truths all_extremes();

}  // namespace sunder::truths
