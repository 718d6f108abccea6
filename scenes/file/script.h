// What happens in a scene: [script] and its shots, blasts, removals, drives and moves.
#pragma once

#include "engine/model/scene.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// Adds what the table says to a scene that has its solids, balls and joints. Throws InputError.
void read_script(const Value& table, Scene& scene);

}  // namespace sunder::scenes
