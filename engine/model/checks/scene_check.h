// Validation of a scene before a run.
#pragma once

#include "engine/model/scene.h"

namespace sunder {

/// Throws InputError, with the member's name, its value and the allowed values, for the first
/// invalid member of the scene.
void check_scene(const Scene& scene);

}  // namespace sunder
