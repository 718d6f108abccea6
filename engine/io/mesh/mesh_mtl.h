// Material files (MTL) of OBJ files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/io/mesh/mesh_text.h"

namespace sunder {

/// Returns the appearance of the materials of an MTL file in the folder of `source`, by name; empty
/// if the file is missing. Missing images are left out. Appends the names of missing files to
/// `missing`. Throws InputError if the file is not valid MTL.
std::map<std::string, Appearance> read_mtl(const MeshSource& source, const std::string& name,
                                           std::vector<std::string>& missing);

}  // namespace sunder
