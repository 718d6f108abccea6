// Formatted text.
#pragma once

#include <string>

namespace sunder {

/// Returns text formatted as by printf(), truncated to 255 bytes.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

}  // namespace sunder
