// Real meshes that benchmarks use; they are not part of the repository.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/base/random.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"

namespace sunder::bench {

/// Returns the path of a mesh of the set good/, whether or not the file exists. The folder is the
/// one that SUNDER_MESHES names, or shared/meshes beside the repository.
inline std::filesystem::path real_mesh(const std::string& name) {
  const char* folder = std::getenv("SUNDER_MESHES");
  return std::filesystem::path(folder ? folder : SUNDER_ROOT "/../shared/meshes") / "good" / name;
}

/// Reads and repairs a real mesh, once per program.
inline const RepairedMesh& repaired_real_mesh(const std::string& name) {
  static std::map<std::string, RepairedMesh> loaded;
  RepairedMesh& mesh = loaded[name];
  if (mesh.shells.empty()) mesh = repair_mesh(read_mesh(real_mesh(name)), name);
  return mesh;
}

/// Returns the vertices of the bunny, or of a bumpy ball if the bunny's file is missing.
inline const std::vector<Vec3>& bunny_points() {
  static const std::vector<Vec3> loaded = [] {
    const std::filesystem::path file = real_mesh("bunny_12k.off");
    if (std::filesystem::exists(file)) return read_mesh(file).vertices;
    std::printf("no %s: measuring a bumpy ball instead\n", file.c_str());
    Random random(1);
    std::vector<Vec3> points(6000);
    for (Vec3& p : points) p = random.uniform(0.8, 1) * random.direction();
    return points;
  }();
  return loaded;
}

}  // namespace sunder::bench
