// Implements Physics with Box2D. Read first: replace(), then solve().
#include "solver/planar/planar_physics.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/froude.h"
#include "engine/base/trigonometry.h"
#include "engine/model/work_log.h"
#include "solver/base/check_bodies.h"
#include "solver/impact/event_probe.h"
#include "solver/planar/contact_listener.h"
#include "solver/planar/planar_reports.h"
#include "solver/planar/planar_touches.h"

namespace sunder::solver {
namespace {

// Iterations that the Box2D manual recommends.
constexpr int kVelocityIterations = 8, kPositionIterations = 3;
// Duration of a free fall whose final speed is the least closing speed for restitution.
constexpr double kRestitutionFall_s = 0.05;
constexpr double kMaxFiniteSpeed_m_s = 1e9;  // speed from which a body counts as not finite
// Least and greatest motion of a body per Box2D step for which steps are added, in units.
constexpr float kMinMotionPerStep = 0.02f, kMaxMotionPerStep = 0.9f * b2_maxTranslation;
constexpr int kMaxBox2DSteps = 4096;

class PlanarPhysics final : public Physics {
 public:
  explicit PlanarPhysics(const PlanarOptions& options);

  std::vector<BodyId> replace(std::span<const BodyId> remove,
                              std::span<const BodyDesc> add) override;
  void edit(const BodyEdit& edit) override;
  void collide(double dt_s) override;
  std::unique_ptr<ImpactProbe> probe(ProbeCluster cluster) const override {
    return make_event_probe(std::move(cluster));
  }
  std::vector<SpeculativeContact> speculative_contacts() override;
  std::vector<Touch> touches(std::span<const BodyId> bodies) override;
  void set_state(BodyId body, const BodyState& state) override;
  void apply_impulse(BodyId body, const Vec3& impulse_W, const Vec3& point_W) override;
  SolveReport solve(double dt_s, int substeps) override;
  BodyStates states() const override { return table_.states(); }
  std::vector<ContactImpulse> contact_impulses() const override;
  std::vector<float> penetrations() const override { return find_penetrations(world_, plane_); }
  std::unique_ptr<Physics> copy() const override {
    throw InputError("a planar world cannot be copied, as Box2D has no copies of its worlds");
  }
  void archive(Archive& /*bytes*/) override {
    throw InputError("a planar world cannot be saved, as Box2D hides the state of its worlds");
  }
  PhysicsInspection inspect() const override { return inspect_planar(bodies_.items, plane_); }
  std::vector<ContactForce> contact_forces() const override {
    return find_contact_forces(world_, bodies_.items, plane_, last_h_s_);
  }
  std::vector<WorkItem> take_work() override { return work_.take(); }

 private:
  /// Updates the state of one body, or of all, in table_, and invalidates the contacts.
  void update_table(std::uint32_t slot);
  void update_whole_table();
  BodyState state_of(const PlanarBody& body) const;
  Vec3 momentum_Ns() const;
  double kinetic_J() const;
  void step(float h_s, SolveReport& report);
  void scale_sleeping_contacts(float scale, std::span<const std::uint8_t> awake);
  void freeze_not_finite(SolveReport& report);
  int steps_for(double dt_s, int substeps, LimitsHit& limits) const;
  const std::vector<FixtureContact>& contacts();
  double inverse_mass(const PlanarBody& body, const Vec3& arm_W, const Vec3& normal_W) const;
  Vec3 velocity_at(const PlanarBody& body, const Vec3& point_W) const;
  Vec3 center_W(const PlanarBody& body) const { return plane_.metres(body.body->GetPosition()); }
  PlanarBody& at(BodyId id) {
    SUNDER_CHECK(id.slot < bodies_.items.size() && bodies_.items[id.slot].body &&
                 bodies_.items[id.slot].generation == id.generation);
    return bodies_.items[id.slot];
  }

