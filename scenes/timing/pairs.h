// The figures by which two programs are compared that were timed in pairs: of each repeat, one
// value of this program and one of the other.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"

namespace sunder::scenes {

struct PairedFigure {
  std::string what;                 ///< Stage, "frame", "memory" or "draw".
  std::string figure;               ///< "mean", "p50", "p95", "p99", "max", "peak" or "stalls".
  std::string unit;                 ///< "ms of processor time", "ms of wall time", "MB", "frames".
  std::vector<double> now, before;  ///< By repeat: of this program, and of the other.

  /// Returns the two names: "frame p99", "memory peak".
  std::string name() const;
};

/// Most figures of a scene, with and without drawing.
inline constexpr std::size_t kMaxPairedFigures = 16, kMaxPairedFiguresDrawn = 18;

/// Returns the figures that all runs have, of which run i of `now` and run i of `before` are a
/// pair. Times are processor times with one thread, and wall times with several, as threads that
/// wait use the processor. Extremes and stalls are of wall time in any case.
std::vector<PairedFigure> paired_figures(std::span<const Figures> now,
                                         std::span<const Figures> before);

/// Writes the figures to `against.figures` of a scene.
void put_pairs(std::span<const PairedFigure> pairs, Figures& scene);
/// Returns the figures that put_pairs() has written; empty if there are none.
std::vector<PairedFigure> pairs_of(const Figures& scene);

}  // namespace sunder::scenes
