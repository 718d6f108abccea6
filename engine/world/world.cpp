// Read first: World::step(), then advance(), the list of a step's stages.
#include "engine/world/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/archive.h"
#include "engine/base/check.h"
#include "engine/base/cpu_time.h"
#include "engine/base/loop_count.h"
#include "engine/base/parallel.h"
#include "engine/base/rotation.h"
#include "engine/base/trace.h"
#include "engine/model/breaker.h"
#include "engine/model/checks/item_check.h"
#include "engine/model/particles.h"
#include "engine/model/physics.h"
#include "engine/model/work_log.h"
#include "engine/world/act/act_stage.h"
#include "engine/world/actors/check_state.h"
#include "engine/world/actors/hinges.h"
#include "engine/world/actors/landscape.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/break/break_stage.h"
#include "engine/world/inspect.h"
#include "engine/world/load/load_stage.h"
#include "engine/world/particles/particle_stage.h"
#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

/// Measures the time of each stage of a frame, from the end of the last one.
class StageClock {
 public:
  void end(Stage stage, FrameReport& report) {
    const double now_ms = cpu_ms();
    report.stage_ms[static_cast<int>(stage)] += watch_.lap_ms();
    report.stage_cpu_ms[static_cast<int>(stage)] += now_ms - std::exchange(cpu_ms_, now_ms);
    const LoopTimes loops = LoopCount::times();
    report.stage_loops[static_cast<int>(stage)] += loops - std::exchange(loops_, loops);
  }

 private:
  LoopTimes loops_ = LoopCount::times();
  Stopwatch watch_;
  double cpu_ms_ = cpu_ms();
};

/// Advances all bodies by a step, removes joints that broke, and updates plastic hinges.
void solve(WorldState& world) {
  const Clock& clock = world.clock;
  const SolveReport report = world.physics->solve(clock.dt_s, clock.substeps);
  world.log.add_solve(report, world.scene.gravity_W.norm() * clock.dt_s);
  world.log.report.joints_lost += world.joints.take_broken(*world.physics);
  update_hinges(world);
}

/// Returns the key of a body with a tag; none() for the ground.
BodyKey key_of_tag(std::uint32_t tag) { return BodyKey(std::size_t{tag}); }
static_assert(kGroundKey == BodyKey::kNone);

/// Writes or reads a report or events without the times that computations took: equal states have
/// equal bytes.
void archive_without_times(Archive& bytes, FrameReport& of) {
  FrameReport report = of;
  std::ranges::fill(report.stage_ms, 0);
  std::ranges::fill(report.stage_cpu_ms, 0);
  report.stage_loops = {};
  bytes(report);
  if (bytes.reads()) of = std::move(report);
}
void archive_without_times(Archive& bytes, Events& of) {
  Events events = of;
  for (BreakEvent& event : events.breaks) event.plan_ms = 0;
  bytes(events);
  if (bytes.reads()) of = std::move(events);
}

/// Counts the queries that are not finished, whose filters may call functions of the program.
class Query {
 public:
  explicit Query(int& count) : count_(count) { ++count_; }
  ~Query() { --count_; }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

 private:
  int& count_;
};

/// A body, and whether it slept, at the end of a step.
struct Known {
  std::uint32_t key = 0;
  bool asleep = false;
};

}  // namespace

struct Asset::Data {
  Compound compound;
  Structure structure;
  MaterialNames materials;  ///< Of those given, the materials of its convexes.
};

Asset::Asset(Compound compound, MaterialNames materials) {
  ItemCheck("Asset(): ", {}).convexes(compound, "compound");  // worlds know the materials
  std::erase_if(materials, [&](const auto& given) {
    return std::ranges::none_of(compound.convexes, [&](const ConvexPtr& convex) {
      return convex->material == given.first;
    });
  });
  Structure structure(compound);
  data_ = std::make_shared<const Data>(
      Data{std::move(compound), std::move(structure), std::move(materials)});
}

const Compound& Asset::compound() const { return data_->compound; }
const Asset::MaterialNames& Asset::materials() const { return data_->materials; }

