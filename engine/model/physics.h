// Physics: the interface between the world and a rigid-body solver. The world calls it a few times
// per step, in batches; the solver never calls back.
//
// A step, as the world calls it (engine/world/simulation.cpp):
//   replace(), join(), cut()         bodies and joints that the script adds or removes
//   collide()                        contacts, speculative ones included
//   repeated while something breaks:
//     speculative_contacts(), touches()        contacts that may break a body, and what is
//     connected to it set_state(), replace(), edit() the body keeps moving, its pieces are added
//     attach(), cut()                joints are moved to the pieces
//     collide()                      contacts of the new bodies
//   pause(), apply_impulse()         bodies of deferred impacts stop; blasts and drives push
//   solve(), then take_broken()      all bodies move by the step
//   contact_impulses(), joint_impulses()   impulses on breakable bodies; if bonds break, replace(),
//   plastic_flows(), strengthen()      plastic flow of joints, and their hardening
//   ...
// At the end of a frame the world calls penetrations(), and inspect() if a debug view needs it.
// states() may be called at any time.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/model/body_states.h"
#include "engine/model/collision_filter.h"
#include "engine/model/energy.h"
#include "engine/model/impact_probe.h"
#include "engine/model/joint.h"
#include "engine/model/limits_hit.h"
#include "engine/model/section.h"
#include "engine/model/work.h"

