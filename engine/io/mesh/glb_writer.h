// glTF 2.0 in its binary form.
#pragma once

#include <filesystem>

#include "engine/io/mesh/export_model.h"

namespace sunder {

/// A node a part, a primitive a material, with normals and texture coordinates; single precision
/// around each part's centre. Pictures are written as they are, those of relief too, though the
/// format knows no heights. Written under a temporary name and renamed. Throws FileError.
void write_glb(const std::filesystem::path& file, const Model& model);

}  // namespace sunder
