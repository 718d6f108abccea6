// Hashes of what is known to be right, by what they are of: one file in the repository
// (tests/golden/hashes.txt), which only an accept command changes.
//
// A line is WHAT HASH. WHAT is a path that says all that decides the hash:
// state/SCENE/PRESET/FRAMES is the state hash over that many frames of a scene as it is given;
// frames/GOLDEN/PRESET is that of every frame until after the first break, shortened
// (frame_states.h).
#pragma once

#include <map>
#include <string>

namespace sunder::bench {

using StateHashes = std::map<std::string, std::string>;

/// From the text of a file; `file` is what errors call it. Throws InputError naming the line.
StateHashes parse_hashes(const std::string& text, const std::string& file);
/// Of a file; none if there is no file.
StateHashes read_hashes(const std::string& file);
/// As a file has it.
std::string format_hashes(const StateHashes& book);

}  // namespace sunder::bench
