// The real meshes that benchmarks measure, which are not part of the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace sunder::bench {

/// Where a mesh of the set good/ lies if it is there: in the folder that SUNDER_MESHES names, or in
/// shared/meshes beside the repository.
inline std::filesystem::path real_mesh(const std::string& name) {
  const char* folder = std::getenv("SUNDER_MESHES");
  const auto beside = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
  return (folder ? std::filesystem::path(folder) : beside / "shared" / "meshes") / "good" / name;
}

}  // namespace sunder::bench
