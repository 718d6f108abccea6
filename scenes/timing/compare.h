// Comparison of two files of timings: whether the runs can be compared and have the same states,
// and by how much times differ. Which differences are due to the program cannot be known from two
// files: measurements at two times differ by more than the repeats of either do. judge.h judges
// programs that were timed at once.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/timing/verdict.h"

namespace sunder::scenes {

/// A figure that both files have.
struct Change {
  std::string scene;
  std::string what, figure, unit;  ///< As in PairedFigure.
  double before = 0, now = 0;
};

struct Comparison {
  std::vector<Change> changes;
  std::vector<Verdict> verdicts;  ///< By scene.
};

/// Compares every scene of `now` with the scene of the same name in `old`, which was read from the
/// file `old_file`, or timed by the program of that name. The comparison fails for a scene that is
/// missing in `old`, was run differently, on another machine or by other threads, or has another
/// state. If states differ, changes are returned as well.
Comparison compare(std::span<const Figures> now, std::span<const Figures> old,
                   const std::string& old_file);

/// Returns the changes as a table for the terminal; empty if there are none.
std::string changes_table(std::span<const Change> changes);

}  // namespace sunder::scenes
