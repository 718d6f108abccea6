// Options of a renderer that cannot be met are refused before there is a context.
#pragma once

#include "render/sinks.h"

namespace sunder::render {

/// Returns the options. Throws InputError if no picture can be as they say.
const RenderOptions& checked(const RenderOptions& options);

}  // namespace sunder::render
