// The seam between the world and whatever moves bodies. Called a few times a step, in batches;
// nothing calls back.
//
// A step, as the world calls it (engine/world/simulation.cpp):
//   replace(), join(), cut()         what the script brings in or takes away
//   collide()                        contacts, and what will touch before long
//   as often as something breaks:
//     approaches(), touches()        who may break, and what is connected to it
//     set_state(), replace(), edit() what is left moves on, pieces come in
//     attach(), cut()                joints follow the pieces
//     collide()                      new bodies meet the others
//   pause(), apply_impulse()         what waits sits out; blasts and drives push
//   solve(), then take_broken()      everything moves by the step
//   contact_loads(), joint_loads()   what pressed and pulled; overloaded bonds part it: replace(),
//   joint_flows(), strengthen()      what flowed, and hardens by it
//   ...
// And at the end of a frame penetrations(), and inspect() if somebody looks. states() may be asked
// for at any time.
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
#include "engine/model/energy.h"
#include "engine/model/impact_probe.h"
#include "engine/model/joint.h"
#include "engine/model/section.h"
#include "engine/model/work.h"

namespace sunder {

/// How a surface goes on beyond each edge of one of its triangles: cosine and sine of the angle by
/// which it bends away there, up to a right angle; (1, 0) where it goes on straight or rises, (0,
/// 1) where it ends.
using FacetBends = std::array<Vec2, 3>;

/// One convex shape of a body. `hull` must outlive the call only.
struct ShapeDesc {
  enum class Kind : std::uint8_t { kHull, kSphere, kHalfSpace };
  Kind kind = Kind::kHull;
  const ConvexPolyhedron* hull = nullptr;  ///< kHull: in the rest frame R of the body.
  /// kHull of a static body: it is a facet, a triangle that is met from its front alone, as part of
  /// a surface. The hull is a prism: the triangle, what is behind its edges, in their order, and
  /// the back. What gets in no farther than that is pushed out by the front.
  std::optional<FacetBends> bends;
  Vec3 center_R = Vec3::Zero();   ///< kSphere: centre; kHalfSpace: a point of the surface.
  double radius_m = 0;            ///< kSphere.
  Vec3 normal_R = Vec3::UnitY();  ///< kHalfSpace: out of the solid.
  double friction = 0.6;
  double restitution = 0;
  double rolling = 0;     ///< Of resistance to rolling: its torque over load and radius.
  std::uint32_t tag = 0;  ///< Opaque; comes back in contacts.
};

/// A body to add. B sits at the centre of mass with the axes of the rest frame R.
struct BodyDesc {
  Pose X_WB;
  Vec3 com_R = Vec3::Zero();  ///< Origin of B in R: point_B = point_R − com_R.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool is_static = false;
  /// Nothing pushes it: it goes on as set_state() last said, and what it meets gives way.
  bool is_kinematic = false;
  double mass_kg = 0;             ///< > 0 unless static.
  Mat3 inertia_B = Mat3::Zero();  ///< kg·m², about the centre of mass; unless static.
  std::vector<ShapeDesc> shapes;
  std::uint32_t tag = 0;      ///< Opaque; comes back in contacts.
  bool reports_load = false;  ///< What presses and pulls on it is reported.
};

/// A change to the shapes of a body that stays; what it keeps keeps its contacts, and costs
/// nothing. Static bodies only: a body that moves would need a new mass, inertia and centre as
/// well.
struct BodyEdit {
  BodyId body;
  std::span<const std::uint32_t> removed_tags;  ///< Of shapes it has; its tags must be unique.
  std::span<const ShapeDesc> added;             ///< In the rest frame R of the body.
};

struct JointTag;
using JointId = Id<JointTag>;

/// What holds two bodies, or a body and the world, together. Places and directions are in the rest
/// frame R of their body; in W where there is none.
struct JointDesc {
  using Kind = JointKind;
  Kind kind = Kind::kBall;
  BodyId a, b;  ///< None: the world.
  Vec3 anchor_a_R = Vec3::Zero(), anchor_b_R = Vec3::Zero();
  Vec3 axis_a_R = Vec3::UnitZ(), axis_b_R = Vec3::UnitZ();  ///< kHinge: unit.
  Quat rotation_RaRb = Quat::Identity();  ///< kFixed, kPlastic: of b as a sees it.
  double length_m = 0;                    ///< kDistance, kRope.
  /// It breaks when it would have to bear more, within any substep.
  double breaking_N = std::numeric_limits<double>::infinity();
  double breaking_Nm = std::numeric_limits<double>::infinity();
  bool collide = false;  ///< Whether the two bodies touch each other.
  /// kPlastic: of the section at the anchors, in the rest frame of a.
  SectionStrength strength;
  /// kPlastic: tags of the shapes beside the section, on either side. The bodies touch each other,
  /// but for pairs of shapes one of which is among these. Where one of the bodies is static, such
  /// shapes of the other touch nothing that is: a post's foot is held by the ground that it is in.
  std::vector<std::uint32_t> quiet_a, quiet_b;
};

/// A contact that closes, or would close within the step. Ordered by a key that does not depend on
/// threads.
struct Approach {
  BodyId a, b;
  std::uint32_t body_tag_a = 0, body_tag_b = 0;
  std::uint32_t shape_tag_a = 0, shape_tag_b = 0;
  Vec3 point_W = Vec3::Zero();
  Vec3 normal_W = Vec3::UnitY();  ///< Unit, from a to b.
  double separation_m = 0;        ///< Negative: penetrating.
  double speed_m_s = 0;           ///< Approach speed along the normal, > 0.
  double effective_mass_kg = 0;   ///< Of the pair at the point along the normal.
};

/// A point where two bodies touch, or would within the step.
struct Touch {
  std::uint32_t body_tag_a = 0, body_tag_b = 0;
  std::uint32_t shape_tag_a = 0, shape_tag_b = 0;
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< From the centres of mass.
  Vec3 normal_W = Vec3::UnitY();                        ///< Unit, from a to b.
  double separation_m = 0;
};

/// Two bodies that do so.
struct TouchingBodies {
  std::uint32_t tag_a = 0, tag_b = 0;

