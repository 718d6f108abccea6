// Frame: all that is drawn and reported at one instant, and the interfaces that pass frames on
// (docs/architecture.md, "Modules"). The section "A step" there describes how a frame is made.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "engine/base/loop_times.h"
#include "engine/base/types.h"
#include "engine/model/energy.h"
#include "engine/model/limits_hit.h"
#include "engine/model/material.h"
#include "engine/model/work.h"

namespace sunder {

/// Mesh of one convex or ball; immutable. It is in the texture frame T: the rest frame R, or R
/// before the solid was bent. Positions are floats relative to `origin_T`, so that precision does
/// not depend on the distance from the solid's origin; procedural textures use origin_T + position.
struct Mesh {
  /// A vertex in the texture frame, relative to `origin_T`.
  struct Vertex {
    Vec3f position = Vec3f::Zero();
    Vec3f normal = Vec3f::UnitY();
    std::uint32_t look = kSurface;
  };
  /// Appearance of a vertex: the material's surface or interior, or, from kFirstAppearance on, an
  /// element of Frame::appearances.
  static constexpr std::uint32_t kSurface = 0, kInterior = 1, kFirstAppearance = 2;
  Pose X_RT;
  Vec3 origin_T = Vec3::Zero();
  std::vector<Vertex> vertices;
  /// Texture coordinates per vertex; empty if no texture needs them.
  std::vector<Eigen::Vector2f> uvs;
  std::vector<std::uint32_t> indices;  ///< Triangles, counter-clockwise seen from outside.
  MaterialIndex material;

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
};

struct MeshTag;
using MeshIndex = Index<MeshTag>;
/// The meshes of a run by index. An index never changes its meaning; a mesh that nothing shows any
/// more may be released. Each frame has the store of its instant. Copies share all blocks that have
/// not changed since, so that a copy is cheap, and blocks of released meshes take no memory.
class MeshStore {
 public:
  using Pointer = std::shared_ptr<const Mesh>;

