// What was timed, for people: data in, text out.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/timing/compare.h"
#include "bench/timing/verdict.h"
#include "engine/io/figures.h"

namespace sunder::bench {

/// For the terminal: of each scene its stages, in processor and in wall time, and its counts.
std::string timing_table(std::span<const Figures> scenes);
/// What each feature that was turned off saves; empty if none was.
std::string features_table(std::span<const Figures> scenes);
/// A line for each that failed; or for each other, but stages that are well.
std::string verdict_lines(std::span<const Verdict> verdicts, bool failed);

/// All of it on one page that needs nothing beside it, with every stage of every frame plotted.
std::string timing_page(std::span<const Figures> scenes, std::span<const Verdict> verdicts,
                        std::span<const Change> changes);

/// A feature in a scene that was run without it: what of the processor a frame takes.
struct Saving {
  std::string feature;
  double with_ms = 0, without_ms = 0;
};
std::vector<Saving> savings_of(const Figures& scene);

/// "1 thread, 200 frames" and so on.
std::string run_line(const Figures& scene);
/// What there was at most: bodies, awake, pieces, chips, puffs, memory.
std::string counts_line(const Figures& scene);

}  // namespace sunder::bench
