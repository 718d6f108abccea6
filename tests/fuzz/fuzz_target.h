// The table of fuzz targets, by name, for the fuzzers and for replay.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace sunder::fuzz {

/// Function that takes any bytes and ends the program if a property that must hold does not.
using Target = void (*)(std::span<const std::uint8_t> bytes);

/// Returns all targets, by the names of their folders in corpus/.
std::map<std::string, Target>& targets();

/// Adds a target to targets() when its source file is initialised.
struct Registration {
  Registration(const char* name, Target target) { targets()[name] = target; }
};

}  // namespace sunder::fuzz
