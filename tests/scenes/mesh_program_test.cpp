// Tests of the commands on meshes: `sunder fracture`, `sunder vacd` and `sunder hull`.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include <gtest/gtest.h>

#include "engine/geometry/repair/repair.h"
#include "engine/io/figures.h"
#include "engine/io/mesh/mesh_reader.h"
#include "fracture/check/case_file.h"
#include "fracture/solids.h"
#include "scenes/file/text_file.h"
#include "tests/cpu_time.h"
#include "tests/mesh/mesh_files.h"
#include "tests/scenes/program.h"

namespace sunder::tests::mesh_program_test {
namespace {

Figures figures(const std::string& arguments) {
  const Outcome outcome = sunder(arguments + " --quiet --json -");
  EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  return outcome.exit_code == 0 ? parse_figures(outcome.out, arguments) : Figures();
}

std::int64_t count(const Figures& json, const char* key) {
  const auto found = json.find(key);
  EXPECT_NE(found, json.end()) << key;
  return found == json.end() ? -1 : std::get<std::int64_t>(found->second);
}

double number(const Figures& json, const char* key) {
  const auto found = json.find(key);
  EXPECT_NE(found, json.end()) << key;
  if (found == json.end()) return NAN;
  const auto* whole = std::get_if<std::int64_t>(&found->second);
  return whole ? static_cast<double>(*whole) : std::get<double>(found->second);
}

/// Checks all that a break preserves. Meshes that intersect themselves may have overlaps.
void expect_sound(const Figures& json, const std::string& what, bool may_overlap = false) {
  EXPECT_GE(count(json, "/pieces"), 1) << what;
  // A few pieces of self-intersecting meshes keep the walls between their convexes.
  const std::int64_t walled = may_overlap ? count(json, "/walled_pieces") : 0;
  EXPECT_LE(10 * walled, count(json, "/pieces")) << what;
  EXPECT_EQ(count(json, "/watertight_pieces") + walled, count(json, "/pieces")) << what;
  EXPECT_EQ(count(json, "/islands"), count(json, "/pieces")) << what;
  EXPECT_EQ(count(json, "/open_edges"), 0) << what;
  EXPECT_EQ(count(json, "/negative_volumes"), 0) << what;
  EXPECT_LE(number(json, "/volume_error"), 1e-12) << what;
  if (may_overlap) return;
  EXPECT_LE(number(json, "/overlap_volume_m3"), 1e-12 * number(json, "/volume_in_m3")) << what;
}

constexpr const char* kSolids[] = {"box:1,2,3", "column:0.5,4", "torus:1,0.3", "grid:6,5,4",
                                   "voronoi:60"};
constexpr const char* kPatterns[] = {"voronoi:30",        "voronoi:12,1", "web:4x8", "radial:7",
                                     "brick:0.5,0.2,0.3", "slabs:9",      "grid:3"};

TEST(Fracture, KeepsEveryInvariantOnAllSolidsAndPatterns) {
  for (const std::string solid : kSolids) {
    for (const std::string pattern : kPatterns) {
      const std::string command = "fracture " + solid + " --pattern " + pattern;
      expect_sound(figures(command), command);
    }
    const std::string partial =
        "fracture " + solid + " --pattern voronoi:20 --radius 0.6 --at 0,0,0";
    expect_sound(figures(partial), partial);
  }
}

TEST(Fracture, GivesItsFigures) {
  const Figures json = figures("fracture grid:4,4,4 --pattern voronoi:9 --at 2,4,2 --radius 1.2");
  for (const char* key :
       {"/input/vertices", "/input/faces", "/input/closed", "/pieces", "/convexes", "/islands",
        "/welded", "/volume_in_m3", "/volume_out_m3", "/volume_error", "/watertight_pieces",
        "/open_edges", "/negative_volumes", "/overlap_volume_m3", "/untouched_convexes",
        "/prepare_ms", "/clip_ms", "/islands_ms", "/total_ms"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  const Outcome outcome = sunder("fracture box:1,1,1 --pattern grid:2 --quiet --json -");
  EXPECT_NE(outcome.out.find("\"repairs\": []"), std::string::npos) << outcome.out;
  EXPECT_GT(count(json, "/untouched_convexes"), 30);
  EXPECT_LT(count(json, "/untouched_convexes"), 64);
}

TEST(MeshCommands, APictureIsExplodedByDefault) {
  const Folder folder;
  const auto drawn = [&](const std::string& name, const std::string& more) {
    const std::string file = folder / name;
    EXPECT_EQ(sunder("fracture box:1,1,1 --pattern grid:2 -o " + file + more).exit_code, 0);
    return scenes::read_text(file);
  };
  EXPECT_NE(drawn("a.png", ""), drawn("b.png", " --explode 0"));
  EXPECT_EQ(drawn("a.glb", ""), drawn("b.glb", " --explode 0"))
      << "exported meshes are not exploded by default";
}

TEST(Fracture, BreaksTheWholeSolidIntoAsManyPiecesAsThePatternHasCells) {
  EXPECT_EQ(count(figures("fracture box:1,2,5 --pattern voronoi:50"), "/pieces"), 50);
  EXPECT_EQ(count(figures("fracture box:1,2,5 --pattern voronoi:1"), "/pieces"), 1);
  EXPECT_EQ(count(figures("fracture box:1,2,5 --pattern grid:4"), "/pieces"), 64);
  EXPECT_EQ(count(figures("fracture column:0.2,4 --pattern slabs:11"), "/pieces"), 11);
}

TEST(Fracture, AnotherSeedBreaksDifferentlyAndTheSameSeedAlike) {
  const std::string command = "fracture column:1,2 --pattern voronoi:15 --seed ";
  const Folder folder;
  std::vector<std::vector<Vec3>> vertices;
  for (const std::string seed : {"3", "3", "4"}) {
    const std::string file = folder / "x.glb";
    EXPECT_EQ(sunder(command + seed + " -o " + file).exit_code, 0);
    vertices.push_back(read_mesh(file).vertices);
  }
  EXPECT_EQ(vertices[0], vertices[1]);
  EXPECT_NE(vertices[0], vertices[2]);
}

TEST(Fracture, RunsAPatternFileAndACase) {
  const Folder folder;
  std::ofstream(folder / "halves.obj")
      << "v -9 -9 -9\nv 0 -9 -9\nv 9 -9 -9\nv -9 9 -9\nv 0 9 -9\nv 9 9 -9\n"
         "v -9 -9 9\nv 0 -9 9\nv 9 -9 9\nv -9 9 9\nv 0 9 9\nv 9 9 9\n"
         "g left\nf 1 4 5 2\nf 7 8 11 10\nf 1 2 8 7\nf 4 10 11 5\nf 1 7 10 4\nf 2 5 11 8\n"
         "g right\nf 2 5 6 3\nf 8 9 12 11\nf 2 3 9 8\nf 5 11 12 6\nf 2 8 11 5\nf 3 6 12 9\n";
  const Figures halves = figures("fracture box:1,1,1 --pattern " + folder / "halves.obj");
  EXPECT_EQ(count(halves, "/pieces"), 2);
  expect_sound(halves, "halves");

  fracture::BreakCase example;
  example.compound = fracture::voronoi_compound(20, 1);
  example.command.pattern.kind = PatternSpec::Kind::kVoronoi;
  example.command.pattern.cells = 10;
  example.command.radius_m = 0.3;
  std::ofstream file(folder / "x.case");
  fracture::write_case(file, example);
  file.close();
  const Figures json = figures("fracture " + folder / "x.case");
  EXPECT_GT(count(json, "/pieces"), 1);
  expect_sound(json, "x.case");
}

TEST(Fracture, WritesPiecesAsGlbObjAndPng) {
  const Folder folder;
  const std::string command = "fracture box:1,1,1 --pattern grid:2 --explode 0.5 -o ";
  ASSERT_EQ(sunder(command + folder / "x.glb").exit_code, 0);
  ASSERT_EQ(sunder(command + folder / "pieces/").exit_code, 0);
  ASSERT_EQ(sunder(command + folder / "x.png").exit_code, 0);
  const RawMesh glb = read_mesh(folder / "x.glb");
  double most = 0;
  for (const Vec3& vertex : glb.vertices) most = std::max(most, vertex.maxCoeff());
  EXPECT_NEAR(most, 0.5 + 0.5 * 0.25, 1e-6) << "pieces have moved outward";
  EXPECT_TRUE(std::filesystem::exists(folder / "pieces/piece_7.obj"));
  EXPECT_TRUE(std::filesystem::exists(folder / "pieces/materials.mtl"));
  EXPECT_GT(std::filesystem::file_size(folder / "x.png"), 10000u);
}

TEST(Hull, EnclosesAndComesCloserWithMoreVertices) {
  double before = 1e9;
  for (const std::string vertices : {"4", "8", "20", "64"}) {
    const Figures json = figures("hull torus:1,0.3 --vertices " + vertices);
    EXPECT_TRUE(std::get<bool>(json.at("/encloses_all")));
    EXPECT_LE(count(json, "/vertices_used"), std::stoi(vertices));
    EXPECT_GE(count(json, "/faces"), 4);
    EXPECT_GE(number(json, "/volume_ratio"), 1 - 1e-12);
    EXPECT_LE(number(json, "/volume_ratio"), before + 1e-12);
    EXPECT_GE(number(json, "/total_ms"), 0);
    before = number(json, "/volume_ratio");
  }
  EXPECT_NEAR(before, 1, 0.02);
}

TEST(Statue, IsDecomposedBrokenAndFittedLikeAMeshFile) {
  const std::string nodes = " --nodes " SUNDER_ROOT "/scenes/meshes/statue.nodes";
  const Figures vacd = figures("vacd statue:6000" + nodes);
  EXPECT_GE(count(vacd, "/convexes"), 12);
  EXPECT_LT(number(vacd, "/hull_volume_ratio"), 1.3);
  expect_sound(figures("fracture statue:6000 --pattern voronoi:20 --radius 0.5" + nodes), "statue");
  EXPECT_LT(number(figures("hull statue:6000 --vertices 20"), "/volume_ratio"), 1.05)
      << "the ratio of the paper";
  for (const char* wrong : {"statue", "statue:999", "statue:1e5", "statue:2000000", "statue:x"}) {
    const Outcome outcome = sunder(std::string("hull --vertices 8 ") + wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong;
    EXPECT_NE(outcome.err.find("expected statue:N"), std::string::npos) << outcome.err;
  }
}

/// Returns a tetrahedron with one side missing, as OBJ text.
std::string open_tetrahedron() {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
}

/// Writes a mesh as OBJ, moved by a vector, with the digits of its doubles.
void write_obj(const std::string& file, const RawMesh& mesh, const Vec3& by) {
  std::ofstream out(file);
  out.precision(17);
  for (const Vec3& v : mesh.vertices) {
    const Vec3 at = v + by;
    out << "v " << at.x() << ' ' << at.y() << ' ' << at.z() << '\n';
  }
  for (const test::Polygon& polygon : test::polygons_of(mesh)) {
    out << 'f';
    for (const std::uint32_t corner : polygon) out << ' ' << corner + 1;
    out << '\n';
  }
}

TEST(Fracture, OfAMeshFarFromItsOriginEqualsThatAtTheOriginMoved) {
  for (const std::string& name : test::good_names()) {
    const RawMesh mesh = test::make_good(name);
    const auto pieces_at = [&](const Vec3& by, Figures& json) {
      const Folder folder;
      write_obj(folder / "mesh.obj", mesh, by);
      const std::string point = std::to_string(by.x() + 0.1) + "," + std::to_string(by.y()) + "," +
                                std::to_string(by.z());
      json = figures("fracture " + folder / "mesh.obj" + " --nodes 5 --pattern voronoi:20 --at " +
                     point + " -o " + folder / "pieces/");
      std::vector<sunder::Box> boxes;
      for (std::int64_t i = 0; i < count(json, "/pieces"); ++i) {
        std::string number = std::to_string(i);
        if (!std::filesystem::exists(folder / ("pieces/piece_" + number + ".obj")))
          number = "0" + number;
        sunder::Box& box = boxes.emplace_back();
        for (const Vec3& v : read_mesh(folder / ("pieces/piece_" + number + ".obj")).vertices)
          box.extend(Vec3(v - by));
      }
      return boxes;
    };
    Figures at_origin;
    const std::vector<sunder::Box> own = pieces_at(Vec3::Zero(), at_origin);
    for (const double far : {1e3, -1e4, 1e5}) {
      Figures json;
      const std::vector<sunder::Box> moved = pieces_at(Vec3(far, far, -far), json);
      for (const char* key : {"/pieces", "/convexes", "/watertight_pieces", "/walled_pieces"})
        EXPECT_EQ(count(json, key), count(at_origin, key)) << name << ", " << far << ", " << key;
      ASSERT_EQ(moved.size(), own.size()) << name << ", " << far;
      for (std::size_t i = 0; i < own.size(); ++i) {
        EXPECT_LT((moved[i].min - own[i].min).norm(), 1e-6) << name << ", " << far << ": " << i;
        EXPECT_LT((moved[i].max - own[i].max).norm(), 1e-6) << name << ", " << far << ": " << i;
      }
    }
  }
}

TEST(Vacd, NamesHullsThatRemainLoose) {
  const Folder folder;
  write_obj(folder / "star.obj", test::make_star(40, 0.3), Vec3::Zero());
  const Outcome loose = sunder("vacd " + folder / "star.obj");
  EXPECT_EQ(loose.exit_code, 0);
  EXPECT_NE(loose.err.find("times its volume"), std::string::npos) << loose.err;
  const Outcome told = sunder("vacd " + folder / "star.obj" + " --nodes 3");
  EXPECT_EQ(told.err, "") << "as its user wanted";
  RawMesh pegs;
  for (int i = 0; i < 7; ++i)
    test::append(pegs, test::make_block(Vec3(2 * i, 0, 0), Vec3(2 * i + 1, 1, 1), false));
  write_obj(folder / "pegs.obj", pegs, Vec3::Zero());
  const Outcome few = sunder("vacd " + folder / "pegs.obj" + " --convexes 5");
  EXPECT_NE(few.err.find("7 convexes in place of 5"), std::string::npos) << few.err;
  EXPECT_EQ(sunder("vacd " + folder / "pegs.obj" + " --convexes 7").err, "");
}

TEST(Vacd, WritesItsHullsForEngines) {
  const Folder folder;
  const Vec3 far(1e4, 0, 0);
  write_obj(folder / "ring.obj", test::make_ring(40), far);
  const std::string command = "vacd " + folder / "ring.obj" + " --hulls " + folder / "hulls";
  const Figures json = figures(command + ".obj");
  EXPECT_EQ(sunder(command + ".glb").exit_code, 0);
  EXPECT_EQ(sunder(command + ".fbx").exit_code, 2);
  for (const char* kind : {"obj", "glb"}) {
    const RawMesh hulls = read_mesh(folder / (std::string("hulls.") + kind));
    std::map<std::string, RawMesh> by_name;
    for (const RawMesh::Polygon& polygon : hulls.polygons) {
      ASSERT_LT(polygon.group, hulls.groups.size()) << kind;
      const std::vector<std::string>& names = hulls.groups[polygon.group].names;
      const auto name = std::ranges::find_if(
          names, [](const std::string& of) { return of.starts_with("UCX_ring_"); });
      ASSERT_NE(name, names.end()) << kind;
      EXPECT_TRUE(name->ends_with("-convcolonly")) << *name;
      RawMesh& hull = by_name[*name];
      hull.vertices = hulls.vertices;
      hull.polygons.push_back(
          {static_cast<std::uint32_t>(hull.corners.size()), polygon.corner_count});
      for (std::uint32_t i = 0; i < polygon.corner_count; ++i)
        hull.corners.push_back(hulls.corners[polygon.first_corner + i]);
    }
    EXPECT_EQ(static_cast<std::int64_t>(by_name.size()), count(json, "/convexes")) << kind;
    double volume_m3 = 0;
    for (auto& [name, hull] : by_name) {
      for (Vec3& vertex : hull.vertices) vertex -= far;
      const RepairedMesh closed = repair_mesh(std::move(hull), name);
      EXPECT_TRUE(closed.closed) << kind << ": " << name;
      for (const PolygonMesh& shell : closed.shells) volume_m3 += mass_properties(shell).volume_m3;
    }
    EXPECT_NEAR(volume_m3, number(json, "/hull_volume_ratio") * number(json, "/volume_m3"),
                1e-3 * volume_m3)
        << kind;
  }
}

TEST(Vacd, GivesItsFiguresAndNamesRepairs) {
  const Folder folder;
  const std::string mesh = folder / "t.obj";
  std::ofstream(mesh) << open_tetrahedron();
  const Figures json = figures("vacd " + mesh + " --nodes 2");
  for (const char* key :
       {"/input/vertices", "/input/closed", "/input/repairs/0", "/convexes", "/hull_volume_ratio",
        "/max_faces_per_convex", "/ghosts", "/split_ms", "/total_ms"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_FALSE(std::get<bool>(json.at("/input/closed")));
  EXPECT_EQ(std::get<std::string>(json.at("/input/repairs/0")), "planar holes closed (1)");
  EXPECT_NEAR(number(json, "/hull_volume_ratio"), 1, 1e-9);
  const Outcome refused = sunder("vacd " + mesh + " --repair off");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("planar holes"), std::string::npos) << refused.err;
}

TEST(Fracture, WritesThePiecesOfAFilesMesh) {
  const Folder folder;
  std::ofstream(folder / "t.obj") << open_tetrahedron();
  const std::string command = "fracture " + folder / "t.obj" + " --nodes 2 --pattern grid:2 -o ";
  for (const std::string out : {"x.glb", "x.png", "x/"}) {
    const Outcome outcome = sunder(command + folder / out);
    EXPECT_EQ(outcome.exit_code, 0) << out << "\n" << outcome.err;
  }
  EXPECT_GT(read_mesh(folder / "x.glb").polygons.size(), 8u);
}

TEST(MeshCache, OfAnotherBuildIsNotRead) {
  namespace fs = std::filesystem;
  const Folder folder;
  std::ofstream(folder / "t.obj") << open_tetrahedron();
  std::ofstream(folder / "t.toml") << "[scene]\ndescription = \"x\"\n[[body]]\nmesh = \"t.obj\"\n";
  std::ifstream file(SUNDER_PROGRAM, std::ios::binary);
  std::string program(std::istreambuf_iterator<char>(file), {});
  const std::string note("\x04\0\0\0\x14\0\0\0\x03\0\0\0GNU\0", 16);  // of the build id
  const std::size_t id = program.find(note);
  ASSERT_NE(id, std::string::npos) << "the program is linked without a build id";
  program[id + note.size()] ^= 1;
  const std::string other = folder / "sunder";
  std::ofstream(other, std::ios::binary) << program;
  fs::permissions(other, fs::perms::owner_all);
  const auto cached_files = [&] {
    return std::distance(fs::directory_iterator(folder / "cache"), fs::directory_iterator());
  };
  const std::string in_cache = "SUNDER_CACHE='" + folder / "cache" + "' ";
  const std::string check = "check " + folder / "t.toml";
  for (const int run : {0, 1}) {
    ASSERT_EQ(sunder(check, in_cache).exit_code, 0);
    EXPECT_EQ(cached_files(), 1) << run;
  }
  // The shell runs the other program, and this one for its version.
  ASSERT_EQ(sunder("--version", in_cache + "'" + other + "' " + check + " && ").exit_code, 0);
  EXPECT_EQ(cached_files(), 2);
}

TEST(MeshCommands, AScaleMakesMetresOfTheUnitsOfAFile) {
  const Folder folder;
  std::ofstream file(folder / "mm.obj");
  for (int corner = 0; corner < 8; ++corner)
    file << "v " << 200 * (corner & 1) << " " << 150 * (corner >> 1 & 1) << " "
         << 1000 * (corner >> 2) << "\n";
  file << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  file.close();
  const std::string mesh = folder / "mm.obj";
  for (const std::string& command :
       {"fracture " + mesh + " --pattern voronoi:9 --at 0.1,0.1,0.5 --radius 0.1", "vacd " + mesh,
        "hull " + mesh + " --vertices 8"}) {
    const Figures json = figures(command + " --scale 0.001");
    EXPECT_NEAR(number(json, "/input/size_m/0"), 0.2, 1e-9) << command;
    EXPECT_NEAR(number(json, "/input/size_m/1"), 0.15, 1e-9) << command;
    EXPECT_NEAR(number(json, "/input/size_m/2"), 1, 1e-9) << command;
    EXPECT_NEAR(number(json, "/input/stone_kg") / number(figures(command), "/input/stone_kg"), 1e-9,
                1e-12)
        << command;
  }
  EXPECT_GT(count(figures("fracture " + mesh +
                          " --pattern voronoi:40 --at 0.1,0.1,0.5 "
                          "--radius 0.1 --scale 0.001"),
                  "/pieces"),
            2);
  EXPECT_NE(sunder("hull " + mesh + " --vertices 8 --scale 0.001").out.find("0.2 x 0.15 x 1 m"),
            std::string::npos);
}

TEST(Vacd, TakesNodesFromAFile) {
  const Folder folder;
  std::ofstream(folder / "t.obj") << open_tetrahedron();
  std::ofstream(folder / "nodes") << "0 0 0.1 # low\n\n0 0 0.9\n0.9 0 0\n";
  const std::string command = "vacd " + folder / "t.obj" + " --nodes " + folder / "nodes";
  EXPECT_EQ(count(figures(command), "/convexes"), 3);
  std::ofstream(folder / "nodes") << "0 0 0.1\n0 zero 0.9\n";
  const Outcome wrong = sunder(command);
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("nodes:2"), std::string::npos) << wrong.err;
}

TEST(Vacd, WatchesItsNodes) {
  const Folder folder;
  std::ofstream(folder / "t.obj") << open_tetrahedron();
  std::ofstream(folder / "nodes") << "0 0 0.1\n";
  const std::string script = "(sleep 1.5; printf '0 0 0.1\\n0.9 0 0\\n' > " + folder / "nodes" +
                             ") & timeout 4 \"" SUNDER_PROGRAM "\" vacd " + folder / "t.obj" +
                             " --watch --nodes " + folder / "nodes" + " -o " + folder / "x.glb" +
                             " > " + folder / "out";
  std::system(script.c_str());
  std::ifstream in(folder / "out");
  const std::string out((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(out.find("1 convexes"), std::string::npos) << out;
  EXPECT_NE(out.find("2 convexes"), std::string::npos) << out;
  EXPECT_EQ(sunder("vacd " + folder / "t.obj" + " --watch --nodes 3").exit_code, 2);
}

constexpr const char* kWrong[] = {"fracture",
                                  "fracture box:1,1,1",
                                  "fracture --pattern voronoi:9",
                                  "fracture box:1,1 --pattern voronoi:9",
                                  "fracture box:1,1,0 --pattern voronoi:9",
                                  "fracture box:1,1,nan --pattern voronoi:9",
                                  "fracture torus:1,2 --pattern voronoi:9",
                                  "fracture grid:1.5,1,1 --pattern voronoi:9",
                                  "fracture sphere:1 --pattern voronoi:9",
                                  "fracture nowhere.obj --pattern voronoi:9",
                                  "fracture / --pattern voronoi:9",
                                  "fracture box:1,1,1 --pattern voronoi",
                                  "fracture box:1,1,1 --pattern voronoi:",
                                  "fracture box:1,1,1 --pattern voronoi:0",
                                  "fracture box:1,1,1 --pattern voronoi:-3",
                                  "fracture box:1,1,1 --pattern voronoi:2.5",
                                  "fracture box:1,1,1 --pattern voronoi:1e9",
                                  "fracture box:1,1,1 --pattern voronoi:9,99",
                                  "fracture box:1,1,1 --pattern voronoi:9,1,1",
                                  "fracture box:1,1,1 --pattern voronoi:nine",
                                  "fracture box:1,1,1 --pattern web:6",
                                  "fracture box:1,1,1 --pattern web:6x2",
                                  "fracture box:1,1,1 --pattern web:x",
                                  "fracture box:1,1,1 --pattern brick:1,1",
                                  "fracture box:1,1,1 --pattern brick:1,1,0",
                                  "fracture box:1,1,1 --pattern brick:1e-3,1e-3,1e-3",
                                  "fracture box:1,1,1 --pattern grid:1000",
                                  "fracture box:1,1,1 --pattern hexagons:4",
                                  "fracture box:1,1,1 --pattern nowhere.obj",
                                  "fracture box:1,1,1 --pattern voronoi:9 --at 1,2",
                                  "fracture box:1,1,1 --pattern voronoi:9 --at 1,2,x",
                                  "fracture box:1,1,1 --pattern voronoi:9 --at 1,2,inf",
                                  "fracture box:1,1,1 --pattern voronoi:9 --radius 0",
                                  "fracture box:1,1,1 --pattern voronoi:9 --radius -1",
                                  "fracture box:1,1,1 --pattern voronoi:9 --radius wide",
                                  "fracture box:1,1,1 --pattern voronoi:9 --seed -1",
                                  "fracture box:1,1,1 --pattern voronoi:9 --explode -1",
                                  "fracture box:1,1,1 --pattern voronoi:9 --fit loose",
                                  "fracture box:1,1,1 --pattern voronoi:9 --fit hull:3",
                                  "fracture box:1,1,1 --pattern voronoi:9 --nodes 0",
                                  "fracture box:1,1,1 --pattern voronoi:9 --nodes 99999999999",
                                  "fracture box:1,1,1 --pattern voronoi:9 --nodes nowhere.txt",
                                  "fracture box:1,1,1 --pattern voronoi:9 --repair maybe",
                                  "fracture box:1,1,1 --pattern voronoi:9 -o x.fbx",
                                  "fracture nowhere.case",
                                  "fracture /dev/null --pattern voronoi:9",
                                  "vacd box:1,1,1",
                                  "vacd nowhere.obj",
                                  "vacd nowhere.obj --convexes 0",
                                  "vacd nowhere.obj --watch",
                                  "hull box:1,1,1",
                                  "hull box:1,1,1 --vertices 3",
                                  "hull box:1,1,1 --vertices many",
                                  "hull nowhere.ply --vertices 9",
                                  "hull box:1,1,1 --vertices 8 --scale 0.001",
                                  "hull t.obj --vertices 8 --scale 0",
                                  "vacd statue:2000 --scale nan",
                                  "fracture box:1,1,1 --pattern voronoi:9 --scale 2"};

TEST(MeshCommands, WrongUseExitsWithTwoAndOneErrorLine) {
  for (const std::string wrong : kWrong) {
    const Outcome outcome = sunder(wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong << "\n" << outcome.err;
    EXPECT_NE(outcome.err, "") << wrong;
    EXPECT_LE(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
  }
}

TEST(MeshCommands, EachHasHelpForEveryFlag) {
  const std::pair<const char*, std::vector<const char*>> commands[] = {
      {"fracture",
       {"--pattern", "--at", "--radius", "--seed", "--nodes", "--convexes", "--fit", "--repair",
        "--output", "--explode", "--json", "--threads", "--quiet"}},
      {"vacd", {"--nodes", "--convexes", "--fit", "--repair", "--watch", "--output", "--json"}},
      {"hull", {"--vertices", "--json"}}};
  for (const auto& [command, flags] : commands) {
    const Outcome outcome = sunder(std::string(command) + " --help");
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* flag : flags) {
      EXPECT_NE(outcome.out.find(flag), std::string::npos) << command << " " << flag;
    }
  }
}

TEST(MeshCommands, EveryNastyMeshEndsSoonWithPiecesOrOneErrorLine) {
  for (const auto& mesh : test::meshes("nasty")) {
    const double start_s = test::cpu_time_s();
    const Outcome outcome =
        sunder("fracture " + mesh.string() + " --pattern voronoi:20 --quiet --json -");
    const double took_s = test::cpu_time_s() - start_s;
    EXPECT_LT(took_s, 10) << mesh << ": takes 5 s on an idle machine";
    if (outcome.exit_code == 0) {
      expect_sound(parse_figures(outcome.out, mesh.string()), mesh.string(), true);
    } else {
      EXPECT_EQ(outcome.exit_code, 2) << mesh;
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
  }
}

TEST(MeshCommands, EveryGoodMeshBreaksSoundly) {
  for (const auto& mesh : test::meshes("good")) {
    for (const std::string cells : {"1", "20", "100"}) {
      const std::string command = "fracture " + mesh.string() + " --pattern voronoi:" + cells;
      expect_sound(figures(command), command);
    }
  }
}

}  // namespace
}  // namespace sunder::tests::mesh_program_test
