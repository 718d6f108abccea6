// A cache of decompositions on disk: a mesh that was decomposed before with equal options is read
// back, bit for bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "engine/geometry/raw_mesh.h"
#include "fracture/vacd/vacd.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {

/// Returns a 64-bit hash of a mesh and of the options of its decomposition.
std::uint64_t cache_key(const RawMesh& mesh, const fracture::VacdOptions& vacd,
                        const std::string& repair);

/// Returns the folder of the cache: $SUNDER_CACHE, or sunder/ in $XDG_CACHE_HOME, or sunder/ in
/// ~/.cache; empty if none of these variables is set, which turns the cache off.
std::filesystem::path cache_folder();

/// Returns the solid stored under a key; nothing if missing, damaged or of another version.
std::optional<MeshSolid> load_cached(std::uint64_t key);
/// Stores a solid under a key; does nothing if the file cannot be written.
void store_cached(std::uint64_t key, const MeshSolid& solid);

}  // namespace sunder::scenes
