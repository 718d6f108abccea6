// The script of a scene file: [script] with its shots, blasts, removals, drives and moves.
#pragma once

#include "engine/model/scene.h"
#include "scenes/file/error_list.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// Reads [script] into a scene that has its materials, solids, balls and joints. Adds the mistakes
/// of each of its tables to `errors`.
void read_script(const Value& table, Scene& scene, ErrorList& errors);

}  // namespace sunder::scenes
