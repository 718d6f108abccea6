// Case files: a break stored as text, which can be repeated bit for bit.
#pragma once

#include <iosfwd>
#include <string>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// A compound and the command to break it.
struct BreakCase {
  Compound compound;
  BreakCommand command;
};

/// Writes a case as text, with numbers in hexadecimal so that none is rounded.
void write_case(std::ostream& out, const BreakCase& example);
/// Reads a case written by write_case(); `name` is for messages. Throws InputError if the text is
/// anything else.
BreakCase read_case(std::istream& in, const std::string& name);

}  // namespace sunder::fracture
