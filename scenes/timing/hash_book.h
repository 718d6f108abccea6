// Stored state hashes of runs that are known to be right, in one file of the repository
// (tests/golden/hashes.txt) that only the accept commands change.
//
// A line is KEY HASH. The key is a path with everything that decides the hash:
// state/SCENE/PRESET/FRAMES has the state hash over the first frames of an unchanged scene;
// frames/GOLDEN/PRESET has shortened hashes of frames until after the first break, and
// seconds/GOLDEN/PRESET those of the seconds of a whole run (frame_states.h).
#pragma once

#include <map>
#include <string>

namespace sunder::scenes {

using StateHashes = std::map<std::string, std::string>;

/// Parses the text of a file of hashes, named `file` in messages. Throws InputError naming the
/// line.
StateHashes parse_hashes(const std::string& text, const std::string& file);
/// Reads a file of hashes; returns none if there is no file.
StateHashes read_hashes(const std::string& file);
/// Returns the text of a file of hashes.
std::string format_hashes(const StateHashes& book);

}  // namespace sunder::scenes
