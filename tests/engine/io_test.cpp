// Tests of frame files, state hashes and statistics.
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/base/random.h"
#include "engine/io/bytes.h"
#include "engine/io/frame_file.h"
#include "engine/io/particle_codes.h"
#include "engine/io/state_hash.h"
#include "engine/io/statistics.h"
#include "engine/io/unfinished_file.h"
#include "engine/model/piece_mesh.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

/// Path of a file of this test, which is removed at the end.
struct TemporaryFile {
  fs::path path =
      fs::temp_directory_path() / ("sunder-io-" + std::to_string(::getpid()) + "-" +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
  ~TemporaryFile() { fs::remove(path); }
};

Frame sample_frame() {
  Frame frame;
  frame.index = 7;
  frame.time_s = 7 / 60.0;
  frame.view.eye_W = Vec3(1, 2, 3);
  frame.view.ground_m = -0.5;
  frame.view.exposure = 1.5;
  frame.view.shutter = 0.5;
  frame.view.sun_color = Vec3f(1, 2, 3);
  frame.view.sun_strength = 0.25;
  Material stone;
  stone.name = "stone";
  stone.interior.texture = Texture::kConcrete;
  frame.materials = std::make_shared<const std::vector<Material>>(std::vector{stone, stone});
  auto meshes = std::make_shared<MeshStore>();
  meshes->push_back(make_ball_mesh(3, MaterialIndex(0)));  // not drawn: not written
  auto bent = std::make_shared<Mesh>(*make_ball_mesh(0.5, MaterialIndex(1)));
  bent->X_RT = {Vec3(0.3, -0.7, 11), Quat(0.5, -0.5, 0.5, 0.5)};
  meshes->push_back(bent);
  frame.meshes = meshes;
  FrameBody body;
  body.key = 42;
  body.X_WB = {Vec3(0.1, 0.2, 1e4), Quat(0.5, 0.5, 0.5, 0.5)};
  body.com_R = Vec3(1, 1, 1);
  body.asleep = true;
  frame.bodies = {body};
  frame.instances = {{MeshIndex(1), 0}};
  frame.debris = {
      {Vec3f(1.0017f, -2, 300), Quatf(0.5f, 0.5f, -0.5f, 0.5f), 0.0123f, MaterialIndex(1), 5}};
  frame.dust = {{Vec3f(-1, 2.1f, 3), Quatf(0, 1, 0, 0), 0.31f, 0.456f, MaterialIndex(0)}};
  return frame;
}

TEST(FrameFile, GivesBackWhatWasWritten) {
  const TemporaryFile file;
  const Frame frame = sample_frame();
  write_frame(file.path, frame);
  const FramePtr read = read_frame(file.path);
  EXPECT_EQ(read->index, frame.index);
  EXPECT_EQ(read->view.eye_W, frame.view.eye_W);
  EXPECT_EQ(read->view.ground_m, frame.view.ground_m);
  EXPECT_EQ(read->view.exposure, 1.5);
  EXPECT_EQ(read->view.shutter, 0.5);
  EXPECT_EQ(read->view.sun_color, Vec3f(1, 2, 3));
  EXPECT_EQ(read->view.sky_color, View().sky_color);
  EXPECT_EQ(read->view.sun_strength, 0.25);
  EXPECT_EQ(read->materials->at(1).name, "stone");
  EXPECT_EQ(read->materials->at(1).interior.texture, Texture::kConcrete);
  ASSERT_EQ(read->meshes->size(), 1u);
  const Mesh &mesh = *(*read->meshes)[0], &drawn = *(*frame.meshes)[1];
  EXPECT_EQ(mesh.indices, drawn.indices);
  EXPECT_EQ(mesh.X_RT.position, drawn.X_RT.position);
  EXPECT_EQ(mesh.X_RT.rotation.coeffs(), drawn.X_RT.rotation.coeffs());
  EXPECT_EQ(mesh.vertices.back().position, drawn.vertices.back().position);
  EXPECT_EQ(mesh.material, MaterialIndex(1));
  EXPECT_EQ(read->bodies[0].X_WB.position, frame.bodies[0].X_WB.position);
  EXPECT_TRUE(read->bodies[0].asleep);
  EXPECT_FALSE(read->bodies[0].is_static);
  EXPECT_EQ(read->instances[0].mesh, MeshIndex(0));
  ASSERT_EQ(read->debris.size(), 1u);
  EXPECT_LT((read->debris[0].position_W - frame.debris[0].position_W).norm(), 0.008f);
  EXPECT_LT(read->debris[0].rotation_WD.angularDistance(frame.debris[0].rotation_WD), 0.12f);
  EXPECT_EQ(read->debris[0].variant, 5);
  ASSERT_EQ(read->dust.size(), 1u);
  EXPECT_NEAR(read->dust[0].opacity, 0.456f, 0.01f);
}

TEST(FrameFile, KeepsInspectionDataIfTheFrameHasThem) {
  const TemporaryFile file;
  Frame frame = sample_frame();
  write_frame(file.path, frame);
  EXPECT_EQ(read_frame(file.path)->inspection, nullptr);
  auto inside = std::make_shared<Inspection>();
  inside->contacts = {{Vec3f(1, 2, 3), Vec3f(4, 5, 6)}};
  inside->boxes = {{Vec3f(-1, -2, -3), Vec3f(1, 2, 3), 0}};
  inside->islands = {0};
  inside->stresses = {0.25f};
  frame.inspection = inside;
  write_frame(file.path, frame);
  const FramePtr read = read_frame(file.path);
  ASSERT_NE(read->inspection, nullptr);
  EXPECT_EQ(read->inspection->contacts[0].point_W, Vec3f(1, 2, 3));
  EXPECT_EQ(read->inspection->contacts[0].force_W, Vec3f(4, 5, 6));
  EXPECT_EQ(read->inspection->boxes[0].min_W, Vec3f(-1, -2, -3));
  EXPECT_EQ(read->inspection->boxes[0].max_W, Vec3f(1, 2, 3));
  EXPECT_EQ(read->inspection->islands, inside->islands);
  EXPECT_EQ(read->inspection->stresses, inside->stresses);
  inside->islands = {1};  // a body that does not exist
  write_frame(file.path, frame);
  EXPECT_THROW(read_frame(file.path), InputError);
}

TEST(ParticleCodes, EncodingADecodedParticleGivesTheSameCode) {
  Random random(3);
  const auto number = [&](double largest) {
    return static_cast<float>(random.uniform(-largest, largest));
  };
  for (int i = 0; i < 2000; ++i) {
    FrameDebris chip;
    chip.position_W = Vec3f(number(1), number(100), number(5000));
    chip.rotation_WD = Quatf(number(1), number(1), number(1), number(1)).normalized();
    chip.radius_m = std::abs(number(0.2));
    chip.material = MaterialIndex(random.below(9));
    const ParticleCode code = encode(chip);
    EXPECT_EQ(encode(decode_debris(code)), code);
    FrameDust puff;
    puff.position_W = chip.position_W;
    puff.rotation_WD = chip.rotation_WD;
    puff.radius_m = std::abs(number(3));
    puff.opacity = std::abs(number(1));
    puff.material = chip.material;
    const ParticleCode puff_code = encode(puff);
    EXPECT_EQ(encode(decode_dust(puff_code)), puff_code);
  }
}

TEST(FrameFile, RefusesEveryTruncationAndCorruptionWithAnInputError) {
  const TemporaryFile file;
  write_frame(file.path, sample_frame());
  const std::vector<std::byte> good = read_file(file.path);
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::byte> bad = good;
    if (trial % 2) {
      bad.resize(random.below(static_cast<std::uint32_t>(good.size())));
    } else {
      bad[random.below(static_cast<std::uint32_t>(good.size()))] ^= std::byte{0x10};
    }
    write_file(file.path, bad);
    EXPECT_THROW(read_frame(file.path), InputError);
  }
  EXPECT_THROW(read_frame("/nowhere/at/all.frame"), InputError);
}

