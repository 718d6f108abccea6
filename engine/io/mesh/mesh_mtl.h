// The materials that an OBJ keeps in a file beside it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/io/mesh/mesh_text.h"

namespace sunder {

/// By name, what the materials of an MTL beside `source` look like; none if there is no such file,
/// and without the pictures that are not beside it. The names of such files are appended to
/// `missing`. Throws InputError for what is no MTL.
std::map<std::string, Paint> read_mtl(const MeshSource& source, const std::string& name,
                                      std::vector<std::string>& missing);

}  // namespace sunder
