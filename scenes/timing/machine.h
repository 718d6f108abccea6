// Facts about a run and the machine under it, without which its times cannot be compared.
#pragma once

#include <string>

#include "engine/io/figures.h"
#include "engine/io/statistics.h"

namespace sunder::scenes {

/// Returns the name of the vector instructions that the contact solver uses for `lanes` lanes.
const char* instructions_of(int lanes);

/// Returns the processors that this process may run on, as in "0-3,8".
std::string allowed_processors();

/// Returns `machine`: kernel, vector instructions in use, governors of the allowed processors,
/// these processors, and how OpenMP binds threads to them. What cannot be read is "unknown".
Figures machine_figures();

/// Returns the peak resident memory of this program since it was started, without that of the
/// program that started it.
double peak_memory_MB();

/// Returns `state`: the hash of the first kStateFrames frames, or of all of a scene that ends
/// before
/// (`last_frame`). Empty if the run was shorter.
Figures state_figures(const StateHash& states, int last_frame);

}  // namespace sunder::scenes
