// Tests of `sunder export`: files are read back by tests/check_glb.py, which shares no code with
// the program; wrong input and full disks leave nothing behind.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/figures.h"
#include "engine/io/frame_file.h"
#include "engine/io/recording/recording.h"
#include "tests/scenes/program.h"
#include "tests/scenes/run_tables.h"

namespace sunder::tests::scene_export_test {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A recording of a wall of bricks that a ball breaks, shared by the tests.
const std::string& recording() {
  static const Folder folder;
  static const std::string file = folder / "wall.take";
  if (!fs::exists(file)) {
    std::ofstream(folder / "wall.toml")
        << "[scene]\ndescription = \"a wall\"\nduration_s = 1.5\n"
           "[[solid]]\nname = \"wall\"\nstructure = \"box\"\nsize_m = [3, 2, 0.3]\n"
           "material = \"brick\"\n"
           "[[solid]]\nname = \"crate\"\nstructure = \"box\"\nsize_m = [0.5, 0.5, 0.5]\n"
           "position = [5, 0, 0]\n"
           "[[script.shot]]\ntime_s = 0.2\nfrom = [0.2, 1.2, 4]\nat = [0.1, 1.1, 0]\n"
           "speed_m_s = 30\nradius_m = 0.2\n";
    const Outcome outcome =
        sunder("simulate " + (folder / "wall.toml") + " --quiet --take " + file);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  return file;
}

class SceneExport : public ::testing::Test {
 protected:
  std::size_t files() const {
    const fs::recursive_directory_iterator all(folder_.path());
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
  void expect_refused(const std::string& arguments, int exit_code, const std::string& said,
                      const std::string& before = "") {
    const std::size_t old = files();
    const Outcome outcome =
        sunder("export " + arguments, "cd " + folder_.path().string() + "; " + before);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(files(), old) << arguments << " left something behind";
  }

  Folder folder_;
};

/// Compares a GLB with its recording by the script; returns what the script prints.
std::string compare(const std::string& glb, const std::string& take, const std::string& options) {
  const Folder folder;
  RecordingReader reader(take);
  RunTables tables({0, 20, 44, 88});  // multiples of 4, when debris moves
  while (const FramePtr frame = reader.next()) tables.take(frame);
  EXPECT_GT(tables.bodies(), 12u);
  tables.write(folder / "poses", folder / "boxes", folder / "chips");
  const std::string said = folder / "said.txt";
  const std::string command = std::string(SUNDER_NUMPY_PYTHON) +
                              " " SUNDER_ROOT "/tests/check_glb.py " + glb + " " +
                              (folder / "poses") + " " + (folder / "boxes") + " " +
                              (folder / "chips") + " " + options + " > " + said + " 2>&1";
  const int code = std::system(command.c_str());
  EXPECT_EQ(code, 0) << bytes_of(said);
  return bytes_of(said);
}

TEST_F(SceneExport, HasThePosesOfTheRunForAnIndependentReader) {
  if (std::string(SUNDER_NUMPY_PYTHON).empty()) {
    GTEST_SKIP() << "no Python with NumPy was found when the build was configured; install "
                    "python3-numpy";
  }
  const std::string glb = folder_ / "wall.glb";
  for (const auto& [metres, degrees] : {std::pair{"0.001", "0.1"}, {"0.02", "2"}}) {
    const Outcome outcome =
        sunder("export " + recording() + " -o " + glb + " --quiet --particles --tolerance " +
               metres + " --angle " + degrees);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string said =
        compare(glb, recording(), std::string("--metres ") + metres + " --degrees " + degrees);
    EXPECT_NE(said.find("poses"), std::string::npos) << said;
    EXPECT_EQ(said.find("\n0 pieces of debris"), std::string::npos) << said;
  }
}

TEST_F(SceneExport, HasTheTexturesOfAMeshFileForAnIndependentReader) {
  if (std::string(SUNDER_NUMPY_PYTHON).empty()) {
    GTEST_SKIP() << "no Python with NumPy was found when the build was configured; install "
                    "python3-numpy";
  }
  const std::string mesh = folder_ / "box.glb", scene = folder_ / "box.toml",
                    take = folder_ / "box.take", glb = folder_ / "X.GLB", poses = folder_ / "poses",
                    said = folder_ / "said.txt";
  const std::string python = "PYTHONDONTWRITEBYTECODE=1 " SUNDER_NUMPY_PYTHON " ";
  ASSERT_EQ(
      std::system((python + SUNDER_ROOT "/tests/scenes/textured_glb.py small_box " + mesh).c_str()),
      0);
  std::ofstream(scene) << "[scene]\ndescription = \"a box\"\nduration_s = 0.5\n"
                          "[[body]]\nname = \"box\"\nmesh = \"box.glb\"\nmaterial = \"brick\"\n"
                          "position = [0.5, 1.5, -2]\n"
                          "[[script.shot]]\ntime_s = 0.1\nfrom = [0.5, 1.5, 4]\n"
                          "at = [0.5, 1.5, 0]\nspeed_m_s = 60\nradius_m = 0.3\n";
  const Outcome run = sunder("simulate " + scene + " --quiet --take " + take);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  RecordingReader reader(take);
  RunTables tables({});
  while (const FramePtr frame = reader.next()) tables.take(frame);
  EXPECT_GT(tables.bodies(), 20u);
  tables.write(poses, folder_ / "boxes", folder_ / "chips");
  const Outcome outcome = sunder("export " + take + " --quiet -o " + glb);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const int code = std::system((python + SUNDER_ROOT "/tests/check_textures.py " + mesh + " " +
                                glb + " --poses " + poses +
                                " --root box --metres 1e-4 --area 0.05 > " + said + " 2>&1")
                                   .c_str());
  EXPECT_EQ(code, 0) << bytes_of(said);
  EXPECT_NE(bytes_of(said).find("points"), std::string::npos) << bytes_of(said);
}

TEST_F(SceneExport, RecognizesARunByItsContentWhateverItsName) {
  for (const char* name : {"wall.rec", "wall.toml", "wall.frame", "WALL.TAKE"}) {
    const std::string renamed = folder_ / name;
    fs::copy_file(recording(), renamed);
    for (const char* command : {"export ", "render --size 64x36 --frames 30 "}) {
      const std::string out = folder_ / (command[0] == 'e' ? "x.glb" : "x.png");
      const Outcome outcome = sunder(command + renamed + " --quiet -o " + out);
      EXPECT_EQ(outcome.exit_code, 0) << command << name << "\n" << outcome.err;
      EXPECT_TRUE(fs::remove(out)) << command << name;
    }
  }
  const FramePtr frame = RecordingReader(recording()).next();
  write_frame(folder_ / "first.take", *frame);
  EXPECT_EQ(sunder("render --size 64x36 --quiet " + (folder_ / "first.take") + " -o " +
                   (folder_ / "x.png"))
                .exit_code,
            0);
  expect_refused("first.take -o x.glb", 2, "first.take: is a single frame");
  EXPECT_EQ(sunder("export " + recording() + " --quiet -o " + (folder_ / "run")).exit_code, 2);
  EXPECT_EQ(sunder("export " + recording() + " --quiet -o " + (folder_ / "X.GLB")).exit_code, 0);
  fs::rename(folder_ / "X.GLB", folder_ / "run.toml");
  expect_refused("run.toml -o y.glb", 2, "run.toml: has been exported");
  std::ofstream(folder_ / "text.take") << "[scene]";
  expect_refused("text.take -o y.glb", 2, "text.take: not a recording");
  expect_refused("absent.take -o y.glb", 2, "absent.take: cannot be read");
}

TEST_F(SceneExport, OfARecordingAndOfItsSceneDifferOnlyAsThePosesDo) {
  const std::string scene = fs::path(recording()).replace_extension(".toml").string();
  const auto figures = [&](const std::string& from) {
    const Outcome outcome = sunder("export " + from + " -o " + (folder_ / "x.glb") + " --json -");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return parse_figures(outcome.out, from);
  };
  const Figures from_scene = figures(scene), from_recording = figures(recording());
  for (const char* key : {"/frames", "/bodies", "/meshes", "/breaks", "/samples"}) {
    EXPECT_EQ(number_at(from_scene, key), number_at(from_recording, key)) << key;
    EXPECT_GT(number_at(from_scene, key), 0) << key;
  }
  EXPECT_LT(number_at(from_scene, "/keys"), 2 * number_at(from_scene, "/samples"));
}

TEST_F(SceneExport, HasTheSameBytesForAnyNumberOfThreads) {
  for (const char* threads : {"1", "3"}) {
    const Outcome outcome = sunder("export " + recording() + " --quiet --threads " + threads +
                                   " -o " + (folder_ / threads) + ".glb");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  EXPECT_EQ(bytes_of(folder_ / "1.glb"), bytes_of(folder_ / "3.glb"));
  EXPECT_EQ(files(), 2u);
}

TEST_F(SceneExport, OfATruncatedRecordingHasTheWholeFramesAndSaysHowMany) {
  const std::string cut = folder_ / "cut.take";
  fs::copy_file(recording(), cut);
  fs::resize_file(cut, fs::file_size(cut) * 2 / 3);
  const Outcome outcome = sunder("export " + cut + " -o " + (folder_ / "cut.glb") + " --json -");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("after frame"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("the frames before were exported"), std::string::npos) << outcome.err;
  const double frames = number_at(parse_figures(outcome.out, cut), "/frames");
  EXPECT_GT(frames, 10);
  EXPECT_LT(frames, 91);
  EXPECT_TRUE(bytes_of(folder_ / "cut.glb").starts_with("glTF"));
}

TEST_F(SceneExport, HasTheImagesAndTextureCoordinatesOfMeshFiles) {
  std::string png("\x89PNG\r\n\x1a\n");
  png += "not decoded by the export";
  std::ofstream(folder_ / "stone.png", std::ios::binary) << png;
  std::ofstream(folder_ / "t.mtl") << "newmtl m\nmap_Kd stone.png\n";
  std::ofstream(folder_ / "t.obj")
      << "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
         "vt 0 0\nvt 1 0\nvt 0 0.25\nusemtl m\n"
         "f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 1/1 4/3 3/2\nf 2/1 3/2 4/3\n";
  std::ofstream(folder_ / "t.toml") << "[scene]\ndescription = \"t\"\nduration_s = 0.1\n"
                                       "[[body]]\nname = \"stone\"\nmesh = \"t.obj\"\n";
  const Outcome glb = sunder("export " + (folder_ / "t.toml") + " -o " + (folder_ / "t.glb"));
  ASSERT_EQ(glb.exit_code, 0) << glb.err;
  const std::string bytes = bytes_of(folder_ / "t.glb");
  EXPECT_NE(bytes.find(png), std::string::npos);
  EXPECT_NE(bytes.find("TEXCOORD_0"), std::string::npos);
  EXPECT_NE(bytes.find("baseColorTexture"), std::string::npos);
  const Outcome obj = sunder("export " + (folder_ / "t.toml") + " -o " + (folder_ / "t/"));
  ASSERT_EQ(obj.exit_code, 0) << obj.err;
  EXPECT_EQ(bytes_of(folder_ / "t/image_0.png"), png);
  EXPECT_NE(bytes_of(folder_ / "t/materials.mtl").find("map_Kd image_0.png"), std::string::npos);
  EXPECT_NE(bytes_of(folder_ / "t/frame_00000.obj").find("\nvt 0 0.25\n"), std::string::npos);
}

/// Bounds and sizes of what a frame draws.
struct Drawn {
  Box box;
  std::size_t vertices = 0, faces = 0, bodies = 0;
};

Drawn drawn_in(const std::string& take, std::uint32_t frame) {
  RecordingReader reader(take);
  reader.seek(frame);
  const FramePtr at = reader.next();
  Drawn drawn;
  std::set<std::uint32_t> bodies;
  for (const Instance& instance : at->instances) {
    const FrameBody& body = at->bodies[instance.body];
    const Mesh& mesh = *(*at->meshes)[instance.mesh.value];
    bodies.insert(instance.body);
    drawn.vertices += mesh.vertices.size();
    drawn.faces += mesh.indices.size() / 3;
    for (const Mesh::Vertex& vertex : mesh.vertices) {
      const Vec3 point_T = mesh.origin_T + vertex.position.cast<double>();
      drawn.box.extend(body.X_WB * (mesh.X_RT * point_T - body.com_R));
    }
  }
  drawn.bodies = bodies.size();
  return drawn;
}

void expect_same(const Drawn& found, const Drawn& expected) {
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_EQ(found.faces, expected.faces);
  EXPECT_EQ(found.bodies, expected.bodies);
  EXPECT_LT((found.box.min - expected.box.min).norm(), 1e-5);
  EXPECT_LT((found.box.max - expected.box.max).norm(), 1e-5);
}

Drawn drawn_in_obj(const std::string& file) {
  Drawn drawn;
  std::istringstream text(bytes_of(file));
  for (std::string word; text >> word;) {
    Vec3 v;
    if (word == "v" && text >> v.x() >> v.y() >> v.z()) drawn.box.extend(v), ++drawn.vertices;
    drawn.faces += word == "f";
    drawn.bodies += word == "o";
  }
  return drawn;
}

Drawn drawn_in_ply(const std::string& file) {
  const std::string bytes = bytes_of(file);
  const auto number_after = [&](const std::string& words) {
    return std::stoul(bytes.substr(bytes.find(words) + words.size()));
  };
  Drawn drawn;
  drawn.vertices = number_after("element vertex ");
  drawn.faces = number_after("element face ");
  const std::size_t begin = bytes.find("end_header\n") + 11;
  constexpr std::size_t kVertexBytes = 31, kFaceBytes = 13;
  EXPECT_EQ(bytes.size(), begin + kVertexBytes * drawn.vertices + kFaceBytes * drawn.faces);
  std::set<std::uint32_t> keys;
  for (std::size_t v = 0; v < drawn.vertices; ++v) {
    float position[3];
    std::uint32_t key = 0;
    std::memcpy(position, bytes.data() + begin + kVertexBytes * v, sizeof position);
    std::memcpy(&key, bytes.data() + begin + kVertexBytes * v + 27, sizeof key);
    drawn.box.extend(Vec3(position[0], position[1], position[2]));
    keys.insert(key);
  }
  drawn.bodies = keys.size();
  return drawn;
}

TEST_F(SceneExport, OfMeshFilesHasOneOfEveryFrame) {
  const std::string obj = folder_ / "obj", ply = folder_ / "ply";
  for (const std::string& rest : {obj + "/ --fps 30", ply + "/ --format ply --fps 30"}) {
    const Outcome outcome = sunder("export " + recording() + " --quiet -o " + rest);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  EXPECT_EQ(files(), 2u + 46u + 46u + 1u);  // frames 0, 2, ... 90, and the materials
  for (const std::uint32_t frame : {0u, 20u, 45u}) {
    const Drawn expected = drawn_in(recording(), 2 * frame);
    char name[20];
    std::snprintf(name, sizeof name, "/frame_%05u.", frame);
    expect_same(drawn_in_obj(obj + name + "obj"), expected);
    expect_same(drawn_in_ply(ply + name + "ply"), expected);
  }
}

TEST_F(SceneExport, OfMeshFilesReplacesOnlyAFolderOfItsOwn) {
  const std::string run =
      "export " + recording() + " --quiet -o " + (folder_ / "a/") + " --frames ";
  ASSERT_EQ(sunder(run + "4").exit_code, 0);
  ASSERT_EQ(sunder(run + "2").exit_code, 0);
  EXPECT_EQ(files(), 1u + 3u + 1u);
  std::ofstream(folder_ / "a/mine.txt") << "mine";
  expect_refused(recording() + " --quiet -o a/", 2, "choose another folder");
  EXPECT_EQ(bytes_of(folder_ / "a/mine.txt"), "mine");
}

TEST_F(SceneExport, RefusesWrongInput) {
  std::ofstream(folder_ / "noise.take") << "not a recording";
  fs::create_directory(folder_ / "d.glb");
  fs::copy_file(recording(), folder_ / "run.take");
  const std::string run = "run.take --quiet -o ";
  expect_refused(run + "x", 2, "expected X.glb, or a folder");
  expect_refused(run + "x.blend", 2, "expected X.glb, or a folder");
  expect_refused(run + "run.take/", 2, "is a file");
  expect_refused(run + "x/ --format stl", 2, "expected obj or ply");
  expect_refused(run + "x/ --tolerance 0.1", 2, "remove --tolerance");
  expect_refused(run + "x/ --particles", 2, "have no debris");
  expect_refused(run + "x.glb --format obj", 2, "is for a folder");
  expect_refused(run + "d.glb", 2, "is a folder");
  expect_refused("noise.take -o x.glb", 2, "not a recording");
  expect_refused("missing.take -o x.glb", 2, "cannot be read");
  expect_refused("nothing -o x.glb", 2, "nothing");
  expect_refused(run + "run.take", 2, "would overwrite");
  expect_refused(run + "x.glb --fps 50", 2, "divisor of 60");
  expect_refused(run + "x.glb --tolerance 0", 2, "--tolerance");
  expect_refused(run + "x.glb --angle nan", 2, "--angle");
  expect_refused(run + "x.glb --frames 5000", 2, "ends with frame 90");
  expect_refused(run + "x.glb --preset draft", 2, "has been simulated");
  expect_refused(run + "x.glb --set scene.seed=2", 2, "has been simulated");
}

// A limit of 512 bytes per file has the effect of a full disk.
TEST_F(SceneExport, LeavesNothingOnAFullDisk) {
  fs::copy_file(recording(), folder_ / "run.take");
  expect_refused("run.take --quiet -o x.glb", 1, "is the disk full?", "trap '' XFSZ; ulimit -f 1;");
  expect_refused("run.take --quiet -o x/", 1, "is the disk full?", "trap '' XFSZ; ulimit -f 1;");
  expect_refused("run.take --quiet -o run.take/x.glb", 1, "cannot be written");
}

TEST_F(SceneExport, IsWrittenToADevice) {
  fs::create_symlink("/dev/full", folder_ / "full.glb");
  expect_refused(recording() + " --quiet -o full.glb", 1, "is the disk full?");
  EXPECT_TRUE(fs::is_symlink(folder_ / "full.glb"));
  fs::create_symlink("/dev/null", folder_ / "null.glb");
  EXPECT_EQ(sunder("export " + recording() + " --quiet -o " + (folder_ / "null.glb")).exit_code, 0);
}

TEST_F(SceneExport, StoppedByASignalHasTheFramesSoFar) {
  const std::string glb = folder_ / "x.glb";
  const std::string scene = fs::path(recording()).replace_extension(".toml").string();
  const Outcome outcome =
      sunder("export " + scene +
                 " --set scene.duration_s=500 --set accuracy.dt_s=1.6666666666666667e-5 -o " + glb,
             "timeout --signal=INT 3 ");
  EXPECT_NE(outcome.out.find("stopped; wrote the frames so far"), std::string::npos)
      << outcome.out << outcome.err;
  EXPECT_TRUE(bytes_of(glb).starts_with("glTF"));
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace sunder::tests::scene_export_test
