// Tests of the quantities measured of a run, on frames made by hand.
#include "scenes/trade/facts.h"

#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

namespace sunder::scenes {
namespace {

const double kSize = std::sqrt(3.0);  // from the cube's centre to a corner

/// Returns a cube around its body's centre, with faces made by a break if `interior`.
std::shared_ptr<const Mesh> cube(bool interior) {
  auto mesh = std::make_shared<Mesh>();
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    for (int corner = 0; corner < 4; ++corner) {
      Vec3f at;
      at[axis] = face % 2 ? 1.f : -1.f;
      at[(axis + 1) % 3] = corner & 1 ? 1.f : -1.f;
      at[(axis + 2) % 3] = corner & 2 ? 1.f : -1.f;
      mesh->vertices.push_back({at, Vec3f::UnitY(), interior ? 1u : 0u});
    }
    const auto base = static_cast<std::uint32_t>(4 * face);
    for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) mesh->indices.push_back(base + i);
  }
  return mesh;
}

FrameBody body(std::uint64_t key, const Vec3& position_W, const Vec3& velocity_W = Vec3::Zero()) {
  FrameBody made;
  made.key = key;
  made.X_WB.position = position_W;
  made.velocity_W = velocity_W;
  return made;
}

/// A sequence of frames. Bodies with keys from 100 on are pieces.
class FrameSequence {
 public:
  Frame& add(std::vector<FrameBody> bodies) {
    Frame& frame = *frames_.emplace_back(std::make_shared<Frame>());
    frame.index = frames_.size() - 1;
    frame.meshes = meshes_;
    for (const FrameBody& one : bodies) {
      const auto index = static_cast<std::uint32_t>(frame.bodies.size());
      frame.instances.push_back({MeshIndex(one.key < 100 ? 0 : 1), index});
      frame.bodies.push_back(one);
    }
    frame.report.mass_kg = 10;
    return frame;
  }
  Facts facts() const {
    FactsSink sink;
    for (const auto& frame : frames_) sink.take(frame);
    sink.finish();
    return sink.facts();
  }

 private:
  std::shared_ptr<const MeshStore> meshes_ =
      std::make_shared<MeshStore>(MeshStore{cube(false), cube(true)});
  std::vector<std::shared_ptr<Frame>> frames_;
};

using Samples = std::vector<double>;

TEST(Facts, OfNoFramesAreEmpty) { EXPECT_TRUE(FrameSequence().facts().samples.empty()); }

TEST(Facts, ABodyNearItsFirstPositionDriftsAndOthersRunOut) {
  FrameSequence run;
  run.add({body(1, {-3, 0, 0}), body(2, {0, 0, 0}), body(3, {3, 0, 0})});
  run.add({body(1, {-3, -0.1, 0}), body(3, {3, 0, 4}), body(100, {0, 5, -2})}).breaks.resize(1);
  Facts facts = run.facts();
  EXPECT_NEAR(facts.samples["drift m"].at(0), 0.1, 1e-12);
  EXPECT_EQ(facts.samples["drift m"].size(), 1u);
  EXPECT_EQ(facts.samples["drift largest m"], facts.samples["drift m"]);
  EXPECT_NEAR(facts.samples["surface in place share"].at(0), 1.0 / 3, 1e-12);
  EXPECT_EQ(facts.samples["run-out m"], (Samples{5, 2}));
  EXPECT_EQ(facts.samples["pieces"], Samples{1});
  EXPECT_NEAR(facts.samples["size of pieces m"].at(0), kSize, 1e-6);
}

TEST(Facts, ABodyThatLosesAPieceIsInPlaceThoughItsCentreMoves) {
  FrameSequence run;
  run.add({body(1, {0, 0, 0})});
  FrameBody left = body(1, {0.5, 0, 0});
  left.com_R = Vec3(0.5, 0, 0);
  left.is_static = true;
  run.add({left});
  Facts facts = run.facts();
  EXPECT_EQ(facts.samples["surface in place share"], Samples{1});
  EXPECT_EQ(facts.samples.count("drift m"), 0u);  // the only body is static
  EXPECT_EQ(facts.samples.count("run-out m"), 0u);
}