/// The state of the world, its stages, and what was found of it since the last step.
struct World::Parts {
  WorldState world;
  std::shared_ptr<const Breaker> breaker;  ///< Shared with copies: it has no state of a run.
  ActStage act;
  BreakStage breaks;
  LoadStage loads;
  ParticleStage particles;
  int threads = 0;
  bool inspects = false;  ///< Frames get inspections.
  bool counts_loops = false;
  double least_hit_m_s = std::numeric_limits<double>::infinity();

  FrameReport report;                        ///< Of the last step().
  Events events;                             ///< Of the last step().
  std::vector<Known> known;                  ///< Bodies at the end of the last step(); ascending.
  FramePtr frame;                            ///< Of the present state; null if none was asked for.
  mutable std::optional<BodyArrays> arrays;  ///< Likewise.
  mutable std::optional<std::vector<ContactForce>> contacts;  ///< Likewise.
  mutable int queries = 0;                                    ///< Queries that are not finished.

  Parts(Scene scene, std::unique_ptr<Physics> physics, std::unique_ptr<Breaker> breaks_by,
        std::unique_ptr<Particles> moves)
      : world(std::move(scene), std::move(physics)),
        breaker(std::move(breaks_by)),
        breaks(world.scene.limits),
        loads(world.scene.limits),
        particles(std::move(moves)) {
    if (particles.any()) world.exposed.emplace();
  }

  ItemCheck check(const char* call) const {
    return {std::string("World::") + call + "(): ", *world.materials};
  }
  /// As check(), for a call that changes the world; throws during a query.
  ItemCheck change(const char* call) const {
    if (queries > 0)
      check(call).refuse("the world cannot change during a query, whose filter makes this call",
                         "a call after the query");
    return check(call);
  }
  /// Returns the actor with a key, for a call; throws if there is none.
  Actor& actor(BodyKey key, const char* call);
  const Actor& actor(BodyKey key, const char* call) const {
    return const_cast<Parts*>(this)->actor(key, call);
  }
  /// As actor(); also throws if the body is anchored.
  const Actor& movable(BodyKey key, const char* call) const;
  void changed();
  BodyKey added(const std::string& name);
  void advance();
  void note_hits();
  void end_step();

  /// Writes or reads the state of a world, without the scene, and without settings of the process.
  friend void archive(Archive& bytes, Parts& parts) {
    WorldState& world = parts.world;
    bytes(world.materials, world.names, world.clock, world.actors, world.joints, world.meshes,
          world.landscape, world.log, world.next_event, world.smallest_piece_factor, world.exposed);
    world.physics->archive(bytes);
    for (Actor& actor : world.actors) parts.breaker->archive(bytes, actor.stress.memory);
    bytes(parts.act, parts.breaks, parts.loads, parts.particles, parts.inspects, parts.known);
    bytes.infinite(parts.least_hit_m_s);
    archive_without_times(bytes, parts.report);
    archive_without_times(bytes, parts.events);
    if (!bytes.reads()) return;
    bytes.refuse_field<WorldState>(wrong_field(world));
    bytes.refuse_field<ActStage>(parts.act.wrong_field(world));
    bytes.refuse_field<BreakStage>(parts.breaks.wrong_field(world));
    bytes.refuse_field<ParticleStage>(parts.particles.wrong_field(world));
    if (world.exposed.has_value() != parts.particles.any())
      bytes.refuse_field<WorldState>("exposed");
  }
};

Actor& World::Parts::actor(BodyKey key, const char* call) {
  Actor* found = key.none() ? nullptr : world.actors.find(key.value);
  if (!found) {
    const std::string name = key.none() ? "none" : std::to_string(key.value);
    check(call).refuse("there is no body " + name, "the key of a body that is in the world");
  }
  return *found;
}

const Actor& World::Parts::movable(BodyKey key, const char* call) const {
  const Actor& found = actor(key, call);
  if (found.is_static && !found.is_kinematic)
    check(call).refuse("body " + std::to_string(key.value) + " is anchored",
                       "a body that can move; release() frees it");
  return found;
}

