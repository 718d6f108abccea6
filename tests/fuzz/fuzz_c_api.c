// Calls the functions of the C interface at random: with good arguments, and with handles that are
// stale, null or foreign, null pointers, numbers that are huge, NaN or infinite. Checks that each
// call returns a result of the interface, that an error has a message which begins with the name of
// a function, and that a refused call does not change the state of its world.
//
//   fuzz_c_api [SEED [SECONDS]]
//
// The exit code is 1 if a check fails. The calls of a seed are the same in every run, but for their
// number.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "scenes/api/sunder_c.h"

enum { kWorlds = 3, kAssets = 6, kKeys = 32, kMostBodies = 120, kRoom = 64 };

static uint64_t state;
static SunderWorld worlds[kWorlds];
static SunderAsset assets[kAssets];
static SunderBody bodies[kKeys];
static SunderJoint joints[kKeys];
static unsigned long long calls, refusals, breaks, steps;
static double until_s;

// The generator splitmix64.
static uint64_t next(void) {
  uint64_t z = state += 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

static uint32_t below(uint32_t limit) { return (uint32_t)(next() % limit); }
static bool one_in(uint32_t n) { return below(n) == 0; }
static double uniform(double low, double high) {
  return low + (high - low) * ((double)(next() >> 11) / 9007199254740992.0);
}

static void fail(const char* what) {
  printf("wrong after %llu calls: %s; last error: %s\n", calls, what, sunder_last_error());
  exit(1);
}

// Returns a number of a range, or, one time in fifty, one that is seldom right.
static double number(double low, double high) {
  static const double odd[] = {0,      -1,  1e-300, 1e-12, 1e6,       1e9,      1e15,
                               -1e300, NAN, 1e300,  -0.0,  -INFINITY, INFINITY, 5e-324};
  return one_in(50) ? odd[below(sizeof odd / sizeof *odd)] : uniform(low, high);
}

static SunderVec3 vector(double size) {
  const SunderVec3 v = {number(-size, size), number(-size, size), number(-size, size)};
  return v;
}

static SunderVec3 place(void) {
  SunderVec3 v = vector(4);
  if (!one_in(10)) v.y = fabs(v.y);
  return v;
}

static SunderQuat rotation(void) {
  SunderQuat q = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), number(-1, 1)};
  const double length = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (one_in(50) || !(length > 0.1)) return q;
  q.x /= length, q.y /= length, q.z /= length, q.w /= length;
  return q;
}

static SunderPose any_pose(void) {
  const SunderPose pose = {place(), rotation()};
  return pose;
}

static SunderMotion any_motion(void) {
  const SunderMotion motion = {any_pose(), vector(30), vector(10)};
  return motion;
}

static SunderWorld any_world(void) {
  SunderWorld world = worlds[below(kWorlds)];
  if (one_in(60)) world.index = below(5);
  if (one_in(60)) world.generation = below(200);
  if (one_in(200)) world.index = (uint32_t)next();
  return world;
}

static SunderAsset any_asset(void) {
  SunderAsset asset = assets[below(kAssets)];
  if (one_in(60)) asset.generation = below(200);
  if (one_in(200)) asset.index = (uint32_t)next();
  return asset;
}

static SunderBody any_body(void) {
  SunderBody body = bodies[below(kKeys)];
  if (one_in(50)) body.key = one_in(2) ? SUNDER_NO_KEY : below(2000);
  return body;
}

static SunderFilter any_filter(void) {
  const SunderFilter all = {1, 0xffffffffu}, odd = {(uint32_t)next(), (uint32_t)next()};
  return one_in(4) ? odd : all;
}

static SunderMaterial any_material(void) {
  static const char* const names[] = {"brick", "concrete", "glass", "steel", "wood", "stone"};
  SunderMaterial material = {0};
  sunder_builtin_material(names[below(6)], &material);
  if (one_in(50)) material.index = one_in(2) ? below(100) : SUNDER_NO_MATERIAL;
  return material;
}

// Counts a call, and checks its result.
static bool done(SunderResult result) {
  ++calls;
  if (result == SUNDER_OK) return true;
  ++refusals;
  if (result < 0 || result > SUNDER_ERROR_INTERNAL) fail("an unknown result");
  if (result == SUNDER_ERROR_INTERNAL) fail("an internal error");
  if (strncmp(sunder_last_error(), "sunder_", 7) != 0) fail("an error without a message");
  return false;
}

