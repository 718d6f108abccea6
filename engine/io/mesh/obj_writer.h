// Writing of Wavefront OBJ, one file per part or one in all.
#pragma once

#include <filesystem>

#include "engine/io/mesh/export_model.h"

namespace sunder {

/// Writes one .obj with an object per part, in double precision and without materials. Throws
/// FileError if it cannot be written.
void write_obj(const std::filesystem::path& file, const Model& model);
/// Writes a folder with one .obj of triangles per part, in double precision, and materials.mtl. The
/// folder is created under a temporary name and renamed; an existing folder is replaced if it has
/// only such files. Throws InputError if it has other files, and FileError if it cannot be written.
void write_obj_folder(const std::filesystem::path& folder, const Model& model);

}  // namespace sunder
