// Fuzz targets by name: what the fuzzers feed, and what replay.cpp runs on the corpus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace sunder::fuzz {

/// Takes any bytes; ends the program where something that must hold does not.
using Target = void (*)(std::span<const std::uint8_t> bytes);

/// All targets, by the names of their folders in corpus/.
std::map<std::string, Target>& targets();

/// A target of the file it stands in.
struct Registration {
  Registration(const char* name, Target target) { targets()[name] = target; }
};

}  // namespace sunder::fuzz