/// Completes the actor that a call has added last; returns its key.
BodyKey World::Parts::added(const std::string& name) {
  changed();
  Actor& actor = world.actors[world.actors.size() - 1];
  actor.name = world.add_name(name);
  world.log.report.energy.script += kinetic_J(actor, world.physics->state(actor.body));
  return BodyKey(std::size_t{actor.key});
}

/// Forgets what was computed of the present state.
void World::Parts::changed() {
  frame = nullptr;
  arrays.reset();
  contacts.reset();
}

/// Notes the contacts that close fast enough in this step, for each pair of bodies the fastest.
void World::Parts::note_hits() {
  if (!(least_hit_m_s < std::numeric_limits<double>::infinity())) return;
  for (const SpeculativeContact& contact : world.physics->speculative_contacts()) {
    if (contact.speed_m_s < least_hit_m_s) continue;
    if (contact.separation_m > contact.speed_m_s * world.clock.horizon_s()) continue;
    Hit hit{key_of_tag(contact.body_tag_a),
            key_of_tag(contact.body_tag_b),
            contact.point_W,
            contact.normal_W,
            contact.speed_m_s,
            contact.effective_mass_kg};
    if (hit.b < hit.a) {
      std::swap(hit.a, hit.b);
      hit.normal_W = -hit.normal_W;
    }
    events.hits.push_back(hit);
  }
}

void World::Parts::advance() {
  StageClock clock;
  const auto timed = [&](Stage stage, const auto& work) {
    const TraceSpan span(kStageNames[static_cast<int>(stage)]);
    work();
    clock.end(stage, world.log.report);
  };
  std::vector<ActorImpact> impacts;  // of blasts and of the program
  timed(Stage::kAct, [&] { impacts = act.run(world); });
  timed(Stage::kCollide, [&] { world.physics->collide(world.clock.horizon_s()); });
  timed(Stage::kBreak, [&] {
    note_hits();
    breaks.run(world, *breaker, impacts);
  });
  timed(Stage::kAct, [&] { act.push(world); });
  timed(Stage::kSolve, [&] { solve(world); });
  timed(Stage::kLoad, [&] { loads.run(world, *breaker); });
  timed(Stage::kParticles, [&] {
    if (!particles.any() || !world.clock.ends_frame()) return;
    // Faces exposed by a blast emit particles after the blast's impulse, at the speed of their
    // parting.
    const bool delayed = act.has_blast_impulse();
    WorkSpan span(world.log.work_counts, Stage::kParticles, "particles");
    particles.run(world, delayed ? Exposed{} : std::exchange(*world.exposed, {}));
    span.count(particles.alive());
    if (delayed) world.exposed->delay(world.clock.frame_s());
  });
  ++world.clock.step;
}

/// Completes the report and the events of the step.
void World::Parts::end_step() {
  StageClock clock;
  report = end_frame(world, act.mass_to_come_kg(), breaks.deferred() + loads.deferred());
  events.breaks = std::exchange(world.log.breaks, {});
  std::ranges::sort(events.hits, [](const Hit& x, const Hit& y) {
    return std::tuple(x.a, x.b, -x.speed_m_s) < std::tuple(y.a, y.b, -y.speed_m_s);
  });
  const auto same = [](const Hit& x, const Hit& y) { return x.a == y.a && x.b == y.b; };
  events.hits.erase(std::unique(events.hits.begin(), events.hits.end(), same), events.hits.end());
  for (const std::uint32_t key : world.joints.take_lost())
    events.joints_lost.emplace_back(std::size_t{key});
  const BodyStates states = world.physics->states();
  std::vector<Known> now;
  now.reserve(world.actors.size());
  auto before = known.begin();
  for (const Actor& one : world.actors) {
    const bool asleep = states.mode[one.body.slot] == BodyMode::kAsleep;
    const BodyKey key{std::size_t{one.key}};
    for (; before != known.end() && before->key < one.key; ++before)
      events.gone.emplace_back(std::size_t{before->key});
    if (before == known.end() || before->key != one.key) {
      events.appeared.push_back(key);
    } else {
      if (before->asleep != asleep) (asleep ? events.fell_asleep : events.woke).push_back(key);
      ++before;
    }
    now.push_back({one.key, asleep});
  }
  for (; before != known.end(); ++before) events.gone.emplace_back(std::size_t{before->key});
  known = std::move(now);
  world.meshes.tidy(world.actors, world.landscape.meshes);
  clock.end(Stage::kSnapshot, report);
}

