// Implements Physics by the rigid solver. Read first: collide() and solve(), which list their
// stages.
#include "solver/rigid/rigid_physics.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/base/archive.h"
#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/model/work_log.h"
#include "solver/base/check_bodies.h"
#include "solver/impact/event_probe.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/motion.h"
#include "solver/rigid/body/paused.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/broad_phase.h"
#include "solver/rigid/collide/contact_finder.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/dense_clusters.h"
#include "solver/rigid/collide/narrow_phase.h"
#include "solver/rigid/collide/query_tests.h"
#include "solver/rigid/collide/seams.h"
#include "solver/rigid/collide/speculative_contacts.h"
#include "solver/rigid/contact/contact_reports.h"
#include "solver/rigid/contact/contact_solver.h"
#include "solver/rigid/contact/kept_impulses.h"
#include "solver/rigid/contact/static_warm_start.h"
#include "solver/rigid/impulse_reach.h"
#include "solver/rigid/joint/joint.h"
#include "solver/rigid/passages.h"
#include "solver/rigid/sleep.h"
#include "solver/rigid/step_energy.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// Name of the work on contacts of bodies that are removed, edited or joined.
constexpr const char* kChangedContacts = "contacts of changed bodies";

class RigidPhysics final : public Physics {
 public:
  explicit RigidPhysics(const RigidOptions& options)
      : options_(options),
        contact_solver_({options.sweeps, options.accelerated, options.lanes}),
        step_(options.gravity_W, 0) {
    SUNDER_CHECK(options.max_colors >= 0 && options.max_colors <= kMaxColors);
    SUNDER_CHECK(options.sweeps > 0 && options.lanes >= 0);
    contacts_.colors = static_cast<std::uint8_t>(options.max_colors);
  }

  std::unique_ptr<Physics> copy() const override { return std::make_unique<RigidPhysics>(*this); }
  void archive(Archive& bytes) override;
  std::vector<BodyId> replace(std::span<const BodyId> remove,
                              std::span<const BodyDesc> add) override;
  void edit(const BodyEdit& edit) override;
  void collide(double dt_s) override;
  std::unique_ptr<ImpactProbe> probe(ProbeCluster cluster) const override {
    return make_event_probe(std::move(cluster));
  }
  std::vector<SpeculativeContact> speculative_contacts() override {
    return speculative_contacts_.find(contacts_, bodies_, shapes_, step_);
  }
  std::vector<Touch> touches(std::span<const BodyId> bodies) override;
  std::vector<TouchingBodies> touching(std::span<const BodyId> bodies) override;
  void set_state(BodyId body, const BodyState& state) override {
    queries_valid_ = false;
    bodies_.set_state(bodies_.slot(body), state);
  }
  void apply_impulse(BodyId body, const Vec3& impulse_W, const Vec3& point_W) override;
  JointId join(const JointDesc& joint) override;
  void attach(JointId joint, bool end_a, BodyId body,
              std::span<const std::uint32_t> quiet_tags) override;
  void strengthen(JointId joint, const SectionStrength& strength) override {
    joints_.strengthen(joint, strength);
  }
  void cut(JointId joint) override {
    wake_joined(joints_.at(joint));
    joints_.cut(joint, bodies_);
  }
  std::vector<JointId> take_broken() override { return joints_.take_broken(); }
  void pause(std::span<const BodyId> bodies) override;
  SolveReport solve(double dt_s, int substeps) override;
  BodyStates states() const override { return bodies_.states(); }
  std::vector<ContactImpulse> contact_impulses() const override {
    return find_contact_impulses(contacts_, bodies_, shapes_);
  }
  std::vector<JointImpulse> joint_impulses() const override { return joints_.loads(bodies_); }
  std::vector<PlasticFlow> plastic_flows() const override { return joints_.flows(); }
  std::vector<float> penetrations() const override { return find_penetrations(contacts_); }
  PhysicsInspection inspect() const override { return {broad_phase_.boxes(shapes_, bodies_)}; }
  std::vector<ContactForce> contact_forces() const override {
    return find_contact_forces(contacts_, bodies_, last_step_.h_s);
  }
  void visit_on_ray(const Vec3& from_W, const Vec3& direction_W, double reach_m, double radius_m,
                    ShapeVisitor& visitor) override;
  void visit_in_box(const Box& box_W, ShapeVisitor& visitor) override;
  std::vector<WorkItem> take_work() override { return work_.take(); }
  PhysicsContents contents() const override;