  bool operator==(const TouchingBodies&) const = default;
};

/// What a contact did to a body that bears load, over one solve.
struct ContactLoad {
  std::uint32_t body_tag = 0, shape_tag = 0;
  Vec3 impulse_W = Vec3::Zero();  ///< On the body, N·s, friction included.
  Vec3 point_W = Vec3::Zero();
};

/// What a joint did to a body that bears load, over one solve, where it is anchored to it.
struct JointLoad {
  std::uint32_t body_tag = 0;
  Vec3 impulse_W = Vec3::Zero();  ///< On the body, N·s.
  Vec3 point_W = Vec3::Zero();
  Vec3 angular_impulse_W = Vec3::Zero();  ///< N·m·s, besides that of the impulse.
};

/// How a plastic joint has flowed over one solve: how b moved against a, in the rest frame of a.
struct JointFlow {
  JointId joint;
  Vec3 turn_R = Vec3::Zero();   ///< Rotation vector.
  Vec3 drawn_R = Vec3::Zero();  ///< m, of the anchors.
  double work_J = 0;            ///< That it took; >= 0.
};

/// What one solve did, for the ledger.
struct SolveReport {
  /// Gravity, static and kinematic bodies, and what sleep took away.
  Vec3 external_impulse_Ns = Vec3::Zero();
  /// Of all bodies that are neither static nor kinematic.
  Vec3 momentum_before_Ns = Vec3::Zero(), momentum_after_Ns = Vec3::Zero();
  double mass_kg = 0;          ///< Of the same.
  std::uint32_t contacts = 0;  ///< Manifolds with a point in reach.
  std::uint32_t contact_points = 0;
  std::uint32_t awake = 0;         ///< Dynamic bodies.
  std::uint32_t frozen = 0;        ///< Bodies stopped because they were no longer finite.
  EnergyFlows energy;              ///< What changed the kinetic energy.
  double friction_allowed_Ns = 0;  ///< By Coulomb's law, of all contacts,
  double friction_excess_Ns = 0;   ///< and friction beyond it.
};

/// A point where two bodies press on each other.
struct PressPoint {
  std::uint32_t body_tag_a = 0, body_tag_b = 0;
  Vec3 point_W = Vec3::Zero();
  Vec3 force_W = Vec3::Zero();  ///< On b, N, friction included, over the last substep.
};

/// What the broad phase takes a shape for.
struct ShapeBox {
  std::uint32_t body_tag = 0;
  Box box_W;
};

/// What goes on in a physics, for who looks into it.
struct PhysicsInspection {
  std::vector<PressPoint> presses;  ///< Ordered by a key that does not depend on threads.
  std::vector<ShapeBox> boxes;      ///< Likewise.
};

class Physics {
 public:
  virtual ~Physics() = default;

