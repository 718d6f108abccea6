// Worlds, and what they answer.
//
// Read first: PythonWorld.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "engine/base/check.h"
#include "engine/model/joint.h"
#include "scenes/api/python/bindings.h"
#include "scenes/make_simulation.h"

namespace sunder::python {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFrame_s = 1.0 / 60;
constexpr double kFrameTolerance = 1e-6;  ///< Rounding of a number of frames.
constexpr double kShortestRest_s = 1e-6;  ///< Shortest time that a world can advance by.

BodyKey body_key(std::int64_t key) {
  if (key < 0 || key >= BodyKey::kNone) {
    throw InputError("there is no body " + std::to_string(key) +
                     "; expected the key of a body that is in the world");
  }
  return BodyKey(static_cast<std::size_t>(key));
}

JointKey joint_key(std::int64_t key) {
  if (key < 0 || key >= JointKey::kNone) {
    throw InputError("there is no joint " + std::to_string(key) +
                     "; expected the key of a joint that is in the world");
  }
  return JointKey(static_cast<std::size_t>(key));
}

/// Returns the number of a key; None for the ground.
template <class Key>
std::optional<std::uint32_t> number_of(Key key) {
  return key.none() ? std::nullopt : std::optional(key.value);
}

template <class Key>
std::vector<std::uint32_t> numbers_of(const std::vector<Key>& keys) {
  std::vector<std::uint32_t> numbers;
  for (const Key key : keys) numbers.push_back(key.value);
  return numbers;
}

JointKind joint_kind(const std::string& name) {
  if (name == "ball") return JointKind::kBall;
  if (name == "hinge") return JointKind::kHinge;
  if (name == "fixed") return JointKind::kFixed;
  if (name == "distance") return JointKind::kDistance;
  if (name == "rope") return JointKind::kRope;
  throw InputError("kind " + name + ": expected ball | hinge | fixed | distance | rope");
}

/// The bodies of a world at one instant, copied once.
struct Bodies {
  std::shared_ptr<const BodyArrays> arrays;
};

/// A world, and what Python needs beside it.
class PythonWorld {
 public:
  PythonWorld(const Scene& scene, int threads, bool particles);

  /// Calls `call(world)` while other threads may use the interpreter, but not this world.
  template <class Call>
  auto unlocked(const Call& call) {
    check_unasked();
    const Use use(is_used_);
    const py::gil_scoped_release release;
    return call(world_);
  }
  /// Returns the world for a change.
  World& change() {
    check_unasked();
    World& world = ask();
    arrays_ = nullptr;
    return world;
  }
  /// Calls `query(world)`, which may call Python functions that ask the world, too.
  template <class Query>
  auto query(const Query& query) {
    ask();
    const Nesting nesting(queries_);
    return query(world_);
  }
  /// Returns the world for a question.
  World& ask() {
    const Use use(is_used_);
    return world_;
  }

  void step(double dt_s) {
    change();
    unlocked([&](World& world) { world.step(dt_s); });
  }
  /// Returns a world in the same state, which shares the list of warnings.
  std::unique_ptr<PythonWorld> copy() {
    World world = unlocked([](World& of) { return of.copy(); });
    return std::unique_ptr<PythonWorld>(new PythonWorld(std::move(world), warnings_));
  }
  py::bytes save() {
    const auto saved = unlocked([](World& of) { return scenes::save_world(of); });
    return {reinterpret_cast<const char*>(saved.data()), saved.size()};
  }
  static std::unique_ptr<PythonWorld> restore(const py::bytes& saved, int threads) {
    const auto text = static_cast<std::string_view>(saved);
    scenes::SimulationOptions options;
    options.threads = threads;
    World world = scenes::restore_world(std::as_bytes(std::span(text)), options, "restore()");
    return std::unique_ptr<PythonWorld>(
        new PythonWorld(std::move(world), std::make_shared<std::vector<std::string>>()));
  }
  Bodies bodies() {
    if (!arrays_) arrays_ = std::make_shared<const BodyArrays>(ask().bodies());
    return {arrays_};
  }
  MaterialIndex material(const MaterialName& name) const { return material_of(name, materials_); }
  AddedMaterial add(const Material& material) {
    const MaterialIndex index = change().add(material);
    materials_.push_back(material.name);
    return {index.value, material.name};
  }
  const std::vector<std::string>& materials() const { return materials_; }
  const std::vector<std::string>& warnings() const { return *warnings_; }

