// Whether runs simulate what they are known to: a faster run that simulates something else is no
// faster run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/timing/hash_book.h"
#include "bench/timing/verdict.h"
#include "engine/io/figures.h"

namespace sunder::bench {

/// One for each scene. A run that was changed by --set or is too short has no stored state to be
/// held against, and is skipped; any other that has none fails. `file` is what the book is called.
std::vector<Verdict> compare_states(std::span<const Figures> scenes, const StateHashes& book,
                                    const std::string& file);

/// Puts the state of every scene into the book. Throws InputError for one that compare_states()
/// would skip, or whose repeats differ.
void accept_states(std::span<const Figures> scenes, StateHashes& book);

}  // namespace sunder::bench
