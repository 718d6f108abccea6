// Scene files that are refused, and with which message.
#pragma once

#include <string>

#include "engine/base/check.h"
#include "scenes/load.h"

namespace sunder::scenes {

/// The message a text is refused with; empty if it is accepted.
inline std::string refusal(const std::string& text, const LoadOptions& options = {}) {
  try {
    parse_scene(text, "bad.toml", options);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Lines that follow a good line 1 and 2, and how the message begins.
struct Fault {
  const char* lines;
  const char* message;
};

inline constexpr const char* kGood = "[scene]\ndescription = \"x\"\n";

}  // namespace sunder::scenes
