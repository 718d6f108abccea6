// Text as printf() has it.
#pragma once

#include <string>

namespace sunder {

/// At most 255 characters; what is longer is cut off.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

}  // namespace sunder
