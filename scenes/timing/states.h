// Comparison of the state hashes of timed runs with stored ones, because times of a run that
// simulates something else cannot be compared.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/timing/hash_book.h"
#include "scenes/timing/verdict.h"

namespace sunder::scenes {

/// Returns a verdict for each scene. Runs that were changed by --set or are too short have no
/// stored hash and are skipped; others without one fail. `file` names the file of hashes in
/// messages.
std::vector<Verdict> compare_states(std::span<const Figures> scenes, const StateHashes& book,
                                    const std::string& file);

/// Stores the state hash of every scene. Throws InputError for a run that compare_states() skips,
/// and for one whose repeats differ.
void accept_states(std::span<const Figures> scenes, StateHashes& book);

}  // namespace sunder::scenes
