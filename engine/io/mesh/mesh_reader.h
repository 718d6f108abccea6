// Reading of meshes from OBJ, PLY, STL, OFF and glTF/GLB files. Files are not trusted: any sequence
// of bytes gives a mesh or an InputError (docs/decisions, "Mesh input").
//
// Begin with read_mesh(), then the file of a format, such as mesh_obj.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// Upper limits of a mesh file.
struct MeshLimits {
  std::size_t bytes = std::size_t{1} << 30;
  std::size_t vertices = std::size_t{1} << 24;
  std::size_t corners = std::size_t{1} << 26;  ///< Sum over all polygons.
};

enum class MeshFormat { kObj, kPly, kStl, kOff, kGltf };

/// Returns the file's polygons in the file's coordinates; all indices are valid and all coordinates
/// finite. Throws InputError with file, line (if the format has lines) and remedy.
RawMesh read_mesh(const std::filesystem::path& file, const MeshLimits& limits = {});

/// Reads a mesh from memory as read_mesh() does. `file` is used in error messages, and its folder
/// for the external buffers of glTF.
RawMesh parse_mesh(std::span<const std::byte> bytes, MeshFormat format,
                   const std::filesystem::path& file, const MeshLimits& limits = {});

}  // namespace sunder
