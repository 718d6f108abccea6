// Comparison of every frame of a run with stored hashes, to find the first frame that differs.
// Stored hashes (hash_book.h) have the key frames/NAME/PRESET and the first four hexadecimal
// digits of the state hash of each frame, joined. Few digits suffice, because a run that has
// diverged stays different. Of runs that are guarded to their end, seconds/NAME/PRESET has four
// digits for each second.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/model/frame.h"
#include "scenes/load.h"
#include "scenes/timing/hash_book.h"
#include "scenes/timing/verdict.h"

namespace sunder::scenes {

/// Returns the stored digits for the state hashes of a run's frames.
std::string frame_digits(std::span<const std::uint64_t> run);
/// Returns the stored digits of a whole run: those of the hash over each 60 frames, the last ones
/// included.
std::string second_digits(std::span<const std::uint64_t> run);
/// Returns the index of the first stored frame that the run lacks or that differs; nothing if all
/// are equal.
std::optional<int> first_difference(const std::string& known, std::span<const std::uint64_t> run);

/// A scene that is simulated and compared with its stored hashes.
struct GuardedRun {
  std::string name;   ///< Name in the keys of stored hashes.
  std::string scene;  ///< Scene file, or name of a scene.
  LoadOptions load;
  int frame = 0;  ///< Last frame to store if nothing breaks, unless the script begins later.
  bool is_drawn = false;    ///< True if states are stored up to `frame` at the preset of `load`.
  bool to_the_end = false;  ///< True if each second of the run is stored at the preset of `load`.
};

/// Results of compare_frames().
struct FrameComparison {
  std::vector<Verdict> verdicts;
  /// GuardedRun::frame at the preset of GuardedRun::load; null if the simulation ended before.
  FramePtr frame;
  bool is_same = false;  ///< True if the states up to `frame` are equal to stored ones.
};

/// Simulates the scene at every preset with stored hashes and returns a verdict for each:
/// "simulation at realtime" and so on, and one for GuardedRun::to_the_end. Without any stored
/// hashes the only verdict is a failure. `with_bench_state`: also compares the hash that `sunder
/// bench` stores, unless --set changed the scene. `file` is the name of the file of hashes in
/// messages. Throws InputError.
FrameComparison compare_frames(const GuardedRun& run, const StateHashes& book,
                               const std::string& file, bool with_bench_state);

/// Stores the hashes of the run at every preset, up to 50 frames (at the run's own preset) or 8
/// frames (at others) after the first break that is not before the script's first action, and up to
/// the frame that is drawn; and those of each second, if they are to be stored. Throws InputError.
void accept_frames(const GuardedRun& run, StateHashes& book);

}  // namespace sunder::scenes