// Checks that the calls that it is between were refused without an effect.
static uint64_t hash_of(SunderWorld world) {
  uint64_t hash = 0;
  if (sunder_world_is_valid(world) && sunder_world_state_hash(world, &hash) != SUNDER_OK)
    fail("a world without a hash");
  return hash;
}

static SunderPatternDef any_pattern(void) {
  SunderPatternDef pattern = sunder_default_pattern_def();
  pattern.kind = (int32_t)below(7);
  pattern.cells = 1 + (int32_t)below(30);
  if (pattern.kind == SUNDER_PATTERN_GRID) pattern.cells = 1 + (int32_t)below(5);
  pattern.rings = 1 + (int32_t)below(6);
  pattern.spokes = 1 + (int32_t)below(12);
  pattern.falloff = number(1, 4);
  pattern.jitter = number(0, 1);
  pattern.colors = (int32_t)below(6);
  if (one_in(40)) pattern.kind = (int32_t)next();
  if (one_in(40)) pattern.cells = (int32_t)next();
  if (one_in(40)) pattern.brick_m = vector(0.5);
  if (one_in(40)) pattern.cookie = (uint32_t)next();
  return pattern;
}

static SunderBallDef any_ball(void) {
  SunderBallDef ball = sunder_default_ball_def();
  ball.radius_m = number(0.05, 0.5);
  ball.material = any_material();
  ball.center_W = place();
  ball.velocity_W = vector(40);
  ball.filter = any_filter();
  ball.user_data = next();
  if (one_in(3)) ball.name = "ball";
  if (one_in(100)) ball.cookie = 0;
  return ball;
}

static void make_world(void) {
  static const char* const texts[] = {
      NULL,
      NULL,
      "[scene]\ndescription = \"A pane.\"\n[[solid]]\nstructure = \"pane\"\n",
      "[scene]\ndescription = \"A wall.\"\n[[solid]]\nstructure = \"brick_wall\"\nbricks = 4\n"
      "courses = 5\n",
      "[scene]\ndescription = \"A block, in the plane.\"\nplanar = true\n",
      "not a scene"};
  static const char* const presets[] = {NULL, "draft", "realtime", "accurate", "none"};
  const uint32_t at = below(kWorlds);
  if (one_in(2))
    done(sunder_world_destroy(worlds[at]));  // otherwise the handle is overwritten
  else if (sunder_world_is_valid(worlds[at]))
    sunder_world_destroy(worlds[at]);
  SunderWorldDef def = sunder_default_world_def();
  def.scene_text = texts[below(6)];
  def.preset = presets[below(10) < 9 ? below(3) : below(5)];
  def.threads = 1 + (int32_t)below(2);
  def.has_gravity = one_in(3);
  def.gravity_W.y = number(-20, 5);
  def.has_seed = one_in(3);
  def.seed = next();
  def.particles = one_in(2);
  if (one_in(40)) def.threads = (int32_t)next();
  if (one_in(40)) def.cookie = (uint32_t)next();
  if (one_in(40)) def.scene = "none";
  if (one_in(40)) def.setting_count = 1;
  if (one_in(40)) done(sunder_world_create(one_in(2) ? NULL : &def, NULL));
  SunderWorld made = worlds[at];
  if (done(sunder_world_create(&def, &made))) worlds[at] = made;
}

