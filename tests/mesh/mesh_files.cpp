#include "tests/mesh/mesh_files.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iomanip>

#include "tests/mesh/made_meshes.h"
#include "tests/mesh/mesh_damage.h"

namespace sunder::test {

namespace fs = std::filesystem;

void write_obj(const fs::path& file, const RawMesh& mesh) {
  std::ofstream out(file);
  out << std::setprecision(17);
  for (const Vec3& v : mesh.vertices) out << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const Polygon& corners : polygons_of(mesh)) {
    out << "f";
    for (const std::uint32_t corner : corners) out << " " << corner + 1;
    out << "\n";
  }
}

const fs::path& made_folder() {
  struct Made {
    fs::path folder = fs::temp_directory_path() / ("sunder-meshes-" + std::to_string(::getpid()));
    Made() {
      fs::create_directories(folder / "good");
      fs::create_directories(folder / "nasty");
      for (const std::string& name : good_names())
        write_obj(folder / "good" / (name + ".obj"), make_good(name));
      for (int d = 0; d < kDamages; ++d) {
        const auto damage = static_cast<Damage>(d);
        const RawMesh whole = make_good(d % 3 == 0 ? "star" : d % 3 == 1 ? "pebble" : "frame");
        write_obj(folder / "nasty" / (std::string(name_of(damage)) + ".obj"),
                  damaged(whole, damage, 1));
      }
      for (std::uint64_t seed = 1; seed <= 3; ++seed)
        write_obj(folder / "nasty" / ("lattice_" + std::to_string(seed) + ".obj"),
                  make_lattice_mesh(seed));
    }
    ~Made() {
      std::error_code error;
      fs::remove_all(folder, error);
    }
  };
  static const Made kMade;
  return kMade.folder;
}

fs::path made_file(const std::string& name) { return made_folder() / "good" / (name + ".obj"); }

fs::path real_meshes_folder() {
  if (const char* folder = std::getenv("SUNDER_MESHES")) return folder;
  return SUNDER_MESHES_FOLDER;
}

std::vector<fs::path> meshes(const std::string& set) {
  std::vector<fs::path> files;
  for (const fs::path& folder : {made_folder(), real_meshes_folder()}) {
    const auto first = static_cast<std::ptrdiff_t>(files.size());
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / set, error))
      files.push_back(entry.path());
    std::sort(files.begin() + first, files.end());
  }
  return files;
}

}  // namespace sunder::test
