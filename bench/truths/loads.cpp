// Validation of slow loads and rotation of beams: breaking load and place of the break.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bench/truths/truth.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::truths {
namespace {

constexpr double kStrength_Pa = 1e6, kWidth_m = 0.2, kLength_m = 2;
constexpr int kAlong = 20, kAcross = 2;  // convexes of a beam
constexpr MaterialIndex kBrittle{0}, kSteel{1};

/// Returns a scene with two materials only: material 0 breaks under load, material 1 does not.
Scene empty_scene(const Preset& preset, double brittle_kg_m3, double steel_kg_m3) {
  Scene scene;
  Material brittle, steel;
  brittle.name = "brittle", steel.name = "steel";
  brittle.density_kg_m3 = brittle_kg_m3, steel.density_kg_m3 = steel_kg_m3;
  brittle.tensile_Pa = kStrength_Pa;
  scene.materials = {brittle, steel};
  scene.accuracy = {preset.dt_s, preset.substeps};
  scene.solver.sweeps = preset.sweeps;
  scene.ground.height_m = -1000;
  scene.limits.load_work_a_frame = 1000000000;
  scene.duration_s = 1;
  return scene;
}

void add_boxes(const Vec3& min, const Vec3& size, int along, bool anchored, MaterialIndex material,
               std::vector<Part>& parts) {
  const Vec3 cell = size.cwiseQuotient(Vec3(along, kAcross, kAcross));
  for (int i = 0; i < along * kAcross * kAcross; ++i) {
    const Vec3 at(i / (kAcross * kAcross), i / kAcross % kAcross, i % kAcross);
    const Vec3 corner = min + cell.cwiseProduct(at);
    parts.push_back({make_box(corner, corner + cell), material, anchored});
  }
}

/// Returns a beam along x from the origin; if `held`, with an anchored part at x < 0.
Solid beam(bool held, MaterialIndex material = kBrittle) {
  std::vector<Part> parts;
  const Vec3 size(kLength_m, kWidth_m, kWidth_m);
  if (held) add_boxes(Vec3(-0.1, 0, 0), Vec3(0.1, kWidth_m, kWidth_m), 1, true, material, parts);
  add_boxes(Vec3::Zero(), size, kAlong, false, material, parts);
  return {"beam", scenes::make_compound(std::move(parts)), {}};
}

/// Number of bodies that a second of simulation adds.
std::size_t new_bodies(Scene scene) {
  const auto simulation = scenes::make_simulation(std::move(scene));
  std::size_t first = 0, last = 0;
  while (const FramePtr frame = simulation->next()) {
    last = frame->bodies.size();
    if (frame->index == 0) first = last;
  }
  return last - first;
}

/// Returns the least load that breaks, divided by theory; 1.49 if no load up to 1.5 does.
double least_breaking_load(const std::function<bool(double)>& breaks) {
  return threshold(0.5, 1.5, 6, breaks);
}

enum class Attachment { kResting, kRope, kFixed, kRootInJoint };

/// Returns true if a cantilever breaks under `load_factor` times the load of theory, whose stress
/// at the root is 6 F a/(b h²). A joint at the root holds the first convexes, so the root is at
/// their end.
bool cantilever_breaks(const Preset& preset, Attachment how, double load_factor) {
  const bool in_joint = how == Attachment::kRootInJoint;
  const double side_m = 0.2, arm_m = kLength_m - 0.5 * side_m;
  const double root_m = in_joint ? kLength_m / kAlong : 0;
  const double force_N =
      load_factor * kStrength_Pa * std::pow(kWidth_m, 3) / (6 * (arm_m - root_m));
  Scene scene = empty_scene(preset, 1, force_N / kG / std::pow(side_m, 3));
  scene.solids = {beam(!in_joint)};
  const Vec3 half = Vec3::Constant(0.5 * side_m);
  Vec3 center(arm_m, -0.3, 0.5 * kWidth_m);
  if (how == Attachment::kResting) center.y() = kWidth_m + 0.5 * side_m;
  scene.solids.push_back(
      {"load", scenes::make_compound({{make_box(-half, half), kSteel}}), {center, {}}});
  scene.solids.back().X_WR.rotation.setIdentity();
  Joint joint;
  joint.a = 0, joint.b = 1;
  joint.kind = how == Attachment::kRope ? JointKind::kRope : JointKind::kFixed;
  joint.at_W = Vec3(arm_m, 0.05, 0.5 * kWidth_m);
  joint.to_W = center;
  if (how != Attachment::kResting) scene.joints = {joint};
  if (in_joint) {
    Joint root;
    root.kind = JointKind::kFixed;
    root.a = 0;
    root.at_W = Vec3(0, 0.5 * kWidth_m, 0.5 * kWidth_m);
    scene.joints.push_back(root);
  }
  return new_bodies(std::move(scene)) > 0;
}
Measure cantilever(Attachment how) {
  return [=](const Preset& p) {
    return least_breaking_load(
               [&](double load_factor) { return cantilever_breaks(p, how, load_factor); }) -
           1;
  };
}

/// Returns true if a bar with a joint at each end breaks under a weight; the stress is F/A
/// throughout.
bool hanging_bar_tears(const Preset& preset, JointKind kind, double load_factor) {
  const double side_m = 0.3, force_N = load_factor * kStrength_Pa * kWidth_m * kWidth_m;
  Scene scene = empty_scene(preset, 100, force_N / kG / std::pow(side_m, 3));
  scene.gravity_W = Vec3(kG, 0, 0);
  scene.solids = {beam(false)};
  const Vec3 half = Vec3::Constant(0.5 * side_m);
  const Vec3 top(0, 0.5 * kWidth_m, 0.5 * kWidth_m), foot = top + Vec3(kLength_m, 0, 0);
  const Vec3 center = foot + Vec3(0.3, 0, 0);
  scene.solids.push_back({"load",
                          scenes::make_compound({{make_box(-half, half), kSteel}}),
                          {center, Quat::Identity()}});
  Joint above, below;
  above.kind = kind;
  above.a = 0;
  above.at_W = top;
  above.to_W = top - Vec3(0.5, 0, 0);
  below.kind = kind;
  below.a = 0, below.b = 1;
  below.at_W = foot;
  below.to_W = center;
  scene.joints = {above, below};
  return new_bodies(std::move(scene)) > 0;
}
Measure hanging_bar(JointKind kind) {
  return [=](const Preset& p) {
    return least_breaking_load(
               [&](double load_factor) { return hanging_bar_tears(p, kind, load_factor); }) -
           1;
  };
}

constexpr const char* kStruckCantilever = R"(
[scene]
description = "What strikes the tip of a cantilever, and what the cantilever is made of."
duration_s = 1
[limits]
dust = 0
[[solid]]
structure = "box"
material = "concrete"
[[ball]]
position = [1.9, 0.31, 0.1]
velocity = [0, -8, 0]
radius_m = 0.1
)";