 private:
  ContactFinder finder() {
    return {contacts_, bodies_, shapes_, &broad_phase_, contacts_of_bodies_};
  }
  void wake_joined(const Joint& joint);
  void remove_bodies(std::span<const BodyId> ids);
  void remove_shapes(std::span<const ShapeSlot> shapes);
  void wake_hit();
  void find_near();
  void update_contacts();
  void find_reaches();
  ContactSolveReport solve_contacts(const StepContext& step);
  Momentum hold_to_limits();
  const ContactsOfBodies& contacts_of_bodies();
  const std::vector<ShapeSlot>& strays();
  void retest_pairs_of(JointId joint);

  RigidOptions options_;
  Bodies bodies_;
  Shapes shapes_;
  Contacts contacts_;
  Joints joints_;
  BroadPhase broad_phase_;
  std::vector<ContactChanges> changes_;  ///< Contact changes by chunk of pairs.
  DenseClusters dense_clusters_;
  Sleep sleep_;
  ContactSolver contact_solver_;
  StaticWarmStart static_warm_start_;
  SpeculativeContacts speculative_contacts_;
  ContactsOfBodies contacts_of_bodies_;
  Paused paused_;
  Passages passages_;
  StepContext step_;  ///< Context of the last collide().
  /// Length of the substep that the stored impulses are from; 0: no impulses stored.
  StepLengths last_step_;
  std::uint32_t frozen_ = 0;  ///< Number of bodies frozen since the last solve began.
  bool slowed_ = false;       ///< A body was slowed down since the last solve began.
  double slowed_J_ = 0;       ///< Energy that this took before the solve.
  bool skipped_ = false;      ///< Contacts of dense clusters were left out since the last solve.
  ByBody<StepReach> reach_;
  WorkLog work_;
  std::vector<ShapeSlot> strays_;  ///< See BroadPhase::strays(); of the present poses.
  bool queries_valid_ = false;     ///< Nothing has moved since `strays_` were found.
};

void RigidPhysics::archive(Archive& bytes) {
  joints_.update_ignored_pairs(bodies_);
  // The other members are found anew in every step.
  bytes(bodies_, shapes_, contacts_, joints_, broad_phase_, dense_clusters_, speculative_contacts_,
        paused_, last_step_, frozen_, skipped_, slowed_, slowed_J_, reach_);
  if (!bytes.reads()) return;
  bytes.refuse_field<Shapes>(shapes_.wrong_field(bodies_));
  bytes.refuse_field<Contacts>(contacts_.wrong_field(bodies_, shapes_));
  bytes.refuse_field<Joints>(joints_.wrong_field(bodies_));
  bytes.refuse_field<BroadPhase>(broad_phase_.wrong_field(shapes_));
  bytes.refuse_field<SpeculativeContacts>(
      speculative_contacts_.wrong_field(contacts_, bodies_, shapes_));
  bytes.refuse_field<Paused>(paused_.wrong_field(bodies_));
  if (last_step_ != StepLengths{} &&
      !(last_step_.h_s > 0 && last_step_.h_s <= last_step_.dt_s && last_step_.dt_s <= 1))
    bytes.refuse_field<RigidPhysics>("last_step_");
  if (reach_.size() > bodies_.size()) bytes.refuse_field<RigidPhysics>("reach_");
  joints_.list_by_body();
  contacts_of_bodies_.clear();
  queries_valid_ = false;
}

std::vector<BodyId> RigidPhysics::replace(std::span<const BodyId> remove,
                                          std::span<const BodyDesc> add) {
  check_bodies(add);
  queries_valid_ = false;
  remove_bodies(remove);
  std::vector<BodySlot> slots;
  std::vector<BodyId> ids;
  for (const BodyDesc& desc : add) {
    slots.push_back(bodies_.add(desc));
    ids.push_back(bodies_.id(slots.back()));
  }
  contacts_.body_colors.resize(bodies_.size());
  std::vector<NewShape> shapes;
  for (std::size_t i = 0; i < add.size(); ++i)
    for (const ShapeDesc& shape : add[i].shapes) shapes.push_back({&shape, slots[i]});
  broad_phase_.add(shapes_.add(shapes, bodies_), shapes_, bodies_);
  return ids;
}

