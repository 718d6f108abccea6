// Whether the frames of a run are those that they are known to be, and if not, from which on. The
// book (hash_book.h) has them as frames/NAME/PRESET/FIRST: four digits of the state hash of every
// frame from FIRST on. A run whose states differ once keeps differing, so few digits are enough.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/timing/hash_book.h"
#include "bench/timing/verdict.h"
#include "scenes/load.h"

namespace sunder::bench {

/// Frames one after another, at a preset.
struct FrameStates {
  std::string preset;
  int first = 0;
  std::string digits;

  int last() const;
};
/// Of a run, of which every frame's hash is given, from frame 0 on.
FrameStates frame_states(const std::string& preset, int first, int last,
                         std::span<const std::uint64_t> run);
/// The first frame that is another in a run; none if all are the same.
std::optional<int> first_difference(const FrameStates& known, std::span<const std::uint64_t> run);

/// A scene that is simulated to be held against its states.
struct GuardedRun {
  std::string name;   ///< In the book.
  std::string scene;  ///< File or name.
  scenes::LoadOptions load;
  int frame = 0;  ///< One that is of interest, where nothing breaks before it.
};

/// One for every preset that the book has frames for: "simulation realtime" and so on; one that
/// fails if it has none. `whole`: as well the states that `sunder bench` knows of the scene, if the
/// run is of the scene as it is. `file` is what the book is called. Throws InputError.
std::vector<Verdict> judge_frames(const GuardedRun& run, const HashBook& book,
                                  const std::string& file, bool whole);

/// Puts into the book what the run comes to: 60 frames around the first break at its own preset,
/// 10 at every other. Throws InputError.
void accept_frames(const GuardedRun& run, HashBook& book);

}  // namespace sunder::bench