constexpr double kDensity = 2000;

Measure spinning(const std::function<Solid()>& solid, double theory_rad_s) {
  return [=](const Preset& preset) {
    const double load_factor = least_breaking_load([&](double stress) {
      Scene scene = empty_scene(preset, kDensity, kDensity);
      scene.gravity_W.setZero();
      scene.solids = {solid()};
      scene.solids[0].angular_velocity_W = Vec3(0, std::sqrt(stress) * theory_rad_s, 0);
      return new_bodies(std::move(scene)) > 0;
    });
    return load_factor - 1;
  };
}

Solid rod() { return beam(false); }

/// Returns a rod of fewer convexes than fragments need for an evaluation of contact forces.
Solid short_rod() {
  std::vector<Part> parts;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(0.25 * i, 0, 0);
    parts.push_back({make_box(corner, corner + Vec3(0.25, kWidth_m, kWidth_m)), kBrittle});
  }
  return {"rod", scenes::make_compound(std::move(parts)), {}};
}

/// Returns a ring of wedges about y with a mean radius of 1 m.
Solid ring() {
  std::vector<Part> parts;
  constexpr int kWedges = 24;
  for (int i = 0; i < kWedges; ++i) {
    std::vector<Vec3> corners;
    for (int end = 0; end < 2; ++end) {
      const SinCos a = sin_cos(2 * kPi * ((i + end) % kWedges) / kWedges);
      for (const double radius_m : {0.95, 1.05})
        for (const double y : {-0.05, 0.05})
          corners.emplace_back(radius_m * a.cos, y, radius_m * a.sin);
    }
    parts.push_back({make_hull(corners), kBrittle});
  }
  return {"ring", scenes::make_compound(std::move(parts)), {}};
}

