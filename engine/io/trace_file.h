// A trace as a file, to be looked at in a browser.
#pragma once

#include <span>
#include <string>

#include "engine/base/trace.h"

namespace sunder {

/// The spans in the Trace Event Format (JSON), which Perfetto (ui.perfetto.dev) and
/// chrome://tracing open; ends with a newline.
std::string format_trace(std::span<const TracedSpan> spans);

}  // namespace sunder
