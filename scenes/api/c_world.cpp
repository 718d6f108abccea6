// The C interface: worlds, materials, and what is added to worlds.
#include <dlfcn.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "scenes/api/c_base.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr const char* kEmptyScene = "[scene]\ndescription = \"An empty world.\"\n";
constexpr int kMostThreads = 1024;
constexpr double kMostCells = 1e5;  // of a pattern

/// Returns the folder of scenes that was installed with this library.
std::filesystem::path installed_scenes() {
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&sunder_version), &library) == 0 || !library.dli_fname)
    return {};
  return std::filesystem::path(library.dli_fname).parent_path() / SUNDER_SCENES_FROM_LIBRARY;
}

Scene scene_of(const SunderWorldDef& def) {
  LoadOptions options;
  if (def.preset) options.preset = def.preset;
  if (def.setting_count > 0) need_pointer(def.settings, "def.settings");
  for (std::uint32_t i = 0; i < def.setting_count; ++i) {
    need_pointer(def.settings[i], "an element of def.settings");
    options.set.emplace_back(def.settings[i]);
  }
  if (def.scene && def.scene_text)
    refuse("def.scene and def.scene_text are both given; expected at most one");
  Scene scene = def.scene ? load_scene(def.scene, options,
                                       def.scenes_folder ? std::filesystem::path(def.scenes_folder)
                                                         : installed_scenes())
                          : parse_scene(def.scene_text ? def.scene_text : kEmptyScene,
                                        def.scene_text ? "scene_text" : "empty", options);
  if (def.has_gravity) {
    need_vector(def.gravity_W, ranges::kGravity_m_s2.high, "def.gravity_W");
    scene.gravity_W = vec(def.gravity_W);
  }
  if (def.has_seed) scene.seed = def.seed;
  if (!def.particles) scene.limits.debris = scene.limits.dust = 0;
  return scene;
}

SunderPatternDef pattern_def(const PatternSpec& spec) {
  SunderPatternDef def{};
  def.cookie = kPatternCookie;
  def.kind = static_cast<std::int32_t>(spec.kind);
  def.cells = spec.cells;
  def.falloff = spec.falloff;
  def.rings = spec.rings;
  def.spokes = spec.spokes;
  def.jitter = spec.jitter;
  def.brick_m = vec(spec.brick_m);
  def.colors = spec.colors;
  return def;
}

static_assert(static_cast<int>(PatternSpec::Kind::kNone) == SUNDER_PATTERN_NONE);
static_assert(static_cast<int>(PatternSpec::Kind::kVoronoi) == SUNDER_PATTERN_VORONOI);
static_assert(static_cast<int>(PatternSpec::Kind::kWeb) == SUNDER_PATTERN_WEB);
static_assert(static_cast<int>(PatternSpec::Kind::kRadial) == SUNDER_PATTERN_RADIAL);
static_assert(static_cast<int>(PatternSpec::Kind::kBrick) == SUNDER_PATTERN_BRICK);
static_assert(static_cast<int>(PatternSpec::Kind::kSlabs) == SUNDER_PATTERN_SLABS);
static_assert(static_cast<int>(PatternSpec::Kind::kGrid) == SUNDER_PATTERN_GRID);
static_assert(static_cast<int>(PatternSpec::Kind::kFile) == SUNDER_PATTERN_FILE);
static_assert(static_cast<int>(JointKind::kBall) == SUNDER_JOINT_BALL);
static_assert(static_cast<int>(JointKind::kHinge) == SUNDER_JOINT_HINGE);
static_assert(static_cast<int>(JointKind::kFixed) == SUNDER_JOINT_FIXED);
static_assert(static_cast<int>(JointKind::kDistance) == SUNDER_JOINT_DISTANCE);
static_assert(static_cast<int>(JointKind::kRope) == SUNDER_JOINT_ROPE);
static_assert(BodyKey::kNone == SUNDER_NO_KEY && MaterialIndex::kNone == SUNDER_NO_MATERIAL);

/// Returns the index of the last material of a name.
MaterialIndex material_called(const std::vector<Material>& materials, const char* name) {
  need_pointer(name, "name");
  std::string known;
  for (std::size_t i = materials.size(); i-- > 0;)
    if (materials[i].name == name) return MaterialIndex(i);
  for (const Material& material : materials) known += (known.empty() ? "" : ", ") + material.name;
  refuse("name is '" + std::string(name) + "', which no material has; expected one of " + known);
}

