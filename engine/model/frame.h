// A frame: everything there is to see and to count at one instant, and the seams that pass frames
// on (docs/architecture.md, "Rooms"). How one comes about is told there in "A step".
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/energy.h"
#include "engine/model/material.h"
#include "engine/model/work.h"

namespace sunder {

/// What is drawn of one convex (or ball): immutable. It lies in the frame T that it is painted in,
/// the rest frame R, or what that was before the solid was bent. Positions are floats around
/// `origin_T`, so precision does not depend on where in the solid the piece was; textures use
/// origin_T + position.
struct Mesh {
  struct Vertex {
    Vec3f position = Vec3f::Zero();
    Vec3f normal = Vec3f::UnitY();
    std::uint32_t look = kSurface;
  };
  /// Looks of vertices: those of its material, or, from kFirstPaint on, the frame's paints.
  static constexpr std::uint32_t kSurface = 0, kInterior = 1, kFirstPaint = 2;
  Pose X_RT;
  Vec3 origin_T = Vec3::Zero();
  std::vector<Vertex> vertices;
  std::vector<Eigen::Vector2f> uvs;    ///< Of each vertex, where paints need them; else empty.
  std::vector<std::uint32_t> indices;  ///< Triangles, counter-clockwise seen from outside.
  MaterialIndex material;
};

struct MeshTag;
using MeshIndex = Index<MeshTag>;
/// Append-only: an index never changes its meaning. A frame keeps the store of its instant.
using MeshStore = std::vector<std::shared_ptr<const Mesh>>;

/// Camera, light and ground of a scene.
struct View {
  Vec3 eye_W = Vec3(6, 4, 10);
  Vec3 target_W = Vec3(0, 1, 0);
  double fov_rad = 0.8;                             ///< Vertical.
  Vec3 to_sun_W = Vec3(0.5, 0.7, 0.4);              ///< Towards the sun, any length.
  Vec3f ground_color = Vec3f(0.42f, 0.38f, 0.32f);  ///< Linear RGB.
  double ground_m = 0;                              ///< Height of the ground plane.
  double exposure = 1;                              ///< What is seen is this times as bright.
  double shutter = 0;  ///< How much of the time between frames, before each, it is open.
  /// Light on a face turned to the sun, and by the sky on one turned up: linear RGB.
  Vec3f sun_color = Vec3f(3.7f, 3.05f, 2.3f);
  Vec3f sky_color = Vec3f(0.6f, 0.72f, 0.92f);
  double sun_strength = 1, sky_strength = 1;  ///< Times these.
};

/// The key of the ground. Its meshes, if it has any, are a body of this key, which comes last.
inline constexpr std::uint32_t kGroundKey = 0xffffffff;

/// Where the camera is at a time; what is not said is as in the key before (view_path.h).
struct ViewKey {
  double time_s = 0;
  std::optional<Vec3> eye_W, target_W;
  std::optional<double> fov_rad;
};

/// In place of the name of what has none.
inline constexpr std::uint32_t kUnnamed = 0xffffffff;

/// A body at one instant. `key` is unique for a run and never reused.
struct FrameBody {
  std::uint64_t key = 0;
  Pose X_WB;
  Vec3 com_R = Vec3::Zero();  ///< Origin of B in the rest frame R.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool is_static = false;
  bool asleep = false;
  /// Of what it was part of in the frame before, in whose rest frame it lies; its own where nothing
  /// broke.
  std::uint64_t before_key = 0;
  std::uint32_t name = kUnnamed;  ///< In Frame::names, of what it came off in the end.
};

/// A mesh drawn on a body: world = X_WB * (X_RT * (origin_T + position) − com_R).
struct Instance {
  MeshIndex mesh;
  std::uint32_t body = 0;       ///< Index in Frame::bodies.
  MaterialIndex material = {};  ///< That it is drawn as; none(): the mesh's.
};

/// A point where two bodies press on each other.
struct FrameContact {
  Vec3f point_W = Vec3f::Zero();
  Vec3f force_W = Vec3f::Zero();       ///< On body b, N, friction included.
  std::uint64_t key_a = 0, key_b = 0;  ///< Keys of the bodies; kGroundKey: the ground.
};

/// What the broad phase takes a shape of a body for.
struct FrameBox {
  Vec3f min_W = Vec3f::Zero(), max_W = Vec3f::Zero();
  std::uint32_t body = 0;  ///< Index in Frame::bodies.
};

/// What happens inside, for who looks there: gathered only where that was asked for.
struct Inspection {
  std::vector<FrameContact> contacts;
  std::vector<FrameBox> boxes;
  /// Per body, the first of those that contacts and joints lead to without crossing what is held.
  std::vector<std::uint32_t> islands;
  /// Per instance, the worst stress on the bonds of its convex, in parts of what they bear;
  /// negative where no load can break any.
  std::vector<float> stresses;
};

/// A piece of debris: one of kDebrisVariants chips, inscribed in a sphere.
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

/// A body broke or cracked. Several bodies can be born and broken within one frame: `parent_key` is
/// then among the `child_keys` of an earlier event of the frame, and in no frame's bodies.
/// `before_key` and `name` tell what every parent belonged to; FrameBody has the same of the
/// pieces. Bodies that bend, that become one again or that the script lets go get new keys without
/// an event.
struct BreakEvent {
  double time_s = 0;
  std::uint64_t parent_key = 0;           ///< Of the body that broke.
  std::vector<std::uint64_t> child_keys;  ///< Of its pieces. What stands keeps its parent's key.
  MaterialIndex material;                 ///< Where it broke.
  std::uint64_t before_key = 0;           ///< Of what the parent was part of in the frame before.
  std::uint32_t name = kUnnamed;          ///< In Frame::names, of what the parent came off.
  Vec3 point_W = Vec3::Zero();  ///< Where it was hit, or where a blow elsewhere bent it most.
  double energy_J = 0;          ///< Taken from the impact.
  double new_area_m2 = 0;
  double plan_ms = 0;        ///< Wall time of the fracture.
  std::uint32_t pieces = 0;  ///< All pieces; those without a key became debris. 1: it is cracked.
};

/// Counted, not timed: the same on every machine.
struct Counts {
  std::uint32_t bodies = 0;  ///< Dynamic.
  std::uint32_t awake = 0;
  std::uint32_t convexes = 0;
  std::uint32_t compounds = 0;
  std::uint32_t contacts = 0;
  std::uint32_t debris = 0;
  std::uint32_t dust = 0;
};

/// The ledger of a frame.
struct FrameReport {
  double stage_ms[kStages] = {};      ///< Summed over the frame's steps.
  double stage_cpu_ms[kStages] = {};  ///< The same in processor time, of all threads.
  std::vector<WorkItem> work;         ///< Parts of stages; summed as well.
  Counts counts;
  double mass_kg = 0;  ///< Everything: debris, what the script took and shots yet to come included.
  double volume_m3 = 0;  ///< Of all solids.
  double kinetic_J = 0;
  double potential_J = 0;
  double plastic_J = 0;          ///< That hinges have taken since the start.
  EnergyFlows energy;            ///< Since the previous frame.
  double energy_residual_J = 0;  ///< Change of the kinetic energy since then, less their sum.
  /// |change of momentum − external impulses| of the frame over the momentum that changed hands.
  double momentum_residual = 0;
  double friction_allowed_Ns = 0;  ///< By Coulomb's law, of all contacts in the frame,
  double friction_excess_Ns = 0;   ///< and friction beyond it.
  std::uint32_t carried_over = 0;  ///< Impacts and loads waiting for a later step's budget.
  std::uint32_t failed = 0;        ///< Convexes that a break left whole, as they would not add up,
  double failed_m3 = 0;            ///< and their volume.
  std::uint32_t limits_hit = 0;
  std::uint32_t aged = 0;  ///< Fragments that became debris to make room.
  std::uint32_t frozen = 0;
  std::uint32_t joints_lost = 0;  ///< Broken by their load, or without a piece to hold on to.
  std::vector<float> penetrations_m;
};

/// One instant, immutable once made; frames share what did not change.
struct Frame {
  std::uint64_t index = 0;
  double time_s = 0;
  View view;
  std::shared_ptr<const std::vector<Material>> materials;
  std::shared_ptr<const std::vector<Paint>> paints;  ///< Null: none.
  std::shared_ptr<const MeshStore> meshes;
  /// Of the scene's solids, balls and shots; the same in all frames. Null where nobody knows.
  std::shared_ptr<const std::vector<std::string>> names;
  std::vector<FrameBody> bodies;  ///< Ascending by key.
  std::vector<Instance> instances;
  std::vector<FrameDebris> debris;
  std::vector<FrameDust> dust;
  std::vector<BreakEvent> breaks;  ///< Since the previous frame.
  FrameReport report;
  /// Of a frame from a take: the hash of the state as it was, which is stored less exactly; else 0.
  std::uint64_t recorded_hash = 0;
  std::shared_ptr<const Inspection> inspection;  ///< Null unless it was asked for.
};
using FramePtr = std::shared_ptr<const Frame>;

/// Where frames come from: a simulation, a take.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The next frame; null at the end.
  virtual FramePtr next() = 0;
};

/// Where frames go: video, images, statistics, state hash.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual void take(const FramePtr& frame) = 0;
  /// Called once after the last frame; writes what is only known then.
  virtual void finish() {}
};

/// The main loop: every frame of the source, to every sink, in order.
void pump(FrameSource& source, std::span<FrameSink* const> sinks);

}  // namespace sunder
