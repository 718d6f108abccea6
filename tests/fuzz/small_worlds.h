// Small worlds in the middle of their run, for tests and fuzzing of saved states.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sunder::fuzz {

/// The content of the saved states, without seals, of worlds that have between them: bodies asleep,
/// joints, a chain, debris and dust, cracked and bent solids, a ground of meshes, a body on a path,
/// a blast and a shot to come.
const std::vector<std::vector<std::byte>>& small_states();

/// Restores a state, given without its seal, and runs it for some frames. Returns the message if it
/// is refused, or an empty string. Ends the program if a frame is not finite.
std::string run_state(std::span<const std::byte> content, int frames);

}  // namespace sunder::fuzz