const Material& material_at(WorldEntry& entry, SunderMaterial material, const char* name) {
  return entry.world.materials()[index_in(entry, material, name).value];
}

/// Copies a colour, whose elements are finite.
Vec3f color_of(const float (&color)[3], const char* name) {
  for (const float element : color) need_number(double{element}, 0, 1e6, name);
  return {color[0], color[1], color[2]};
}

Material material_from(const Material& base, const SunderMaterialDef& def) {
  Material material = base;
  if (!std::memchr(def.name, 0, sizeof def.name)) refuse("def.name has no final null");
  material.name = def.name;
  material.density_kg_m3 = def.density_kg_m3;
  material.friction = def.friction;
  material.restitution = def.restitution;
  material.rolling = def.rolling;
  material.toughness_J_m2 = def.toughness_J_m2;
  material.pattern = pattern_of(def.pattern, "def.pattern", &base.pattern);
  material.impact_radius_m = def.impact_radius_m;
  material.tensile_Pa = def.tensile_Pa;
  material.shear_Pa = def.shear_Pa;
  material.compressive_Pa = def.compressive_Pa;
  material.reinforcement_percent = def.reinforcement_percent;
  material.youngs_Pa = def.youngs_Pa;
  material.yield_Pa = def.yield_Pa;
  material.hardening_Pa = def.hardening_Pa;
  material.elongation = def.elongation;
  material.smallest_piece_m3 = def.smallest_piece_m3;
  material.surface.color = color_of(def.surface_color, "def.surface_color");
  material.interior.color = color_of(def.interior_color, "def.interior_color");
  return material;
}

/// Refuses a pose or velocity that is not finite, or beyond what a world can compute with.
void need_motion(const SunderMotion& motion, const std::string& name) {
  need_vector(motion.X_WR.position, kMaxPosition_m, name + ".X_WR.position");
  need_vector(motion.velocity_W, kMaxSpeed_m_s, name + ".velocity_W");
  need_vector(motion.angular_velocity_W, kMaxSpin_rad_s, name + ".angular_velocity_W");
}

Ball ball_of(WorldEntry& entry, const SunderBallDef& def, const std::string& name) {
  need_cookie(def.cookie, kBallCookie, name, "sunder_default_ball_def");
  need_vector(def.center_W, kMaxPosition_m, name + ".center_W");
  need_vector(def.velocity_W, kMaxSpeed_m_s, name + ".velocity_W");
  Ball ball;
  ball.name = text_of(def.name);
  ball.radius_m = def.radius_m;
  ball.material = index_in(entry, def.material, name);
  ball.center_W = vec(def.center_W);
  ball.velocity_W = vec(def.velocity_W);
  ball.filter = filter_of(def.filter);
  ball.user_data = def.user_data;
  return ball;
}

/// Returns the end of a joint; none for the world.
std::optional<std::uint32_t> joint_end(const WorldEntry& entry, SunderBody body, const char* name) {
  if (body.key == SUNDER_NO_KEY) return std::nullopt;
  need_body(entry, body, name);
  return body.key;
}

}  // namespace

PatternSpec pattern_of(const SunderPatternDef& def, const std::string& name,
                       const PatternSpec* base) {
  need_cookie(def.cookie, kPatternCookie, name, "sunder_default_pattern_def");
  need_number(def.kind, SUNDER_PATTERN_NONE, SUNDER_PATTERN_FILE, name + ".kind");
  PatternSpec spec;
  if (base) spec.file = base->file;
  if (def.kind == SUNDER_PATTERN_FILE && spec.file.empty())
    refuse(name + ".kind is SUNDER_PATTERN_FILE; expected a kind without a file");
  spec.kind = static_cast<PatternSpec::Kind>(def.kind);
  spec.cells = def.cells;
  spec.falloff = def.falloff;
  spec.rings = def.rings;
  spec.spokes = def.spokes;
  spec.jitter = def.jitter;
  spec.brick_m = vec(def.brick_m);
  spec.colors = def.colors;
  const double cells = def.cells, cells_of_grid = cells * cells * cells;
  const double count = def.kind == SUNDER_PATTERN_GRID ? cells_of_grid
                       : def.kind == SUNDER_PATTERN_WEB
                           ? static_cast<double>(def.rings) * def.spokes
                           : cells;
  need_number(count, -kMostCells, kMostCells, "the number of cells of " + name);
  return spec;
}

}  // namespace sunder::scenes