TEST(FrameFile, OfAnotherVersionIsRefused) {
  const TemporaryFile file;
  write_frame(file.path, sample_frame());
  std::vector<std::byte> older = read_file(file.path);
  older[7] = std::byte{'5'};
  write_file(file.path, older);
  EXPECT_THROW(read_frame(file.path), InputError);
}

TEST(StateHash, ChangesWithOneBitAndOnlyThen) {
  const auto hash_of = [](double x, bool asleep) {
    auto frame = std::make_shared<Frame>(sample_frame());
    frame->bodies[0].X_WB.position.x() = x;
    frame->bodies[0].asleep = asleep;
    StateHash hash;
    hash.take(frame);
    return hash.hex();
  };
  EXPECT_EQ(hash_of(0.1, false), hash_of(0.1, false));
  EXPECT_NE(hash_of(0.1, false), hash_of(std::nextafter(0.1, 1), false));
  EXPECT_NE(hash_of(0.1, false), hash_of(0.1, true));
  EXPECT_EQ(hash_of(0.1, false).size(), 16u);
}

TEST(StateHash, CoversDebrisAndDustAsFarAsTheyAreStored) {
  Frame frame = sample_frame();
  const std::uint64_t hash = hash_state(frame);
  frame.debris[0].position_W.x() += 0.01f;
  EXPECT_NE(hash_state(frame), hash);
  frame = sample_frame();
  frame.dust[0].opacity += 0.1f;
  EXPECT_NE(hash_state(frame), hash);
  const TemporaryFile file;
  write_frame(file.path, sample_frame());
  const FramePtr read = read_frame(file.path);
  EXPECT_EQ(hash_state(*read), hash) << "a stored frame has the hash of the frame it was";
}

