// The seam between the world and what is simulated for the eye: debris (small spheres drawn as
// chips) and dust (a grid of air that carries oriented particles); paper section 5.
//
// Particles weigh nothing to bodies: they feel bodies as obstacles and never push back. A world
// without particles has no Particles at all. Everything depends only on the calls and their order,
// never on threads.
//
// At the end of a frame's last step the world calls (engine/world/particles/particle_stage.cpp):
//   emit(faces), emit(chips)  what the frame's breaks laid bare, if anything
//   report()                  whether there is anything to move
//   advance()                 by a whole frame, among all bodies as they stand then
// And for the frame to show: debris(), dust(), report().
#pragma once

#include <cstdint>
#include <span>

#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/model/body_states.h"
#include "engine/model/material.h"

namespace sunder {

/// A face that a break laid bare, which crumbles as its material does.
struct Emission {
  std::span<const Vec3> corners_W;  ///< A convex polygon; outlives the call only.
  Vec3 normal_W = Vec3::UnitY();    ///< Unit, out of the solid.
  VelocityField motion;             ///< Of the solid.
  /// How fast the break drove the solid from what it was part of: the faster, the more comes off,
  /// up to what the material says, and the faster that flies.
  double parting_m_s = 5;
  MaterialIndex material;
  Crumbling crumbling;
};

/// A solid too small to be a body any longer; the world keeps its mass in the ledger.
struct Chip {
  Vec3 center_W = Vec3::Zero();
  double radius_m = 0;  ///< Of the sphere of the same volume.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  MaterialIndex material;
};

/// A body as particles see it.
struct ObstacleBody {
  std::uint32_t key = 0;    ///< Unique in a run: debris that rests on it wakes when it is gone,
  std::uint32_t edits = 0;  ///< or when this changes, as its convexes have.
  Pose X_WB;
  Vec3 com_R = Vec3::Zero();  ///< Origin of B in the rest frame R.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool moves = false;  ///< Neither static nor asleep.
};

/// One convex (or ball) of a body.
struct ObstacleShape {
  std::uint32_t body = 0;  ///< Index in Obstacles::bodies.
  /// In R; null for a ball about the origin of B. Outlives the call only.
  const ConvexPolyhedron* hull = nullptr;
  Box box_R;             ///< Of the hull.
  double volume_m3 = 0;  ///< Of the hull.
  double radius_m = 0;   ///< Of the ball.
  bool facet = false;    ///< It is met from its first face alone, as part of a surface.
};

/// All that is in the particles' way.
struct Obstacles {
  std::span<const ObstacleBody> bodies;  ///< Ascending by key.
  std::span<const ObstacleShape> shapes;
  double ground_m = 0;  ///< Height of the ground plane.
};

/// Chip meshes to draw debris with: the variants are 0 to kDebrisVariants − 1.
inline constexpr std::uint32_t kDebrisVariants = 8;

/// Debris to draw, in parallel arrays. A chip's mesh is inscribed in a sphere of the radius.
struct DebrisView {
  std::span<const Vec3f> position_W;
  std::span<const Quatf> rotation_WD;
  std::span<const float> radius_m;  ///< Shrinks to nothing as a chip fades.
  std::span<const std::uint8_t> variant;
  std::span<const MaterialIndex> material;
};

/// Dust to draw as rotating sprites, in parallel arrays.
struct DustView {
  std::span<const Vec3f> position_W;
  std::span<const Quatf> rotation_WD;  ///< Turns with the swirl of the air.
  std::span<const float> radius_m;     ///< Of the puff.
  std::span<const float> opacity;      ///< 0 to 1.
  std::span<const float> age_s;
  std::span<const MaterialIndex> material;
};

/// Most that is alive at once.
struct ParticleLimits {
  std::uint32_t debris = 50000;
  std::uint32_t dust = 20000;
};

/// Of one kind. emitted + ignored counts all that was asked for; alive = emitted − gone.
struct ParticleLedger {
  std::uint32_t alive = 0;
  std::uint32_t awake = 0;    ///< Of those alive.
  std::uint64_t emitted = 0;  ///< Since the start.
  std::uint64_t gone = 0;     ///< Faded or settled.
  std::uint64_t ignored = 0;  ///< For want of room.
};

struct ParticleReport {
  ParticleLedger debris;
  ParticleLedger dust;
  std::uint32_t air_cells = 0;       ///< 0 without dust.
  std::uint32_t air_iterations = 0;  ///< Of the last pressure solve.
};

class Particles {
 public:
  virtual ~Particles() = default;

  /// Debris and dust, uniformly on each face.
  virtual void emit(std::span<const Emission> faces) = 0;
  /// One piece of debris each.
  virtual void emit(std::span<const Chip> chips) = 0;
  /// Moves everything by dt_s; `obstacles` stand where they do at its end.
  virtual void advance(double dt_s, const Obstacles& obstacles) = 0;

  /// Valid until the next call that changes anything.
  virtual DebrisView debris() const = 0;
  virtual DustView dust() const = 0;
  virtual ParticleReport report() const = 0;
};

}  // namespace sunder