using namespace sunder;
using namespace sunder::scenes;

SunderWorldDef sunder_default_world_def() {
  SunderWorldDef def{};
  def.cookie = kWorldCookie;
  def.gravity_W = {0, -9.81, 0};
  def.seed = 1;
  def.particles = true;
  return def;
}

SunderResult sunder_world_create(const SunderWorldDef* def, SunderWorld* world) {
  return guard("sunder_world_create", SUNDER_ERROR_INPUT, [&] {
    need_def(def, kWorldCookie, "def", "sunder_default_world_def");
    need_pointer(world, "world");
    need_number(def->threads, 0, kMostThreads, "def.threads");
    SimulationOptions options;
    options.threads = def->threads;
    if (def->warn)
      options.warn = [warn = def->warn, user = def->warn_user](const std::string& warning) {
        warn(warning.c_str(), user);
      };
    *world = add_world(std::allocate_shared<WorldEntry>(HookAllocator<WorldEntry>(),
                                                        make_world(scene_of(*def), options)));
  });
}

SunderResult sunder_world_copy(SunderWorld world, SunderWorld* copy) {
  return ask_world("sunder_world_copy", world, [&](WorldEntry& entry) {
    need_pointer(copy, "copy");
    *copy = add_world(
        std::allocate_shared<WorldEntry>(HookAllocator<WorldEntry>(), entry.world.copy()));
  });
}

SunderResult sunder_world_save(SunderWorld world, const void** bytes, size_t* size) {
  return ask_world("sunder_world_save", world, [&](WorldEntry& entry) {
    need_pointer(bytes, "bytes");
    need_pointer(size, "size");
    const std::vector<std::byte> saved = save_world(entry.world);
    entry.saved.assign(saved.begin(), saved.end());
    *bytes = entry.saved.data();
    *size = entry.saved.size();
  });
}

SunderResult sunder_world_restore(const void* bytes, size_t size, int32_t threads,
                                  SunderWorld* world) {
  return guard("sunder_world_restore", SUNDER_ERROR_INPUT, [&] {
    need_pointer(bytes, "bytes");
    need_pointer(world, "world");
    need_number(threads, 0, kMostThreads, "threads");
    SimulationOptions options;
    options.threads = threads;
    *world = add_world(std::allocate_shared<WorldEntry>(
        HookAllocator<WorldEntry>(),
        restore_world(std::span(static_cast<const std::byte*>(bytes), size), options, "bytes")));
  });
}

SunderResult sunder_world_destroy(SunderWorld world) {
  return guard("sunder_world_destroy", SUNDER_ERROR_ARGUMENT, [&] {
    const WorldPtr entry = take_world(world);
    const std::lock_guard wait(entry->mutex);  // for a call of another thread
  });
}

bool sunder_world_is_valid(SunderWorld world) { return has_world(world); }

SunderResult sunder_world_step(SunderWorld world, double time_s) {
  return change_world("sunder_world_step", world, [&](WorldEntry& entry) {
    entry.world.step(time_s);
    entry.events.reset();
  });
}

SunderPatternDef sunder_default_pattern_def() {
  PatternSpec spec;
  spec.kind = PatternSpec::Kind::kVoronoi;
  return pattern_def(spec);
}

SunderResult sunder_builtin_material(const char* name, SunderMaterial* material) {
  return guard("sunder_builtin_material", SUNDER_ERROR_ARGUMENT, [&] {
    need_pointer(material, "material");
    *material = {material_called(builtins(), name).value};
  });
}

SunderResult sunder_world_material(SunderWorld world, const char* name, SunderMaterial* material) {
  return ask_world("sunder_world_material", world, [&](WorldEntry& entry) {
    need_pointer(material, "material");
    *material = material_of(entry, material_called(entry.world.materials(), name));
  });
}

