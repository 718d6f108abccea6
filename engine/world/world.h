// World: a running simulation that a program acts on and asks.
//
// A game, a tool or a script makes a World of a scene (scenes/make_simulation.h), and then, as
// often as it likes: adds and pushes bodies, advances by step(), reads events() and bodies(), casts
// rays, and takes a frame() if it draws. Scripts of scene files and Simulation use the same calls.
//
// Bodies are known by keys. A key is never used again, so that the key of a body that is gone
// remains invalid: contains() tells, and other calls throw InputError. All calls throw InputError,
// with the call's name and the invalid argument, before they change anything. A world is used by
// one thread at a time; several worlds may run in several threads at once.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/scene.h"

namespace sunder {

class Archive;
class Breaker;
class Particles;
class Physics;

/// Key of a body in a world: of a solid, a ball, or a piece of one. Those of the scene have the
/// keys 0, 1, … in the order of its solids and then its balls. FrameBody::key and
/// BreakEvent::child_keys are the values of such keys.
struct BodyKeyTag;
using BodyKey = Index<BodyKeyTag>;

/// Key of a joint in a world; those of the scene have the keys 0, 1, … in its order.
struct JointKeyTag;
using JointKey = Index<JointKeyTag>;

/// A solid of which a world can have any number: compound, adjacency and mass are computed once.
class Asset {
 public:
  /// Names of materials, by the indices that stand for them.
  using MaterialNames = std::vector<std::pair<MaterialIndex, std::string>>;

  /// Throws InputError if the compound is invalid. A world that has a material of another name at
  /// an index of `materials` refuses the asset; other indices stand for what the world has there.
  explicit Asset(Compound compound, MaterialNames materials = {});
  /// Returns the geometry, in the rest frame.
  const Compound& compound() const;
  /// Returns the names of materials that a world must have.
  const MaterialNames& materials() const;