PhysicsContents RigidPhysics::contents() const {
  PhysicsContents all;
  for (const BodySlot body : bodies_.slots()) {
    if (bodies_.motion[body] == Motion::kAbsent) continue;
    PhysicsContents::Body& one = all.bodies.emplace_back();
    one.id = bodies_.id(body);
    one.tag = bodies_.tag[body];
    for (const ShapeSlot s : shapes_.of_body(body, bodies_))
      one.shape_tags.push_back(shapes_[s].tag);
    std::ranges::sort(one.shape_tags);
  }
  for (std::uint32_t slot = 0; slot < joints_.size(); ++slot)
    if (joints_[slot].present)
      all.joints.push_back({{slot, joints_[slot].generation}, joints_[slot].desc.kind});
  return all;
}

void RigidPhysics::remove_bodies(std::span<const BodyId> ids) {
  std::vector<ShapeSlot> shapes;
  for (const BodyId id : ids) {
    const std::vector<ShapeSlot> of_body = shapes_.of_body(bodies_.slot(id), bodies_);
    shapes.insert(shapes.end(), of_body.begin(), of_body.end());
  }
  remove_shapes(shapes);
  for (const BodyId id : ids) {
    const BodySlot body = bodies_.slot(id);  // fails for an id given twice
    for (const std::uint32_t joint : joints_.of(body)) wake_joined(joints_[joint]);
    joints_.detach(body, bodies_);
    paused_.remove(body);
    bodies_.remove(body);
    contacts_.body_colors[body] = 0;
  }
}

/// Wakes what a joint holds that will be removed.
void RigidPhysics::wake_joined(const Joint& joint) {
  ContactFinder near = finder();
  sleep_.wake_joined(joint, options_.gravity_W, near, bodies_);
  work_.add({Stage::kCollide, kChangedContacts, near.looked_at()});
}

void RigidPhysics::remove_shapes(std::span<const ShapeSlot> shapes) {
  const std::vector<PairSlot> pairs = broad_phase_.pairs_with(shapes, shapes_, contacts_);
  std::vector<ManifoldSlot> manifolds;
  for (const PairSlot pair : pairs)
    if (contacts_.pairs[pair].touching()) manifolds.push_back(contacts_.pairs[pair].manifold);
  ContactFinder near = finder();
  sleep_.wake_unsupported(manifolds, options_.gravity_W, near, bodies_);
  work_.add({Stage::kCollide, kChangedContacts, manifolds.size() + near.looked_at()});
  contacts_of_bodies_.clear();
  for (const PairSlot pair : pairs) {
    speculative_contacts_.invalidate(contacts_.pairs[pair]);
    contacts_.remove(pair);
  }
  broad_phase_.remove(shapes);
  shapes_.remove(shapes, bodies_);
}

void RigidPhysics::edit(const BodyEdit& edit) {
  const BodySlot body = bodies_.slot(edit.body);
  SUNDER_CHECK(bodies_.motion[body] == Motion::kStatic);
  check_shapes(edit.added, bodies_.tag[body]);
  queries_valid_ = false;
  std::vector<ShapeSlot> removed;
  for (const std::uint32_t tag : edit.removed_tags) removed.push_back(shapes_.with_tag(body, tag));
  remove_shapes(removed);
  std::vector<NewShape> added;
  for (const ShapeDesc& shape : edit.added) added.push_back({&shape, body});
  broad_phase_.add(shapes_.add(added, bodies_), shapes_, bodies_);
}

void RigidPhysics::collide(double dt_s) {
  queries_valid_ = false;
  slowed_J_ += hold_to_limits().kinetic_J;
  step_ = StepContext(options_.gravity_W, dt_s);
  find_near();
  update_contacts();
  contacts_of_bodies_.clear();
  wake_hit();
  ContactFinder contacts = finder();
  sleep_.wake_on_kinematic(options_.gravity_W, contacts, bodies_);
}

/// Wakes the sleeping bodies that impacts will move within the step.
void RigidPhysics::wake_hit() {
  const std::vector<Hit> hits = find_hits(step_, contacts_, bodies_);
  if (hits.empty()) return;
  for (const BodySlot body :
       find_reached(step_, hits, contacts_, contacts_of_bodies(), joints_, bodies_))
    bodies_.wake(body);
}

void RigidPhysics::find_near() {
  WorkSpan span(work_, Stage::kCollide, "boxes that moved");
  broad_phase_.update(step_, shapes_, bodies_, contacts_);
  span.count(broad_phase_.moved());
  skipped_ |= broad_phase_.has_skipped();
}