  PlanarOptions options_;
  Plane2 plane_;
  b2World world_;
  PlanarBodies bodies_;
  ContactListener listener_;
  BodyTable table_;
  std::vector<FixtureContact> contacts_;
  bool contacts_valid_ = false;
  double dt_s_ = 0;       ///< Step of the last collide().
  double last_h_s_ = 0;   ///< Duration of Box2D's last step; 0 before the first.
  double last_dt_s_ = 0;  ///< Duration of the last solve; 0 before the first.
  WorkLog work_;
};

PlanarPhysics::PlanarPhysics(const PlanarOptions& options)
    : options_(options),
      plane_{1 / options.piece_m},
      world_(plane_.units(options.gravity_W)),
      bodies_(world_, plane_, kRestitutionFall_s * options.gravity_W.norm()),
      listener_(bodies_.items) {
  SUNDER_CHECK(options.piece_m > 0 && options.gravity_W.z() == 0);
  world_.SetAllowSleeping(options.sleeping);
  world_.SetContinuousPhysics(false);
  world_.SetContactListener(&listener_);
}

std::vector<BodyId> PlanarPhysics::replace(std::span<const BodyId> remove,
                                           std::span<const BodyDesc> add) {
  check_bodies(add);
  std::vector<ConvertedShapes> converted;  // made before anything changes, because this may throw
  for (const BodyDesc& desc : add) {
    converted.push_back(bodies_.convert_shapes(desc.shapes, desc.tag, desc.com_R, desc.X_WB));
  }
  for (const BodyId id : remove) {
    at(id);
    bodies_.remove(id.slot);
    table_.remove(id);
  }
  std::vector<BodyId> ids;
  for (std::size_t i = 0; i < add.size(); ++i) {
    const std::uint32_t slot = bodies_.add(add[i], converted[i]);
    ids.push_back({slot, bodies_.items[slot].generation});
  }
  update_whole_table();
  return ids;
}

void PlanarPhysics::edit(const BodyEdit& edit) {
  PlanarBody& body = at(edit.body);
  SUNDER_CHECK(!body.dynamic() && !body.kinematic());
  check_shapes(edit.added, body.tag);
  const ConvertedShapes converted =
      bodies_.convert_shapes(edit.added, body.tag, body.com_R, body.X_WB);
  for (const std::uint32_t tag : edit.removed_tags) {
    const auto found = std::find_if(body.shapes.begin(), body.shapes.end(),
                                    [&](std::uint32_t s) { return bodies_.shapes[s].tag == tag; });
    SUNDER_CHECK(found != body.shapes.end());
    bodies_.remove_shape(*found);
  }
  bodies_.add_shapes(edit.body.slot, edit.added, converted);
  update_whole_table();
}

/// Contacts are found when speculative_contacts() or touches() is called; Box2D finds its own in
/// the solve.
void PlanarPhysics::collide(double dt_s) {
  dt_s_ = dt_s;
  contacts_valid_ = false;
}

const std::vector<FixtureContact>& PlanarPhysics::contacts() {
  if (!contacts_valid_)
    contacts_ = find_fixture_contacts(world_, bodies_.items, bodies_.shapes, plane_, dt_s_);
  contacts_valid_ = true;
  return contacts_;
}

Vec3 PlanarPhysics::velocity_at(const PlanarBody& body, const Vec3& point_W) const {
  const Vec3 angular_velocity_W(0, 0, static_cast<double>(body.body->GetAngularVelocity()));
  return plane_.metres(body.body->GetLinearVelocity()) +
         angular_velocity_W.cross(point_W - center_W(body));
}

double PlanarPhysics::inverse_mass(const PlanarBody& body, const Vec3& arm_W,
                                   const Vec3& normal_W) const {
  if (!body.dynamic()) return 0;
  const double arm = arm_W.cross(normal_W).z();
  return 1 / body.mass_kg + arm * arm / body.inertia_kg_m2;
}

std::vector<SpeculativeContact> PlanarPhysics::speculative_contacts() {
  const double rest_speed_m_s = FroudeScale(options_.gravity_W).rest_speed_m_s(dt_s_);
  std::vector<SpeculativeContact> all;
  for (const FixtureContact& contact : contacts()) {
    const PlanarBody &a = bodies_.items[contact.body_a], &b = bodies_.items[contact.body_b];
    const auto awake = [](const PlanarBody& body) {
      return body.dynamic() && body.body->IsAwake();
    };
    if (!awake(a) && !awake(b)) continue;
    const auto speed_at = [&](const Vec3& point) {
      return contact.normal_W.dot(velocity_at(a, point) - velocity_at(b, point));
    };
    SpeculativeContact approach;
    int closing = 0;
    for (int i = 0; i < contact.count; ++i) {
      const double speed = speed_at(contact.points_W[i]);
      if (speed < rest_speed_m_s || contact.separations_m[i] > speed * dt_s_) continue;
      approach.separation_m = closing == 0
                                  ? contact.separations_m[i]
                                  : std::min(approach.separation_m, contact.separations_m[i]);
      approach.point_W += contact.points_W[i];
      ++closing;
    }
    if (closing == 0) continue;
    approach.point_W /= closing;
    approach.normal_W = contact.normal_W;
    approach.speed_m_s = speed_at(approach.point_W);
    const double inverse = inverse_mass(a, approach.point_W - center_W(a), contact.normal_W) +
                           inverse_mass(b, approach.point_W - center_W(b), contact.normal_W);
    if (approach.speed_m_s <= 0 || inverse <= 0) continue;
    approach.effective_mass_kg = 1 / inverse;
    approach.a = {contact.body_a, a.generation}, approach.b = {contact.body_b, b.generation};
    approach.body_tag_a = a.tag, approach.body_tag_b = b.tag;
    approach.shape_tag_a = bodies_.shapes[contact.shape_a].tag;
    approach.shape_tag_b = bodies_.shapes[contact.shape_b].tag;
    all.push_back(approach);
  }
  return all;
}

std::vector<Touch> PlanarPhysics::touches(std::span<const BodyId> bodies) {
  std::set<std::uint32_t> wanted;
  for (const BodyId id : bodies) {
    at(id);
    wanted.insert(id.slot);
  }
  std::vector<Touch> all;
  for (const FixtureContact& contact : contacts()) {
    if (!wanted.contains(contact.body_a) && !wanted.contains(contact.body_b)) continue;
    const PlanarBody &a = bodies_.items[contact.body_a], &b = bodies_.items[contact.body_b];
    Touch touch;
    touch.body_tag_a = a.tag, touch.body_tag_b = b.tag;
    touch.shape_tag_a = bodies_.shapes[contact.shape_a].tag,
    touch.shape_tag_b = bodies_.shapes[contact.shape_b].tag;
    touch.normal_W = contact.normal_W;
    for (int i = 0; i < contact.count; ++i) {
      const Vec3 half_gap = 0.5 * contact.separations_m[i] * contact.normal_W;
      touch.arm_a_W = contact.points_W[i] - half_gap - center_W(a);
      touch.arm_b_W = contact.points_W[i] + half_gap - center_W(b);
      touch.separation_m = contact.separations_m[i];
      all.push_back(touch);
    }
  }
  return all;
}

void PlanarPhysics::set_state(BodyId id, const BodyState& state) {
  PlanarBody& body = at(id);
  if (!body.dynamic() && !body.kinematic()) return;
  const Quat rotation = state.X_WB.rotation * body.X_WB.rotation.conjugate();
  body.body->SetTransform(plane_.units(state.X_WB.position),
                          static_cast<float>(2 * arc_tangent(rotation.z(), rotation.w())));
  body.body->SetLinearVelocity(plane_.units(state.velocity_W));
  body.body->SetAngularVelocity(static_cast<float>(state.angular_velocity_W.z()));
  body.body->SetAwake(true);
  update_table(id.slot);
}

void PlanarPhysics::apply_impulse(BodyId id, const Vec3& impulse_W, const Vec3& point_W) {
  PlanarBody& body = at(id);
  if (!body.dynamic()) return;
  body.body->ApplyLinearImpulse(plane_.units(impulse_W), plane_.units(point_W), true);
  update_table(id.slot);
}

SolveReport PlanarPhysics::solve(double dt_s, int substeps) {
  SUNDER_CHECK(dt_s > 0 && substeps > 0);
  WorkSpan span(work_, Stage::kSolve, "contacts in Box2D");
  SolveReport report;
  report.momentum_before_Ns = momentum_Ns();
  freeze_not_finite(report);
  const double before_J = kinetic_J();
  const int steps = steps_for(dt_s, substeps, report.limits);
  listener_.begin(last_dt_s_ > 0 ? static_cast<float>(dt_s / last_dt_s_) : 1);
  for (int i = 0; i < steps; ++i) {
    step(static_cast<float>(dt_s / steps), report);
    last_h_s_ = dt_s / steps;
  }
  listener_.end(steps);
  last_dt_s_ = dt_s;
  freeze_not_finite(report);
  report.external_impulse_Ns += plane_.metres(listener_.impulse_from_static);
  for (const b2Contact* c = world_.GetContactList(); c; c = c->GetNext()) {
    if (!c->IsTouching()) continue;
    ++report.contacts;
    report.contact_points += static_cast<std::uint32_t>(c->GetManifold()->pointCount);
  }
  for (const PlanarBody& body : bodies_.items) {
    report.awake += body.dynamic() && body.body->IsAwake() ? 1 : 0;
    report.mass_kg += body.body ? body.mass_kg : 0;
  }
  report.momentum_after_Ns = momentum_Ns();
  report.energy.contacts = before_J + report.energy.gravity - kinetic_J();
  update_whole_table();
  span.count(report.contacts);
  return report;
}

/// Returns the Box2D steps, at most kMaxBox2DSteps or `substeps`, in which no body moves farther
/// than half the least width of a shape, so that none tunnels, nor Box2D's own limit.
int PlanarPhysics::steps_for(double dt_s, int substeps, LimitsHit& limits) const {
  double fastest = 0;  // units/s
  for (const PlanarBody& body : bodies_.items) {
    if (!body.dynamic() && !body.kinematic()) continue;
    fastest = std::max(fastest, static_cast<double>(body.body->GetLinearVelocity().Length()));
  }
  const float motion = std::clamp(0.5f * bodies_.min_width, kMinMotionPerStep, kMaxMotionPerStep);
  const double wanted = fastest * dt_s / static_cast<double>(motion);
  const int steps =
      std::max(substeps, static_cast<int>(std::ceil(std::min<double>(wanted, kMaxBox2DSteps))));
  limits[Limit::kPlanarSteps] = wanted > steps;
  return steps;
}

/// Runs one Box2D step and adds the impulse and work of gravity on bodies that are awake before or
/// after it, and the momentum that bodies lose by falling asleep, to the report.
void PlanarPhysics::step(float h_s, SolveReport& report) {
  std::vector<std::uint8_t> awake(bodies_.items.size());
  for (std::size_t i = 0; i < bodies_.items.size(); ++i) {
    awake[i] = bodies_.items[i].dynamic() && bodies_.items[i].body->IsAwake() ? 1 : 0;
    if (awake[i]) bodies_.items[i].last_velocity = bodies_.items[i].body->GetLinearVelocity();
  }
  world_.Step(h_s, kVelocityIterations, kPositionIterations);
  if (last_h_s_ > 0 && h_s != static_cast<float>(last_h_s_))
    scale_sleeping_contacts(h_s / static_cast<float>(last_h_s_), awake);
  for (std::size_t i = 0; i < bodies_.items.size(); ++i) {
    PlanarBody& body = bodies_.items[i];
    if (!body.dynamic()) continue;
    const bool now = body.body->IsAwake();
    if (awake[i] || now) {
      const Vec3 weight_Ns = static_cast<double>(h_s) * body.mass_kg * options_.gravity_W;
      const b2Vec2 before = awake[i] ? body.last_velocity : b2Vec2(0, 0);
      report.external_impulse_Ns += weight_Ns;
      report.energy.gravity +=
          0.5 * weight_Ns.dot(plane_.metres(before + body.body->GetLinearVelocity()));
    }
    if (awake[i] && !now) {
      report.external_impulse_Ns -= body.mass_kg * plane_.metres(body.last_velocity);
    }
  }
}

/// Multiplies the impulses of contacts that Box2D's last step left out by `scale`. Box2D does this
/// for the others.
void PlanarPhysics::scale_sleeping_contacts(float scale, std::span<const std::uint8_t> awake) {
  for (b2Contact* c = world_.GetContactList(); c; c = c->GetNext()) {
    const auto solved = [&](b2Fixture* fixture) {
      return awake[body_of(fixture->GetBody())] || fixture->GetBody()->IsAwake();
    };
    const auto dynamic = [](b2Fixture* fixture) {
      return fixture->GetBody()->GetType() == b2_dynamicBody;
    };
    b2Fixture *a = c->GetFixtureA(), *b = c->GetFixtureB();
    if ((dynamic(a) && solved(a)) || (dynamic(b) && solved(b))) continue;
    for (b2ManifoldPoint& point : c->GetManifold()->points)
      point.normalImpulse *= scale, point.tangentImpulse *= scale;
  }
}

void PlanarPhysics::freeze_not_finite(SolveReport& report) {
  for (PlanarBody& body : bodies_.items) {
    if (!body.dynamic()) continue;
    const b2Vec2 v = body.body->GetLinearVelocity();
    const float w = body.body->GetAngularVelocity();
    const auto most = static_cast<float>(plane_.units_per_m * kMaxFiniteSpeed_m_s);
    if (std::abs(v.x) < most && std::abs(v.y) < most && std::abs(w) < most &&
        body.body->GetPosition().IsValid()) {
      continue;
    }
    if (!body.body->GetPosition().IsValid()) body.body->SetTransform(b2Vec2(0, 0), 0);
    if (v.IsValid()) report.external_impulse_Ns -= body.mass_kg * plane_.metres(v);
    body.body->SetType(b2_staticBody);  // also stops the body
    body.frozen = true;
    ++report.frozen;
  }
}

void PlanarPhysics::update_table(std::uint32_t slot) {
  const PlanarBody& body = bodies_.items[slot];
  contacts_valid_ = false;
  if (!body.body) return;
  const BodyState state = state_of(body);
  const BodyMode mode = body.frozen        ? BodyMode::kFrozen
                        : body.kinematic() ? BodyMode::kKinematic
                        : !body.dynamic()  ? BodyMode::kStatic
                        : state.asleep     ? BodyMode::kAsleep
                                           : BodyMode::kAwake;
  table_.set({slot, body.generation}, mode, state);
}

void PlanarPhysics::update_whole_table() {
  contacts_valid_ = false;
  for (std::uint32_t slot = 0; slot < bodies_.items.size(); ++slot) update_table(slot);
}

Vec3 PlanarPhysics::momentum_Ns() const {
  Vec3 sum = Vec3::Zero();
  for (const PlanarBody& body : bodies_.items) {
    if (body.body) sum += body.mass_kg * plane_.metres(body.body->GetLinearVelocity());
  }
  return sum;
}

double PlanarPhysics::kinetic_J() const {
  double sum = 0;
  for (const PlanarBody& body : bodies_.items) {
    if (!body.dynamic()) continue;
    const b2Body& b = *body.body;
    const float about_center = b.GetInertia() - b.GetMass() * b.GetLocalCenter().LengthSquared();
    const double radius = std::sqrt(double{about_center / b.GetMass()});  // of gyration, units
    const double rim_m_s = double{b.GetAngularVelocity()} * radius / plane_.units_per_m;
    const Vec3 velocity_W = plane_.metres(b.GetLinearVelocity());
    sum += 0.5 * body.mass_kg * (velocity_W.squaredNorm() + rim_m_s * rim_m_s);
  }
  return sum;
}

BodyState PlanarPhysics::state_of(const PlanarBody& body) const {
  BodyState state;
  const SinCos half = sin_cos(0.5 * static_cast<double>(body.body->GetAngle()));
  state.X_WB.position = plane_.metres(body.body->GetPosition(), body.X_WB.position.z());
  state.X_WB.rotation = Quat(half.cos, 0, 0, half.sin) * body.X_WB.rotation;
  state.velocity_W = plane_.metres(body.body->GetLinearVelocity());
  state.angular_velocity_W.z() = static_cast<double>(body.body->GetAngularVelocity());
  state.asleep = body.dynamic() && !body.body->IsAwake();
  return state;
}

std::vector<ContactImpulse> PlanarPhysics::contact_impulses() const {
  std::vector<ContactImpulse> loads;
  for (const auto& [pair, p] : listener_.pair_impulses) {
    if (p.weight <= 0) continue;
    const Vec3 impulse = plane_.metres(p.impulse), point = plane_.metres((1 / p.weight) * p.moment);
    for (const bool on_b : {false, true}) {
      const PlanarBody& body = bodies_.items[on_b ? p.body_b : p.body_a];
      if (!body.reports_load) continue;
      const std::uint32_t shape = on_b ? pair.second : pair.first;
      loads.push_back(
          {body.tag, bodies_.shapes[shape].tag, on_b ? impulse : Vec3(-impulse), point});
    }
  }
  return loads;
}

}  // namespace

std::unique_ptr<Physics> make_planar_physics(const PlanarOptions& options) {
  return std::make_unique<PlanarPhysics>(options);
}

}  // namespace sunder::solver
