// Compounds as bytes, bit for bit: what decompositions are kept as between runs.
#pragma once

#include "engine/io/bytes.h"
#include "engine/model/compound.h"

namespace sunder {

void put(ByteWriter& out, const Compound& compound);
/// What put() wrote; throws InputError for anything that is no sound compound.
Compound take_compound(ByteReader& in, const std::string& file);

}  // namespace sunder
