// Tests of exported pieces by check_pieces.py, which shares no code with the program.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/io/figures.h"
#include "tests/mesh/mesh_files.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

/// Breaks a mesh and exports the pieces as a folder of OBJ files in double precision, or as GLB in
/// single precision. Checks every edge and the volume of the exported files.
void expect_closed(const std::string& mesh, const std::string& pattern, const char* output,
                   double within) {
  const Folder folder;
  const std::string out = folder / output, said = folder / "said.txt";
  const Outcome broken =
      sunder("fracture " + mesh + " --pattern " + pattern + " -o " + out + " --quiet --json -");
  ASSERT_EQ(broken.exit_code, 0) << broken.err;
  const Figures json = parse_figures(broken.out, mesh);
  std::ostringstream command;
  command.precision(17);
  command << "python3 " SUNDER_ROOT "/tests/check_pieces.py " << out << " --volume "
          << std::get<double>(json.at("/surface_volume_m3")) << " --within " << within << " > "
          << said;
  const int code = std::system(command.str().c_str());
  std::stringstream text;
  text << std::ifstream(said).rdbuf();
  EXPECT_EQ(code, 0) << mesh << " " << pattern << "\n" << text.str();
}

TEST(Exports, HaveEveryEdgeInTwoFacesAndTheVolumeOfThePieces) {
  for (const std::string name : {"frame", "knot", "pebble", "ring", "star"}) {
    const std::string file = test::made_file(name).string();
    for (const char* pattern : {"voronoi:20", "slabs:8", "grid:3", "web:6x12"})
      expect_closed(file, pattern, "pieces/", 1e-12);
    for (const char* pattern : {"voronoi:20", "web:6x12"})
      expect_closed(file, pattern, "pieces.glb", 1e-6);
  }
}

TEST(Exports, OfDamagedMeshesHaveEveryEdgeInTwoFaces) {
  for (const auto& file : test::meshes("nasty")) {
    if (file.string().starts_with(test::made_folder().string()))
      expect_closed(file.string(), "voronoi:20", "pieces/", 1e-12);
  }
}

}  // namespace
}  // namespace sunder::tests
