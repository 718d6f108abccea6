// Writing of binary glTF 2.0 (GLB).
#pragma once

#include <filesystem>

#include "engine/io/mesh/export_model.h"

namespace sunder {

/// Writes a model with one node per part and one primitive per material, with normals and texture
/// coordinates, in single precision relative to each part's centre. Images are written unchanged; a
/// height map becomes the normal texture, though glTF has no height maps. Written under a temporary
/// name and renamed. Throws FileError.
void write_glb(const std::filesystem::path& file, const Model& model);

}  // namespace sunder