  MeshStore() = default;
  /// Makes a store of these meshes, in their order.
  MeshStore(std::initializer_list<Pointer> meshes) {
    for (const Pointer& mesh : meshes) push_back(mesh);
  }
  /// Number of meshes, the released ones included.
  std::size_t size() const { return size_; }
  /// Returns a mesh, i < size(); null if it has been released.
  const Pointer& operator[](std::size_t i) const {
    static const Pointer kReleased;
    const auto& block = blocks_[i / kBlock];
    return block ? (*block)[i % kBlock] : kReleased;
  }
  /// Adds a mesh, which gets the index size().
  void push_back(Pointer mesh);
  /// Releases the meshes whose indices are given, ascending.
  void release(std::span<const std::uint32_t> meshes);
  /// Calls `visit(i)` for each mesh that has not been released, in ascending order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < size_; ++i) {
      if (!blocks_[i / kBlock])
        i += kBlock - 1;
      else if ((*this)[i])
        visit(i);
    }
  }
  /// Returns the fields, for saved states.
  static auto fields(auto& self) { return std::tie(self.blocks_, self.size_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  static constexpr std::size_t kBlock = 64;
  using Block = std::array<Pointer, kBlock>;

  Block& changeable(std::size_t block);

  std::vector<std::shared_ptr<Block>> blocks_;  ///< Null: all its meshes have been released.
  std::size_t size_ = 0;
};

/// Camera, light and ground plane of a scene.
struct View {
  Vec3 eye_W = Vec3(6, 4, 10);
  Vec3 target_W = Vec3(0, 1, 0);
  double fov_rad = 0.8;                             ///< Vertical.
  Vec3 to_sun_W = Vec3(0.5, 0.7, 0.4);              ///< Towards the sun, any length.
  Vec3f ground_color = Vec3f(0.42f, 0.38f, 0.32f);  ///< Linear RGB.
  double ground_m = 0;                              ///< Height of the ground plane.
  double exposure = 1;                              ///< Factor of the brightness of the image.
  /// Fraction of the frame interval, at its end, during which the shutter is open.
  double shutter = 0;
  /// Irradiance by the sun on a face turned to it, and by the sky on a face turned up; linear RGB.
  Vec3f sun_color = Vec3f(3.7f, 3.05f, 2.3f);
  Vec3f sky_color = Vec3f(0.6f, 0.72f, 0.92f);
  double sun_strength = 1, sky_strength = 1;  ///< Factors of `sun_color` and `sky_color`.
};

/// Key of the ground. If the ground has meshes, the last body of a frame has this key.
inline constexpr std::uint32_t kGroundKey = 0xffffffff;

/// Camera at a time; an unset member has its value of the key before (view_path.h).
struct ViewKey {
  double time_s = 0;
  std::optional<Vec3> eye_W, target_W;
  std::optional<double> fov_rad;
};

/// Index in place of a name, for bodies without one.
inline constexpr std::uint32_t kNoName = 0xffffffff;

/// A body at one instant. `key` is unique in a run and never reused.
struct FrameBody {
  std::uint64_t key = 0;
  Pose X_WB;
  Vec3 com_R = Vec3::Zero();  ///< Origin of B in the rest frame R.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool is_static = false;
  bool asleep = false;
  /// Key, in the previous frame, of the body that this was part of, whose rest frame it shares;
  /// equal to `key` if nothing broke.
  std::uint64_t previous_key = 0;
  /// Index in Frame::names of the solid, ball or shot that this came from.
  std::uint32_t name = kNoName;
  double mass_kg = 0;  ///< 0 in frames from a recording.
};

/// A mesh drawn on a body: world = X_WB * (X_RT * (origin_T + position) − com_R).
struct Instance {
  MeshIndex mesh;
  std::uint32_t body = 0;       ///< Index in Frame::bodies.
  MaterialIndex material = {};  ///< Material to draw it with; none(): the mesh's.
};

/// A contact point that carries load.
struct FrameContact {
  Vec3f point_W = Vec3f::Zero();
  Vec3f force_W = Vec3f::Zero();       ///< On body b, in N, friction included.
  std::uint64_t key_a = 0, key_b = 0;  ///< Keys of the bodies; kGroundKey for the ground.
};

/// Bounding box of a shape in the broad phase.
struct FrameBox {
  Vec3f min_W = Vec3f::Zero(), max_W = Vec3f::Zero();
  std::uint32_t body = 0;  ///< Index in Frame::bodies.
};

/// Internal state for debug views; gathered only on request.
struct Inspection {
  std::vector<FrameContact> contacts;
  std::vector<FrameBox> boxes;
  /// For each body, the first body of its island (connected by contacts and joints).
  std::vector<std::uint32_t> islands;
  /// For each instance, the highest stress over its limit among the bonds of its convex; negative
  /// if no load can break any.
  std::vector<float> stresses;
};

/// A piece of debris: one of kDebrisVariants chip meshes, inscribed in a sphere.
struct FrameDebris {
  Vec3f position_W = Vec3f::Zero();
  Quatf rotation_WD = Quatf::Identity();
  float radius_m = 0;
  MaterialIndex material;
  std::uint8_t variant = 0;
};

/// A puff of dust.
struct FrameDust {
  Vec3f position_W = Vec3f::Zero();
  Quatf rotation_WD = Quatf::Identity();
  float radius_m = 0;
  float opacity = 0;  ///< 0 to 1.
  MaterialIndex material;
};

/// A body broke or cracked. A body may be created and broken within one frame: `parent_key` is then
/// among the `child_keys` of an earlier event of the frame, and no frame has such a body.
/// `previous_key` and `name` identify the origin of every parent; FrameBody has them for the
/// pieces. Bodies that bend, that are merged again or that the script releases get new keys without
/// an event.
struct BreakEvent {
  double time_s = 0;
  std::uint64_t parent_key = 0;  ///< Key of the body that broke.
  /// Keys of its pieces. A static remainder keeps the parent's key.
  std::vector<std::uint64_t> child_keys;
  MaterialIndex material;  ///< Material at the point of the break.
  /// Key, in the previous frame, of the body that the parent was part of.
  std::uint64_t previous_key = 0;
  std::uint32_t name = kNoName;  ///< Index in Frame::names of the parent's origin.
  /// Point of impact, or, if an impact elsewhere broke it, the point of highest stress.
  Vec3 point_W = Vec3::Zero();
  double energy_J = 0;  ///< Energy taken from the impact.
  double new_area_m2 = 0;
  double plan_ms = 0;  ///< Wall time of the fracture computation.
  /// Number of all pieces; pieces without a key became debris. 1: the body only cracked.
  std::uint32_t pieces = 0;
};

/// Deterministic counts, equal on every machine.
struct Counts {
  std::uint32_t bodies = 0;  ///< Dynamic bodies.
  std::uint32_t awake = 0;
  std::uint32_t convexes = 0;
  std::uint32_t compounds = 0;
  std::uint32_t contacts = 0;
  std::uint32_t debris = 0;
  std::uint32_t dust = 0;
};

/// Figures of a frame: work, time, and accounting of mass, energy and momentum.
struct FrameReport {
  double stage_ms[kStages] = {};  ///< Wall time, summed over the frame's steps.
  /// Processor time of all threads, summed over the frame's steps.
  double stage_cpu_ms[kStages] = {};
  /// Parallel loops, if World::count_loops() was called; summed over the frame's steps, not
  /// stored in recordings.
  std::array<LoopTimes, kStages> stage_loops;
  std::vector<WorkItem> work;  ///< Parts of stages, summed over the frame's steps.
  Counts counts;
  /// Total mass, including debris, bodies removed by the script and shots yet to come.
  double mass_kg = 0;
  double volume_m3 = 0;  ///< Volume of all solids.
  double kinetic_J = 0;
  double potential_J = 0;
  double plastic_J = 0;  ///< Plastic work of hinges since the start.
  EnergyFlows energy;    ///< Changes of the kinetic energy since the previous frame.
  /// Change of the kinetic energy since the previous frame, less energy.sum().
  double energy_residual_J = 0;
  /// |change of momentum − external impulses| of the frame over the momentum exchanged.
  double momentum_residual = 0;
  /// Sum over all contacts of the largest friction by Coulomb's law.
  double friction_allowed_Ns = 0;
  double friction_excess_Ns = 0;   ///< Sum of friction beyond Coulomb's law.
  std::uint32_t carried_over = 0;  ///< Impacts and loads deferred to a later step by the budget.
  /// Convexes that a break left whole because their parts did not sum to their volume.
  std::uint32_t failed = 0;
  double failed_m3 = 0;          ///< Volume of the convexes counted in `failed`.
  LimitsHit limits;              ///< How often each limit was reached; not stored in recordings.
  std::uint32_t limits_hit = 0;  ///< Sum of `limits`, without limits that act by design.
  std::uint32_t aged = 0;        ///< Fragments turned into debris to keep within limits.
  std::uint32_t frozen = 0;
  std::uint32_t joints_lost = 0;  ///< Joints broken by load, or without a piece to attach to.
  std::vector<float> penetrations_m;
};

/// One instant; immutable once made. Frames share unchanged parts.
struct Frame {
  std::uint64_t index = 0;
  double time_s = 0;
  View view;
  std::shared_ptr<const std::vector<Material>> materials;
  std::shared_ptr<const std::vector<Appearance>> appearances;  ///< Null if there are none.
  /// Those that neither this frame nor the one before draws may be null.
  std::shared_ptr<const MeshStore> meshes;
  /// Names of the scene's solids, balls and shots; the same in all frames. Null if unknown.
  std::shared_ptr<const std::vector<std::string>> names;
  std::vector<FrameBody> bodies;  ///< Ascending by key.
  std::vector<Instance> instances;
  std::vector<FrameDebris> debris;
  std::vector<FrameDust> dust;
  std::vector<BreakEvent> breaks;  ///< Breaks since the previous frame.
  FrameReport report;
  /// For a frame from a recording: hash of the original state, which was more precise; else 0.
  std::uint64_t recorded_hash = 0;
  std::shared_ptr<const Inspection> inspection;  ///< Null unless requested.
};
using FramePtr = std::shared_ptr<const Frame>;

/// Source of frames: a simulation, a recording.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Returns the next frame; null at the end.
  virtual FramePtr next() = 0;
};

/// Consumer of frames: video, images, statistics, state hash.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// Processes one frame.
  virtual void take(const FramePtr& frame) = 0;
  /// Called once after the last frame; writes results that depend on all frames.
  virtual void finish() {}
};

/// Main loop: passes every frame of the source to every sink, in order, then finishes the sinks.
void pump(FrameSource& source, std::span<FrameSink* const> sinks);

}  // namespace sunder
