// The state behind a simulation: actors, books, and the stages that work on them. Internal to
// engine/world; users see Simulation and Frame.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "engine/model/breaker.h"
#include "engine/model/frame.h"
#include "engine/model/particles.h"
#include "engine/model/physics.h"
#include "engine/model/scene.h"

namespace sunder {

inline constexpr std::uint32_t kNoConvex = 0xffffffff;

/// What presses on a convex (a slot): force in the rest frame, torque about its centroid.
struct Press {
  std::uint32_t convex = 0;
  Vec3 force_R = Vec3::Zero();
  Vec3 torque_R = Vec3::Zero();
};

/// What an actor bears, and how far it is known whether it can.
struct StressState {
  bool breakable = false;        ///< Load can break it.
  bool settled = false;          ///< Judged for `judged`, to the end.
  std::uint64_t since_step = 0;  ///< Waits to be judged since then, if not settled.
  std::vector<Press> pressing;   ///< Averaged over time; ascending by convex.
  std::vector<Press> judged;
  StressMemoryPtr memory;
};

/// Stands for a mesh that is not made yet: until the next snapshot, nobody looks.
inline constexpr MeshIndex kUndrawn = MeshIndex(0xfffffffe);

/// A convex of an actor that is to be drawn anew.
struct Undrawn {
  std::uint32_t key = 0;
  std::uint32_t slot = 0;

  auto operator<=>(const Undrawn&) const = default;
};

/// A solid in the world: a body, what it is made of, and what is drawn of it.
struct Actor {
  std::uint32_t key = 0;       ///< Unique in a run, ascending with age; the tag of its body.
  std::uint32_t root_key = 0;  ///< Of what it came off in the end: a solid or ball of the scene.
  BodyId body;
  bool is_static = false;
  Structure structure;      ///< Without convexes for a ball.
  std::uint32_t edits = 0;  ///< Of its structure, since it was made.
  /// Of what stands, the centre is where it was when its body was made: there B has its origin.
  Weight weight;
  double volume_m3 = 0;
  std::vector<MaterialIndex> materials;  ///< Of its convexes when it was made, each once.
  std::uint64_t born_step = 0;
  /// No impact with less energy can break it: it is too tough, or its last fruitless plan asked for
  /// more. Infinite if nothing can.
  double least_J = std::numeric_limits<double>::infinity();
  double least_Ns = 0;  ///< No impact with less impulse can break it.
  StressState stress;
  std::vector<MeshIndex> meshes;  ///< Per slot; none() where nothing shows, or kUndrawn.
  std::vector<std::vector<std::uint8_t>> hidden;  ///< Per slot, a flag for each face.
};

/// The body tag of the ground, which is no actor.
inline constexpr std::uint32_t kGroundKey = 0xffffffff;
/// What hits where nobody does: a blast.
inline constexpr std::uint32_t kNobodyKey = 0xfffffffe;

/// An impact that may break an actor, as decided from the approaches of a body pair.
struct Impact {
  std::uint32_t key = 0;        ///< The actor that may break.
  std::uint32_t other_key = 0;  ///< What hits it.
  std::uint32_t convex = 0;     ///< The convex that is hit, by slot.
  Vec3 point_W = Vec3::Zero();
  Vec3 direction_W = Vec3::UnitY();  ///< Unit, into the actor.
  double energy_J = 0;               ///< The work it would do.
};

/// What breaks laid bare since the particles last moved.
struct Exposed {
  /// The solid that a break took apart, as it was then.
  struct Parent {
    Pose X_WR;
    VelocityField motion;
    double back_s = 0;  ///< Since this frame began.
  };
  struct Face {
    std::uint32_t parent = 0;     ///< Index in `parents`.
    std::uint32_t owner_key = 0;  ///< The actor that it is a face of; none may have this key.
    Vec3 normal_R = Vec3::UnitY();
    MaterialIndex material;
    std::size_t corners_end = 0;
  };
  std::vector<Parent> parents;
  std::vector<Face> faces;
  std::vector<Vec3> corners_R;
  std::vector<Chip> chips;  ///< Where they were when this frame began.
};

/// A blast under way: it breaks, one place of each solid a step, then it pushes.
struct Burst {
  Blast blast;
  double pushes_at_s = 0;
  std::vector<Vec3> tried_W;  ///< Where it has broken something, or failed to.
};

/// One end of a joint: an actor, or the world.
struct JointEnd {
  std::uint32_t key = 0;  ///< kGroundKey: the world.
  Vec3 anchor_R = Vec3::Zero();
};

/// A joint of the running world.
struct LiveJoint {
  JointId id;
  JointEnd a, b;
  bool rigid = false;  ///< kFixed.
};

/// A body that sits steps out until what it hits can be decided.
struct Waiter {
  std::uint32_t key = 0;
  std::uint64_t since_step = 0;
  std::uint64_t cluster = 0;  ///< Waits together with the others of this number.
};

struct World {
  Scene scene;
  std::unique_ptr<Physics> physics;
  std::unique_ptr<Breaker> breaker;
  std::unique_ptr<Particles> particles;  ///< Null: none.
  std::shared_ptr<const std::vector<Material>> materials;