  /// Removes, then adds; the answer's order is that of `add`. Neighbours of what goes wake up.
  virtual std::vector<BodyId> replace(std::span<const BodyId> remove,
                                      std::span<const BodyDesc> add) = 0;
  /// Changes the shapes of a static body; sleepers that lose a support wake up.
  virtual void edit(const BodyEdit& edit) = 0;
  /// Finds contacts and what may touch within that time; new bodies are included when called again.
  virtual void collide(double horizon_s) = 0;
  /// Approaches among the contacts of the last collide(), with the velocities as they are now.
  virtual std::vector<Approach> approaches() = 0;
  /// Contact points of any of `bodies`, each once, as the last collide() found them and in order of
  /// keys; valid until the next call that changes anything.
  virtual std::vector<Touch> touches(std::span<const BodyId> bodies) = 0;
  /// Whose they are, in the same order; who comes several times in a row, once.
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
  /// Puts a body into a state of motion and wakes it; static bodies ignore it. Kinematic ones keep
  /// to it through solves, with its velocities as they are, until they are told otherwise.
  virtual void set_state(BodyId body, const BodyState& state) = 0;
  /// Changes a body's momentum by an impulse at a point and wakes it; static and kinematic
  /// bodies ignore it.
  virtual void apply_impulse(BodyId body, const Vec3& impulse_W, const Vec3& point_W) = 0;
  /// Bodies that stand still in the next solve and go on as they were after it: nothing pushes
  /// them, and others meet them as they meet what is asleep. What they are joined to stands as
  /// well, or it would hang on what cannot move. A physics that cannot lets them move.
  virtual void pause(std::span<const BodyId> /*bodies*/) {}
  /// Joins two bodies and wakes them. When a body is removed, its ends of joints hold nothing until
  /// attach() or cut().
  virtual JointId join(const JointDesc&) {
    throw InputError("this physics has no joints: take [[joint]] out of the scene");
  }
  /// Moves an end of a joint (a, or else b) to another body with the same rest frame; its quiet
  /// shapes, if it is plastic, have these tags.
  virtual void attach(JointId, bool /*end_a*/, BodyId,
                      std::span<const std::uint32_t> /*quiet_tags*/ = {}) {}
  /// Of a plastic joint that has hardened.
  virtual void strengthen(JointId, const SectionStrength&) {}
  /// Takes a joint away and wakes what it held.
  virtual void cut(JointId) {}
  /// The joints that broke under load since the last call, which are gone; ascending.
  virtual std::vector<JointId> take_broken() { return {}; }
  /// Advances by dt_s in `substeps` equal parts, using the contacts of the last collide().
  virtual SolveReport solve(double dt_s, int substeps) = 0;

  /// How all bodies move now; valid until the next call that changes anything.
  virtual BodyStates states() const = 0;
  /// Of one of them, to keep.
  BodyState state(BodyId body) const { return states()[body]; }
  /// What the last solve() did to bodies that bear load, ordered by a key that does not depend on
  /// threads; contacts asleep count with what they last carried.
  virtual std::vector<ContactLoad> contact_loads() const = 0;
  /// The same of joints.
  virtual std::vector<JointLoad> joint_loads() const { return {}; }
  /// Of the plastic joints that flowed in the last solve(); ascending.
  virtual std::vector<JointFlow> joint_flows() const { return {}; }
  /// Depths (m, >= 0) of all contact points that carry load, unordered; for statistics.
  virtual std::vector<float> penetrations() const = 0;
  /// As it is now; asked for by debug views alone.
  virtual PhysicsInspection inspect() const { return {}; }
  /// What it did since the last call.
  virtual std::vector<WorkItem> take_work() { return {}; }
};

}  // namespace sunder