namespace sunder {

class Archive;

/// Angles between a triangle and its neighbours, one per edge, as the cosine and sine of the angle
/// by which the surface bends away (convex edge) beyond the edge; limited to a right angle. (1, 0):
/// the neighbour is flat or rises (concave edge). (0, 1): the surface ends at the edge.
using EdgeAngles = std::array<Vec2, 3>;

/// One convex shape of a body. `hull` is read during the call only.
struct ShapeDesc {
  enum class Kind : std::uint8_t { kHull, kSphere, kHalfSpace };
  Kind kind = Kind::kHull;
  const ConvexPolyhedron* hull = nullptr;  ///< kHull: in the rest frame R of the body.
  /// For a kHull of a static body: the shape is a facet, a triangle of a surface that collides with
  /// its front only. The hull is a prism whose faces are the triangle, then the sides behind its
  /// edges in their order, then the back. A shape that penetrates no deeper than the prism is
  /// pushed out through the front.
  std::optional<EdgeAngles> bends;
  Vec3 center_R = Vec3::Zero();   ///< kSphere: centre; kHalfSpace: a point of the surface.
  double radius_m = 0;            ///< kSphere.
  Vec3 normal_R = Vec3::UnitY();  ///< kHalfSpace: out of the solid.
  double friction = 0.6;
  double restitution = 0;
  double rolling = 0;  ///< Coefficient of rolling resistance: torque over normal force and radius.
  std::uint32_t tag = 0;  ///< Not read by the solver; returned with contacts.
};

/// A body to add. Frame B has the axes of rest frame R and its origin at the centre of mass.
struct BodyDesc {
  Pose X_WB;
  Vec3 com_R = Vec3::Zero();  ///< Origin of B in R: point_B = point_R − com_R.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool is_static = false;
  /// True: infinite mass; the body moves at the velocities last given to set_state().
  bool is_kinematic = false;
  double mass_kg = 0;             ///< > 0 unless static.
  Mat3 inertia_B = Mat3::Zero();  ///< kg·m², about the centre of mass; unless static.
  std::vector<ShapeDesc> shapes;
  std::uint32_t tag = 0;  ///< Not read by the solver; returned with contacts.
  CollisionFilter filter;
  bool reports_load = false;  ///< True: contact_impulses() and joint_impulses() include this body.
};

/// A change to the shapes of a static body. Shapes that are not removed keep their contacts, at no
/// cost. Bodies that move cannot be edited: their mass, inertia and centre of mass would change.
struct BodyEdit {
  BodyId body;
  /// Tags of shapes to remove; the body's tags must be unique.
  std::span<const std::uint32_t> removed_tags;
  std::span<const ShapeDesc> added;  ///< In the rest frame R of the body.
};

struct JointTag;
using JointId = Id<JointTag>;

/// A joint between two bodies, or between a body and the world. Points and directions are in the
/// rest frame R of their body, or in W for the world.
struct JointDesc {
  static constexpr bool kMayBeInfinite = true;  ///< For saved states: breaking_N, breaking_Nm.
  using Kind = JointKind;
  Kind kind = Kind::kBall;
  BodyId a, b;  ///< none(): the world.
  Vec3 anchor_a_R = Vec3::Zero(), anchor_b_R = Vec3::Zero();
  Vec3 axis_a_R = Vec3::UnitZ(), axis_b_R = Vec3::UnitZ();  ///< kHinge: unit.
  /// kFixed, kPlastic: orientation of b's rest frame in a's.
  Quat rotation_RaRb = Quat::Identity();
  double length_m = 0;  ///< kDistance, kRope.
  /// The joint breaks when its force in a substep would exceed this.
  double breaking_N = std::numeric_limits<double>::infinity();
  /// The joint breaks when its torque in a substep would exceed this.
  double breaking_Nm = std::numeric_limits<double>::infinity();
  bool collide = false;  ///< True if the two bodies collide with each other.
  /// kPlastic: strength of the section at the anchors, in the rest frame of a.
  SectionStrength strength;
  /// kPlastic: tags of the shapes next to the section, on either side. The two bodies collide,
  /// except for pairs of shapes of which one has such a tag. If one of the bodies is static, such
  /// shapes of the other body collide with no static body at all: the foot of a post does not
  /// collide with the ground around it.
  std::vector<std::uint32_t> quiet_a, quiet_b;
};

/// The bodies and joints of a physics, with what their owner gave them.
struct PhysicsContents {
  struct Body {
    BodyId id;
    std::uint32_t tag = 0;
    std::vector<std::uint32_t> shape_tags;  ///< Ascending.
  };
  struct Joint {
    JointId id;
    JointKind kind = JointKind::kBall;
  };
  std::vector<Body> bodies;
  std::vector<Joint> joints;
};

/// A contact that closes, or that would close within the step (speculative contact). Sorted by a
/// key that does not depend on the number of threads.
struct SpeculativeContact {
  BodyId a, b;
  std::uint32_t body_tag_a = 0, body_tag_b = 0;
  std::uint32_t shape_tag_a = 0, shape_tag_b = 0;
  Vec3 point_W = Vec3::Zero();
  Vec3 normal_W = Vec3::UnitY();  ///< Unit, from a to b.
  double separation_m = 0;        ///< Negative: penetrating.
  double speed_m_s = 0;           ///< Closing speed along the normal, > 0.
  double effective_mass_kg = 0;   ///< Effective mass of the pair at the point, along the normal.
};

/// A contact point of two bodies, speculative ones included.
struct Touch {
  std::uint32_t body_tag_a = 0, body_tag_b = 0;
  std::uint32_t shape_tag_a = 0, shape_tag_b = 0;
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< Lever arms from the centres of mass.
  Vec3 normal_W = Vec3::UnitY();                        ///< Unit, from a to b.
  double separation_m = 0;
};

/// A pair of bodies in contact.
struct TouchingBodies {
  std::uint32_t tag_a = 0, tag_b = 0;

