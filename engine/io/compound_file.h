// Exact binary storage of compounds, for the cache of decompositions. Convex::X_RT is not stored:
// it is the identity before a solid bends.
#pragma once

#include "engine/io/bytes.h"
#include "engine/model/compound.h"

namespace sunder {

/// Appends a compound to `out`.
void put(ByteWriter& out, const Compound& compound);
/// Reads a compound written by put(); throws InputError if it is not a valid compound.
Compound take_compound(ByteReader& in, const std::string& file);

}  // namespace sunder