World::World(Scene scene, std::unique_ptr<Physics> physics, std::unique_ptr<Breaker> breaker,
             std::unique_ptr<Particles> particles)
    : parts_(std::make_unique<Parts>(std::move(scene), std::move(physics), std::move(breaker),
                                     std::move(particles))) {
  WorldState& world = parts_->world;
  add_ground(world);
  add_compounds(world, world.scene.solids);
  for (const Ball& ball : world.scene.balls) add_ball(world, ball);
  for (Actor& actor : world.actors) actor.name = actor.key;
  for (const Joint& joint : world.scene.joints) {  // keys are still indices
    world.joints.add(*world.physics, world.actors, joint);
  }
  parts_->act.start(world);
  parts_->loads.prepare(world, *parts_->breaker);
  parts_->end_step();
  parts_->events = {};
}

World::World(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

World World::copy() const {
  World world(std::make_unique<Parts>(*parts_));
  world.parts_->queries = 0;
  return world;
}

void World::save(Archive& bytes) const {
  // An archive that writes leaves the objects as they are.
  Parts& parts = const_cast<Parts&>(*parts_);
  bytes(const_cast<Scene&>(*parts.world.given), parts);
}

World::World(Archive& bytes, Scene scene, std::unique_ptr<Physics> physics,
             std::unique_ptr<Breaker> breaker, std::unique_ptr<Particles> particles)
    : parts_(std::make_unique<Parts>(std::move(scene), std::move(physics), std::move(breaker),
                                     std::move(particles))) {
  bytes(*parts_);
}

World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

void World::set_threads(int count) {
  parts_->change("set_threads").need_number(count, 0, 1024, "count");
  parts_->threads = count;
}

void World::step(double time_s) {
  parts_->change("step").need_number(time_s, kShortestStep_s, kLongestStep_s, "time_s");
  auto& parts = *parts_;
  const ThreadScope scope(parts.threads);
  std::optional<LoopCount> count;
  if (parts.counts_loops) count.emplace();
  // A time that is a multiple of the scene's step, but for rounding, has exactly this step.
  const double scene_dt_s = parts.world.scene.accuracy.dt_s;
  const double exact = time_s / scene_dt_s, whole = std::max(1.0, std::round(exact));
  const bool fits = std::abs(exact - whole) < 1e-9 * whole;
  const int steps = static_cast<int>(fits ? whole : std::max(1.0, std::ceil(exact)));
  parts.world.clock.begin_frame(steps, fits ? scene_dt_s : time_s / steps);
  parts.changed();
  parts.events = {};
  const double share = fits && std::abs(60 * time_s - 1) < 1e-9 ? 1 : 60 * time_s;
  parts.breaks.begin_frame(share);
  parts.loads.begin_frame(share);
  for (int i = 0; i < steps; ++i) parts.advance();
  parts.end_step();
}

double World::time_s() const { return parts_->world.clock.time_s(); }
const Scene& World::scene() const { return parts_->world.scene; }
const std::vector<Material>& World::materials() const { return *parts_->world.materials; }

MaterialIndex World::add(const Material& material) {
  parts_->change("add").material(material, "material");
  return parts_->world.add_material(material);
}

BodyKey World::add(const Solid& solid) {
  parts_->change("add").solid(solid, "solid");
  add_compounds(parts_->world, std::span(&solid, 1));
  return parts_->added(solid.name);
}

BodyKey World::add(const Asset& asset, const BodyMotion& motion, const std::string& name) {
  Solid solid;
  solid.name = name;
  solid.compound = asset.compound();
  solid.X_WR = motion.X_WR;
  solid.velocity_W = motion.velocity_W;
  solid.angular_velocity_W = motion.angular_velocity_W;
  const ItemCheck check = parts_->change("add");
  check.solid(solid, "solid");
  for (const auto& [index, given] : asset.materials()) {
    if (const std::string& found = materials()[index.value].name; found != given)
      check.refuse("the asset has material " + std::to_string(index.value) + ", " + given +
                       ", which is " + found + " in this world",
                   "an asset made of the materials of this world");
  }
  add_compounds(parts_->world, std::span(&solid, 1), {asset.data_->structure});
  return parts_->added(name);
}

BodyKey World::add(const Ball& ball) {
  parts_->change("add").ball(ball, "ball");
  add_ball(parts_->world, ball);
  return parts_->added(ball.name);
}

JointKey World::add(const Joint& joint) {
  parts_->change("add").joint(joint, "joint");
  for (const std::optional<std::uint32_t>& end : {joint.a, joint.b})
    if (end) parts_->actor(BodyKey(std::size_t{*end}), "add");
  parts_->changed();
  WorldState& world = parts_->world;
  return JointKey(std::size_t{world.joints.add(*world.physics, world.actors, joint)});
}

void World::shoot(const Shot& shot) {
  parts_->change("shoot").shot(shot, "shot");
  parts_->act.add(parts_->world, shot);
}

void World::blast(const Blast& blast) {
  parts_->change("blast").blast(blast, "blast");
  parts_->act.add(blast);
}

void World::drive(const Drive& drive) {
  parts_->change("drive").drive(drive, "drive");
  for (const std::uint32_t key : drive.roots) parts_->actor(BodyKey(std::size_t{key}), "drive");
  parts_->act.add(drive);
}

void World::remove(BodyKey body) {
  parts_->change("remove");
  parts_->actor(body, "remove");
  parts_->changed();
  remove_actor(parts_->world, body.value);
}

void World::remove(JointKey joint) {
  parts_->change("remove");
  const Joints::Live* live = parts_->world.joints.find(joint.value);
  if (!live)
    parts_->check("remove").refuse("there is no joint " + std::to_string(joint.value),
                                   "the key of a joint that is in the world");
  parts_->changed();
  parts_->world.joints.cut(*parts_->world.physics, live->id);
}

void World::set_motion(BodyKey body, const BodyMotion& motion) {
  const Actor& actor = parts_->movable(body, "set_motion");
  const ItemCheck check = parts_->change("set_motion");
  check.pose(motion.X_WR, "motion.X_WR");
  check.need_vector(motion.velocity_W, ranges::kSpeed_m_s, "motion.velocity_W");
  check.need_vector(motion.angular_velocity_W, ranges::kSpin_rad_s, "motion.angular_velocity_W");
  parts_->changed();
  const Quat rotation = motion.X_WR.rotation.normalized();
  const Pose X_WR{motion.X_WR.position, rotation};
  parts_->act.end_move(body.value);
  parts_->world.log.report.energy.script += move_actor(
      parts_->world, actor,
      {{X_WR * actor.weight.com_R, rotation}, motion.velocity_W, motion.angular_velocity_W});
}

void World::move_to(BodyKey body, const Pose& X_WR, double duration_s) {
  const Actor& actor = parts_->movable(body, "move_to");
  const ItemCheck check = parts_->change("move_to");
  check.pose(X_WR, "X_WR");
  check.need_number(duration_s, kShortestStep_s, kMaxTime_s, "duration_s");
  parts_->changed();
  const Pose from = rest_pose(actor, parts_->world.physics->state(actor.body).X_WB);
  Move move;
  move.path.smooth = false;
  move.path.keys = {{duration_s, X_WR.position - from.position,
                     rotation_vector(X_WR.rotation.normalized() * from.rotation.conjugate())}};
  parts_->act.add(parts_->world, move, actor);
}

void World::release(BodyKey body) {
  parts_->change("release");
  Actor& actor = parts_->actor(body, "release");
  if (!actor.is_static) return;
  parts_->changed();
  if (actor.is_kinematic) {
    parts_->act.end_move(body.value);
    set_kinematic(parts_->world, actor, false);
  } else {
    loosen_actor(parts_->world, body.value);
  }
}

void World::apply_impulse(BodyKey body, const Vec3& impulse_W, const Vec3& point_W) {
  const Actor& actor = parts_->actor(body, "apply_impulse");
  const ItemCheck check = parts_->change("apply_impulse");
  check.need_finite(impulse_W, "impulse_W");
  check.need_finite(point_W, "point_W");
  parts_->changed();
  parts_->world.log.report.energy.script += push_actor(parts_->world, actor, impulse_W, point_W);
}

void World::break_at(BodyKey body, const Vec3& point_W, const Vec3& direction_W, double energy_J,
                     std::optional<PatternSpec> pattern) {
  const Actor& actor = parts_->actor(body, "break_at");
  const ItemCheck check = parts_->change("break_at");
  check.need_finite(point_W, "point_W");
  check.need_finite(direction_W, "direction_W");
  if (!(direction_W.norm() > 0)) check.refuse("direction_W is zero", "a vector with a length");
  check.need_number(energy_J, 0, std::numeric_limits<double>::max(), "energy_J");
  if (pattern) check.pattern(*pattern, "pattern.");
  if (actor.structure.empty() || actor.is_kinematic) return;
  const Pose X_WR = rest_pose(actor, parts_->world.physics->state(actor.body).X_WB);
  const ConvexSlot slot = nearest(actor.structure, X_WR.inverse() * point_W);
  if (!parts_->world.material(actor.structure.convex(slot)->material).breakable()) return;
  ActorImpact impact;
  impact.key = actor.key;
  impact.convex = slot;
  impact.point_W = point_W;
  impact.direction_W = direction_W.normalized();
  impact.energy_J = energy_J;
  impact.pattern = std::move(pattern);
  parts_->act.add(std::move(impact));
}

void World::set_user_data(BodyKey body, std::uint64_t user_data) {
  parts_->change("set_user_data");
  parts_->actor(body, "set_user_data").user_data = user_data;
}

void World::set_filter(BodyKey body, CollisionFilter filter) {
  parts_->change("set_filter");
  Actor& actor = parts_->actor(body, "set_filter");
  if (actor.filter == filter) return;
  parts_->changed();
  actor.filter = filter;
  remake_body(parts_->world, actor);
}

bool World::contains(BodyKey body) const {
  return !body.none() && parts_->world.actors.find(body.value) != nullptr;
}

bool World::contains(JointKey joint) const {
  return parts_->world.joints.find(joint.value) != nullptr;
}

std::size_t World::size() const { return parts_->world.actors.size(); }

BodyView World::body(BodyKey body) const {
  const Actor& actor = parts_->actor(body, "body");
  const WorldState& world = parts_->world;
  const BodyState state = world.physics->state(actor.body);
  BodyView view;
  view.key = body;
  view.root = BodyKey(std::size_t{actor.root_key});
  view.motion = {rest_pose(actor, state.X_WB), state.velocity_W, state.angular_velocity_W};
  view.com_W = state.X_WB.position;
  view.mass_kg = actor.weight.mass_kg;
  view.volume_m3 = actor.volume_m3;
  view.convexes = actor.structure.size();
  view.is_static = actor.is_static;
  view.is_kinematic = actor.is_kinematic;
  view.asleep = state.asleep;
  if (actor.name != kNoName) view.name = (*world.names)[actor.name];
  view.user_data = actor.user_data;
  view.filter = actor.filter;
  return view;
}

const BodyArrays& World::bodies() const {
  if (parts_->arrays) return *parts_->arrays;
  const WorldState& world = parts_->world;
  const BodyStates states = world.physics->states();
  BodyArrays all;
  const std::size_t count = world.actors.size();
  all.key.reserve(count), all.position_W.reserve(count), all.rotation_W.reserve(count);
  all.velocity_W.reserve(count), all.angular_velocity_W.reserve(count);
  all.is_static.reserve(count), all.asleep.reserve(count);
  for (const Actor& actor : world.actors) {
    const std::uint32_t slot = actor.body.slot;
    all.key.emplace_back(std::size_t{actor.key});
    all.position_W.push_back(states.position_W[slot]);
    all.rotation_W.push_back(states.rotation_WB[slot]);
    all.velocity_W.push_back(states.velocity_W[slot]);
    all.angular_velocity_W.push_back(states.angular_velocity_W[slot]);
    all.is_static.push_back(actor.is_static);
    all.asleep.push_back(states.mode[slot] == BodyMode::kAsleep);
  }
  return parts_->arrays.emplace(std::move(all));
}

std::vector<Contact> World::contacts(BodyKey body) const {
  const std::uint32_t tag = parts_->actor(body, "contacts").key;
  if (!parts_->contacts) parts_->contacts = parts_->world.physics->contact_forces();
  std::vector<Contact> found;
  for (const ContactForce& press : *parts_->contacts) {
    if (press.body_tag_a == tag)
      found.push_back({key_of_tag(press.body_tag_b), press.point_W, -press.force_W});
    if (press.body_tag_b == tag)
      found.push_back({key_of_tag(press.body_tag_a), press.point_W, press.force_W});
  }
  return found;
}

namespace {

/// Returns the way of a ray or ball; throws if it is invalid.
MovingBall moving_ball(const ItemCheck& check, const Vec3& from_W, const Vec3& direction_W,
                       double most_m, double radius_m) {
  check.need_finite(from_W, "from_W");
  check.need_finite(direction_W, "direction_W");
  if (!(direction_W.norm() > 0)) check.refuse("direction_W is zero", "a vector with a length");
  check.need_number(most_m, 0, kMaxNumber, "most_m");
  check.need_number(radius_m, 0, kMaxNumber, "radius_m");
  return {from_W, direction_W.normalized(), most_m, radius_m};
}

}  // namespace

std::optional<CastHit> World::cast(const Vec3& from_W, const Vec3& direction_W, double most_m,
                                   double radius_m, const QueryFilter& filter) const {
  const Query query(parts_->queries);
  return find_first(parts_->world, filter,
                    moving_ball(parts_->check("cast"), from_W, direction_W, most_m, radius_m));
}

std::vector<CastHit> World::cast_all(const Vec3& from_W, const Vec3& direction_W, double most_m,
                                     double radius_m, const QueryFilter& filter) const {
  const Query query(parts_->queries);
  return find_all(parts_->world, filter,
                  moving_ball(parts_->check("cast_all"), from_W, direction_W, most_m, radius_m));
}

std::vector<Overlap> World::overlap(const Vec3& center_W, double radius_m,
                                    const QueryFilter& filter) const {
  const ItemCheck check = parts_->check("overlap");
  check.need_finite(center_W, "center_W");
  check.need_number(radius_m, 0, kMaxNumber, "radius_m");
  const Query query(parts_->queries);
  return find_overlaps(parts_->world, filter, center_W, radius_m);
}

std::vector<Overlap> World::overlap(const Box& box_W, const QueryFilter& filter) const {
  const ItemCheck check = parts_->check("overlap");
  check.need_finite(box_W.min, "box_W.min");
  check.need_finite(box_W.max, "box_W.max");
  if (box_W.empty()) check.refuse("box_W is empty", "min at most max");
  const Query query(parts_->queries);
  return find_overlaps(parts_->world, filter, box_W);
}

const Events& World::events() const { return parts_->events; }

void World::report_hits(double least_m_s) {
  parts_->change("report_hits")
      .need_number(least_m_s, 0, std::numeric_limits<double>::infinity(), "least_m_s");
  parts_->least_hit_m_s = least_m_s;
}

const FrameReport& World::report() const { return parts_->report; }

FramePtr World::frame() {
  auto& parts = *parts_;
  if (parts.frame) return parts.frame;
  const ThreadScope scope(parts.threads);
  std::optional<LoopCount> count;
  if (parts.counts_loops) count.emplace();
  const TraceSpan span(kStageNames[static_cast<int>(Stage::kSnapshot)]);
  StageClock clock;
  auto frame = snapshot(parts.world, parts.particles, parts.report);
  frame->breaks = parts.events.breaks;
  clock.end(Stage::kSnapshot, frame->report);
  if (parts.inspects) frame->inspection = sunder::inspect(parts.world, *parts.breaker, *frame);
  return parts.frame = std::move(frame);
}

void World::inspect() { parts_->inspects = true; }

void World::count_loops() { parts_->counts_loops = true; }

}  // namespace sunder
