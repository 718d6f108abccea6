// The identity of the program or library that contains this code.
#pragma once

#include <string>

namespace sunder {

/// Returns the GNU build id, in hexadecimal digits, of the program or shared library that contains
/// this function: a hash that the linker makes of all its code, so that two builds have equal ids
/// only if they compute the same. Empty if it was linked without an id.
std::string build_id();

}  // namespace sunder