TEST(Statistics, TakesQuantilesByNearestRank) {
  EXPECT_EQ(quantile({}, 0.5), 0);
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({3, 1, 2}, 1), 3);
  std::vector<double> hundred(100);
  for (int i = 0; i < 100; ++i) hundred[static_cast<std::size_t>(i)] = i + 1;
  EXPECT_EQ(quantile(hundred, 0.95), 95);
}

TEST(Statistics, WarnsOfConvexesLeftWholeAndOfLimits) {
  Statistics statistics({"house", "draft", 2, {1.0 / 60, 2}, {}, {64, 1, 8}});
  auto frame = std::make_shared<Frame>();
  frame->report.volume_m3 = 2;
  statistics.take(frame);
  const auto before = nlohmann::json::parse(statistics.json("", false));
  EXPECT_TRUE(before["warnings"].empty());
  EXPECT_EQ(before["limits_hit_by_name"], nlohmann::json::object());
  frame->report.failed = 2;
  frame->report.failed_m3 = 0.5;
  frame->report.limits[Limit::kBodies] = frame->report.limits_hit = 3;
  frame->report.limits[Limit::kLoadedConvexes] = 5;
  statistics.take(frame);
  statistics.take(frame);
  const auto json = nlohmann::json::parse(statistics.json("", false));
  EXPECT_EQ(json["fractures"]["failed"], 4);
  EXPECT_EQ(json["fractures"]["failed_volume_m3"], 1.0);
  ASSERT_EQ(json["warnings"].size(), 2u);
  EXPECT_NE(json["warnings"][0].get<std::string>().find("4 convexes were not cut, 50 %"),
            std::string::npos);
  const std::string limits = json["warnings"][1];
  EXPECT_NE(limits.find("bodies 6 times"), std::string::npos) << limits;
  EXPECT_NE(limits.find("raise limits.bodies"), std::string::npos) << limits;
  EXPECT_EQ(limits.find("loaded_convexes"), std::string::npos) << "it acts by design";
  EXPECT_EQ(json["limits_hit"], 6);
  EXPECT_EQ(json["limits_hit_by_name"], (nlohmann::json{{"bodies", 6}, {"loaded_convexes", 10}}));
}

