// The library of materials, scenes/materials.toml, compiled in as a string by sunder_embed() of
// cmake/Sunder.cmake.
#pragma once

namespace sunder::scenes::builtin {

extern const char* const materials_toml;

}  // namespace sunder::scenes::builtin