 private:
  PythonWorld(World world, std::shared_ptr<std::vector<std::string>> warnings)
      : materials_(names_of(world.materials())),
        warnings_(std::move(warnings)),
        world_(std::move(world)) {}

  /// Counts a query while it exists.
  class Nesting {
   public:
    explicit Nesting(int& count) : count_(count) { ++count_; }
    ~Nesting() { --count_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    int& count_;
  };

  void check_unasked() const {
    if (queries_ > 0) throw std::runtime_error("the world cannot change during a query");
  }

  std::vector<std::string> materials_;  ///< Names by index.
  std::shared_ptr<std::vector<std::string>> warnings_ =
      std::make_shared<std::vector<std::string>>();
  World world_;
  std::shared_ptr<const BodyArrays> arrays_;  ///< Null after a change.
  bool is_used_ = false;
  int queries_ = 0;  ///< Queries that are not finished.
};

World made(Scene scene, int threads, bool particles,
           const std::shared_ptr<std::vector<std::string>>& warnings) {
  if (!particles) scene.limits.debris = scene.limits.dust = 0;
  scenes::SimulationOptions options;
  options.threads = threads;
  options.warn = [warnings](const std::string& warning) { warnings->push_back(warning); };
  const py::gil_scoped_release release;
  return scenes::make_world(std::move(scene), options);
}

PythonWorld::PythonWorld(const Scene& scene, int threads, bool particles)
    : materials_(names_of(scene.materials)), world_(made(scene, threads, particles, warnings_)) {}

void run(const py::object& self, double duration_s, const py::object& on_frame) {
  if (!(duration_s >= 0) || !(duration_s < kInfinity)) {
    throw InputError("run(): duration_s is " + std::to_string(duration_s) +
                     "; expected a finite time that is not negative");
  }
  auto& world = self.cast<PythonWorld&>();
  const double frames = std::floor(duration_s / kFrame_s + kFrameTolerance);
  const double rest_s = duration_s - frames * kFrame_s;
  for (double frame = 0; frame < frames; ++frame) {
    world.step(kFrame_s);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!on_frame.is_none() && on_frame(self).is(py::bool_(false))) return;
  }
  if (rest_s >= kShortestRest_s) world.step(rest_s);
}

QueryFilter filter_of(std::uint32_t mask, bool ground, const py::object& accepts) {
  QueryFilter filter;
  filter.mask = mask;
  filter.ground = ground;
  if (!accepts.is_none()) {
    filter.accepts = [accepts](BodyKey key) { return accepts(key.value).cast<bool>(); };
  }
  return filter;
}

void bind_bodies(py::module_& module) {
  py::class_<Bodies>(module, "Bodies",
                     "All bodies of a world at one instant, ascending by key, as read-only arrays. "
                     "They keep their "
                     "values after further steps, and after the world is gone.")
      .def("__len__", [](const Bodies& self) { return self.arrays->key.size(); })
      .def_property_readonly(
          "keys",
          [](const Bodies& self) { return rows_of<std::uint32_t>(self.arrays, self.arrays->key); },
          "Keys (n), uint32.")
      .def_property_readonly(
          "positions",
          [](const Bodies& self) {
            return rows_of<double>(self.arrays, self.arrays->position_W, 3);
          },
          "Centres of mass (n, 3), float64.")
      .def_property_readonly(
          "rotations",
          [](const Bodies& self) {
            return rows_of<double>(self.arrays, self.arrays->rotation_W, 4);
          },
          "Quaternions (n, 4), float64, in the order x, y, z, w.")
      .def_property_readonly(
          "velocities",
          [](const Bodies& self) {
            return rows_of<double>(self.arrays, self.arrays->velocity_W, 3);
          },
          "Velocities of the centres of mass (n, 3), float64, in m/s.")
      .def_property_readonly(
          "angular_velocities",
          [](const Bodies& self) {
            return rows_of<double>(self.arrays, self.arrays->angular_velocity_W, 3);
          },
          "Angular velocities (n, 3), float64, in rad/s.")
      .def_property_readonly(
          "is_static",
          [](const Bodies& self) { return rows_of<bool>(self.arrays, self.arrays->is_static); },
          "True for anchored bodies and those on a path (n), bool.")
      .def_property_readonly(
          "asleep",
          [](const Bodies& self) { return rows_of<bool>(self.arrays, self.arrays->asleep); },
          "True for bodies at rest that are not simulated (n), bool.");

  py::class_<BodyView>(module, "Body", "A body at one instant.")
      .def_property_readonly(
          "key", [](const BodyView& self) { return self.key.value; }, "Its key.")
      .def_property_readonly(
          "root", [](const BodyView& self) { return self.root.value; },
          "Key of the solid or ball that it was part of.")
      .def_readonly("position", &BodyView::com_W, "Centre of mass.")
      .def_property_readonly(
          "origin", [](const BodyView& self) { return self.motion.X_WR.position; },
          "Position of the origin of the frame that its solid was modelled in.")
      .def_property_readonly(
          "rotation", [](const BodyView& self) { return Xyzw(self.motion.X_WR.rotation.coeffs()); },
          "Quaternion x, y, z, w.")
      .def_property_readonly(
          "velocity", [](const BodyView& self) { return self.motion.velocity_W; },
          "Velocity of the centre of mass in m/s.")
      .def_property_readonly(
          "angular_velocity", [](const BodyView& self) { return self.motion.angular_velocity_W; },
          "Angular velocity in rad/s.")
      .def_readonly("mass_kg", &BodyView::mass_kg, "Mass.")
      .def_readonly("volume_m3", &BodyView::volume_m3, "Volume.")
      .def_readonly("convexes", &BodyView::convexes, "Number of convexes; 0 for a ball.")
      .def_readonly("is_static", &BodyView::is_static, "True if it is anchored or on a path.")
      .def_readonly("is_kinematic", &BodyView::is_kinematic, "True if it is on a path.")
      .def_readonly("asleep", &BodyView::asleep, "True if it is at rest and not simulated.")
      .def_readonly("name", &BodyView::name, "Name of its root; may be empty.")
      .def_readonly("user_data", &BodyView::user_data, "Number set by set_user_data().")
      .def_property_readonly(
          "category", [](const BodyView& self) { return self.filter.category; },
          "Category bits of its collision filter.")
      .def_property_readonly(
          "mask", [](const BodyView& self) { return self.filter.mask; },
          "Mask bits of its collision filter.")
      .def("__repr__", [](const BodyView& self) {
        return "<Body " + std::to_string(self.key.value) +
               (self.name.empty() ? "" : " of " + self.name) + ">";
      });
}

void bind_answers(py::module_& module) {
  py::class_<CastHit>(module, "CastHit", "A point that a ray or a moving ball meets.")
      .def_property_readonly(
          "body", [](const CastHit& self) { return number_of(self.body); },
          "Key of the body; None for the ground.")
      .def_readonly("slot", &CastHit::slot, "Number of the convex within the body.")
      .def_property_readonly(
          "material", [](const CastHit& self) { return number_of(self.material); },
          "Index of the material; None for the ground plane.")
      .def_readonly("distance_m", &CastHit::distance_m, "Distance along the ray.")
      .def_readonly("point", &CastHit::point_W, "The point.")
      .def_readonly("normal", &CastHit::normal_W, "Unit normal, out of the body.");
  py::class_<Overlap>(module, "Overlap", "A convex or ball that overlaps a volume.")
      .def_property_readonly(
          "body", [](const Overlap& self) { return number_of(self.body); },
          "Key of the body; None for the ground.")
      .def_readonly("slot", &Overlap::slot, "Number of the convex within the body.");
  py::class_<Contact>(module, "Contact", "A point where a body touches another.")
      .def_property_readonly(
          "other", [](const Contact& self) { return number_of(self.other); },
          "Key of the other body; None for the ground.")
      .def_readonly("point", &Contact::point_W, "The point.")
      .def_readonly("force", &Contact::force_W, "Force on the body in N, friction included.");
  py::class_<Hit>(module, "Hit", "Two bodies that met in a step.")
      .def_property_readonly(
          "a", [](const Hit& self) { return self.a.value; }, "Key of the first body.")
      .def_property_readonly(
          "b", [](const Hit& self) { return number_of(self.b); },
          "Key of the second body; None for the ground.")
      .def_readonly("point", &Hit::point_W, "The point.")
      .def_readonly("normal", &Hit::normal_W, "Unit normal from a to b.")
      .def_readonly("speed_m_s", &Hit::speed_m_s, "Closing speed along the normal.")
      .def_readonly("mass_kg", &Hit::mass_kg, "Effective mass along the normal.");
  py::class_<Events>(module, "Events",
                     "Changes during the last step, and between it and the step before.")
      .def_readonly("breaks", &Events::breaks, "Bodies that broke or cracked.")
      .def_readonly("hits", &Events::hits, "Hits, if report_hits() was called.")
      .def_property_readonly(
          "appeared", [](const Events& self) { return numbers_of(self.appeared); },
          "Keys of bodies that appeared.")
      .def_property_readonly(
          "gone", [](const Events& self) { return numbers_of(self.gone); },
          "Keys of bodies that are gone.")
      .def_property_readonly(
          "fell_asleep", [](const Events& self) { return numbers_of(self.fell_asleep); },
          "Keys of bodies that fell asleep.")
      .def_property_readonly(
          "woke", [](const Events& self) { return numbers_of(self.woke); },
          "Keys of bodies that woke.")
      .def_property_readonly(
          "joints_lost", [](const Events& self) { return numbers_of(self.joints_lost); },
          "Keys of joints that broke, or lost a body.");
}

using WorldClass = py::class_<PythonWorld>;

void bind_time(WorldClass& type) {
  type.def(
          "step", [](PythonWorld& self, double dt_s) { self.step(dt_s); },
          py::arg_v("dt_s", kFrame_s, "1 / 60"),
          "Advances by a time from 1e-6 to 0.1 s. Other Python threads run meanwhile.")
      .def("run", &run, py::arg("duration_s"), py::arg("on_frame") = py::none(),
           "Advances by a time in steps of 1/60 s. Calls on_frame(world) after each of them, and "
           "stops if the call returns False. A keyboard interrupt stops it, too.")
      .def(
          "copy", &PythonWorld::copy,
          "Returns a world in the same state, which goes on with the same bits: to roll back, keep "
          "a copy. A planar world cannot be copied.")
      .def("save", &PythonWorld::save,
           "Returns the state as bytes, for restore(); worlds in equal states have equal bytes. A "
           "planar world cannot be saved. Worlds can be pickled in this way.")
      .def_static("restore", &PythonWorld::restore, py::arg("saved"), py::arg("threads") = 0,
                  "Returns a world in the state that save() of the same version has returned, in "
                  "this or another process; it goes on with the same bits.")
      .def(py::pickle([](PythonWorld& self) { return self.save(); },
                      [](const py::bytes& saved) { return PythonWorld::restore(saved, 0); }))
      .def_property_readonly(
          "time_s", [](PythonWorld& self) { return self.ask().time_s(); }, "Time in s.")
      .def_property_readonly(
          "warnings", [](const PythonWorld& self) { return self.warnings(); },
          "Warnings about the scene.");
}

void bind_creation(WorldClass& type) {
  type.def(
          "add_material",
          [](PythonWorld& self, const Material& material) { return self.add(material); },
          py::arg("material"), "Adds a material. Returns its index.")
      .def(
          "add_solid",
          [](PythonWorld& self, const Asset& asset, const Vec3& origin, const Xyzw& rotation,
             const Vec3& velocity, const Vec3& angular_velocity, const std::string& name,
             std::uint32_t category, std::uint32_t mask, std::uint64_t user_data) {
            BodyMotion motion;
            motion.X_WR = pose_of(origin, rotation);
            motion.velocity_W = velocity;
            motion.angular_velocity_W = angular_velocity;
            World& world = self.change();
            const BodyKey key = world.add(asset, motion, name);
            const CollisionFilter filter{category, mask};
            if (filter != CollisionFilter()) world.set_filter(key, filter);
            if (user_data != 0) world.set_user_data(key, user_data);
            return key.value;
          },
          py::arg("asset"), py::arg_v("origin", Vec3(Vec3::Zero()), "(0, 0, 0)"),
          py::arg_v("rotation", Xyzw(0, 0, 0, 1), "(0, 0, 0, 1)"),
          py::arg_v("velocity", Vec3(Vec3::Zero()), "(0, 0, 0)"),
          py::arg_v("angular_velocity", Vec3(Vec3::Zero()), "(0, 0, 0)"), py::arg("name") = "",
          py::arg("category") = 1, py::arg("mask") = 0xffffffff, py::arg("user_data") = 0,
          "Adds a solid, with the origin of the asset at `origin`; rotation is a quaternion x, y, "
          "z, "
          "w. Two bodies collide if the category of each has a bit in the mask of the other. "
          "Returns the key of the body.")
      .def(
          "add_ball",
          [](PythonWorld& self, const Vec3& center, double radius_m, const MaterialName& material,
             const Vec3& velocity, const std::string& name, std::uint32_t category,
             std::uint32_t mask, std::uint64_t user_data) {
            Ball ball;
            ball.name = name;
            ball.radius_m = radius_m;
            ball.material = self.material(material);
            ball.center_W = center;
            ball.velocity_W = velocity;
            ball.filter = {category, mask};
            ball.user_data = user_data;
            return self.change().add(ball).value;
          },
          py::arg("center"), py::arg("radius_m") = 0.5, py::arg("material") = "steel",
          py::arg_v("velocity", Vec3(Vec3::Zero()), "(0, 0, 0)"), py::arg("name") = "",
          py::arg("category") = 1, py::arg("mask") = 0xffffffff, py::arg("user_data") = 0,
          "Adds a ball. Returns its key.")
      .def(
          "add_joint",
          [](PythonWorld& self, const std::string& kind, std::optional<std::int64_t> a,
             std::optional<std::int64_t> b, const Vec3& at, std::optional<Vec3> to,
             const Vec3& axis, double breaking_N, double breaking_Nm, bool collide) {
            Joint joint;
            joint.kind = joint_kind(kind);
            if (a) joint.a = body_key(*a).value;
            if (b) joint.b = body_key(*b).value;
            joint.at_W = at;
            joint.to_W = to.value_or(at);
            joint.axis_W = axis;
            joint.breaking_N = breaking_N;
            joint.breaking_Nm = breaking_Nm;
            joint.collide = collide;
            return self.change().add(joint).value;
          },
          py::arg("kind"), py::arg("a"), py::arg("b"), py::arg("at"), py::arg("to") = py::none(),
          py::arg_v("axis", Vec3(Vec3::UnitZ()), "(0, 0, 1)"), py::arg("breaking_N") = kInfinity,
          py::arg("breaking_Nm") = kInfinity, py::arg("collide") = false,
          "Joins two bodies, or a body and the world (None), in their present poses. kind: ball, "
          "hinge, fixed, distance or rope. at: anchor on a; to: anchor on b of distance and rope. "
          "Returns the key of the joint.")
      .def(
          "shoot",
          [](PythonWorld& self, const Vec3& start, const Vec3& velocity, double radius_m,
             const MaterialName& material, double time_s, const std::string& name) {
            Shot shot;
            shot.time_s = time_s;
            shot.ball.name = name;
            shot.ball.radius_m = radius_m;
            shot.ball.material = self.material(material);
            shot.ball.center_W = start;
            shot.ball.velocity_W = velocity;
            self.change().shoot(shot);
          },
          py::arg("start"), py::arg("velocity"), py::arg("radius_m") = 0.2,
          py::arg("material") = "steel", py::arg("time_s") = 0.0, py::arg("name") = "",
          "Adds a ball that appears at a time; in the next step if that has passed.")
      .def(
          "blast",
          [](PythonWorld& self, const Vec3& center, double radius_m, double impulse_Ns_m2,
             std::optional<double> tnt_kg, bool in_air, bool cover, double time_s) {
            Blast blast;
            blast.time_s = time_s;
            blast.center_W = center;
            blast.radius_m = radius_m;
            blast.impulse_Ns_m2 = impulse_Ns_m2;
            blast.tnt_kg = tnt_kg;
            blast.burst = in_air ? BurstKind::kAir : BurstKind::kGround;
            blast.cover = cover;
            self.change().blast(blast);
          },
          py::arg("center"), py::arg("radius_m") = 4.0, py::arg("impulse_Ns_m2") = 1000.0,
          py::arg("tnt_kg") = py::none(), py::arg("in_air") = false, py::arg("cover") = false,
          py::arg("time_s") = 0.0,
          "Ignites a blast: an impulse per area on every face turned to the centre, or the wave of "
          "a "
          "charge of tnt_kg on the ground, or in the air. cover: nearer bodies shield others.")
      .def(
          "drive",
          [](PythonWorld& self, const std::vector<std::int64_t>& bodies,
             std::optional<Vec3> velocity, double force_N, std::optional<Vec3> angular_velocity,
             double torque_Nm, double time_s, double until_s) {
            Drive drive;
            for (const std::int64_t body : bodies) drive.roots.push_back(body_key(body).value);
            std::ranges::sort(drive.roots);
            drive.velocity_W = velocity;
            drive.force_N = force_N;
            drive.angular_velocity_W = angular_velocity;
            drive.torque_Nm = torque_Nm;
            drive.time_s = time_s;
            drive.until_s = until_s;
            self.change().drive(drive);
          },
          py::arg("bodies"), py::arg("velocity") = py::none(), py::arg("force_N") = 1e6,
          py::arg("angular_velocity") = py::none(), py::arg("torque_Nm") = 1e6,
          py::arg("time_s") = 0.0, py::arg("until_s") = kInfinity,
          "Holds bodies at a velocity by limited force, an angular velocity by limited torque, or "
          "both, until a time, or until they break.");
}

void bind_actions(WorldClass& type) {
  type.def(
          "remove",
          [](PythonWorld& self, std::int64_t body) { self.change().remove(body_key(body)); },
          py::arg("body"), "Removes a body.")
      .def(
          "remove_joint",
          [](PythonWorld& self, std::int64_t joint) { self.change().remove(joint_key(joint)); },
          py::arg("joint"), "Removes a joint.")
      .def(
          "set_motion",
          [](PythonWorld& self, std::int64_t body, std::optional<Vec3> origin,
             std::optional<Xyzw> rotation, std::optional<Vec3> velocity,
             std::optional<Vec3> angular_velocity) {
            const BodyKey key = body_key(body);
            BodyMotion motion = self.ask().body(key).motion;
            if (origin) motion.X_WR.position = *origin;
            if (rotation) motion.X_WR.rotation = rotation_of(*rotation);
            if (velocity) motion.velocity_W = *velocity;
            if (angular_velocity) motion.angular_velocity_W = *angular_velocity;
            self.change().set_motion(key, motion);
          },
          py::arg("body"), py::arg("origin") = py::none(), py::arg("rotation") = py::none(),
          py::arg("velocity") = py::none(), py::arg("angular_velocity") = py::none(),
          "Sets the pose and velocities of a body that is not anchored, and wakes it; None: as "
          "they "
          "are.")
      .def(
          "move_to",
          [](PythonWorld& self, std::int64_t body, std::optional<Vec3> origin,
             std::optional<Xyzw> rotation, double duration_s) {
            const BodyKey key = body_key(body);
            Pose pose = self.ask().body(key).motion.X_WR;
            if (origin) pose.position = *origin;
            if (rotation) pose.rotation = rotation_of(*rotation);
            self.change().move_to(key, pose, duration_s);
          },
          py::arg("body"), py::arg("origin") = py::none(), py::arg("rotation") = py::none(),
          py::arg("duration_s") = 1.0,
          "Moves a body evenly to a pose within a time, as a kinematic body: of infinite mass, and "
          "unbreakable. It stays there until it is moved on or released.")
      .def(
          "release",
          [](PythonWorld& self, std::int64_t body) { self.change().release(body_key(body)); },
          py::arg("body"),
          "Frees a kinematic body, or removes all anchors of an anchored one. It keeps its key.")
      .def(
          "apply_impulse",
          [](PythonWorld& self, std::int64_t body, const Vec3& impulse, std::optional<Vec3> point) {
            const BodyKey key = body_key(body);
            const Vec3 at = point ? *point : self.ask().body(key).com_W;
            self.change().apply_impulse(key, impulse, at);
          },
          py::arg("body"), py::arg("impulse"), py::arg("point") = py::none(),
          "Applies an impulse in N s at a point; None: at the centre of mass.")
      .def(
          "break_at",
          [](PythonWorld& self, std::int64_t body, const Vec3& point, const Vec3& direction,
             double energy_J, const std::optional<std::string>& pattern) {
            std::optional<PatternSpec> spec;
            if (pattern) spec = pattern_of(*pattern);
            self.change().break_at(body_key(body), point, direction, energy_J, spec);
          },
          py::arg("body"), py::arg("point"), py::arg("direction"), py::arg("energy_J"),
          py::arg("pattern") = py::none(),
          "Breaks a body in the next step, as an impact that does this work at the point of the "
          "body "
          "nearest to `point` would; by a pattern such as \"voronoi:50\" in place of its "
          "material's.")
      .def(
          "set_user_data",
          [](PythonWorld& self, std::int64_t body, std::uint64_t user_data) {
            self.change().set_user_data(body_key(body), user_data);
          },
          py::arg("body"), py::arg("user_data"), "Sets a number that pieces inherit.")
      .def(
          "set_filter",
          [](PythonWorld& self, std::int64_t body, std::uint32_t category, std::uint32_t mask) {
            self.change().set_filter(body_key(body), {category, mask});
          },
          py::arg("body"), py::arg("category") = 1, py::arg("mask") = 0xffffffff,
          "Sets what the body and its pieces collide with.");
}

void bind_questions(WorldClass& type) {
  constexpr const char* kFilterDoc =
      " mask: categories that are found. accepts(key): False for bodies that are not found.";
  type.def("__len__", [](PythonWorld& self) { return self.ask().size(); })
      .def_property_readonly(
          "bodies", [](PythonWorld& self) { return self.bodies(); },
          "All bodies at present, copied once per step; its arrays are views of that copy.")
      .def(
          "body",
          [](PythonWorld& self, std::int64_t key) { return self.ask().body(body_key(key)); },
          py::arg("key"), "Returns a body. Raises InputError if it is gone.")
      .def(
          "contains",
          [](PythonWorld& self, std::int64_t key) {
            return key >= 0 && key < BodyKey::kNone && self.ask().contains(body_key(key));
          },
          py::arg("key"), "Returns True if a body is in the world.")
      .def("__contains__",
           [](PythonWorld& self, std::int64_t key) {
             return key >= 0 && key < BodyKey::kNone && self.ask().contains(body_key(key));
           })
      .def(
          "contains_joint",
          [](PythonWorld& self, std::int64_t key) {
            return key >= 0 && key < JointKey::kNone && self.ask().contains(joint_key(key));
          },
          py::arg("key"), "Returns True if a joint is in the world.")
      .def(
          "contacts",
          [](PythonWorld& self, std::int64_t body) { return self.ask().contacts(body_key(body)); },
          py::arg("body"), "Returns the contacts of a body that carry load.")
      .def(
          "cast",
          [](PythonWorld& self, const Vec3& start, const Vec3& direction, double most_m,
             double radius_m, std::uint32_t mask, bool ground, const py::object& accepts) {
            return self.query([&](World& world) {
              return world.cast(start, direction, most_m, radius_m,
                                filter_of(mask, ground, accepts));
            });
          },
          py::arg("start"), py::arg("direction"), py::arg("most_m") = 1e6,
          py::arg("radius_m") = 0.0, py::arg("mask") = 0xffffffff, py::arg("ground") = true,
          py::arg("accepts") = py::none(),
          (std::string(
               "Returns the first point that a ray meets, or a ball of this radius; None if "
               "there is none.") +
           kFilterDoc)
              .c_str())
      .def(
          "cast_all",
          [](PythonWorld& self, const Vec3& start, const Vec3& direction, double most_m,
             double radius_m, std::uint32_t mask, bool ground, const py::object& accepts) {
            return self.query([&](World& world) {
              return world.cast_all(start, direction, most_m, radius_m,
                                    filter_of(mask, ground, accepts));
            });
          },
          py::arg("start"), py::arg("direction"), py::arg("most_m") = 1e6,
          py::arg("radius_m") = 0.0, py::arg("mask") = 0xffffffff, py::arg("ground") = true,
          py::arg("accepts") = py::none(),
          (std::string("Returns all convexes and balls that a ray meets, by distance.") +
           kFilterDoc)
              .c_str())
      .def(
          "overlap",
          [](PythonWorld& self, const Vec3& center, double radius_m, std::uint32_t mask,
             bool ground, const py::object& accepts) {
            return self.query([&](World& world) {
              return world.overlap(center, radius_m, filter_of(mask, ground, accepts));
            });
          },
          py::arg("center"), py::arg("radius_m"), py::arg("mask") = 0xffffffff,
          py::arg("ground") = true, py::arg("accepts") = py::none(),
          (std::string("Returns what overlaps a ball.") + kFilterDoc).c_str())
      .def(
          "overlap_box",
          [](PythonWorld& self, const Vec3& low, const Vec3& high, std::uint32_t mask, bool ground,
             const py::object& accepts) {
            return self.query([&](World& world) {
              return world.overlap(Box{low, high}, filter_of(mask, ground, accepts));
            });
          },
          py::arg("low"), py::arg("high"), py::arg("mask") = 0xffffffff, py::arg("ground") = true,
          py::arg("accepts") = py::none(),
          (std::string("Returns what overlaps a box.") + kFilterDoc).c_str())
      .def_property_readonly(
          "materials", [](const PythonWorld& self) { return self.materials(); },
          "Names of the materials by index.")
      .def_property_readonly(
          "events", [](PythonWorld& self) { return Events(self.ask().events()); },
          "Changes during the last step, and between it and the step before.")
      .def(
          "report_hits",
          [](PythonWorld& self, double least_m_s) { self.change().report_hits(least_m_s); },
          py::arg("least_m_s"),
          "Has `events` list hits of at least this closing speed from now on; inf: none.")
      .def_property_readonly(
          "report", [](PythonWorld& self) { return dict_of(self.ask().report()); },
          "Counts, times and sums of the last step, with the names of the program's JSON.")
      .def(
          "frame",
          [](PythonWorld& self) {
            return SharedFrame{self.unlocked([](World& world) { return world.frame(); })};
          },
          "Returns the present state to draw, store or read.")
      .def(
          "state_hash",
          [](PythonWorld& self) {
            return hash_of(self.unlocked([](World& world) { return world.frame(); }));
          },
          "Returns 16 hexadecimal digits: equal digits, equal states. StateHash is for whole "
          "runs.");
}

}  // namespace

void bind_worlds(py::module_& module) {
  bind_bodies(module);
  bind_answers(module);
  WorldClass world(
      module, "World",
      "A running simulation that a program acts on and asks. Bodies are known by keys, "
      "which are never used again; wrong keys raise InputError. One thread uses a world "
      "at a time; several worlds may run in several threads.");
  world.def(py::init([](const Scene& scene, int threads, bool particles) {
              return std::make_unique<PythonWorld>(scene, threads, particles);
            }),
            py::arg("scene"), py::arg("threads") = 0, py::arg("particles") = true,
            "Makes a world of a copy of the scene. threads: 0 for one per processor; results have "
            "the same bits for any number. particles: False for neither debris nor dust.");
  bind_time(world);
  bind_creation(world);
  bind_actions(world);
  bind_questions(world);
}

}  // namespace sunder::python
