// Wavefront OBJ, a file a part.
#pragma once

#include <filesystem>

#include "engine/io/mesh/export_model.h"

namespace sunder {

/// Fills a folder with one .obj of triangles a part, in double precision, and materials.mtl. The
/// folder is made under a temporary name and renamed; one that stands there already is replaced if
/// all it holds is such files. Throws InputError for
/// another folder, FileError if it cannot be written.
void write_obj_folder(const std::filesystem::path& folder, const Model& model);

}  // namespace sunder
