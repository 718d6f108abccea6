// Case files: a break that can be carried out again, bit for bit, wherever it went wrong.
#pragma once

#include <iosfwd>
#include <string>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// A compound and what was to be done to it.
struct BreakCase {
  Compound compound;
  BreakCommand command;
};

/// Writes a case as text; numbers are in hexadecimal, so that none is rounded.
void write_case(std::ostream& out, const BreakCase& example);
/// Reads what write_case() wrote; `name` is for messages. Throws InputError if it is anything else.
BreakCase read_case(std::istream& in, const std::string& name);

}  // namespace sunder::fracture