SunderResult sunder_world_material_def(SunderWorld world, SunderMaterial material,
                                       SunderMaterialDef* def) {
  return ask_world("sunder_world_material_def", world, [&](WorldEntry& entry) {
    need_pointer(def, "def");
    const Material& base = material_at(entry, material, "material");
    SunderMaterialDef copy{};
    copy.cookie = kMaterialCookie;
    copy.base = material;
    copy_name(base.name, copy.name);
    copy.density_kg_m3 = base.density_kg_m3;
    copy.friction = base.friction;
    copy.restitution = base.restitution;
    copy.rolling = base.rolling;
    copy.toughness_J_m2 = base.toughness_J_m2;
    copy.pattern = pattern_def(base.pattern);
    copy.impact_radius_m = base.impact_radius_m;
    copy.tensile_Pa = base.tensile_Pa;
    copy.shear_Pa = base.shear_Pa;
    copy.compressive_Pa = base.compressive_Pa;
    copy.reinforcement_percent = base.reinforcement_percent;
    copy.youngs_Pa = base.youngs_Pa;
    copy.yield_Pa = base.yield_Pa;
    copy.hardening_Pa = base.hardening_Pa;
    copy.elongation = base.elongation;
    copy.smallest_piece_m3 = base.smallest_piece_m3;
    for (int i = 0; i < 3; ++i) {
      copy.surface_color[i] = base.surface.color[i];
      copy.interior_color[i] = base.interior.color[i];
    }
    *def = copy;
  });
}

SunderResult sunder_world_add_material(SunderWorld world, const SunderMaterialDef* def,
                                       SunderMaterial* material) {
  return change_world("sunder_world_add_material", world, [&](WorldEntry& entry) {
    need_def(def, kMaterialCookie, "def", "sunder_world_material_def");
    need_pointer(material, "material");
    const Material added = material_from(values_of(entry, def->base, "def.base"), *def);
    *material = material_of(entry, entry.world.add(added));
  });
}

SunderMotion sunder_default_motion() { return motion(BodyMotion{}); }

SunderSolidDef sunder_default_solid_def() {
  SunderSolidDef def{};
  def.cookie = kSolidCookie;
  def.motion = sunder_default_motion();
  def.filter = filter_of(CollisionFilter{});
  return def;
}

SunderBallDef sunder_default_ball_def() {
  SunderBallDef def{};
  def.cookie = kBallCookie;
  def.radius_m = 0.5;
  def.material = default_material("steel");
  def.filter = filter_of(CollisionFilter{});
  return def;
}

SunderJointDef sunder_default_joint_def() {
  SunderJointDef def{};
  def.cookie = kJointCookie;
  def.kind = SUNDER_JOINT_BALL;
  def.a = def.b = {SUNDER_NO_KEY};
  def.axis_W = {0, 0, 1};
  def.breaking_N = def.breaking_Nm = kInfinity;
  return def;
}

SunderResult sunder_world_add_solid(SunderWorld world, SunderAsset asset,
                                    const SunderSolidDef* solid, SunderBody* body) {
  return change_world("sunder_world_add_solid", world, [&](WorldEntry& entry) {
    const AssetPtr shared = find_asset(asset);
    need_def(solid, kSolidCookie, "solid", "sunder_default_solid_def");
    need_motion(solid->motion, "solid.motion");
    for (const SunderMaterial material : shared->materials) index_in(entry, material, "asset");
    const BodyKey key = entry.world.add(shared->asset, motion(solid->motion), text_of(solid->name));
    entry.world.set_user_data(key, solid->user_data);
    entry.world.set_filter(key, filter_of(solid->filter));
    if (body) *body = body_of(key);
  });
}

SunderResult sunder_world_add_ball(SunderWorld world, const SunderBallDef* ball, SunderBody* body) {
  return change_world("sunder_world_add_ball", world, [&](WorldEntry& entry) {
    need_pointer(ball, "ball");
    const BodyKey key = entry.world.add(ball_of(entry, *ball, "ball"));
    if (body) *body = body_of(key);
  });
}

SunderResult sunder_world_add_joint(SunderWorld world, const SunderJointDef* joint,
                                    SunderJoint* key) {
  return change_world("sunder_world_add_joint", world, [&](WorldEntry& entry) {
    need_def(joint, kJointCookie, "joint", "sunder_default_joint_def");
    need_number(joint->kind, SUNDER_JOINT_BALL, SUNDER_JOINT_ROPE, "joint.kind");
    need_vector(joint->at_W, kMaxPosition_m, "joint.at_W");
    need_vector(joint->to_W, kMaxPosition_m, "joint.to_W");
    Joint made;
    made.kind = static_cast<JointKind>(joint->kind);
    made.a = joint_end(entry, joint->a, "joint.a");
    made.b = joint_end(entry, joint->b, "joint.b");
    made.at_W = vec(joint->at_W);
    made.to_W = vec(joint->to_W);
    made.axis_W = vec(joint->axis_W);
    made.breaking_N = joint->breaking_N;
    made.breaking_Nm = joint->breaking_Nm;
    made.collide = joint->collide;
    const JointKey added = entry.world.add(made);
    if (key) *key = {added.value};
  });
}