TEST(Statistics, WarnsOfLimitsOfARecordingWhichHasNoNames) {
  EXPECT_EQ(limits_warning({}, 0), "");
  EXPECT_NE(limits_warning({}, 2).find("2 times"), std::string::npos);
}

// The residual is the change of energy that the flows do not account for, summed over frames.
TEST(Statistics, SumsEnergyFlowsAndTheirResidual) {
  Statistics statistics({"house", "draft", 2, {1.0 / 60, 2}, {}, {64, 1, 8}});
  auto frame = std::make_shared<Frame>();
  statistics.take(frame);
  frame->report.energy.gravity = 30;
  frame->report.energy.friction = 10;
  frame->report.energy_residual_J = -2;
  statistics.take(frame);
  const auto json = nlohmann::json::parse(statistics.json("", true));
  EXPECT_EQ(json["energy_flows_J"]["gravity"], 30);
  EXPECT_EQ(json["energy_flows_J"]["residual"], -2);
  EXPECT_EQ(json["energy_residual"], 0.05);
  EXPECT_EQ(json["per_frame"][0]["energy_flows_J"]["friction"], 10);
}

// Frame i takes i ms; the first is the initial one, which takes no time.
TEST(Statistics, OfARunAreItsPercentilesItsTotalsAndItsFirstAndLastMass) {
  Statistics statistics({"house", "draft", 2, {1.0 / 60, 2}, {}, {64, 1, 8}});
  for (std::uint32_t i = 0; i <= 200; ++i) {
    auto frame = std::make_shared<Frame>();
    frame->report.stage_ms[static_cast<int>(Stage::kSolve)] = i;
    frame->report.mass_kg = 1000 - i;
    frame->report.counts.bodies = i <= 150 ? i : 300 - i;
    if (i > 0) frame->report.carried_over = frame->report.limits_hit = 3;
    statistics.take(frame);
  }
  const auto json = nlohmann::json::parse(statistics.json("", false));
  for (const auto& times : {json["frame"], json["stages"]["solve"]}) {
    EXPECT_EQ(times["p50_ms"], 100);
    EXPECT_EQ(times["p95_ms"], 190);
    EXPECT_EQ(times["p99_ms"], 198);
    EXPECT_EQ(times["max_ms"], 200);
    EXPECT_EQ(times["mean_ms"], 100.5);
  }
  EXPECT_EQ(json["frames"], 200);
  EXPECT_EQ(json["mass_kg"]["initial"], 1000);
  EXPECT_EQ(json["mass_kg"]["final"], 800);
  EXPECT_EQ(json["peak"]["bodies"], 150);
  EXPECT_EQ(json["counts"]["bodies"], 100);
  EXPECT_EQ(json["fractures"]["carried_over"], 600);
  EXPECT_EQ(json["limits_hit"], 600);
}

