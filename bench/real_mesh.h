// Paths of the real meshes that benchmarks use; these meshes are not part of the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace sunder::bench {

/// Returns the path of a mesh of the set good/, whether or not the file exists. The folder is the
/// one that SUNDER_MESHES names, or shared/meshes beside the repository.
inline std::filesystem::path real_mesh(const std::string& name) {
  const char* folder = std::getenv("SUNDER_MESHES");
  const auto beside = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
  return (folder ? std::filesystem::path(folder) : beside / "shared" / "meshes") / "good" / name;
}

}  // namespace sunder::bench