static void make_asset(void) {
  const uint32_t at = below(kAssets);
  if (one_in(2)) done(sunder_asset_destroy(assets[at]));
  SunderVec3 points[24];
  for (int i = 0; i < 24; ++i) points[i] = one_in(6) && i > 0 ? points[i - 1] : vector(0.6);
  if (one_in(4)) {
    static const char* const meshes[] = {"torus:0.6,0.2", "box:1,1,1", "sphere:0.5", "nothing", ""};
    uint32_t indices[36];
    SunderMeshDef mesh = sunder_default_mesh_def();
    mesh.mesh = one_in(2) ? meshes[below(5)] : NULL;
    mesh.vertices = one_in(20) ? NULL : points;
    mesh.vertex_count = below(25);
    for (int i = 0; i < 36; ++i)
      indices[i] = one_in(400) ? (uint32_t)next() : below(mesh.vertex_count + 1);
    mesh.indices = one_in(20) ? NULL : indices;
    mesh.index_count = one_in(10) ? below(37) : 3 * below(13);
    mesh.material = any_material();
    mesh.convexes = below(5);
    mesh.repair = !one_in(5);
    mesh.fit = one_in(5) ? "aabb" : one_in(40) ? "hull:0" : NULL;
    mesh.nodes = one_in(5) ? "3" : one_in(40) ? "none" : NULL;
    if (one_in(20)) mesh.scale = number(0.1, 10);
    if (one_in(20)) mesh.size_m = number(0.1, 3);
    SunderAsset made;
    if (done(sunder_asset_create_mesh(&mesh, &made))) {
      sunder_asset_destroy(assets[at]);
      assets[at] = made;
    }
    return;
  }
  SunderPartDef parts[6];
  const uint32_t count = below(7);
  for (uint32_t i = 0; i < 6; ++i) {
    parts[i] = sunder_default_part_def();
    parts[i].material = any_material();
    parts[i].anchored = one_in(12);
    if (one_in(4)) {
      parts[i].points = points;
      parts[i].point_count = below(25);
    } else if (one_in(8)) {
      parts[i].box_min = vector(1), parts[i].box_max = vector(1);
    } else {
      parts[i].box_min.x = -0.3 + 0.6 * i, parts[i].box_max.x = 0.3 + 0.6 * i;
      parts[i].box_min.y = -0.4, parts[i].box_max.y = 0.4;
    }
    if (one_in(100)) parts[i].cookie = 0;
  }
  SunderAsset made;
  if (done(sunder_asset_create_parts(one_in(100) ? NULL : parts, count, &made))) {
    sunder_asset_destroy(assets[at]);
    assets[at] = made;
    SunderAssetInfo info;
    if (!done(sunder_asset_info(made, &info)) || !(info.volume_m3 > 0)) fail("no volume");
  }
}

static void add_body(SunderWorld world) {
  uint32_t count = 0;
  if (sunder_world_is_valid(world)) sunder_world_body_count(world, &count);
  if (count > kMostBodies) return;
  SunderBody body = {0};
  if (one_in(3)) {
    const SunderBallDef ball = any_ball();
    if (done(sunder_world_add_ball(world, one_in(100) ? NULL : &ball, &body)))
      bodies[below(kKeys)] = body;
    return;
  }
  SunderSolidDef solid = sunder_default_solid_def();
  solid.motion = any_motion();
  solid.user_data = next();
  solid.filter = any_filter();
  if (one_in(100)) solid.cookie = 0;
  if (done(sunder_world_add_solid(world, any_asset(), one_in(100) ? NULL : &solid, &body)))
    bodies[below(kKeys)] = body;
}

static void add_joint(SunderWorld world) {
  SunderJointDef joint = sunder_default_joint_def();
  joint.kind = (int32_t)below(5);
  if (!one_in(4)) joint.a = any_body();
  if (!one_in(4)) joint.b = any_body();
  joint.at_W = place();
  joint.to_W = place();
  joint.axis_W = vector(1);
  if (one_in(2)) joint.breaking_N = number(0, 1e5);
  if (one_in(2)) joint.breaking_Nm = number(0, 1e5);
  joint.collide = one_in(2);
  if (one_in(50)) joint.kind = (int32_t)next();
  SunderJoint key;
  if (done(sunder_world_add_joint(world, &joint, &key))) joints[below(kKeys)] = key;
}

static void add_material(SunderWorld world) {
  SunderMaterialDef def;
  memset(&def, 0, sizeof def);
  if (!done(sunder_world_material_def(world, any_material(), &def)) && !one_in(4)) return;
  if (one_in(3)) def.density_kg_m3 = number(100, 9000);
  if (one_in(3)) def.friction = number(0, 1);
  if (one_in(3)) def.restitution = number(0, 1);
  if (one_in(3)) def.toughness_J_m2 = number(0, 100);
  if (one_in(3)) def.tensile_Pa = number(0, 1e7);
  if (one_in(3)) def.compressive_Pa = number(0, 1e8);
  if (one_in(3)) def.youngs_Pa = number(1e7, 1e11);
  if (one_in(3)) def.yield_Pa = number(0, 1e8);
  if (one_in(3)) def.impact_radius_m = number(0.1, 2);
  if (one_in(3)) def.smallest_piece_m3 = number(1e-6, 1e-3);
  if (one_in(3)) def.pattern = any_pattern();
  if (one_in(20)) def.base.index = (uint32_t)next();
  if (one_in(20)) memset(def.name, 'x', sizeof def.name);
  SunderMaterial material;
  done(sunder_world_add_material(world, &def, &material));
}

