// Meshes from files: OBJ, PLY, STL, OFF and glTF/GLB. Files are not trusted: whatever the bytes,
// reading ends with a mesh or an InputError (docs/decisions, "Mesh input").
//
// Read first: read_mesh(), then one of the format's files: mesh_obj.cpp and its neighbours.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// What a file may ask for at most.
struct MeshLimits {
  std::size_t bytes = std::size_t{1} << 30;
  std::size_t vertices = std::size_t{1} << 24;
  std::size_t corners = std::size_t{1} << 26;  ///< Of all polygons together.
};

enum class MeshFormat { kObj, kPly, kStl, kOff, kGltf };

/// The file's polygons in its own coordinates, every index checked, every coordinate finite.
/// Throws InputError naming file, line (where the format has lines) and what to do.
RawMesh read_mesh(const std::filesystem::path& file, const MeshLimits& limits = {});

/// As read_mesh(), of bytes in memory; `file` is named in errors, and the buffers that a glTF keeps
/// beside it are sought in its folder.
RawMesh parse_mesh(std::span<const std::byte> bytes, MeshFormat format,
                   const std::filesystem::path& file, const MeshLimits& limits = {});

}  // namespace sunder