  bool operator==(const TouchingBodies&) const = default;
};

/// Impulse of a contact on a body that has `reports_load`, over one solve.
struct ContactImpulse {
  std::uint32_t body_tag = 0, shape_tag = 0;
  Vec3 impulse_W = Vec3::Zero();  ///< On the body, in N s, friction included.
  Vec3 point_W = Vec3::Zero();
};

/// Impulse of a joint on a body that has `reports_load`, over one solve, at the body's anchor.
struct JointImpulse {
  std::uint32_t body_tag = 0;
  Vec3 impulse_W = Vec3::Zero();  ///< On the body, in N s.
  Vec3 point_W = Vec3::Zero();
  Vec3 angular_impulse_W = Vec3::Zero();  ///< N m s, in addition to the moment of `impulse_W`.
};

/// Plastic flow of a joint over one solve: motion of b relative to a, in the rest frame of a.
struct PlasticFlow {
  JointId joint;
  Vec3 turn_R = Vec3::Zero();          ///< Rotation, as a rotation vector.
  Vec3 displacement_R = Vec3::Zero();  ///< Displacement of b's anchor relative to a's, in m.
  double work_J = 0;                   ///< Plastic work, >= 0.
};

/// Results of one solve, for the accounting of momentum and energy.
struct SolveReport {
  /// Impulse of gravity, of static and kinematic bodies, and of putting bodies to sleep.
  Vec3 external_impulse_Ns = Vec3::Zero();
  /// Momentum of all bodies that are neither static nor kinematic.
  Vec3 momentum_before_Ns = Vec3::Zero(), momentum_after_Ns = Vec3::Zero();
  double mass_kg = 0;          ///< Mass of all bodies that are neither static nor kinematic.
  std::uint32_t contacts = 0;  ///< Manifolds with at least one point in reach.
  std::uint32_t contact_points = 0;
  std::uint32_t awake = 0;   ///< Dynamic bodies.
  std::uint32_t frozen = 0;  ///< Bodies stopped because their state was not finite.
  EnergyFlows energy;        ///< Changes of the kinetic energy by cause.
  /// Sum over all contacts of the largest friction by Coulomb's law.
  double friction_allowed_Ns = 0;
  double friction_excess_Ns = 0;  ///< Sum of friction beyond Coulomb's law.
  /// Limits reached since the last solve, in collide() or solve(): each at most once.
  LimitsHit limits;
};

/// A contact point that carries load.
struct ContactForce {
  std::uint32_t body_tag_a = 0, body_tag_b = 0;
  Vec3 point_W = Vec3::Zero();
  Vec3 force_W = Vec3::Zero();  ///< On b, in N, friction included; mean over the last substep.
};

/// Bounding box of a shape in the broad phase.
struct ShapeBox {
  std::uint32_t body_tag = 0;
  Box box_W;
};

/// Internal state of the solver, for debug views.
struct PhysicsInspection {
  std::vector<ShapeBox> boxes;  ///< Sorted by a key that does not depend on the number of threads.
};

/// A shape that a query may meet.
struct ShapeId {
  std::uint32_t body_tag = 0, shape_tag = 0;

  auto operator<=>(const ShapeId&) const = default;
};

/// Receives the shapes that a query may meet.
class ShapeVisitor {
 public:
  /// Called with a shape, which may come more than once; returns how far along the ray the query
  /// goes on, at most `reach_m`.
  virtual double visit(const ShapeId& shape, double reach_m) = 0;

 protected:
  ~ShapeVisitor() = default;
};

/// Interface of a rigid-body solver. Implemented by solver/rigid and solver/planar.
class Physics {
 public:
  virtual ~Physics() = default;