// Calls a function that changes a world. Returns false if it was refused.
static bool act(SunderWorld world) {
  const SunderBody body = any_body();
  const SunderMotion motion = any_motion();
  SunderShotDef shot = sunder_default_shot_def();
  SunderBlastDef blast = sunder_default_blast_def();
  SunderPatternDef pattern = any_pattern();
  SunderDriveDef drive = sunder_default_drive_def();
  switch (below(13)) {
    case 0:
      return done(sunder_world_set_motion(world, body, one_in(100) ? NULL : &motion));
    case 1:
      return done(sunder_world_move_to(world, body, motion.X_WR, number(0.01, 1)));
    case 2:
      return done(sunder_world_release(world, body));
    case 3:
      return done(sunder_world_apply_impulse(world, body, vector(300), place()));
    case 4:
      return done(sunder_world_break_at(world, body, place(), vector(1), number(0, 1e5),
                                        one_in(2) ? &pattern : NULL));
    case 5:
      return done(sunder_world_set_user_data(world, body, next()));
    case 6:
      return done(sunder_world_set_filter(world, body, any_filter()));
    case 7:
      return done(sunder_world_report_hits(world, number(0, 5)));
    case 8:
      return done(sunder_world_remove_body(world, body));
    case 9: {
      SunderJoint joint = joints[below(kKeys)];
      if (one_in(50)) joint.key = one_in(2) ? SUNDER_NO_KEY : below(200);
      return done(sunder_world_remove_joint(world, joint));
    }
    case 10:
      shot.time_s = number(-1, 3);
      shot.ball = any_ball();
      shot.hangs = one_in(4);
      shot.hangs_from_W = place();
      return done(sunder_world_shoot(world, &shot));
    case 11:
      drive.time_s = number(-1, 3);
      drive.until_s = number(0, 10);
      drive.bodies = one_in(100) ? NULL : &body;
      drive.body_count = below(20) > 0;
      drive.has_velocity = one_in(2);
      drive.velocity_W = vector(5);
      drive.has_angular_velocity = one_in(2);
      drive.angular_velocity_W = vector(5);
      if (one_in(2)) drive.force_N = number(0, 1e6);
      if (one_in(2)) drive.torque_Nm = number(0, 1e6);
      return done(sunder_world_drive(world, &drive));
    default:
      blast.time_s = number(-1, 3);
      blast.center_W = place();
      blast.radius_m = number(0.5, 5);
      blast.impulse_Ns_m2 = number(0, 3000);
      blast.cover = one_in(2);
      blast.in_air = one_in(2);
      if (one_in(3)) blast.tnt_kg = number(0, 3);
      return done(sunder_world_blast(world, one_in(100) ? NULL : &blast));
  }
}

static void ask(SunderWorld world) {
  SunderBodyInfo info;
  SunderCastHit hits[kRoom];
  SunderOverlap overlaps[kRoom];
  SunderContact contacts[kRoom];
  SunderReport report;
  SunderQuery query = sunder_default_query();
  query.mask = one_in(3) ? (uint32_t)next() : 0xffffffffu;
  query.ground = one_in(2);
  query.ignored = any_body();
  if (one_in(100)) query.cookie = 0;
  const SunderQuery* filter = one_in(2) ? &query : NULL;
  uint32_t count = below(kRoom + 1);
  bool found = false;
  switch (below(9)) {
    case 0:
      if (done(sunder_world_body(world, any_body(), &info)) &&
          !(info.mass_kg > 0 && isfinite(info.com_W.x) && isfinite(info.motion.velocity_W.y)))
        fail("a body with wrong numbers");
      break;
    case 1:
      done(sunder_world_cast(world, place(), vector(1), number(0, 20), one_in(2) ? number(0, 1) : 0,
                             filter, hits, one_in(100) ? NULL : &found));
      break;
    case 2:
      done(sunder_world_cast_all(world, place(), vector(1), number(0, 20),
                                 one_in(2) ? number(0, 1) : 0, filter, one_in(5) ? NULL : hits,
                                 one_in(100) ? NULL : &count));
      break;
    case 3:
      done(sunder_world_overlap_ball(world, place(), number(0, 3), filter,
                                     one_in(5) ? NULL : overlaps, &count));
      break;
    case 4:
      done(sunder_world_overlap_box(world, vector(3), vector(3), filter,
                                    one_in(5) ? NULL : overlaps, &count));
      break;
    case 5:
      done(sunder_world_contacts(world, any_body(), one_in(5) ? NULL : contacts, &count));
      break;
    case 6: {
      SunderBody keys[kRoom];
      SunderVec3 positions[kRoom];
      SunderQuat rotations[kRoom];
      uint8_t asleep[kRoom];
      SunderBodyArrays arrays = {0};
      arrays.body = keys;
      arrays.position_W = one_in(2) ? positions : NULL;
      arrays.rotation_W = one_in(2) ? rotations : NULL;
      arrays.asleep = one_in(2) ? asleep : NULL;
      count = below(kRoom + 1);
      if (done(sunder_world_bodies(world, &arrays, &count)) && count > 0)
        bodies[below(kKeys)] = keys[below(count)];
      break;
    }
    case 7:
      done(sunder_world_report(world, one_in(100) ? NULL : &report));
      break;
    default:
      done(sunder_world_contains_body(world, any_body(), &found));
      break;
  }
}