 private:
  friend class World;
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Pose and velocities of a body. The velocity is that of its centre of mass.
struct BodyMotion {
  Pose X_WR;  ///< Pose of its rest frame R, in which its solid was modelled.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
};

/// A body at present.
struct BodyView {
  BodyKey key;
  BodyKey root;  ///< Key of the solid or ball that it was part of.
  BodyMotion motion;
  Vec3 com_W = Vec3::Zero();  ///< Centre of mass.
  double mass_kg = 0;
  double volume_m3 = 0;
  std::uint32_t convexes = 0;  ///< 0 for a ball.
  bool is_static = false;      ///< It is anchored, or follows a path.
  bool is_kinematic = false;   ///< It follows a path.
  bool asleep = false;
  std::string name;             ///< That of its root; may be empty.
  std::uint64_t user_data = 0;  ///< As set for it, or for the body that it was part of.
  CollisionFilter filter;       ///< Likewise.
};

/// All bodies at present as arrays, ascending by key; positions are of the centres of mass. Valid
/// until the next call that changes the world.
struct BodyArrays {
  std::vector<BodyKey> key;
  std::vector<Vec3> position_W;
  std::vector<Quat> rotation_W;
  std::vector<Vec3> velocity_W;
  std::vector<Vec3> angular_velocity_W;
  std::vector<std::uint8_t> is_static, asleep;
};

/// Selects the bodies that a query can find.
struct QueryFilter {
  /// A body is found if its filter's category is in this mask.
  std::uint32_t mask = 0xffffffff;
  bool ground = true;  ///< False: the ground is not found.
  /// Bodies for which it returns false are not found; empty: all are. It may ask the world; calls
  /// that change the world throw InputError meanwhile.
  std::function<bool(BodyKey)> accepts = {};
};

/// A point that a ray or a moving ball meets first on a body.
struct CastHit {
  BodyKey body;                   ///< none(): the ground.
  std::uint32_t slot = 0;         ///< Slot of the convex; 0 for a ball.
  MaterialIndex material;         ///< none() for the plane of the ground.
  double distance_m = 0;          ///< Along the ray, from its start; 0 if it starts inside.
  Vec3 point_W = Vec3::Zero();    ///< On the surface; the start of the ray if it starts inside.
  Vec3 normal_W = Vec3::UnitY();  ///< Unit, out of the body; against the ray if it starts inside.
};

/// A convex or ball that overlaps a volume.
struct Overlap {
  BodyKey body;            ///< none(): the ground.
  std::uint32_t slot = 0;  ///< As in CastHit.
  auto operator<=>(const Overlap&) const = default;
};

/// A point where a body touches another.
struct Contact {
  BodyKey other;  ///< none(): the ground.
  Vec3 point_W = Vec3::Zero();
  Vec3 force_W = Vec3::Zero();  ///< On the body, in N, friction included; at the end of the step.
};

/// Two bodies that met in a step, at the point at which they closed fastest.
struct Hit {
  BodyKey a, b;  ///< a < b; b may be the ground: none(). Either may have broken in the step.
  Vec3 point_W = Vec3::Zero();
  Vec3 normal_W = Vec3::UnitY();  ///< Unit, from a to b.
  double speed_m_s = 0;           ///< Closing speed along the normal.
  double mass_kg = 0;  ///< Effective mass along the normal: the energy is mass · speed² / 2.
};

/// Changes during the last step, and between it and the step before.
struct Events {
  std::vector<BreakEvent> breaks;
  std::vector<Hit> hits;  ///< If requested by report_hits(); sorted by keys.
  /// Ascending. A body that appeared and broke within the step is in none of them.
  std::vector<BodyKey> appeared, gone, fell_asleep, woke;
  std::vector<JointKey> joints_lost;
};

/// A running simulation that a program acts on and asks.
class World {
 public:
  /// Makes a world of a scene, whose script is carried out as time passes. Without `particles`
  /// there are neither debris nor dust. scenes/make_simulation.h supplies the arguments.
  World(Scene scene, std::unique_ptr<Physics> physics, std::unique_ptr<Breaker> breaker,
        std::unique_ptr<Particles> particles = nullptr);
  /// Returns a world in the same state, which goes on with the same bits: to roll back, keep a copy
  /// and assign it later. What does not change is shared: solids, meshes, frames. Throws InputError
  /// for a planar scene.
  World copy() const;
  /// Writes the scene, and then the rest of the state. Throws InputError for a planar scene.
  /// scenes/make_simulation.h makes bytes of it.
  void save(Archive& bytes) const;
  /// Makes a world in the state that save() wrote, which goes on with the same bits, on the number
  /// of threads of the process. The scene has been read from `bytes`, the rest of the state has
  /// not; more may follow. Throws InputError if the bytes are damaged.
  World(Archive& bytes, Scene scene, std::unique_ptr<Physics> physics,
        std::unique_ptr<Breaker> breaker, std::unique_ptr<Particles> particles);
  /// Moves a world; the other can only be assigned to or destroyed.
  World(World&&) noexcept;
  /// Replaces this world by another, as to roll back.
  World& operator=(World&&) noexcept;
  ~World();

  /// Sets the number of threads of this world's steps and frames; 0, the default: that of the
  /// process (set_threads()). Results have the same bits for any number.
  void set_threads(int count);
  /// Advances by a time from 1e-6 to 0.1 s, in equal steps of at most the scene's dt. Budgets of
  /// Limits that are for a frame are in proportion to the time.
  void step(double time_s);
  /// Returns the time since the world was made.
  double time_s() const;
  /// The scene that the world was made of; bodies and materials may have been added since.
  const Scene& scene() const;

  /// The materials of the scene, and then those that were added; valid until the next one is added.
  const std::vector<Material>& materials() const;

  // Create. Times of actions are in seconds of the world, and may have passed.
  /// Adds a material, for bodies that are added later.
  MaterialIndex add(const Material& material);
  /// Adds a solid; its compound is prepared in the call.
  BodyKey add(const Solid& solid);
  /// Adds a solid at a pose, without what the asset has already. Throws InputError if a
  /// material of the asset is another one in this world.
  BodyKey add(const Asset& asset, const BodyMotion& motion, const std::string& name = "");
  /// Adds a ball.
  BodyKey add(const Ball& ball);
  /// Joins two bodies, or a body and the world, in their present poses; `joint.a` and `joint.b`
  /// are keys.
  JointKey add(const Joint& joint);
  /// Adds a ball that appears at a time, maybe on a rope or a chain; with time 0 in the next step.
  void shoot(const Shot& shot);
  /// Adds an explosion; with time 0 it is in the next step.
  void blast(const Blast& blast);
  /// Adds a motor, which runs from its time on.
  void drive(const Drive& drive);

