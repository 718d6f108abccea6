// Decompositions kept on disk between runs, by what they were made of: the same mesh decomposed
// with the same options is read back, bit for bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "engine/geometry/raw_mesh.h"
#include "fracture/vacd/vacd.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {

/// What a mesh is made into by the options, in 64 bits.
std::uint64_t cache_key(const RawMesh& mesh, const fracture::VacdOptions& vacd,
                        const std::string& repair);

/// $SUNDER_CACHE, or sunder/ in $XDG_CACHE_HOME, or in ~/.cache; empty if none of them is set, and
/// then nothing is kept.
std::filesystem::path cache_folder();

/// What was kept under a key; nothing if there is none, or it is damaged or of another version.
std::optional<MeshSolid> recall(std::uint64_t key);
/// Keeps it; where that cannot be done, nothing happens.
void keep(std::uint64_t key, const MeshSolid& solid);

}  // namespace sunder::scenes
