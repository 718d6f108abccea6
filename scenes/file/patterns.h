// The tables of a material that say how it breaks.
#pragma once

#include <filesystem>

#include "engine/model/material.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// Changes `pattern` to what [material.pattern] says; its file is sought from `folder` on. Throws
/// InputError naming the place, also for a file that is no pattern.
void read_pattern(const Value& table, const std::filesystem::path& folder, PatternSpec& pattern);
/// Replaces what harder impacts do by the array `stronger` of a material's table, if there is one.
/// What it leaves out is as in `material`.
void read_stronger(const Value& table, const std::filesystem::path& folder, Material& material);

}  // namespace sunder::scenes
