// Reports of timings for people, as text for the terminal and as an HTML page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/timing/compare.h"
#include "scenes/timing/judge.h"
#include "scenes/timing/verdict.h"

namespace sunder::scenes {

/// Returns the stages of each scene, and drawing, in processor and wall time, and its counts, for
/// the terminal.
std::string timing_table(std::span<const Figures> scenes);
/// Returns the time of each feature that was turned off in a further run; empty if there was none.
std::string features_table(std::span<const Figures> scenes);
/// Returns a line for each failed verdict, or for each other one, without figures of a table.
std::string verdict_lines(std::span<const Verdict> verdicts, bool failed);

/// Returns a self-contained HTML page with all results and plots of every stage of every frame.
std::string timing_page(std::span<const Figures> scenes, std::span<const Verdict> verdicts,
                        std::span<const Change> changes, const Judgements& judgements);

/// A feature, with the processor time per frame of the scene with and without it.
struct Saving {
  std::string feature;
  double with_ms = 0, without_ms = 0;
};
std::vector<Saving> savings_of(const Figures& scene);

/// Returns the settings of the run: "realtime, 200 frames, 1 thread" and so on.
std::string run_line(const Figures& scene);
/// Returns peak numbers of bodies and particles, peak memory, and numbers of breaks and pieces.
std::string counts_line(const Figures& scene);

}  // namespace sunder::scenes