TEST(Statistics, WritesTheKeysThatUsersRelyOn) {
  Statistics statistics({"house", "draft", 2, {1.0 / 60, 2}, {{"dust", "off"}}, {64, 1, 8}});
  auto frame = std::make_shared<Frame>(sample_frame());
  frame->report.mass_kg = 5;
  frame->report.stage_ms[static_cast<int>(Stage::kSolve)] = 2;
  frame->report.stage_cpu_ms[static_cast<int>(Stage::kSolve)] = 3;
  frame->report.penetrations_m = {0.001f, 0.002f};
  BreakEvent& event = frame->breaks.emplace_back();
  event.plan_ms = 0.5;
  event.pieces = 8;
  statistics.take(frame);
  statistics.take(frame);
  const auto json = nlohmann::json::parse(statistics.json("0123456789abcdef", true));
  for (const char* key : {"scene",
                          "preset",
                          "threads",
                          "frames",
                          "dt_s",
                          "substeps",
                          "solver",
                          "state_hash",
                          "steps",
                          "stages",
                          "frame",
                          "counts",
                          "peak",
                          "fractures",
                          "penetration_m",
                          "energy_J",
                          "energy_flows_J",
                          "energy_residual",
                          "friction_excess",
                          "momentum_residual",
                          "mass_kg",
                          "limits_hit",
                          "modelled",
                          "cpu",
                          "limits_hit_by_name",
                          "sunder_version",
                          "per_frame"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["frames"], 1);
  EXPECT_EQ(json["solver"]["lanes"], 8);
  EXPECT_EQ(json["frame"]["p50_ms"], 2.0);
  EXPECT_EQ(json["frame"]["cpu_p50_ms"], 3.0);
  for (const char* figure : {"p50_ms", "p95_ms", "p99_ms", "max_ms", "mean_ms"}) {
    EXPECT_EQ(json["stages"]["solve"][figure], 2.0) << figure;
    EXPECT_EQ(json["stages"]["solve"][std::string("cpu_") + figure], 3.0) << figure;
    EXPECT_EQ(json["stages"]["load"][figure], 0.0) << figure;
  }
  EXPECT_EQ(json["per_frame"][0]["stages_cpu_ms"]["solve"], 3.0);
  EXPECT_EQ(json["fractures"]["pieces"], 16);
  EXPECT_EQ(json["per_frame"][0]["fractures"]["events"], 1);
  EXPECT_EQ(json["per_frame"][0]["fractures"]["max_ms"], json["fractures"]["max_ms"]);
  EXPECT_NEAR(json["penetration_m"]["max"].get<double>(), 0.002, 1e-9);
  EXPECT_FALSE(nlohmann::json::parse(statistics.json("", false)).contains("state_hash"));
}

TEST(UnfinishedFile, IsRemovedUnlessItIsPublished) {
  const TemporaryFile place;
  fs::path name;
  {
    const UnfinishedFile file(place.path);
    name = file.path();
    std::ofstream(name) << "half";
    EXPECT_NE(name, place.path);
    EXPECT_EQ(name.parent_path(), place.path.parent_path());
  }
  EXPECT_FALSE(fs::exists(name));
  UnfinishedFile file(place.path);
  std::ofstream(file.path()) << "whole";
  file.publish();
  EXPECT_FALSE(fs::exists(file.path()));
  EXPECT_EQ(fs::file_size(place.path), 5u);
}

TEST(UnfinishedFile, OfAProcessIsRemovedByItsSignalHandlerWithItsWriterKilled) {
  const TemporaryFile place;
  const UnfinishedFile of_parent(place.path, ".parent");
  std::ofstream(of_parent.path()) << "half";
  const auto end = [&] {
    std::vector<std::unique_ptr<UnfinishedFile>> files;
    for (int i = 0; i < 100; ++i) {  // more than can be known at a time
      files.push_back(std::make_unique<UnfinishedFile>(place.path, "." + std::to_string(i)));
      if (i % 2 == 1) files.erase(files.begin());
    }
    std::ofstream(files.front()->path()) << "half";
    fs::create_directory(files[1]->path());
    for (int i = 0; i < 300; ++i) std::ofstream(files[1]->path() / std::to_string(i)) << "half";
    const pid_t writer = ::fork();
    if (writer == 0) {
      ::setpgid(0, 0);
      for (;;) ::pause();
    }
    ::setpgid(writer, writer);
    std::ofstream(files[2]->path()) << "half";
    files[2]->set_writer(writer);
    const bool existed = fs::exists(files[0]->path()) && fs::exists(files[1]->path() / "299");
    remove_unfinished_files();
    bool left = ::kill(writer, 0) == 0;
    for (int i = 0; i < 3; ++i)
      left = left || fs::exists(files[static_cast<std::size_t>(i)]->path());
    ::_exit(existed && !left ? 7 : 1);
  };
  EXPECT_EXIT(end(), ::testing::ExitedWithCode(7), "");
  EXPECT_TRUE(fs::exists(of_parent.path())) << "a fork removes its own files only";
}

}  // namespace
}  // namespace sunder