  std::vector<Actor> actors;  ///< Ascending by key.
  std::shared_ptr<MeshStore> meshes = std::make_shared<MeshStore>();
  bool meshes_published = false;  ///< A frame holds `meshes`: copy before the next change.
  std::vector<Undrawn> undrawn;   ///< Since the last snapshot.
  std::uint32_t next_key = 0;
  std::uint64_t next_event = 1;
  std::uint64_t step = 0;
  std::uint64_t frame = 0;
  bool started = false;  ///< Frame 0 has been given out.
  std::size_t next_shot = 0, next_blast = 0, next_removal = 0;
  std::vector<Burst> bursts;
  std::vector<LiveJoint> joints;
  std::vector<Impact> waiting;  ///< Of blasts, over the frame's budget: decided first in the next.
  std::vector<Waiter> waiters;  ///< Ascending by key; as of the last step.
  std::uint64_t next_waiting = 0;    ///< Number of the next cluster to wait.
  std::uint32_t trials_waiting = 0;  ///< Clusters that they are in.
  std::uint32_t parts_left = 0;      ///< Of the frame's budget, in parts to cut.
  std::int64_t load_work_left = 0;   ///< Of the frame's budget, in visits of bonds; may be owed.
  std::uint32_t loads_waiting = 0;   ///< Actors whose load is not judged yet.
  double debris_mass_kg = 0;
  double removed_mass_kg = 0;  ///< By the script.
  int steps_per_frame = 1;
  Exposed exposed;
  std::uint64_t particles_ignored = 0;  ///< Up to the last frame, for want of room.

  FrameReport report;  ///< Of the frame under way.
  std::vector<BreakEvent> breaks;
  double momentum_error_Ns = 0, momentum_moved_Ns = 0;

  /// How far ahead approaches are looked for, and decided: a solve's last substep stops what would
  /// meet within one substep more.
  double horizon_s() const {
    const Accuracy& accuracy = scene.accuracy;
    return accuracy.dt_s * (1 + 1.0 / accuracy.substeps);
  }
  double time_s() const { return static_cast<double>(step) * scene.accuracy.dt_s; }
  const Material& material(MaterialIndex index) const { return (*materials)[index.value]; }
  /// Null if the actor is gone.
  Actor* find(std::uint32_t key);
  MeshIndex add_mesh(std::shared_ptr<const Mesh> mesh);
};

/// Stage `act`: what the script brings in, takes away or lights now, and room when it is short.
void act_stage(World& world);
/// After breaks: what blasts and drives push.
void push_stage(World& world);
/// Parts of both: what the blasts due now can break, and what they push.
void light_blasts(World& world);
void push_blasts(World& world);

/// Stage `break`: approaches become breaks, before the solve.
void break_stage(World& world);

/// Stage `load`: own weight and what presses on a compound break what they overload.
void load_stage(World& world);
/// Stage `particles`, once a frame: debris and dust come off what broke, and everything moves.
void particle_stage(World& world);

/// The frame as it stands.
std::shared_ptr<Frame> snapshot(World& world);

}  // namespace sunder
