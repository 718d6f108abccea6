// Helpers for tests of scene files that are refused.
#pragma once

#include <string>

#include "engine/base/check.h"
#include "scenes/load.h"

namespace sunder::scenes {

/// Returns the message that a text is refused with; empty if it is accepted.
inline std::string refusal(const std::string& text, const LoadOptions& options = {}) {
  try {
    parse_scene(text, "bad.toml", options);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Faulty lines that follow two valid ones, and the beginning of the message that refuses them.
struct Fault {
  const char* lines;
  const char* message;
};

inline constexpr const char* kGood = "[scene]\ndescription = \"x\"\n";

}  // namespace sunder::scenes
