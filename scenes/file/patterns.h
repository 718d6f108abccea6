// The fracture patterns and strengths of a material in a scene file.
#pragma once

#include <filesystem>

#include "engine/model/material.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// Reads [material.pattern] into `pattern`, whose fields stay where the table has no key for them.
/// A pattern's file is relative to `folder`. Throws InputError with file and line, also for a file
/// that is no pattern.
void read_pattern(const Value& table, const std::filesystem::path& folder, PatternSpec& pattern);
/// Replaces the patterns of harder impacts by the array `stronger` of a material's table, if there
/// is one. Keys that an element does not have are as in `material`. Throws InputError.
void read_stronger(const Value& table, const std::filesystem::path& folder, Material& material);
/// Throws InputError if the strengths of the material in `table` contradict its stiffness or each
/// other: a strength is above a tenth of youngs_Pa, or the compressive strength is below the
/// tensile one. Strengths of 0 and inf, at which nothing breaks, are not checked.
void check_strengths(const Value& table, const Material& material);

}  // namespace sunder::scenes
