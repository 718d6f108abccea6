// Whether a scene can be run at all: what is made by hand is looked at before anything relies on
// it.
#pragma once

#include "engine/model/scene.h"

namespace sunder {

/// Throws InputError that names the first member of the scene that no run can begin with, says what
/// it is and what is allowed.
void check_scene(const Scene& scene);

}  // namespace sunder