void RigidPhysics::find_reaches() {
  const double dt_s = step_.dt_s;
  reach_.resize(bodies_.size());
  for_chunks(bodies_.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (BodySlot body(begin); body.value < end; ++body.value) {
      const double angle = std::min(1.0, dt_s * bodies_.angular_velocity[body].norm());
      reach_[body] = {(dt_s * bodies_.velocity[body]).cast<float>(),
                      static_cast<float>(angle * bodies_.reach_m[body]) * 1.00001f};
    }
  });
}

/// Runs the narrow phase over pairs with a body that changed. Then, in order of slots, adds a
/// manifold for each pair that began to touch, and removes pairs that moved apart.
void RigidPhysics::update_contacts() {
  constexpr std::size_t kChunk = 1024;
  WorkSpan span(work_, Stage::kCollide, "pairs looked at");
  auto& pairs = contacts_.pairs;
  const std::size_t chunks = (pairs.size() + kChunk - 1) / kChunk;
  changes_.resize(std::max(changes_.size(), chunks));
  const auto changes = std::span(changes_).first(chunks);
  for (ContactChanges& chunk : changes) chunk.clear();
  find_reaches();
  joints_.update_ignored_pairs(bodies_);
  for_chunks(pairs.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    NarrowScratch scratch;
    Manifold fresh;
    for (PairSlot i(begin); i.value < end; ++i.value) {
      Pair& pair = pairs[i];
      prefetch_pairs(i, PairSlot(end), contacts_, shapes_, bodies_);
      if (!pair.present()) continue;
      if (!pair.needs_test && !bodies_.changed[pair.body_a] && !bodies_.changed[pair.body_b])
        continue;
      ++changes[c].moved;
      const bool touched = pair.touching();
      Manifold& m = touched ? contacts_.manifolds[pair.manifold] : fresh;
      if (same_as_before(bodies_, reach_, pair, touched ? &m : nullptr)) {
        if (!touched && broad_phase_.left_fat_box(pair)) changes[c].removed.push_back(i);
        continue;
      }
      ++changes[c].tested;
      const bool ignored = joints_.ignores(pair, shapes_, bodies_);
      pair.needs_test = ignored;  // tested again once the bodies collide again
      const bool near = !ignored && broad_phase_.may_touch(pair);
      if (near) update_contact(step_, shapes_, bodies_, pair, m, scratch);
      m.deep = m.count > 0 && m.least_separation() < -kDeepOverlap * m.size_m;
      if (m.deep) changes[c].deep.push_back(i);
      if (touched && (!near || m.count == 0)) changes[c].separated.push_back(i);
      if (near && m.count > 0 && may_be_at_seam(step_, shapes_, bodies_, pair, m))
        changes[c].closing.push_back(i);
      if (!touched && m.count > 0) changes[c].touched.emplace_back(i, std::exchange(fresh, {}));
      if (!near && !broad_phase_.is_near(pair)) changes[c].removed.push_back(i);
    }
  });
  drop_covered(step_, changes, contacts_, shapes_, bodies_);
  skipped_ |= dense_clusters_.drop_contacts(changes, contacts_, bodies_);
  std::vector<ManifoldSlot> left;
  for (const ContactChanges& chunk : changes)
    for (const PairSlot i : chunk.separated) left.push_back(pairs[i].manifold);
  ContactFinder before{contacts_, bodies_, shapes_, nullptr, contacts_of_bodies_};
  sleep_.wake_unsupported(left, options_.gravity_W, before, bodies_);
  speculative_contacts_.invalidate_changed(bodies_);
  for (const ContactChanges& chunk : changes)
    for (const PairSlot i : chunk.separated) {
      speculative_contacts_.invalidate(pairs[i]);
      contacts_.remove_manifold(i);
    }
  std::size_t touched = 0;
  for (const ContactChanges& chunk : changes) touched += chunk.touched.size();
  contacts_.expect_manifolds(touched);
  WorkItem moved{Stage::kCollide, "pairs that moved"},
      touches{Stage::kCollide, "pairs that came to touch", touched};
  for (const ContactChanges& chunk : changes) {
    moved.count += chunk.moved;
    span.count(chunk.tested);
  }
  work_.add(moved);
  work_.add(touches);
  for (const ContactChanges& chunk : changes)
    for (const auto& [pair, manifold] : chunk.touched) {
      speculative_contacts_.invalidate(pairs[pair]);
      contacts_.add_manifold(pair, manifold, bodies_);
    }
  for (const ContactChanges& chunk : changes)
    for (const PairSlot i : chunk.removed) contacts_.remove(i);
  std::fill(bodies_.changed.begin(), bodies_.changed.end(), std::uint8_t{0});
}

