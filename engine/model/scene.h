// A scene: everything a run starts from. Made by scenes/ from a file, or by hand in code.
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

#include "engine/model/compound.h"
#include "engine/model/frame.h"
#include "engine/model/joint.h"
#include "engine/model/material.h"
#include "engine/model/path.h"

namespace sunder {

/// A compound placed in the world; held in place if any of its convexes is anchored.
struct Solid {
  std::string name;
  Compound compound;
  Pose X_WR;
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
};

struct Ball {
  std::string name;
  double radius_m = 0.5;
  MaterialIndex material;
  Vec3 center_W = Vec3::Zero();
  Vec3 velocity_W = Vec3::Zero();
};

inline double ball_volume_m3(double radius_m) {
  return 4.0 / 3.0 * std::numbers::pi * radius_m * radius_m * radius_m;
}
inline double ball_mass_kg(const Ball& ball, std::span<const Material> materials) {
  return materials[ball.material.value].density_kg_m3 * ball_volume_m3(ball.radius_m);
}

/// A ball that appears at a time. A wrecking ball hangs on a chain that reaches from where it hangs
/// to its surface, or, without links, on a rope without weight to its centre.
struct Shot {
  double time_s = 0;
  Ball ball;
  std::optional<Vec3> hangs_from_W = std::nullopt;
  std::vector<Solid> links = {};  ///< From the top down, in one line and equally long.
};

/// Place of a charge: the wave of one on the ground is hemispherical, and stronger.
enum class BurstKind : std::uint8_t { kGround, kAir };

/// An impulse on every face that sees the centre: per square metre, falling with the square of the
/// distance left to `radius_m`, and with slant; or, with `tnt_kg`, that of the wave of such a
/// charge (engine/world/act/charge.h). It breaks what its energy can.
struct Blast {
  double time_s = 0;
  Vec3 center_W = Vec3::Zero();
  double radius_m = 4;
  double impulse_Ns_m2 = 1000;  ///< At the centre.
  bool cover = false;           ///< Whether what is nearer to the centre covers what is behind it.
  /// Mass of a charge of TNT, in place of `radius_m` and `impulse_Ns_m2`.
  std::optional<double> tnt_kg = std::nullopt;
  BurstKind burst = BurstKind::kGround;  ///< Of the charge.
};

/// Supports go: solids with all that came off them, or else the anchors in a box.
struct Removal {
  double time_s = 0;
  std::vector<std::uint32_t> roots;  ///< Indices of solids, then of balls, ascending.
  Box anchors_W;
};

/// What holds a body's velocity as far as the force goes, or its spin as far as the torque does, or
/// both.
struct Drive {
  double time_s = 0, until_s = 0;
  std::vector<std::uint32_t> roots;  ///< As in Removal; driven until they break.
  std::optional<Vec3> velocity_W;
  double force_N = 1e6;
  std::optional<Vec3> angular_velocity_W = std::nullopt;
  double torque_Nm = 1e6;
};

/// What goes its path whatever is in its way: of infinite mass, and not to be broken, until it is
/// let go.
struct Move {
  std::vector<std::uint32_t>
      roots;  ///< Of solids; none is anchored, or jointed to what is not free.
  Path path;
  std::optional<Vec3>
      pivot_W;  ///< What its turns are about, where it stood; or each its own origin.
  double release_s = std::numeric_limits<double>::infinity();
};

/// Triangles that stand for good: hills, rocks, walls. They are met from the front, seen from which
/// they run counter-clockwise, and seen from there; the surface may be open.
struct GroundMesh {
  std::vector<Vec3> vertices_W;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  MaterialIndex material;  ///< Its friction, its bounce and its look.
};

/// The horizontal plane y = height_m, without end, and what stands on it.
struct Ground {
  double height_m = 0;
  double friction = 0.8;
  double restitution = 0;
  std::vector<GroundMesh> meshes;
};

/// Speed against accuracy.
struct Accuracy {
  double dt_s = 1.0 / 120;
  int substeps = 4;
  double error_target_m = 0;  ///< What `substeps` were worked out for; 0: they were given.
};

/// How contacts are solved; what each means is in solver/rigid/rigid_physics.h.
struct SolverDials {
  int max_colors = 64;
  int sweeps = 1;
  int lanes = 0;
  bool sleeping = true;
};

struct Limits {
  std::uint32_t bodies = 20000;
  /// From so many bodies on, the smallest fragments at rest become debris; 0: when room is short.
  std::uint32_t ageing = 0;
  /// Parts to cut, about: cells of a pattern, and eight for each convex in its reach; breaks beyond
  /// it wait a frame.
  std::uint32_t parts_a_frame = 1000;
  /// Visits of bonds to find out what load breaks; what is beyond it waits a frame.
  std::uint32_t load_work_a_frame = 40000;
  std::uint32_t debris = 20000;  ///< Pieces of debris alive at once.
  std::uint32_t dust = 4000;     ///< Puffs of dust alive at once.
};

struct Scene {
  std::string name;
  std::string description;
  std::vector<std::string> warnings;  ///< Faults of what it was made from: missing pictures.
  double duration_s = 6;
  Vec3 gravity_W = Vec3(0, -9.81, 0);
  std::uint64_t seed = 1;
  bool planar = false;  ///< Moves in the plane z = 0 alone: the third dimension is not simulated.
  Accuracy accuracy;
  SolverDials solver;
  Limits limits;
  Ground ground;
  View view;
  std::vector<ViewKey> view_keys;  ///< Where its camera goes; none: it stays.
  std::vector<Material> materials;
  std::vector<Paint> paints;  ///< Of meshes from files: PolygonMesh::Face::mark.
  std::vector<Solid> solids;
  std::vector<Ball> balls;
  std::vector<Joint> joints;
  // The script, each in order of time.
  std::vector<Shot> shots;
  std::vector<Blast> blasts;
  std::vector<Removal> removals;
  std::vector<Drive> drives;
  std::vector<Move> moves;  ///< In no order.
};

/// Of its solids, balls and shots, in this order; a chain goes by the name of its ball. Shots
/// without one are shot.0, shot.1 and so on, counted among all.
inline std::vector<std::string> names_in(const Scene& scene) {
  std::vector<std::string> names;
  for (const Solid& solid : scene.solids) names.push_back(solid.name);
  for (const Ball& ball : scene.balls) names.push_back(ball.name);
  for (std::size_t i = 0; i < scene.shots.size(); ++i) {
    const std::string& name = scene.shots[i].ball.name;
    names.push_back(name.empty() ? "shot." + std::to_string(i) : name);
  }
  return names;
}

}  // namespace sunder