TEST(Facts, TheExitSpeedIsThatAFifthOfASecondAfterTheImpact) {
  FrameSequence run;
  const auto flies = [&](double speed_m_s, std::uint64_t key = 9) {
    return body(key, Vec3::Zero(), Vec3(0, 0, -speed_m_s));
  };
  run.add({body(1, {9, 0, 0})});
  run.add({body(1, {9, 0, 0}), flies(20)});
  run.add({body(1, {9, 0, 0}), flies(19)});  // slowed by air or gravity, not by an impact
  for (int i = 0; i <= 12; ++i) run.add({body(1, {9, 0, 0}), flies(15 - i * 0.5)});
  for (int i = 0; i < 5; ++i) run.add({body(1, {9, 0, 0}), flies(1)});
  Facts facts = run.facts();
  EXPECT_EQ(facts.samples["exit speed m/s"], Samples{9});
  EXPECT_EQ(facts.samples["pieces"], Samples{0});
}

TEST(Facts, AFastPieceIsNoStriker) {
  FrameSequence run;
  run.add({body(1, Vec3::Zero()), body(2, Vec3::Zero(), {6, 0, 0})});
  run.add({body(1, Vec3::Zero()), body(100, Vec3::Zero(), {50, 0, 0})}).breaks.resize(1);
  Facts facts = run.facts();
  EXPECT_EQ(facts.samples["exit speed m/s"],
            Samples{6});  // of body 2, which was a striker and is gone
  EXPECT_EQ(facts.samples["pieces"], Samples{1});
}

TEST(Facts, EnergyIsPerMassAndGainsCountOnlyWithoutShotsAndBreaks) {
  FrameSequence run;
  const auto energy = [&](double kinetic_J, std::vector<FrameBody> bodies) -> Frame& {
    Frame& frame = run.add(std::move(bodies));
    frame.report.kinetic_J = kinetic_J;
    frame.report.potential_J = 100;
    frame.report.plastic_J = 10;
    return frame;
  };
  energy(0, {body(1, Vec3::Zero())});
  energy(50, {body(1, Vec3::Zero()), body(2, Vec3::Zero())});  // a shot
  energy(40, {body(1, Vec3::Zero()), body(2, Vec3::Zero())});
  energy(43, {body(1, Vec3::Zero()), body(2, Vec3::Zero())});
  energy(90, {body(1, Vec3::Zero()), body(2, Vec3::Zero())}).breaks.resize(1);
  Facts facts = run.facts();
  EXPECT_NEAR(facts.samples["energy gained J/kg"].at(0), 0.3, 1e-12);
  EXPECT_NEAR(facts.samples["energy after 1/4 J/kg"].at(0), 16, 1e-12);
  EXPECT_NEAR(facts.samples["energy after 1/2 J/kg"].at(0), 15, 1e-12);
  EXPECT_NEAR(facts.samples["energy after 1 J/kg"].at(0), 20, 1e-12);
}

TEST(Facts, PenetrationIsOfAllContactsOfTheRun) {
  FrameSequence run;
  for (int i = 0; i < 10; ++i) {
    Frame& frame = run.add({body(1, Vec3::Zero())});
    frame.report.penetrations_m.assign(20, 0.001f * static_cast<float>(i));
    frame.report.momentum_residual = i == 5 ? 1e-3 : 1e-6;
  }
  Frame& last = run.add({body(1, Vec3::Zero())});
  last.report.penetrations_m = {0.5f};
  Facts facts = run.facts();
  EXPECT_NEAR(facts.samples["penetration p99 m"].at(0), 0.009, 1e-6);
  EXPECT_NEAR(facts.samples["penetration worst m"].at(0), 0.5, 1e-6);
  EXPECT_EQ(facts.samples["momentum residual share"], Samples{1e-3});
}

TEST(Facts, MotionIsSampledEveryHalfSecond) {
  FrameSequence run;
  for (int i = 0; i < 100; ++i) {
    FrameBody spins = body(1, Vec3::Zero(), Vec3(0.01 * i, 0, 0));
    spins.angular_velocity_W = Vec3(0, 0, 2);
    FrameBody wall = body(2, Vec3::Zero());
    wall.is_static = true;
    run.add({spins, wall});
  }
  Facts facts = run.facts();
  ASSERT_EQ(facts.samples["speed m/s"].size(), 3u);
  EXPECT_NEAR(facts.samples["speed m/s"][2], 0.9, 1e-12);
  EXPECT_EQ(facts.samples["spin rad/s"], (Samples{2, 2, 2}));
}

TEST(Facts, HaveAHashOfTheStates) {
  FrameSequence run, other;
  run.add({body(1, Vec3::Zero())});
  other.add({body(1, Vec3(1e-9, 0, 0))});
  EXPECT_EQ(run.facts().state_hash.size(), 16u);
  EXPECT_EQ(run.facts().state_hash, run.facts().state_hash);
  EXPECT_NE(run.facts().state_hash, other.facts().state_hash);
}

}  // namespace
}  // namespace sunder::scenes