  // Act on bodies; the others notice in the next step.
  /// Removes a body, with its joints.
  void remove(BodyKey body);
  /// Removes a joint.
  void remove(JointKey joint);
  /// Sets the pose and velocities of a body that is not anchored, and wakes it.
  void set_motion(BodyKey body, const BodyMotion& motion);
  /// Moves a body evenly to a pose within a time, as a kinematic body: of infinite mass, and
  /// unbreakable. It stays there until it is moved on or released.
  void move_to(BodyKey body, const Pose& X_WR, double duration_s);
  /// Frees a kinematic body, which keeps its velocity, or removes all anchors of an anchored one.
  /// The body keeps its key.
  void release(BodyKey body);
  /// Applies an impulse, N s, at a point; has no effect on anchored and kinematic bodies.
  void apply_impulse(BodyKey body, const Vec3& impulse_W, const Vec3& point_W);
  /// Breaks a body in the next step, as an impact would that does work `energy_J` at the point of
  /// the body nearest to `point_W`, along `direction_W`; by `pattern` in place of its material's,
  /// if given. It holds if the energy is too little for the crack, or its material is unbreakable.
  void break_at(BodyKey body, const Vec3& point_W, const Vec3& direction_W, double energy_J,
                std::optional<PatternSpec> pattern = std::nullopt);
  /// Any number of the caller's; pieces inherit it.
  void set_user_data(BodyKey body, std::uint64_t user_data);
  /// Sets what the body and its pieces collide with.
  void set_filter(BodyKey body, CollisionFilter filter);

  // Ask. Queries see the present poses, whatever has changed since the last step.
  /// Returns true if the body is in the world.
  bool contains(BodyKey body) const;
  /// Returns true if the joint is in the world.
  bool contains(JointKey joint) const;
  std::size_t size() const;  ///< Number of bodies, the ground not included.
  /// Returns a body.
  BodyView body(BodyKey body) const;
  /// Returns all bodies as arrays, which are filled at the first call after a change of the world.
  const BodyArrays& bodies() const;
  /// Returns the contacts of a body that carry load.
  std::vector<Contact> contacts(BodyKey body) const;
  /// Returns the first point on the way from `from_W` along `direction_W` (of any length above 0)
  /// up to `most_m`; of a ball of this radius, where it touches first.
  std::optional<CastHit> cast(const Vec3& from_W, const Vec3& direction_W, double most_m,
                              double radius_m = 0, const QueryFilter& filter = {}) const;
  /// Returns all convexes and balls that the ray, or the ball, meets, by distance.
  std::vector<CastHit> cast_all(const Vec3& from_W, const Vec3& direction_W, double most_m,
                                double radius_m = 0, const QueryFilter& filter = {}) const;
  /// Returns what overlaps a ball or a box, sorted.
  std::vector<Overlap> overlap(const Vec3& center_W, double radius_m,
                               const QueryFilter& filter = {}) const;
  /// Returns what overlaps a box along the axes of the world, sorted.
  std::vector<Overlap> overlap(const Box& box_W, const QueryFilter& filter = {}) const;

  /// Returns the events of the last step; valid until the next step.
  const Events& events() const;
  /// Reports hits of at least this closing speed from now on; infinity, the default: none.
  void report_hits(double least_m_s);
  /// Counts, times, and sums of mass, energy and momentum of the last step, without penetrations
  /// and particles, which its frame has.
  const FrameReport& report() const;

  /// Returns the present state to draw or store, with the breaks and the report of the last step.
  /// Costs nothing unless it is called.
  FramePtr frame();
  /// Adds inspections to all later frames (Frame::inspection).
  void inspect();
  /// Runs all later steps on the thread that calls, and reports what their parallel loops would
  /// take with more threads (FrameReport::stage_loops).
  void count_loops();

 private:
  struct Parts;
  explicit World(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace sunder