  /// Returns a copy, which later calls change as they would change this; ids stay valid in it.
  virtual std::unique_ptr<Physics> copy() const {
    throw InputError("the state of this solver cannot be copied");
  }
  /// Writes the state to an archive, or takes it over from one; ids stay valid in it.
  virtual void archive(Archive& /*bytes*/) {
    throw InputError("the state of this solver cannot be saved");
  }
  /// Returns all bodies and joints, to check a state that was read.
  virtual PhysicsContents contents() const { return {}; }
  /// Removes bodies, then adds bodies; returns the new ids in the order of `add`. Neighbours of
  /// removed bodies are woken.
  virtual std::vector<BodyId> replace(std::span<const BodyId> remove,
                                      std::span<const BodyDesc> add) = 0;
  /// Changes the shapes of a static body and wakes bodies that lose a support.
  virtual void edit(const BodyEdit& edit) = 0;
  /// Finds contacts, speculative ones within `horizon_s` included; a second call adds new bodies.
  virtual void collide(double horizon_s) = 0;
  /// Returns the contacts of the last collide() that close at the current velocities.
  virtual std::vector<SpeculativeContact> speculative_contacts() = 0;
  /// Returns the contact points of `bodies`, each once, as the last collide() found them, in order
  /// of their keys. Valid until the next call that changes anything.
  virtual std::vector<Touch> touches(std::span<const BodyId> bodies) = 0;
  /// Returns the body pairs of touches(bodies), in its order; consecutive equal pairs once.
  virtual std::vector<TouchingBodies> touching(std::span<const BodyId> bodies) {
    std::vector<TouchingBodies> all;
    for (const Touch& touch : touches(bodies)) {
      const TouchingBodies both{touch.body_tag_a, touch.body_tag_b};
      if (all.empty() || all.back() != both) all.push_back(both);
    }
    return all;
  }
  /// Returns a probe of the impacts on a cluster within the step. Any thread may call it.
  virtual std::unique_ptr<ImpactProbe> probe(ProbeCluster cluster) const = 0;
  /// Sets a body's pose and velocities and wakes it; ignored for static bodies. A kinematic body
  /// keeps these velocities through all solves until the next call.
  virtual void set_state(BodyId body, const BodyState& state) = 0;
  /// Changes a body's momentum and wakes it; ignored for static and kinematic bodies.
  virtual void apply_impulse(BodyId body, const Vec3& impulse_W, const Vec3& point_W) = 0;
  /// Makes bodies stand still in the next solve, after which they have their former velocities:
  /// nothing pushes them, and other bodies collide with them as with sleeping ones. Bodies joined
  /// to them stand still as well. A solver that does not implement this moves them.
  virtual void pause(std::span<const BodyId> /*bodies*/) {}
  /// Adds a joint and wakes its bodies. When a body is removed, its joints hold nothing until
  /// attach() or cut().
  virtual JointId join(const JointDesc&) {
    throw InputError("this solver does not support joints; remove [[joint]] from the scene");
  }
  /// Moves an end of a joint (a, or else b) to another body with the same rest frame. `quiet_tags`
  /// replace the tags in JointDesc::quiet_a or quiet_b of a plastic joint.
  virtual void attach(JointId, bool /*end_a*/, BodyId,
                      std::span<const std::uint32_t> /*quiet_tags*/ = {}) {}
  /// Replaces the strength of a plastic joint, which has hardened.
  virtual void strengthen(JointId, const SectionStrength&) {}
  /// Removes a joint and wakes its bodies.
  virtual void cut(JointId) {}
  /// Returns the joints that broke under load since the last call, ascending; they no longer exist.
  virtual std::vector<JointId> take_broken() { return {}; }
  /// Advances by dt_s in `substeps` equal parts, using the contacts of the last collide().
  virtual SolveReport solve(double dt_s, int substeps) = 0;

  /// Returns the current state of all bodies; valid until the next call that changes anything.
  virtual BodyStates states() const = 0;
  /// Returns a copy of the state of one body.
  BodyState state(BodyId body) const { return states()[body]; }
  /// Returns the contact impulses of the last solve() on bodies that have `reports_load`, sorted by
  /// a key that does not depend on the number of threads. A sleeping contact counts with the
  /// impulse that it last carried.
  virtual std::vector<ContactImpulse> contact_impulses() const = 0;
  /// Returns the joint impulses of the last solve() on bodies that have `reports_load`.
  virtual std::vector<JointImpulse> joint_impulses() const { return {}; }
  /// Returns the plastic joints that flowed in the last solve(); ascending.
  virtual std::vector<PlasticFlow> plastic_flows() const { return {}; }
  /// Returns the penetrations (m, >= 0) of contact points that carry load, unordered; statistics.
  virtual std::vector<float> penetrations() const = 0;
  /// Returns the contact points that carry load, sorted by a key that does not depend on the number
  /// of threads.
  virtual std::vector<ContactForce> contact_forces() const { return {}; }
  /// Visits the shapes whose boxes a ball of `radius_m` (maybe 0) meets on its way from `from_W`
  /// along the unit vector `direction_W` up to `reach_m`, in their present poses, near ones first
  /// by and large; half-spaces always. Does not change what any other call returns.
  virtual void visit_on_ray(const Vec3& /*from_W*/, const Vec3& /*direction_W*/, double /*reach_m*/,
                            double /*radius_m*/, ShapeVisitor& /*visitor*/) {
    throw InputError("this solver answers no ray casts");
  }
  /// Visits the shapes whose boxes overlap a box, in their present poses; half-spaces always.
  virtual void visit_in_box(const Box& /*box_W*/, ShapeVisitor& /*visitor*/) {
    throw InputError("this solver answers no overlap queries");
  }
  /// Returns the current internal state; called for debug views only.
  virtual PhysicsInspection inspect() const { return {}; }
  /// Returns the work counted since the last call.
  virtual std::vector<WorkItem> take_work() { return {}; }
};

}  // namespace sunder
