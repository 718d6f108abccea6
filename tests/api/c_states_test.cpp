// A scene that is run through the C interface has the states that it has through World.
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/statistics.h"
#include "scenes/api/sunder_c.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

constexpr double kFrame_s = 1.0 / 60;

std::string c_hash(SunderWorld world, int frames) {
  std::vector<std::uint64_t> states;
  for (int i = 0; i <= frames; ++i) {
    const SunderResult result = i > 0 ? sunder_world_step(world, kFrame_s) : SUNDER_OK;
    EXPECT_EQ(result, SUNDER_OK) << sunder_last_error();
    states.emplace_back();
    EXPECT_EQ(sunder_world_state_hash(world, &states.back()), SUNDER_OK) << sunder_last_error();
  }
  char hex[17];
  EXPECT_EQ(sunder_run_hash(states.data(), static_cast<uint32_t>(states.size()), hex), SUNDER_OK);
  return hex;
}

std::string world_hash(World& world, int frames) {
  StateHash hash;
  for (int i = 0; i <= frames; ++i) {
    if (i > 0) world.step(kFrame_s);
    hash.take(world.frame());
  }
  return hash.hex();
}

SunderWorld c_world(const char* scene, int threads) {
  SunderWorldDef def = sunder_default_world_def();
  def.scene = scene;
  def.scenes_folder = SUNDER_SCENES_FOLDER;
  def.threads = threads;
  SunderWorld world{};
  EXPECT_EQ(sunder_world_create(&def, &world), SUNDER_OK) << sunder_last_error();
  return world;
}

TEST(CStates, AreThoseOfASimulationOfASceneByName) {
  for (const char* name : {"glass", "archway"}) {
    const auto simulation = make_simulation(load_scene(name));
    StateHash hash;
    for (int i = 0; i <= 60; ++i) hash.take(simulation->next());
    const SunderWorld world = c_world(name, 1);
    EXPECT_EQ(c_hash(world, 60), hash.hex()) << name;
    EXPECT_EQ(sunder_world_destroy(world), SUNDER_OK);
  }
}

TEST(CStates, AreThoseOfAWorldThatIsActedOn) {
  World world = make_world(parse_scene("[scene]\ndescription = \"Nothing.\"\n", "nothing"));
  Part part;
  part.material = material_named(world.scene(), "brick");
  part.polyhedron = make_box({-1, 0, -0.2}, {1, 2, 0.2});
  part.anchored = 1;
  const Asset asset(make_compound({part}));
  BodyMotion motion;
  motion.X_WR.position = {0.5, 0, 0};
  const BodyKey wall = world.add(asset, motion);
  world.set_user_data(wall, 3);
  Shot shot;
  shot.ball.radius_m = 0.2;
  shot.ball.material = material_named(world.scene(), "steel");
  shot.ball.center_W = {0.4, 1, 3};
  shot.ball.velocity_W = {0, 0, -30};
  world.shoot(shot);
  const std::string expected = world_hash(world, 60);
  EXPECT_GT(world.size(), 5u);

  SunderWorld made{};
  const SunderWorldDef def = sunder_default_world_def();
  ASSERT_EQ(sunder_world_create(&def, &made), SUNDER_OK);
  SunderPartDef c_part = sunder_default_part_def();
  ASSERT_EQ(sunder_builtin_material("brick", &c_part.material), SUNDER_OK);
  c_part.box_min = {-1, 0, -0.2};
  c_part.box_max = {1, 2, 0.2};
  c_part.anchored = true;
  SunderAsset c_asset{};
  ASSERT_EQ(sunder_asset_create_parts(&c_part, 1, &c_asset), SUNDER_OK);
  SunderSolidDef solid = sunder_default_solid_def();
  solid.motion.X_WR.position = {0.5, 0, 0};
  solid.user_data = 3;
  ASSERT_EQ(sunder_world_add_solid(made, c_asset, &solid, nullptr), SUNDER_OK);
  SunderShotDef c_shot = sunder_default_shot_def();
  c_shot.ball.radius_m = 0.2;
  c_shot.ball.center_W = {0.4, 1, 3};
  c_shot.ball.velocity_W = {0, 0, -30};
  ASSERT_EQ(sunder_world_shoot(made, &c_shot), SUNDER_OK);
  EXPECT_EQ(c_hash(made, 60), expected);
  EXPECT_EQ(sunder_asset_destroy(c_asset), SUNDER_OK);
  EXPECT_EQ(sunder_world_destroy(made), SUNDER_OK);
}