static void read_events(SunderWorld world) {
  SunderEvents events;
  if (!done(sunder_world_events(world, &events))) return;
  for (uint32_t i = 0; i < events.break_count; ++i) {
    const SunderBreak* one = &events.breaks[i];
    if (!isfinite(one->energy_J) || !isfinite(one->point_W.x)) fail("a break with wrong numbers");
    for (uint32_t k = 0; k < one->child_count; ++k) bodies[below(kKeys)] = one->children[k];
  }
  breaks += events.break_count;
  for (uint32_t i = 0; i < events.hit_count; ++i)
    if (!(events.hits[i].speed_m_s >= 0)) fail("a hit with a wrong speed");
  for (uint32_t i = 0; i < events.appeared_count; ++i) bodies[below(kKeys)] = events.appeared[i];
}

static void draw(SunderWorld world) {
  SunderFrame frame;
  if (!done(sunder_world_frame(world, &frame))) return;
  for (uint32_t i = 0; i < frame.instance_count; ++i) {
    SunderMesh mesh;
    if (!done(sunder_world_mesh(world, frame.instances[i].mesh, &mesh))) fail("no mesh");
    for (uint32_t k = 0; k < mesh.index_count; ++k)
      if (mesh.indices[k] >= mesh.vertex_count) fail("an index of no vertex");
    if (!isfinite(frame.instances[i].X_WM.position.x)) fail("an instance at no place");
  }
  SunderMesh mesh;
  done(sunder_world_mesh(world, below(frame.mesh_count + 2), &mesh));
}

static void copy_world(void) {
  const uint32_t at = below(kWorlds);
  SunderWorld copy;
  const SunderWorld world = any_world();
  if (!done(sunder_world_copy(world, one_in(20) ? NULL : &copy))) return;
  if (hash_of(copy) != hash_of(world)) fail("a copy in another state");
  sunder_world_destroy(worlds[at]);
  worlds[at] = copy;
}

static void restore_world(void) {
  const uint32_t at = below(kWorlds);
  SunderWorld restored;
  const void* bytes;
  size_t size;
  const SunderWorld world = any_world();
  if (!done(sunder_world_save(world, one_in(20) ? NULL : &bytes, &size))) return;
  if (one_in(4)) --size;
  if (!done(sunder_world_restore(bytes, size, 0, &restored))) return;
  if (hash_of(restored) != hash_of(world)) fail("a restored world in another state");
  sunder_world_destroy(worlds[at]);
  worlds[at] = restored;
}

// Calls one function, or a few.
static void call(void) {
  const SunderWorld world = any_world();
  const uint32_t which = below(100);
  if (which < 1)
    one_in(3) ? copy_world() : one_in(3) ? restore_world() : make_world();
  else if (which < 3)
    make_asset();
  else if (which < 10)
    add_body(world);
  else if (which < 13)
    add_joint(world);
  else if (which < 14)
    add_material(world);
  else if (which < 40) {
    const uint64_t before = hash_of(world);
    if (!act(world) && hash_of(world) != before) fail("a refused call changed the world");
  } else if (which < 75)
    ask(world);
  else if (which < 78)
    draw(world);
  else {
    if (one_in(10))
      done(sunder_world_step(world, number(0, 0.05)));
    else if (done(sunder_world_step(world, 1.0 / 60)))
      ++steps;
    read_events(world);
  }
}

int main(int argc, char** argv) {
  const uint64_t seed = argc > 1 ? strtoull(argv[1], NULL, 10) : 1;
  until_s = argc > 2 ? atof(argv[2]) : 5;
  state = seed;
  const time_t start = time(NULL);
  while (difftime(time(NULL), start) < until_s)
    for (int i = 0; i < 10; ++i) call();
  for (int i = 0; i < kWorlds; ++i) sunder_world_destroy(worlds[i]);
  for (int i = 0; i < kAssets; ++i) sunder_asset_destroy(assets[i]);
  printf("%llu calls, of which %llu were refused; %llu steps, %llu breaks\n", calls, refusals,
         steps, breaks);
  return 0;
}