/// Slows down bodies that are too fast, and freezes those that are not finite; returns the momentum
/// and energy that this takes.
Momentum RigidPhysics::hold_to_limits() {
  Momentum taken;
  for (const BodySlot body : bodies_.slots()) {
    if (!bodies_.awake(body) || bodies_.is_within_limits(body)) continue;
    if (const std::optional<Momentum> slowed = bodies_.slow_down(body)) {
      taken.momentum_Ns += slowed->momentum_Ns;
      taken.kinetic_J += slowed->kinetic_J;
      slowed_ = true;
      continue;
    }
    if (!bodies_.has_finite_pose(body)) bodies_.place(body, Vec3::Zero(), Quat::Identity());
    taken.momentum_Ns += bodies_.freeze(body);
    ++frozen_;
  }
  return taken;
}

const ContactsOfBodies& RigidPhysics::contacts_of_bodies() {
  if (contacts_of_bodies_.empty()) contacts_of_bodies_ = ContactsOfBodies(contacts_, bodies_);
  return contacts_of_bodies_;
}

std::vector<Touch> RigidPhysics::touches(std::span<const BodyId> bodies) {
  return find_touches(contacts_, bodies_, shapes_, contacts_of_bodies(), bodies);
}

std::vector<TouchingBodies> RigidPhysics::touching(std::span<const BodyId> bodies) {
  return find_touching(contacts_, bodies_, contacts_of_bodies(), bodies);
}

void RigidPhysics::apply_impulse(BodyId id, const Vec3& impulse_W, const Vec3& point_W) {
  bodies_.apply_impulse(bodies_.slot(id), impulse_W, point_W);
}

/// Marks the pairs of a joint's bodies for a test, since the joint may have made them ignore each
/// other.
void RigidPhysics::retest_pairs_of(JointId id) {
  const Joint& joint = joints_[id.slot];
  const BodySlot a = joint.body_a, b = joint.body_b;
  if (a.none() || b.none()) return;
  const std::vector<ShapeSlot> shapes = shapes_.of_body(bodies_.mobile(a) ? a : b, bodies_);
  const std::vector<PairSlot> near = broad_phase_.pairs_with(shapes, shapes_, contacts_);
  work_.add({Stage::kCollide, kChangedContacts, near.size()});
  for (const PairSlot slot : near) {
    Pair& pair = contacts_.pairs[slot];
    if ((pair.body_a == a && pair.body_b == b) || (pair.body_a == b && pair.body_b == a))
      pair.needs_test = true;
  }
}

JointId RigidPhysics::join(const JointDesc& joint) {
  const JointId id = joints_.add(joint, bodies_);
  retest_pairs_of(id);
  // Bodies in joints get no static warm start, which would let their contacts bear what joints
  // bear.
  for (const BodyId end : {joint.a, joint.b})
    if (bodies_.contains(end)) bodies_.is_new[bodies_.slot(end)] = 0;
  return id;
}

void RigidPhysics::attach(JointId id, bool end_a, BodyId body,
                          std::span<const std::uint32_t> quiet_tags) {
  wake_joined(joints_.at(id));
  joints_.attach(id, end_a, body, quiet_tags, bodies_);
  retest_pairs_of(id);
}

void RigidPhysics::pause(std::span<const BodyId> bodies) {
  for (const BodyId id : bodies)
    for (const BodySlot body : joints_.joined_to(bodies_.slot(id), bodies_)) paused_.add(body);
}

const std::vector<ShapeSlot>& RigidPhysics::strays() {
  if (!std::exchange(queries_valid_, true)) strays_ = broad_phase_.strays(shapes_, bodies_);
  return strays_;
}

void RigidPhysics::visit_on_ray(const Vec3& from_W, const Vec3& direction_W, double reach_m,
                                double radius_m, ShapeVisitor& visitor) {
  Ray ray(from_W, direction_W, reach_m, radius_m);
  broad_phase_.on_ray(ray, strays(), [&](ShapeSlot shape) {
    if (!may_meet(ray, shapes_[shape], bodies_)) return;
    const ShapeId id{bodies_.tag[shapes_[shape].body], shapes_[shape].tag};
    ray.shorten(visitor.visit(id, ray.reach_m));
  });
}

