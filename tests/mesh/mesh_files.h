// The made meshes as files, and real ones where they lie beside the project.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/mesh/made_meshes.h"

namespace sunder::test {

/// Writes an OBJ file.
void write_obj(const std::filesystem::path& file, const RawMesh& mesh);
/// A folder with `good/` and `nasty/`, as long as the program runs.
const std::filesystem::path& made_folder();
/// The file of a good mesh that was made.
std::filesystem::path made_file(const std::string& name);
/// SUNDER_MESHES, or the folder that lies beside the sources; may not exist.
std::filesystem::path real_meshes_folder();
/// The files of a set ("good" or "nasty"): made ones, then real ones if there are any, in order.
std::vector<std::filesystem::path> meshes(const std::string& set);

}  // namespace sunder::test
