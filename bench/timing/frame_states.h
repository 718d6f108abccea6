// Whether the frames of a run are those that they are known to be, and if not, from which on. The
// book (hash_book.h) has them as frames/NAME/PRESET: four digits of the state hash of every frame,
// from frame 0 on. A run that has gone another way stays on it, so few digits are enough.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/timing/hash_book.h"
#include "bench/timing/verdict.h"
#include "scenes/load.h"

namespace sunder::bench {

/// Of a run, of which every frame's hash is given.
std::string frame_digits(std::span<const std::uint64_t> run);
/// The first of the known frames that is another in the run; none if all are the same.
std::optional<int> first_difference(const std::string& known, std::span<const std::uint64_t> run);

/// A scene that is simulated to be held against its states.
struct GuardedRun {
  std::string name;   ///< In the book.
  std::string scene;  ///< File or name.
  scenes::LoadOptions load;
  int frame = 0;  ///< Where it ends if nothing breaks and the script has begun by then.
};

/// One for every preset that the book has frames for: "simulation at realtime" and so on; one that
/// fails if it has none. `whole`: as well the states that `sunder bench` knows of the scene, if the
/// run is of the scene as it is. `file` is what the book is called. Throws InputError.
std::vector<Verdict> compare_frames(const GuardedRun& run, const StateHashes& book,
                                    const std::string& file, bool whole);

/// Puts the states of the run into the book, until some time after the first break that does not
/// come before the script's first action: 50 frames at its own preset, 8 at every other. Throws
/// InputError.
void accept_frames(const GuardedRun& run, StateHashes& book);

}  // namespace sunder::bench