/// Returns a world after 20 frames, to which a copy of a material was added.
SunderWorld world_with_a_material(SunderMaterialDef& def, SunderMaterial& added) {
  const SunderWorld world = c_world("glass", 1);
  SunderMaterial stone{};
  EXPECT_EQ(sunder_world_material(world, "stone", &stone), SUNDER_OK);
  EXPECT_EQ(sunder_world_material_def(world, stone, &def), SUNDER_OK);
  EXPECT_EQ(sunder_world_add_material(world, &def, &added), SUNDER_OK);
  c_hash(world, 20);
  return world;
}

TEST(CStates, OfACopyGoOnWithTheSameBits) {
  SunderMaterialDef def;
  SunderMaterial added{};
  const SunderWorld world = world_with_a_material(def, added);
  SunderWorld copy{};
  ASSERT_EQ(sunder_world_copy(world, &copy), SUNDER_OK) << sunder_last_error();
  const std::string expected = c_hash(world, 20);
  EXPECT_EQ(sunder_world_destroy(world), SUNDER_OK);
  EXPECT_EQ(c_hash(copy, 20), expected);
  EXPECT_EQ(sunder_world_material_def(copy, added, &def), SUNDER_OK);
  EXPECT_EQ(sunder_world_destroy(copy), SUNDER_OK);
}

TEST(CStates, OfARestoredWorldGoOnWithTheSameBits) {
  SunderMaterialDef def;
  SunderMaterial added{};
  const SunderWorld world = world_with_a_material(def, added);
  const void* bytes = nullptr;
  size_t size = 0;
  ASSERT_EQ(sunder_world_save(world, &bytes, &size), SUNDER_OK) << sunder_last_error();
  const std::vector<char> kept(static_cast<const char*>(bytes),
                               static_cast<const char*>(bytes) + size);
  const std::string expected = c_hash(world, 20);
  EXPECT_EQ(sunder_world_destroy(world), SUNDER_OK);
  SunderWorld restored{};
  ASSERT_EQ(sunder_world_restore(kept.data(), kept.size(), 1, &restored), SUNDER_OK)
      << sunder_last_error();
  EXPECT_EQ(c_hash(restored, 20), expected);
  EXPECT_EQ(sunder_world_material_def(restored, added, &def), SUNDER_OK);
  EXPECT_EQ(sunder_world_destroy(restored), SUNDER_OK);
  EXPECT_EQ(sunder_world_restore(kept.data(), kept.size() - 1, 1, &restored), SUNDER_ERROR_INPUT);
  EXPECT_EQ(std::string(sunder_last_error()),
            "sunder_world_restore(): bytes: the saved state is truncated or damaged");
}

