// Small random scenes of yielding steel, and a simulation that records their joints and sums.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/io/state_hash.h"
#include "fracture/adjacency/compound_builder.h"
#include "tests/motion/run.h"
#include "tests/motion/spy.h"

namespace sunder::tests {

inline constexpr MaterialIndex kDuctile{0};

/// Physics that counts plastic joints and records the bodies of each joint.
class JointRecorder final : public ForwardingPhysics {
 public:
  using ForwardingPhysics::ForwardingPhysics;
  JointId join(const JointDesc& joint) override {
    const JointId id = physics_->join(joint);
    hinges += joint.kind == JointKind::kPlastic;
    joints_.push_back({id, {joint.a, joint.b}});
    return id;
  }
  void attach(JointId id, bool end_a, BodyId body,
              std::span<const std::uint32_t> quiet_tags) override {
    physics_->attach(id, end_a, body, quiet_tags);
    std::ranges::find(joints_, id, &Joined::id)->ends[end_a ? 0 : 1] = body;
  }
  void cut(JointId id) override {
    physics_->cut(id);
    std::erase_if(joints_, [&](const Joined& joined) { return joined.id == id; });
  }
  /// True if a joint has an end at a body that was removed.
  bool any_end_removed() const {
    const BodyStates states = physics_->states();
    return std::ranges::any_of(joints_, [&](const Joined& joined) {
      return !states.holds(joined.ends[0]) || !states.holds(joined.ends[1]);
    });
  }
  std::size_t joined() const { return joints_.size(); }
  std::size_t hinges = 0;  ///< Number of plastic joints made, including those made again
                           ///< when one side is merged into another body.

 private:
  struct Joined {
    JointId id;
    BodyId ends[2];
  };
  std::vector<Joined> joints_;
};

/// Simulation of yielding steel, with its joints, sums over bodies, and number of breaks.
struct BendingRun {
  SpyPhysics* spy = nullptr;
  JointRecorder* joints = nullptr;
  std::unique_ptr<Simulation> simulation;
  FramePtr frame;
  std::size_t breaks = 0;

