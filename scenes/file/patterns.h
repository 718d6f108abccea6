// Patterns of a material: how its tables say that it breaks.
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
/// Throws InputError if the strengths of a material that `table` gave contradict its stiffness or
/// each other: a strength above a tenth of youngs_Pa, or a compressive strength below the tensile
/// one. Strengths of 0 and inf, which never break, contradict nothing.
void check_strengths(const Value& table, const Material& material);

}  // namespace sunder::scenes