/// Remaining length of a concrete cantilever, relative to the whole, after a steel ball hits its
/// tip. The moment is largest at the clamp.
double remaining_length(const Preset& preset) {
  Scene scene = scenes::parse_scene(kStruckCantilever, "blow.toml", {preset.name, {}});
  const MaterialIndex concrete = scene.solids[0].compound.convexes[0]->material;
  scene.solids = {beam(true, concrete)};
  const auto simulation = scenes::make_simulation(std::move(scene));
  FramePtr last;
  while (const FramePtr frame = simulation->next()) last = frame;
  double end_m = 0;
  for (const Instance& instance : last->instances) {
    if (last->bodies[instance.body].key != 0) continue;
    const Mesh& mesh = *(*last->meshes)[instance.mesh.value];
    for (const Mesh::Vertex& vertex : mesh.vertices)
      end_m = std::max(end_m, mesh.origin_T.x() + static_cast<double>(vertex.position.x()));
  }
  return end_m / kLength_m;
}

}  // namespace

Truths load_truths() {
  const char* beams = "σ = 6 F a/(b h²)";
  const double rod_rad_s = std::sqrt(8 * kStrength_Pa / kDensity) / kLength_m;
  const double ring_rad_s = std::sqrt(kStrength_Pa / kDensity);
  return {
      truth(34, "cantilever under a load that rests on it: limit", "", beams, 0.1,
            cantilever(Attachment::kResting), {0.083, 0.083, 0.083, 0.059}),
      truth(34, "cantilever under a load on a rope: limit", "", beams, 0.1,
            cantilever(Attachment::kRope), {0.083, 0.083, 0.083, 0.059}),
      truth(34, "cantilever under a load in a fixed joint: limit", "", beams, 0.1,
            cantilever(Attachment::kFixed), {0.083, 0.083, 0.083, 0.059}),
      truth(34, "cantilever whose root is in a fixed joint: limit", "", beams, 0.1,
            cantilever(Attachment::kRootInJoint), {0.083, 0.083, 0.083, 0.113}),
      truth(34, "bar between two ropes: limit", "", "σ = F/A", 0.1, hanging_bar(JointKind::kRope),
            {0.059, 0.083, 0.083, 0.059}),
      truth(34, "bar between two fixed joints: limit", "", "σ = F/A", 0.1,
            hanging_bar(JointKind::kFixed), {0.059, 0.083, 0.083, 0.059}),
      truth(34, "bar between two hinges: limit", "", "σ = F/A", 0.1, hanging_bar(JointKind::kHinge),
            {0.012, 0.012, 0.012, 0.012}),
      truth(35, "spinning rod: stress when it bursts", "", "σ = ρ ω² L²/8", 0.1,
            spinning(rod, rod_rad_s), {0.012, 0.012, 0.012, 0.012}),
      truth(35, "spinning rod of 8 boxes: stress when it bursts", "", "σ = ρ ω² L²/8", 0.1,
            spinning(short_rod, rod_rad_s), {0.012, 0.012, 0.012, 0.012}),
      truth(35, "spinning ring: stress when it bursts", "", "σ = ρ ω² r²", 0.1,
            spinning(ring, ring_rad_s), {0.036, 0.036, 0.036, 0.036}),
      truth(36, "cantilever struck at its tip: length left standing", "", "largest moment", 0.1,
            remaining_length, {0.01, 0.01, 0.01, 0.01}),
  };
}

}  // namespace sunder::truths