  explicit BendingRun(const Scene& scene) {
    auto watched = std::make_unique<SpyPhysics>(solver::make_rigid_physics({scene.gravity_W}));
    spy = watched.get();
    auto joined = std::make_unique<JointRecorder>(std::move(watched));
    joints = joined.get();
    simulation =
        std::make_unique<Simulation>(scene, std::move(joined), fracture::make_pattern_breaker());
    frame = simulation->next();
  }
  void step() {
    frame = simulation->next();
    breaks += frame->breaks.size();
    for (const FrameBody& body : frame->bodies) {
      ASSERT_TRUE(body.X_WB.position.allFinite() && body.X_WB.rotation.coeffs().allFinite() &&
                  body.velocity_W.allFinite() && body.angular_velocity_W.allFinite())
          << body.key << " at " << frame->time_s;
    }
    ASSERT_FALSE(joints->any_end_removed());
    for (const Instance& instance : frame->instances)
      ASSERT_LT(instance.mesh.value, frame->meshes->size());
  }
  std::vector<std::uint64_t> states() const {
    std::vector<std::uint64_t> hashes;
    for (const FrameBody& body : frame->bodies) hashes.push_back(hash_body(body));
    return hashes;
  }
  /// Returns kinetic energy, potential energy and plastic work, in J.
  double energy_J() const {
    const FrameReport& report = frame->report;
    return report.kinetic_J + report.potential_J + report.plastic_J;
  }
};

inline Scene steel_scene(Random& random) {
  Scene scene = bare_scene(1.0 / 120, 0, 1000);
  Material& steel = scene.materials[0];
  steel = {};
  steel.name = "ductile";
  steel.density_kg_m3 = 2000;
  steel.smallest_piece_m3 = 0;  // no debris
  steel.youngs_Pa = 2e11;
  steel.yield_Pa = std::pow(10, random.uniform(5, 6.3));
  steel.hardening_Pa = random.below(2) ? steel.yield_Pa : 0;
  steel.elongation = random.below(3) ? 0.3 : 0.03;
  return scene;
}

/// Appends the box from `low` to `high`, in cells of about `cell_m`, to `parts`.
inline void add(const Vec3& low, const Vec3& high, double cell_m, bool anchored,
                std::vector<Part>& parts) {
  const Vec3 size = high - low;
  const Eigen::Vector3i n = (size / cell_m).array().round().max(1).cast<int>();
  const Vec3 cell = size.cwiseQuotient(n.cast<double>());
  for (int i = 0; i < n.prod(); ++i) {
    const Vec3 corner =
        low + cell.cwiseProduct(Vec3(i % n.x(), i / n.x() % n.y(), i / (n.x() * n.y())));
    parts.push_back({make_box(corner, corner + cell), kDuctile, anchored});
  }
}

inline Compound bar(double length_m, double width_m, double cell_m) {
  std::vector<Part> parts;
  const Vec3 half = 0.5 * Vec3(length_m, width_m, width_m);
  add(-half, half, cell_m, false, parts);
  return fracture::make_compound(std::move(parts));
}

/// Returns a scene of spinning bars that collide and are hit by balls.
inline Scene thrown_bars(std::uint64_t seed) {
  Random random(seed, 11);
  Scene scene = steel_scene(random);
  if (random.below(4) == 0) {  // the steel can also break by a pattern
    scene.materials[0].pattern.kind = PatternSpec::Kind::kVoronoi;
    scene.materials[0].pattern.cells = 8;
    scene.materials[0].toughness_J_m2 = 20000;
    scene.materials[0].impact_radius_m = 0.3;
  }
  const int bars = 2 + static_cast<int>(random.below(3));
  for (int i = 0; i < bars; ++i) {
    const double width_m = random.uniform(0.1, 0.25);
    const double cell_m = width_m / static_cast<double>(1 + random.below(2));
    Solid solid{"bar", bar(random.uniform(1.5, 3), width_m, cell_m), {}};
    solid.X_WR = {Vec3(2.0 * i, random.uniform(-1, 1), random.uniform(-1, 1)),
                  Quat(Eigen::AngleAxisd(random.uniform(0, 3), random.direction()))};
    solid.velocity_W = Vec3(random.uniform(5, 15) * (i % 2 == 0 ? 1 : -1), 0, 0);
    solid.angular_velocity_W = random.uniform(0, 6) * random.direction();
    scene.solids.push_back(std::move(solid));
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3 from(random.uniform(0, 4), random.uniform(3, 5), random.uniform(-1, 1));
    scene.balls.push_back(steel_ball(0.15, from, Vec3(0, -20, 0)));
  }
  return scene;
}

/// Returns a scene of an anchored frame that two bars fall onto and a ball hits.
inline Scene frames_and_bars(std::uint64_t seed) {
  Random random(seed, 12);
  Scene scene = steel_scene(random);
  scene.gravity_W = Vec3(0, -9.81, 0);
  scene.ground.height_m = 0;
  for (Material& material : scene.materials) material.friction = 0.5;
  const double w = 0.2, span_m = random.uniform(1, 3), height_m = random.uniform(1, 2);
  std::vector<Part> parts;
  add(Vec3(0, 0, 0), Vec3(w, w, w), w, true, parts);
  add(Vec3(0, w, 0), Vec3(w, height_m, w), w, false, parts);
  add(Vec3(0, height_m, 0), Vec3(span_m, height_m + w, w), w, false, parts);
  if (random.below(2) == 0) {
    add(Vec3(span_m - w, 0, 0), Vec3(span_m, w, w), w, true, parts);
    add(Vec3(span_m - w, w, 0), Vec3(span_m, height_m, w), w, false, parts);
  }
  scene.solids.push_back({"frame", fracture::make_compound(std::move(parts)), {}});
  for (int i = 0; i < 2; ++i) {
    Solid solid{"bar", bar(random.uniform(1, 2), 0.2, 0.1), {}};
    const Vec3 above(random.uniform(0, span_m), height_m + 1.5 + i, random.uniform(-0.5, 0.5));
    solid.X_WR = {above, Quat(Eigen::AngleAxisd(random.uniform(0, 3), random.direction()))};
    scene.solids.push_back(std::move(solid));
  }
  const Vec3 from(-3, random.uniform(0.5, height_m), 0.5 * w);
  scene.balls.push_back(steel_ball(0.2, from, Vec3(15, 0, 0)));
  return scene;
}

/// Returns a scene of a cantilever that sags by its self-weight until it has hardened enough. The
/// moment at its root is `utilisation` times the plastic moment of its section.
inline Scene sagging_beam(double utilisation) {
  Random random(1);
  Scene scene = steel_scene(random);
  Material& steel = scene.materials[0];
  const double long_m = 2, w = 0.2;
  scene.gravity_W = Vec3(0, -9.81, 0);
  const double moment_Nm = steel.density_kg_m3 * w * w * 9.81 * long_m * long_m / 2;
  steel.yield_Pa = moment_Nm / (utilisation * w * w * w / 4);
  steel.hardening_Pa = 20 * steel.yield_Pa;
  steel.elongation = 1;
  std::vector<Part> parts;
  add(Vec3(-w, 0, 0), Vec3(0, w, w), w / 2, true, parts);
  add(Vec3(0, 0, 0), Vec3(long_m, w, w), w / 2, false, parts);
  scene.solids = {{"beam", fracture::make_compound(std::move(parts)), {}}};
  return scene;
}

}  // namespace sunder::tests