/// A picture of one pixel, as the bytes of its PNG file.
constexpr unsigned char kPicture[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
    0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9c, 0x63, 0xf8, 0xcf, 0xc0, 0x00, 0x00, 0x03, 0x01, 0x01, 0x00, 0xc9, 0xfe, 0x92,
    0xef, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

TEST(CFrames, HaveTextureCoordinatesAndAppearancesOfMeshFiles) {
  namespace fs = std::filesystem;
  std::string name = (fs::temp_directory_path() / "sunder-c-XXXXXX").string();
  const fs::path folder = mkdtemp(name.data());
  std::ofstream(folder / "p.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(kPicture), sizeof kPicture);
  std::ofstream(folder / "box.mtl") << "newmtl m\nKd 1 0 0.5\nmap_Kd p.png\n";
  std::ofstream obj(folder / "box.obj");
  obj << "mtllib box.mtl\nusemtl m\n";
  const ConvexPolyhedron box = make_box({0, 0, 0}, {1, 2, 1});
  // Texture coordinates are x + 2 z and y - 3 z.
  for (const Vec3& v : box.vertices)
    obj << "v " << v.x() << " " << v.y() << " " << v.z() << "\nvt " << v.x() + 2 * v.z() << " "
        << v.y() - 3 * v.z() << "\n";
  for (std::size_t f = 0; f < box.faces.size(); ++f) {
    obj << "f";
    for (const std::uint32_t v : box.face_corners(f)) obj << " " << v + 1 << "/" << v + 1;
    obj << "\n";
  }
  obj.close();
  const std::string file = (folder / "scene.toml").string();
  std::ofstream(file) << "[scene]\ndescription = \"x\"\n[[body]]\nmesh = \"box.obj\"\n"
                         "material = \"stone\"\n[script]\n[[script.shot]]\ntime_s = 0.05\n"
                         "from = [-3, 1, 0]\nat = [0, 1, 0]\nspeed_m_s = 60\nradius_m = 0.3\n";
  const SunderWorld world = c_world(file.c_str(), 1);
  std::uint32_t bodies = 0;
  for (int i = 0; i < 20; ++i) ASSERT_EQ(sunder_world_step(world, kFrame_s), SUNDER_OK);
  ASSERT_EQ(sunder_world_body_count(world, &bodies), SUNDER_OK);
  EXPECT_GT(bodies, 4u) << "the box broke";

  SunderFrame frame{};
  ASSERT_EQ(sunder_world_frame(world, &frame), SUNDER_OK);
  std::size_t textured = 0, inside = 0;
  std::set<std::uint32_t> seen;
  for (std::uint32_t i = 0; i < frame.instance_count; ++i) {
    const std::uint32_t index = frame.instances[i].mesh;
    if (!seen.insert(index).second) continue;
    SunderMesh mesh{};
    ASSERT_EQ(sunder_world_mesh(world, index, &mesh), SUNDER_OK) << sunder_last_error();
    if (!mesh.uvs) continue;
    // Differences of the coordinates are those of the positions, which are relative to a point.
    std::optional<std::array<float, 4>> first;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const float *p = mesh.vertices[v].position, *uv = mesh.uvs + 2 * v;
      if (mesh.vertices[v].look < SUNDER_LOOK_FILE) {
        ++inside;
        continue;
      }
      EXPECT_EQ(mesh.vertices[v].look, static_cast<std::uint32_t>(SUNDER_LOOK_FILE));
      ++textured;
      const float x = p[0] + 2 * p[2], y = p[1] - 3 * p[2];
      if (!first) first = {{x, y, uv[0], uv[1]}};
      EXPECT_NEAR(uv[0] - (*first)[2], x - (*first)[0], 1e-4);
      EXPECT_NEAR(uv[1] - (*first)[3], y - (*first)[1], 1e-4);
    }
  }
  EXPECT_GT(textured, 20u);
  EXPECT_GT(inside, 20u);

  ASSERT_EQ(frame.appearance_count, 1u);
  SunderAppearance appearance{};
  ASSERT_EQ(sunder_world_appearance(world, 0, &appearance), SUNDER_OK) << sunder_last_error();
  EXPECT_EQ(appearance.color[0], 1);
  EXPECT_EQ(appearance.color[1], 0);
  EXPECT_TRUE(appearance.v_from_bottom);
  EXPECT_FALSE(appearance.has_gloss);
  EXPECT_EQ(appearance.gloss.bytes, nullptr);
  ASSERT_EQ(appearance.picture.size, sizeof kPicture);
  EXPECT_EQ(std::memcmp(appearance.picture.bytes, kPicture, sizeof kPicture), 0);
  EXPECT_EQ(sunder_world_destroy(world), SUNDER_OK);
  fs::remove_all(folder);
}

TEST(CThreads, RunWorldsAtOnceAndCallsForOneWorldOneAfterAnother) {
  const SunderWorld alone = c_world("glass", 1);
  const std::string expected = c_hash(alone, 30);
  EXPECT_EQ(sunder_world_destroy(alone), SUNDER_OK);

  const SunderWorld shared = c_world("glass", 1);
  std::string hashes[2];
  {
    std::vector<std::jthread> threads;
    for (std::string& hash : hashes) {
      threads.emplace_back([&hash] {
        const SunderWorld own = c_world("glass", 1);
        hash = c_hash(own, 30);
        EXPECT_EQ(sunder_world_destroy(own), SUNDER_OK);
      });
    }
    for (int i = 0; i < 2; ++i) {
      threads.emplace_back([shared] {
        for (int step = 0; step < 15; ++step)
          EXPECT_EQ(sunder_world_step(shared, kFrame_s), SUNDER_OK);
        EXPECT_EQ(sunder_world_step(shared, 7), SUNDER_ERROR_ARGUMENT);
        EXPECT_NE(std::string(sunder_last_error()).find("time_s is 7"), std::string::npos);
      });
    }
  }
  EXPECT_EQ(hashes[0], expected);
  EXPECT_EQ(hashes[1], expected);
  EXPECT_STREQ(sunder_last_error(), "") << "errors are those of a thread";
  double time_s = 0;
  EXPECT_EQ(sunder_world_time(shared, &time_s), SUNDER_OK);
  EXPECT_NEAR(time_s, 0.5, 1e-9);
  EXPECT_EQ(sunder_world_destroy(shared), SUNDER_OK);
}

TEST(CThreads, DestroyAWorldWhileAnotherThreadStepsIt) {
  for (int round = 0; round < 5; ++round) {
    const SunderWorld world = c_world("glass", 1);
    std::jthread stepper([world] {
      SunderResult result = SUNDER_OK;
      while (result == SUNDER_OK) result = sunder_world_step(world, kFrame_s);
      EXPECT_EQ(result, SUNDER_ERROR_HANDLE) << sunder_last_error();
    });
    while (true) {
      double time_s = 0;
      ASSERT_EQ(sunder_world_time(world, &time_s), SUNDER_OK);
      if (time_s > 0.05) break;
    }
    EXPECT_EQ(sunder_world_destroy(world), SUNDER_OK);
  }
}

}  // namespace
}  // namespace sunder::scenes
