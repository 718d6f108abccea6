// A cache of decompositions on disk: a mesh that this build of the program has decomposed before
// with equal options is read back, bit for bit. What another build wrote is never read, so that a
// cache cannot hide a change of the decomposition.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "engine/geometry/raw_mesh.h"
#include "fracture/vacd/vacd.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {

/// Returns the built-in mesh whose decomposition is part of every key: two boxes that overlap.
RawMesh cache_probe();
/// Returns a hash of the decomposition of `probe` and of the build id of the program: equal only
/// for one build, on machines where it computes the same bits.
std::uint64_t decomposition_digest(RawMesh probe);
/// Returns a 64-bit hash of a mesh, of the options of its decomposition, and of `digest`.
std::uint64_t cache_key(const RawMesh& mesh, const fracture::VacdOptions& vacd,
                        const std::string& repair, std::uint64_t digest);
/// Returns the key with the digest of cache_probe().
std::uint64_t cache_key(const RawMesh& mesh, const fracture::VacdOptions& vacd,
                        const std::string& repair);

/// Returns the folder of the cache: $SUNDER_CACHE, or sunder/ in $XDG_CACHE_HOME, or sunder/ in
/// ~/.cache; empty if none of these variables is set, which turns the cache off.
std::filesystem::path cache_folder();

/// Removes the entries used longest ago until the others take no more than `most_bytes`.
void trim_cache(std::uintmax_t most_bytes);

/// Returns the solid stored under a key; nothing if it is missing or damaged.
std::optional<MeshSolid> load_cached(std::uint64_t key);
/// Stores a solid under a key, and removes the entries used longest ago beyond half a gigabyte;
/// does nothing if the file cannot be written.
void store_cached(std::uint64_t key, const MeshSolid& solid);

}  // namespace sunder::scenes
