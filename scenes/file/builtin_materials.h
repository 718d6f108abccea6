// The library of materials, scenes/materials.toml, compiled in as a string (CMake: sunder_embed).
#pragma once

namespace sunder::scenes::builtin {

extern const char* const materials_toml;

}  // namespace sunder::scenes::builtin
