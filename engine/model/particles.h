// Particles: the interface between the world and visual-only simulation: debris (small spheres
// drawn as chips) and dust (a grid of air that carries oriented particles); paper section 5.
//
// Particles collide with bodies as obstacles and have no effect on them. A world without particles
// has no Particles object. Results depend only on the calls and their order, not on threads.
//
// At the end of a frame's last step the world calls (engine/world/particles/particle_stage.cpp):
//   emit(faces), emit(chips)  the faces and chips of the frame's breaks, if any
//   report()                  to see if there are particles
//   advance()                 by a whole frame, among all bodies at their current poses
// To make the frame it calls debris(), dust(), report().
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/base/check.h"
#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/model/body_states.h"
#include "engine/model/material.h"

namespace sunder {

class Archive;

/// A face exposed by a break, from which debris and dust come off.
struct ExposedPolygon {
  std::span<const Vec3> corners_W;  ///< A convex polygon; read during the call only.
  Vec3 normal_W = Vec3::UnitY();    ///< Unit, out of the solid.
  VelocityField motion;             ///< Velocity field of the solid.
  /// Speed at which the break separates the solid from its parent. A higher speed gives more
  /// particles, up to the material's limit, and faster ones.
  double opening_speed_m_s = 5;
  MaterialIndex material;
  DebrisEmission crumbling;
};

/// A piece too small to be a body; the world keeps its mass in the accounting.
struct DebrisPiece {
  Vec3 center_W = Vec3::Zero();
  double radius_m = 0;  ///< Radius of a sphere of equal volume.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  MaterialIndex material;
};

/// A body as an obstacle for particles.
struct ObstacleBody {
  /// Unique in a run; debris at rest on a body wakes when the body's key disappears.
  std::uint32_t key = 0;
  /// Number of changes of the convexes; debris at rest on the body wakes when it changes.
  std::uint32_t edits = 0;
  Pose X_WB;
  Vec3 com_R = Vec3::Zero();  ///< Origin of B in the rest frame R.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool moves = false;  ///< True if the body is neither static nor asleep.
};

/// One convex or ball of a body.
struct ObstacleShape {
  std::uint32_t body = 0;  ///< Index in Obstacles::bodies.
  /// In R; null for a ball around the origin of B. Read during the call only.
  const ConvexPolyhedron* hull = nullptr;
  Box box_R;             ///< Bounding box of the hull.
  double volume_m3 = 0;  ///< Volume of the hull.
  double radius_m = 0;   ///< Radius of the ball.
  bool facet = false;    ///< True: collides with its first face only, as part of a surface.
};

/// All obstacles.
struct Obstacles {
  std::span<const ObstacleBody> bodies;  ///< Ascending by key.
  std::span<const ObstacleShape> shapes;
  double ground_m = 0;  ///< Height of the ground plane.
};

/// Number of chip meshes that debris is drawn with; variants are 0 to kDebrisVariants − 1.
inline constexpr std::uint32_t kDebrisVariants = 8;

/// Debris to draw, in parallel arrays. A chip's mesh is inscribed in a sphere of `radius_m`.
struct DebrisView {
  std::span<const Vec3f> position_W;
  std::span<const Quatf> rotation_WD;
  std::span<const float> radius_m;  ///< Decreases to 0 as a chip fades.
  std::span<const std::uint8_t> variant;
  std::span<const MaterialIndex> material;
};

/// Dust to draw as rotating sprites, in parallel arrays.
struct DustView {
  std::span<const Vec3f> position_W;
  std::span<const Quatf> rotation_WD;  ///< Rotates with the vorticity of the air.
  std::span<const float> radius_m;     ///< Radius of the puff.
  std::span<const float> opacity;      ///< 0 to 1.
  std::span<const MaterialIndex> material;
};

/// Largest numbers of particles alive at once.
struct ParticleLimits {
  std::uint32_t debris = 50000;
  std::uint32_t dust = 20000;
};

/// Counts of one kind of particle; emitted + ignored were requested, alive = emitted − gone.
struct ParticleCounts {
  std::uint32_t alive = 0;
  std::uint32_t awake = 0;    ///< Number awake, out of `alive`.
  std::uint64_t emitted = 0;  ///< Since the start.
  std::uint64_t gone = 0;     ///< Faded or settled.
  std::uint64_t ignored = 0;  ///< Not emitted because the limit was reached.
};

/// Counts of all particles.
struct ParticleReport {
  ParticleCounts debris;
  ParticleCounts dust;
  std::uint32_t air_cells = 0;       ///< Cells of the air grid; 0 without dust.
  std::uint32_t air_iterations = 0;  ///< Iterations of the last pressure solve.
};

/// Interface of the particle simulation. Implemented by solver/particles.
class Particles {
 public:
  virtual ~Particles() = default;

  virtual std::unique_ptr<Particles> copy() const = 0;
  /// Writes the state to an archive, or takes it over from one.
  virtual void archive(Archive& /*bytes*/) {
    throw InputError("the state of these particles cannot be saved");
  }

  /// Emits debris and dust, distributed uniformly on each face.
  virtual void emit(std::span<const ExposedPolygon> faces) = 0;
  /// Emits one piece of debris per chip.
  virtual void emit(std::span<const DebrisPiece> chips) = 0;
  /// Advances all particles by dt_s; `obstacles` are in their poses at the end of it.
  virtual void advance(double dt_s, const Obstacles& obstacles) = 0;

  /// Returns debris to draw; valid until the next call that changes anything.
  virtual DebrisView debris() const = 0;
  /// Returns dust to draw; valid until the next call that changes anything.
  virtual DustView dust() const = 0;
  virtual ParticleReport report() const = 0;
};

}  // namespace sunder
