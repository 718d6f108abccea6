// Trace files for browsers.
#pragma once

#include <span>
#include <string>

#include "engine/base/trace.h"

namespace sunder {

/// Returns spans in the Trace Event Format (JSON), for Perfetto (ui.perfetto.dev) and
/// chrome://tracing, with a final newline.
std::string format_trace(std::span<const TracedSpan> spans);

}  // namespace sunder
