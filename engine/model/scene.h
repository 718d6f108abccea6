// Scene: all inputs of a run. Made by scenes/ from a file, or in code.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/model/collision_filter.h"
#include "engine/model/compound.h"
#include "engine/model/frame.h"
#include "engine/model/joint.h"
#include "engine/model/material.h"
#include "engine/model/path.h"

namespace sunder {

/// A compound placed in the world; static if any of its convexes is anchored.
struct Solid {
  std::string name;
  Compound compound;
  Pose X_WR;
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  CollisionFilter filter = {};  ///< Pieces inherit it.
  /// A number of the caller's, which pieces inherit.
  std::uint64_t user_data = 0;
};

/// A solid ball, which does not break.
struct Ball {
  std::string name;
  double radius_m = 0.5;
  MaterialIndex material;
  Vec3 center_W = Vec3::Zero();
  Vec3 velocity_W = Vec3::Zero();
  CollisionFilter filter = {};
  std::uint64_t user_data = 0;
};

/// Returns the volume of a ball.
inline double ball_volume_m3(double radius_m) {
  return 4.0 / 3.0 * std::numbers::pi * radius_m * radius_m * radius_m;
}
/// Returns the mass of a ball of one of the materials.
inline double ball_mass_kg(const Ball& ball, std::span<const Material> materials) {
  return materials[ball.material.value].density_kg_m3 * ball_volume_m3(ball.radius_m);
}

/// A ball that appears at a time. A wrecking ball hangs on a chain from `hangs_from_W` to its
/// surface, or, without links, on a massless rope to its centre.
struct Shot {
  double time_s = 0;
  Ball ball;
  std::optional<Vec3> hangs_from_W = std::nullopt;
  std::vector<Solid> links = {};  ///< From the top down, in a straight line, of equal length.
};

/// Position of a charge; the wave of a charge on the ground is hemispherical, and stronger.
enum class BurstKind : std::uint8_t { kGround, kAir };

/// An impulse on every face turned to the centre. Per area it decreases with the squared distance
/// left to `radius_m` and with slant; with `tnt_kg` it is that of the blast wave of a charge
/// (engine/world/act/charge.h). It breaks bodies by its energy.
struct Blast {
  double time_s = 0;
  Vec3 center_W = Vec3::Zero();
  double radius_m = 4;
  double impulse_Ns_m2 = 1000;  ///< Impulse per area at the centre.
  bool cover = false;           ///< True: nearer bodies shield those behind them.
  /// Mass of a TNT charge; replaces `radius_m` and `impulse_Ns_m2`.
  std::optional<double> tnt_kg = std::nullopt;
  BurstKind burst = BurstKind::kGround;  ///< Position of the charge.
};

/// Removes solids together with all pieces of them, or, if `roots` is empty, the anchors in a box.
struct Removal {
  double time_s = 0;
  std::vector<std::uint32_t> roots;  ///< Indices of solids, then of balls, ascending.
  Box anchors_W;
};

/// Holds bodies at a velocity by limited force, an angular velocity by limited torque, or both.
struct Drive {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  double time_s = 0, until_s = 0;
  std::vector<std::uint32_t> roots;  ///< As in Removal; a body is driven until it breaks.
  std::optional<Vec3> velocity_W;
  double force_N = 1e6;
  std::optional<Vec3> angular_velocity_W = std::nullopt;
  double torque_Nm = 1e6;
};

/// Moves solids along a path as kinematic, unbreakable bodies of infinite mass until `release_s`.
struct Move {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  /// Indices of solids; none is anchored, or jointed to a body that is not free.
  std::vector<std::uint32_t> roots;
  Path path;
  std::optional<Vec3> pivot_W;  ///< Centre of rotation at the start; none: each solid's own origin.
  double release_s = std::numeric_limits<double>::infinity();
};

/// Static triangles: hills, rocks, walls. Only the front, from which they are counter-clockwise,
/// collides and is drawn; the surface may be open.
struct GroundMesh {
  std::vector<Vec3> vertices_W;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  MaterialIndex material;  ///< Gives friction, restitution and appearance.
};

/// The infinite horizontal plane y = height_m, and the meshes of the ground.
struct Ground {
  double height_m = 0;
  double friction = 0.8;
  double restitution = 0;
  std::vector<GroundMesh> meshes;
};

/// Step and substeps, which determine accuracy and cost.
struct Accuracy {
  double dt_s = 1.0 / 120;
  int substeps = 4;
  double error_target_m = 0;  ///< Error that `substeps` were computed for; 0: they were given.
};

/// Options of the contact solver, described in solver/rigid/rigid_physics.h.
struct SolverOptions {
  int max_colors = 64;
  int sweeps = 1;
  int lanes = 0;
  bool sleeping = true;
};

/// Limits of a run. FrameReport counts when one is reached: limits, carried_over, aged. A run that
/// reaches no limit has the same states without them.
struct Limits {
  std::uint32_t bodies = 20000;
  /// Number of bodies from which the smallest fragments at rest become debris; 0: `bodies`.
  std::uint32_t ageing = 0;
  /// Approximate number of parts cut per frame: cells of a pattern, and eight for each convex in
  /// its reach. Further breaks wait for the next frame.
  std::uint32_t parts_a_frame = 1000;
  /// Bond evaluations per frame to find the bonds that load breaks; more work waits for the next.
  std::uint32_t load_work_a_frame = 40000;
  std::uint32_t debris = 20000;  ///< Pieces of debris alive at once.
  std::uint32_t dust = 4000;     ///< Puffs of dust alive at once.
  /// Bonds of a solid with a pattern above which impacts do not break it by stress: with more
  /// bonds, no plan ends within its evaluations, as half of all plans take 13 or more for each
  /// bond.
  std::uint32_t impact_bonds = 40000;
  /// Bond evaluations of a plan by stress, enough for 8,000 convexes (docs/decisions/012).
  std::uint32_t impact_evaluations = 500000;
  /// Least convexes of a brittle piece for which contact forces and impacts are evaluated by
  /// stress. Small pieces are many, and impacts break them by their pattern.
  std::uint32_t loaded_convexes = 16;
  /// Moving bodies of the cluster around an impact, the nearest first; three eighths of it if
  /// neither body of the impact can break, so that the impact can only be passed on.
  std::uint32_t cluster_bodies = 32;
  /// Events of a cluster in a step after which its impacts break nothing.
  std::uint32_t probe_events = 24;
  /// Rounds of breaks in a step: solids that break one behind the other.
  std::uint32_t break_rounds = 8;
  /// Number of awake bodies above which the smallest piece that is a body grows: its volume is
  /// multiplied by the awake bodies over this number; 0: never.
  std::uint32_t full_detail = 0;
  /// Factor on the size of the smallest pieces that are bodies (the cube root of
  /// Material::smallest_piece_m3): smaller pieces become debris.
  double piece_size_factor = 1;
  /// Factor on the least radius of debris; smaller debris is left out.
  double chip_size_factor = 1;
  /// False: impacts break only the two bodies that meet, not those that they are passed on to.
  bool passed_impacts = true;
};

/// All that a run depends on: solids, balls, ground, joints, materials, script and settings.
struct Scene {
  std::string name;
  std::string description;
  std::vector<std::string> warnings;  ///< Problems of its input files, such as missing images.
  double duration_s = 6;
  Vec3 gravity_W = Vec3(0, -9.81, 0);
  std::uint64_t seed = 1;
  bool planar = false;  ///< True: motion in the plane z = 0 only, by a two-dimensional solver.
  Accuracy accuracy;
  SolverOptions solver;
  Limits limits;
  Ground ground;
  View view;
  std::vector<ViewKey> view_keys;  ///< Keys of the camera's path; empty: the camera is fixed.
  std::vector<Material> materials;
  /// Appearances of faces of meshes from files (PolygonMesh::Face::appearance).
  std::vector<Appearance> appearances;
  std::vector<Solid> solids;
  std::vector<Ball> balls;
  std::vector<Joint> joints;
  // Script; each list is sorted by time.
  std::vector<Shot> shots;
  std::vector<Blast> blasts;
  std::vector<Removal> removals;
  std::vector<Drive> drives;
  std::vector<Move> moves;  ///< Unsorted.
};

/// Returns `name` or, if it is empty, "kind.index", as in "shot.0".
inline std::string name_or_index(const std::string& name, const char* kind, std::size_t index) {
  return name.empty() ? kind + ("." + std::to_string(index)) : name;
}

/// Returns the names of solids, balls and shots, in this order; a chain has the name of its ball.
/// Shots without a name are shot.0, shot.1 and so on, by their index among all shots.
inline std::vector<std::string> object_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Solid& solid : scene.solids) names.push_back(solid.name);
  for (const Ball& ball : scene.balls) names.push_back(ball.name);
  for (std::size_t i = 0; i < scene.shots.size(); ++i) {
    names.push_back(name_or_index(scene.shots[i].ball.name, "shot", i));
  }
  return names;
}

}  // namespace sunder