SunderShotDef sunder_default_shot_def() {
  SunderShotDef def{};
  def.cookie = kShotCookie;
  def.ball = sunder_default_ball_def();
  return def;
}

SunderBlastDef sunder_default_blast_def() {
  const Blast blast;
  SunderBlastDef def{};
  def.cookie = kBlastCookie;
  def.radius_m = blast.radius_m;
  def.impulse_Ns_m2 = blast.impulse_Ns_m2;
  return def;
}

SunderResult sunder_world_shoot(SunderWorld world, const SunderShotDef* shot) {
  return change_world("sunder_world_shoot", world, [&](WorldEntry& entry) {
    need_def(shot, kShotCookie, "shot", "sunder_default_shot_def");
    Shot made;
    made.time_s = shot->time_s;
    made.ball = ball_of(entry, shot->ball, "shot.ball");
    if (shot->hangs) {
      need_vector(shot->hangs_from_W, kMaxPosition_m, "shot.hangs_from_W");
      made.hangs_from_W = vec(shot->hangs_from_W);
    }
    entry.world.shoot(made);
  });
}

SunderResult sunder_world_blast(SunderWorld world, const SunderBlastDef* blast) {
  return change_world("sunder_world_blast", world, [&](WorldEntry& entry) {
    need_def(blast, kBlastCookie, "blast", "sunder_default_blast_def");
    need_vector(blast->center_W, kMaxPosition_m, "blast.center_W");
    Blast made;
    made.time_s = blast->time_s;
    made.center_W = vec(blast->center_W);
    made.radius_m = blast->radius_m;
    made.impulse_Ns_m2 = blast->impulse_Ns_m2;
    made.cover = blast->cover;
    if (blast->tnt_kg != 0) made.tnt_kg = blast->tnt_kg;
    made.burst = blast->in_air ? BurstKind::kAir : BurstKind::kGround;
    entry.world.blast(made);
  });
}

SunderDriveDef sunder_default_drive_def() {
  const Drive drive;
  SunderDriveDef def{};
  def.cookie = kDriveCookie;
  def.until_s = kInfinity;
  def.force_N = drive.force_N;
  def.torque_Nm = drive.torque_Nm;
  return def;
}

SunderResult sunder_world_drive(SunderWorld world, const SunderDriveDef* drive) {
  return change_world("sunder_world_drive", world, [&](WorldEntry& entry) {
    need_def(drive, kDriveCookie, "drive", "sunder_default_drive_def");
    if (drive->body_count == 0) refuse("drive.body_count is 0; expected one body or more");
    need_pointer(drive->bodies, "drive.bodies");
    Drive made;
    made.time_s = drive->time_s;
    made.until_s = drive->until_s;
    for (std::uint32_t i = 0; i < drive->body_count; ++i) {
      need_body(entry, drive->bodies[i], "an element of drive.bodies");
      made.roots.push_back(drive->bodies[i].key);
    }
    if (drive->has_velocity) {
      need_vector(drive->velocity_W, kMaxSpeed_m_s, "drive.velocity_W");
      made.velocity_W = vec(drive->velocity_W);
    }
    if (drive->has_angular_velocity) {
      need_vector(drive->angular_velocity_W, kMaxSpin_rad_s, "drive.angular_velocity_W");
      made.angular_velocity_W = vec(drive->angular_velocity_W);
    }
    made.force_N = drive->force_N;
    made.torque_Nm = drive->torque_Nm;
    entry.world.drive(made);
  });
}

SunderResult sunder_world_set_motion(SunderWorld world, SunderBody body,
                                     const SunderMotion* motion) {
  return change_world("sunder_world_set_motion", world, [&](WorldEntry& entry) {
    need_pointer(motion, "motion");
    need_body(entry, body, "body");
    need_motion(*motion, "motion");
    entry.world.set_motion(key_of(body), scenes::motion(*motion));
  });
}