void RigidPhysics::visit_in_box(const Box& box_W, ShapeVisitor& visitor) {
  const float pad =
      4e-7f * static_cast<float>(box_W.min.cwiseAbs().cwiseMax(box_W.max.cwiseAbs()).maxCoeff());
  const FloatBox box{box_W.min.cast<float>() - Vec3f::Constant(pad),
                     box_W.max.cast<float>() + Vec3f::Constant(pad)};
  broad_phase_.in_box(box, strays(), [&](ShapeSlot shape) {
    if (may_overlap(box, shapes_[shape], bodies_))
      visitor.visit({bodies_.tag[shapes_[shape].body], shapes_[shape].tag}, 0);
  });
}

SolveReport RigidPhysics::solve(double dt_s, int substeps) {
  SUNDER_CHECK(dt_s > 0 && substeps > 0);
  queries_valid_ = false;
  const StepContext step(options_.gravity_W, dt_s, substeps);
  const StepLengths lengths{dt_s, step.h_s};
  change_step(std::exchange(last_step_, lengths), lengths, bodies_, contacts_, joints_);
  SolveReport report;
  slowed_J_ += hold_to_limits().kinetic_J;
  joints_.wake(bodies_);
  joints_.clear_flows();
  paused_.suspend(bodies_);
  const Momentum start = bodies_.momentum();
  double awake_mass = 0;
  for (const BodySlot body : bodies_.slots()) {
    if (!bodies_.awake(body)) continue;
    awake_mass += bodies_.mass_kg[body];
    bodies_.changed[body] = 1;
  }
  static_warm_start_.apply(step, options_.static_warm_start, bodies_, contacts_);
  bodies_.clear_step_flags();
  passages_.begin(bodies_);
  ContactSolveReport solved = solve_contacts(step);
  for (const BodySlot body : bodies_.slots())
    if (bodies_.is_moving_kinematic(body)) move_kinematic(step, body, bodies_);
  report.external_impulse_Ns = solved.outside_impulse_Ns + dt_s * awake_mass * options_.gravity_W;
  const Momentum taken = hold_to_limits();
  report.external_impulse_Ns -= taken.momentum_Ns;
  solved.work.drive_J -= taken.kinetic_J;
  joints_.update_ignored_pairs(bodies_);
  const auto back = passages_.put_back(step, broad_phase_, shapes_, joints_, bodies_);
  report.external_impulse_Ns -= back.impulse_Ns;
  if (back.bodies > 0) work_.add({Stage::kSolve, "bodies put back", back.bodies});
  const Momentum end = bodies_.momentum();
  report.momentum_before_Ns = start.momentum_Ns;
  report.momentum_after_Ns = end.momentum_Ns;
  report.mass_kg = end.mass_kg;
  report.energy = energy_of(solved, step, start, end);
  report.energy.drives -= std::exchange(slowed_J_, 0);
  report.friction_allowed_Ns = solved.work.allowed_Ns;
  report.friction_excess_Ns = solved.work.excess_Ns;
  paused_.resume(bodies_);  // paused bodies are not asleep: contacts no longer wake them
  if (options_.sleeping) {
    const WorkSpan span(work_, Stage::kSolve, "sleep");
    ContactFinder contacts = finder();
    sleep_.wake_by_load(step, contacts, bodies_);
    report.energy.sleep = sleep_.put_to_sleep(step, joints_, bodies_, contacts_);
  }
  contacts_of_bodies_.clear();
  report.contacts = solved.manifolds;
  report.contact_points = solved.points;
  for (const BodySlot body : bodies_.slots()) report.awake += bodies_.awake(body);
  report.limits = solved.limits;
  report.limits[Limit::kDenseClusters] = std::exchange(skipped_, false);
  report.limits[Limit::kSpeeds] = std::exchange(slowed_, false);
  report.frozen = frozen_;
  frozen_ = 0;
  return report;
}

ContactSolveReport RigidPhysics::solve_contacts(const StepContext& step) {
  WorkSpan span(work_, Stage::kSolve, "points in substeps");
  const ContactSolveReport solved = contact_solver_.solve(step, bodies_, contacts_, joints_);
  span.count(std::uint64_t{solved.points} * static_cast<std::uint64_t>(step.substeps));
  work_.add({Stage::kSolve, "manifolds", solved.manifolds});
  return solved;
}

}  // namespace

int lanes_in_use(int lanes) { return static_cast<int>(make_contact_blocks(lanes)->lanes()); }

std::unique_ptr<Physics> make_rigid_physics(const RigidOptions& options) {
  return std::make_unique<RigidPhysics>(options);
}

}  // namespace sunder::solver
