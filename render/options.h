// Validation of render options before a context is made.
#pragma once

#include "render/sinks.h"

namespace sunder::render {

/// Returns the options. Throws InputError if a value is out of range or a layer is unknown.
const RenderOptions& checked_options(const RenderOptions& options);

}  // namespace sunder::render
