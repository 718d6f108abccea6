// Test fixture: the made meshes as files, and real ones if they exist beside the project.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/mesh/made_meshes.h"

namespace sunder::test {

/// Writes an OBJ file.
void write_obj(const std::filesystem::path& file, const RawMesh& mesh);
/// Returns a folder with `good/` and `nasty/` that exists until the program ends.
const std::filesystem::path& made_folder();
/// Returns the file of a good mesh in the made folder.
std::filesystem::path made_file(const std::string& name);
/// Returns SUNDER_MESHES, or the folder beside the sources; the folder may not exist.
std::filesystem::path real_meshes_folder();
/// Returns the files of a set ("good" or "nasty"), sorted: made ones, then real ones if they exist.
std::vector<std::filesystem::path> meshes(const std::string& set);

}  // namespace sunder::test
