// A program in C99 that uses the C interface as a game would, right and wrong. Its exit code is 1
// if a check fails. Argument: the folder of the scenes.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/api/sunder_c.h"

static int wrong = 0;

#define EXPECT(condition)                                       \
  do {                                                          \
    if (!(condition)) {                                         \
      printf("line %d: wrong: %s\n", __LINE__, #condition);     \
      printf("  the last error is: %s\n", sunder_last_error()); \
      ++wrong;                                                  \
    }                                                           \
  } while (0)

#define OK(call) EXPECT((call) == SUNDER_OK)

// Expects that a call is refused with a code, and that its message has the text.
static void refused(SunderResult result, SunderResult expected, const char* text, int line) {
  if (result == expected && strstr(sunder_last_error(), text)) return;
  printf("line %d: wrong: %s, \"%s\"; expected %s with \"%s\"\n", line, sunder_result_name(result),
         sunder_last_error(), sunder_result_name(expected), text);
  ++wrong;
}
#define REFUSED(call, code, text) refused((call), SUNDER_ERROR_##code, text, __LINE__)

static SunderVec3 vec(double x, double y, double z) {
  const SunderVec3 v = {x, y, z};
  return v;
}

static SunderWorld make_world(void) {
  const SunderWorldDef def = sunder_default_world_def();
  SunderWorld world = {0, 0};
  OK(sunder_world_create(&def, &world));
  return world;
}

// Makes a wall of two layers of four concrete blocks, of which the lower ones are anchored.
static SunderAsset make_wall(void) {
  SunderPartDef parts[8];
  for (int i = 0; i < 8; ++i) {
    parts[i] = sunder_default_part_def();
    parts[i].box_min = vec(i % 4 - 2, i / 4, -0.1);
    parts[i].box_max = vec(i % 4 - 1, i / 4 + 1, 0.1);
    parts[i].anchored = i < 4;
  }
  SunderAsset asset = {0, 0};
  OK(sunder_asset_create_parts(parts, 8, &asset));
  return asset;
}

static SunderAsset make_crate(void) {
  const SunderPartDef part = sunder_default_part_def();
  SunderAsset asset = {0, 0};
  OK(sunder_asset_create_parts(&part, 1, &asset));
  return asset;
}

typedef struct Refusal {
  SunderBody refused;
  int calls;
} Refusal;

static bool is_not_refused(SunderBody body, void* user) {
  Refusal* refusal = user;
  ++refusal->calls;
  EXPECT(body.key != SUNDER_NO_KEY);
  return body.key != refusal->refused.key;
}

// Queries ask a function of the program which bodies they may find.
static void query_by_callback(SunderWorld world, SunderBody wall, SunderBody crate) {
  Refusal refusal = {wall, 0};
  SunderQuery query = sunder_default_query();
  query.accepts = is_not_refused;
  query.accepts_user = &refusal;
  SunderCastHit hit;
  bool found = false;
  // The ray would meet the wall, then the crate.
  OK(sunder_world_cast(world, vec(-5, 1.2, 0), vec(1, 0.18, 0), 30, 0, &query, &hit, &found));
  EXPECT(found && hit.body.key == crate.key && refusal.calls >= 2);
  OK(sunder_world_cast(world, vec(-5, 1.2, 0), vec(1, 0.18, 0), 30, 0, NULL, &hit, &found));
  EXPECT(found && hit.body.key == wall.key);
  uint32_t count = 0;
  OK(sunder_world_cast_all(world, vec(-5, 1.2, 0), vec(1, 0.18, 0), 30, 0, &query, NULL, &count));
  EXPECT(count == 1);
  OK(sunder_world_overlap_box(world, vec(-9, 0.5, -9), vec(9, 9, 9), &query, NULL, &count));
  EXPECT(count == 1);
  OK(sunder_world_overlap_ball(world, vec(0, 2, 0), 9, &query, NULL, &count));
  EXPECT(count == 2);  // the crate and the ground
  query.ignored = crate;
  query.ground = false;
  OK(sunder_world_overlap_ball(world, vec(0, 2, 0), 9, &query, NULL, &count));
  EXPECT(count == 0);
  refusal.refused = crate;
  query.ignored.key = SUNDER_NO_KEY;
  query.mask = 0;  // of no body, so that there is nothing to ask
  refusal.calls = 0;
  OK(sunder_world_overlap_ball(world, vec(0, 2, 0), 9, &query, NULL, &count));
  EXPECT(count == 0 && refusal.calls == 0);
}

// A query's callback that asks the world, and tries to change it.
typedef struct Meddler {
  SunderWorld world;
  int refused;
} Meddler;

static bool meddles(SunderBody body, void* user) {
  Meddler* meddler = user;
  SunderBodyInfo info;
  OK(sunder_world_body(meddler->world, body, &info));
  SunderBallDef ball = sunder_default_ball_def();
  REFUSED(sunder_world_remove_body(meddler->world, body), ARGUMENT, "during a query");
  REFUSED(sunder_world_add_ball(meddler->world, &ball, NULL), ARGUMENT, "during a query");
  REFUSED(sunder_world_step(meddler->world, 0.01), ARGUMENT, "during a query");
  REFUSED(sunder_world_set_user_data(meddler->world, body, 3), ARGUMENT, "during a query");
  ++meddler->refused;
  return info.mass_kg > 0;
}

static void a_callback_may_ask(SunderWorld world, SunderBody crate) {
  Meddler meddler = {world, 0};
  SunderQuery query = sunder_default_query();
  query.accepts = meddles;
  query.accepts_user = &meddler;
  uint32_t count = 0;
  OK(sunder_world_overlap_ball(world, vec(5, 3, 0), 0.1, &query, NULL, &count));
  EXPECT(count == 1 && meddler.refused > 0);
  OK(sunder_world_set_user_data(world, crate, 42));  // after the query
}

// Drops a crate, shoots at a wall, and asks what happened.
static void a_short_game(void) {
  const SunderWorld world = make_world();
  const SunderAsset wall_asset = make_wall(), crate_asset = make_crate();
  SunderAssetInfo figures;
  OK(sunder_asset_info(wall_asset, &figures));
  EXPECT(figures.convexes == 8 && figures.bonds == 10 && figures.anchored);
  EXPECT(fabs(figures.volume_m3 - 8 * 0.2) < 1e-9 && figures.box_max.y == 2);

  SunderSolidDef def = sunder_default_solid_def();
  SunderBody wall, crate;
  def.name = "wall";
  OK(sunder_world_add_solid(world, wall_asset, &def, &wall));
  def.name = "a crate with a name that is much longer than the buffer of sixty-four bytes";
  def.motion.X_WR.position = vec(5, 3, 0);
  def.user_data = 42;
  OK(sunder_world_add_solid(world, crate_asset, &def, &crate));
  OK(sunder_asset_destroy(wall_asset));
  OK(sunder_asset_destroy(crate_asset));

  SunderBodyInfo info;
  OK(sunder_world_body(world, crate, &info));
  EXPECT(info.user_data == 42 && info.convexes == 1 && !info.is_static && info.com_W.y == 3);
  EXPECT(strlen(info.name) == SUNDER_NAME_SIZE - 1 && strncmp(info.name, def.name, 63) == 0);

  // A ray meets the wall, a ball meets it earlier by its radius, and a query can leave it out.
  SunderCastHit hit;
  bool found = false;
  OK(sunder_world_cast(world, vec(0.5, 1.5, 5), vec(0, 0, -2), 10, 0, NULL, &hit, &found));
  EXPECT(found && hit.body.key == wall.key && fabs(hit.distance_m - 4.9) < 1e-9);
  EXPECT(hit.normal_W.z == 1 && fabs(hit.point_W.z - 0.1) < 1e-9);
  OK(sunder_world_cast(world, vec(0.5, 1.5, 5), vec(0, 0, -2), 10, 0.2, NULL, &hit, &found));
  EXPECT(found && fabs(hit.distance_m - 4.7) < 1e-6);
  SunderQuery query = sunder_default_query();
  query.ignored = wall;
  OK(sunder_world_cast(world, vec(0.5, 1.5, 5), vec(0, 0, -2), 10, 0, &query, &hit, &found));
  EXPECT(!found);
  OK(sunder_world_cast(world, vec(9, 5, 9), vec(0, -1, 0), 10, 0, NULL, &hit, &found));
  EXPECT(found && hit.body.key == SUNDER_NO_KEY && hit.material.index == SUNDER_NO_MATERIAL);
  query = sunder_default_query();
  query.ground = false;
  uint32_t count = 0;
  OK(sunder_world_cast_all(world, vec(-3, 1.5, 0), vec(1, 0, 0), 4.6, 0, &query, NULL, &count));
  EXPECT(count == 4);
  SunderCastHit hits[4];
  count = 3;
  REFUSED(sunder_world_cast_all(world, vec(-3, 1.5, 0), vec(1, 0, 0), 4.6, 0, &query, hits, &count),
          ARGUMENT, "hits has room for 3 elements; expected 4");
  EXPECT(count == 4);
  OK(sunder_world_cast_all(world, vec(-3, 1.5, 0), vec(1, 0, 0), 4.6, 0, &query, hits, &count));
  EXPECT(hits[0].distance_m <= hits[3].distance_m);
  SunderOverlap overlaps[16];
  count = 16;
  OK(sunder_world_overlap_ball(world, vec(5, 3, 0), 0.1, NULL, overlaps, &count));
  EXPECT(count == 1 && overlaps[0].body.key == crate.key);
  count = 16;
  OK(sunder_world_overlap_box(world, vec(-2, 0.5, -1), vec(-1.5, 1.5, 1), &query, overlaps,
                              &count));
  EXPECT(count == 2 && overlaps[0].body.key == wall.key);

  query_by_callback(world, wall, crate);
  a_callback_may_ask(world, crate);

  SunderShotDef shot = sunder_default_shot_def();
  shot.ball.radius_m = 0.25;
  shot.ball.center_W = vec(0.5, 1.5, 5);
  shot.ball.velocity_W = vec(0, 0, -40);
  OK(sunder_world_shoot(world, &shot));
  OK(sunder_world_report_hits(world, 1));

  uint32_t breaks = 0, all_hits = 0, children = 0;
  for (int step = 0; step < 120; ++step) {
    OK(sunder_world_step(world, 1.0 / 60));
    SunderEvents events;
    OK(sunder_world_events(world, &events));
    EXPECT((events.break_count == 0) == (events.breaks == NULL));
    for (uint32_t i = 0; i < events.break_count; ++i) {
      children += events.breaks[i].child_count;
      EXPECT(events.breaks[i].pieces > 0 && events.breaks[i].energy_J >= 0);
    }
    for (uint32_t i = 0; i < events.appeared_count; ++i) {
      bool is_in = false;
      OK(sunder_world_contains_body(world, events.appeared[i], &is_in));
      EXPECT(is_in);
    }
    breaks += events.break_count;
    all_hits += events.hit_count;
  }
  EXPECT(breaks > 0 && children > 1 && all_hits > 0);
  double time_s = 0;
  OK(sunder_world_time(world, &time_s));
  EXPECT(fabs(time_s - 2) < 1e-9);

  // The crate rests on the ground, which carries its weight.
  OK(sunder_world_body(world, crate, &info));
  EXPECT(fabs(info.com_W.y - 0.5) < 0.02);
  SunderContact contacts[64];
  count = 64;
  OK(sunder_world_contacts(world, crate, contacts, &count));
  double force_N = 0;
  for (uint32_t i = 0; i < count; ++i) {
    EXPECT(contacts[i].other.key == SUNDER_NO_KEY);
    force_N += contacts[i].force_W.y;
  }
  EXPECT(count > 0 && fabs(force_N / (info.mass_kg * 9.81) - 1) < 0.05);

  // All bodies as arrays.
  uint32_t bodies = 0, needed = 0;
  OK(sunder_world_body_count(world, &bodies));
  OK(sunder_world_bodies(world, NULL, &needed));
  EXPECT(needed == bodies && bodies > 3);
  SunderBody* keys = malloc(bodies * sizeof *keys);
  SunderVec3* positions = malloc(bodies * sizeof *positions);
  SunderBodyArrays arrays = {0};
  arrays.body = keys;
  arrays.position_W = positions;
  count = bodies - 1;
  REFUSED(sunder_world_bodies(world, &arrays, &count), ARGUMENT, "arrays have room for");
  EXPECT(count == bodies);
  OK(sunder_world_bodies(world, &arrays, &count));
  for (uint32_t i = 0; i < bodies; ++i) {
    EXPECT(i == 0 || keys[i - 1].key < keys[i].key);
    EXPECT(isfinite(positions[i].x) && positions[i].y > -1);
  }
  free(keys);
  free(positions);

  SunderReport report;
  OK(sunder_world_report(world, &report));
  EXPECT(report.mass_kg > 0 && report.stage_ms[SUNDER_STAGE_SOLVE] >= 0);

  // Vertices of all meshes, by the pose of their instance, are where the bodies are.
  SunderFrame frame;
  OK(sunder_world_frame(world, &frame));
  EXPECT(frame.instance_count >= bodies && frame.mesh_count >= 1);
  uint32_t triangles = 0;
  for (uint32_t i = 0; i < frame.instance_count; ++i) {
    SunderMesh mesh;
    OK(sunder_world_mesh(world, frame.instances[i].mesh, &mesh));
    triangles += mesh.index_count / 3;
    EXPECT(mesh.uvs == NULL);
    for (uint32_t k = 0; k < mesh.index_count; ++k) EXPECT(mesh.indices[k] < mesh.vertex_count);
    if (frame.instances[i].body.key != crate.key) continue;
    for (uint32_t k = 0; k < mesh.vertex_count; ++k) {
      const float* p = mesh.vertices[k].position;
      const SunderVec3 at = frame.instances[i].X_WM.position;
      EXPECT(sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) < 2);
      EXPECT(fabs(at.x - 5) < 2 && fabs(at.z) < 2);
    }
  }
  EXPECT(triangles >= 12);
  SunderMesh mesh;
  REFUSED(sunder_world_mesh(world, frame.mesh_count, &mesh), ARGUMENT, "mesh is");
  SunderAppearance appearance;
  EXPECT(frame.appearance_count == 0);
  REFUSED(sunder_world_appearance(world, 0, &appearance), ARGUMENT, "index is 0");

  OK(sunder_world_destroy(world));
  EXPECT(!sunder_world_is_valid(world));
}

// Moves bodies as the program wants.
static void acts(void) {
  const SunderWorld world = make_world();
  const SunderAsset asset = make_crate();
  SunderSolidDef def = sunder_default_solid_def();
  SunderBody a, b;
  def.motion.X_WR.position = vec(0, 5, 0);
  OK(sunder_world_add_solid(world, asset, &def, &a));
  def.motion.X_WR.position = vec(0, 7, 0);
  OK(sunder_world_add_solid(world, asset, &def, &b));

  SunderJointDef joint_def = sunder_default_joint_def();
  SunderJoint joint;
  joint_def.a = a;
  joint_def.at_W = vec(0, 5, 0);
  OK(sunder_world_add_joint(world, &joint_def, &joint));
  OK(sunder_world_step(world, 0.1));
  SunderBodyInfo info;
  OK(sunder_world_body(world, a, &info));
  EXPECT(fabs(info.com_W.y - 5) < 1e-3);
  bool is_in = false;
  OK(sunder_world_contains_joint(world, joint, &is_in));
  EXPECT(is_in);
  OK(sunder_world_remove_joint(world, joint));
  REFUSED(sunder_world_remove_joint(world, joint), HANDLE, "sunder_world_remove_joint(): joint");

  SunderMotion motion = sunder_default_motion();
  motion.X_WR.position = vec(20, 1, 0);
  motion.velocity_W = vec(3, 0, 0);
  OK(sunder_world_set_motion(world, b, &motion));
  OK(sunder_world_body(world, b, &info));
  EXPECT(info.com_W.x == 20 && info.motion.velocity_W.x == 3);
  OK(sunder_world_apply_impulse(world, b, vec(info.mass_kg, 0, 0), info.com_W));
  OK(sunder_world_body(world, b, &info));
  EXPECT(fabs(info.motion.velocity_W.x - 4) < 1e-9);

  motion.X_WR.position = vec(20, 4, 0);
  OK(sunder_world_move_to(world, b, motion.X_WR, 0.1));
  OK(sunder_world_step(world, 0.1));
  OK(sunder_world_step(world, 1.0 / 60));
  OK(sunder_world_body(world, b, &info));
  EXPECT(info.is_kinematic && fabs(info.com_W.y - 4) < 1e-6);
  OK(sunder_world_release(world, b));
  OK(sunder_world_body(world, b, &info));
  EXPECT(!info.is_kinematic);

  SunderDriveDef drive = sunder_default_drive_def();
  REFUSED(sunder_world_drive(world, &drive), ARGUMENT, "drive.body_count is 0");
  drive.bodies = &b;
  drive.body_count = 1;
  REFUSED(sunder_world_drive(world, &drive), ARGUMENT, "drive has no velocity");
  drive.has_velocity = true;
  drive.velocity_W = vec(0, 0, 2);
  OK(sunder_world_drive(world, &drive));
  OK(sunder_world_step(world, 0.05));
  OK(sunder_world_body(world, b, &info));
  EXPECT(fabs(info.motion.velocity_W.z - 2) < 1e-3 &&
         fabs(info.motion.velocity_W.y) < 0.1);  // gravity of a step

  const SunderFilter nothing = {2, 0};
  OK(sunder_world_set_filter(world, b, nothing));
  OK(sunder_world_set_user_data(world, b, 7));
  OK(sunder_world_body(world, b, &info));
  EXPECT(info.user_data == 7 && info.filter.category == 2 && info.filter.mask == 0);

  const SunderPatternDef pattern = sunder_default_pattern_def();
  OK(sunder_world_body(world, a, &info));
  OK(sunder_world_break_at(world, a, info.com_W, vec(0, -1, 0), 1e5, &pattern));
  SunderBlastDef blast = sunder_default_blast_def();
  blast.center_W = vec(20, 3, 1);
  OK(sunder_world_blast(world, &blast));
  OK(sunder_world_step(world, 1.0 / 60));
  SunderEvents events;
  OK(sunder_world_events(world, &events));
  EXPECT(events.break_count >= 1 && events.gone_count >= 1);
  REFUSED(sunder_world_body(world, a, &info), HANDLE, "sunder_world_body(): body has the key");

  OK(sunder_world_remove_body(world, b));
  OK(sunder_world_contains_body(world, b, &is_in));
  EXPECT(!is_in);
  REFUSED(sunder_world_remove_body(world, b), HANDLE, "body has the key");
  OK(sunder_asset_destroy(asset));
  OK(sunder_world_destroy(world));
}

static void materials_and_meshes(void) {
  const SunderWorld world = make_world();
  SunderMaterial glass, heavy;
  SunderMaterialDef def;
  OK(sunder_world_material(world, "glass", &glass));
  REFUSED(sunder_world_material(world, "jelly", &heavy), ARGUMENT, "expected one of brick");
  REFUSED(sunder_builtin_material("jelly", &heavy), ARGUMENT, "'jelly'");
  OK(sunder_world_material_def(world, glass, &def));
  EXPECT(strcmp(def.name, "glass") == 0 && def.density_kg_m3 == 2500);
  strcpy(def.name, "lead glass");
  def.density_kg_m3 = 5000;
  OK(sunder_world_add_material(world, &def, &heavy));
  SunderMaterial again;
  OK(sunder_world_material(world, "lead glass", &again));
  EXPECT(again.index == heavy.index && heavy.index != glass.index);
  def.density_kg_m3 = -1;
  REFUSED(sunder_world_add_material(world, &def, &heavy), ARGUMENT, "density_kg_m3 is -1");
  def.density_kg_m3 = 1000;
  def.pattern.cells = 0;
  REFUSED(sunder_world_add_material(world, &def, &heavy), ARGUMENT, "pattern.cells is 0");
  memset(&def, 0, sizeof def);
  REFUSED(sunder_world_add_material(world, &def, &heavy), ARGUMENT, "def was not filled");

  SunderMeshDef mesh = sunder_default_mesh_def();
  SunderAsset ring, tetrahedron, lump, never = {7, 7};
  mesh.mesh = "torus:1,0.3";
  mesh.material = heavy;
  OK(sunder_asset_create_mesh(&mesh, &ring));
  mesh.mesh = "no/such/file.obj";
  REFUSED(sunder_asset_create_mesh(&mesh, &never), INPUT, "no/such/file.obj");
  const SunderVec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  uint32_t indices[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  mesh.mesh = NULL;
  mesh.vertices = corners;
  mesh.vertex_count = 4;
  mesh.indices = indices;
  mesh.index_count = 12;
  OK(sunder_asset_create_mesh(&mesh, &tetrahedron));
  SunderAssetInfo info;
  OK(sunder_asset_info(tetrahedron, &info));
  EXPECT(fabs(info.volume_m3 - 1.0 / 6) < 1e-9);
  indices[5] = 4;
  REFUSED(sunder_asset_create_mesh(&mesh, &never), ARGUMENT, "mesh.indices[5] is 4");
  indices[5] = 3;
  mesh.index_count = 11;
  REFUSED(sunder_asset_create_mesh(&mesh, &never), ARGUMENT, "mesh.index_count is 11");
  mesh.index_count = 3;
  REFUSED(sunder_asset_create_mesh(&mesh, &never), INPUT, "encloses no volume");
  EXPECT(never.index == 7 && never.generation == 7);

  SunderPartDef part = sunder_default_part_def();
  part.points = corners;
  part.point_count = 4;
  OK(sunder_asset_create_parts(&part, 1, &lump));
  part.point_count = 3;
  REFUSED(sunder_asset_create_parts(&part, 1, &never), ARGUMENT, "parts[0].points span no volume");
  part.points = NULL;
  part.box_max = part.box_min;
  REFUSED(sunder_asset_create_parts(&part, 1, &never), ARGUMENT, "min must be less than max");
  part.box_max.x = NAN;
  REFUSED(sunder_asset_create_parts(&part, 1, &never), ARGUMENT, "parts[0].box_max.x is nan");

  const SunderSolidDef solid = sunder_default_solid_def();
  const SunderAsset assets[3] = {ring, tetrahedron, lump};
  for (int i = 0; i < 3; ++i) {
    OK(sunder_world_add_solid(world, assets[i], &solid, NULL));
    OK(sunder_world_step(world, 0.01));
  }
  // Another material has the same place in the list of another world.
  const SunderWorld other = make_world();
  SunderBallDef ball = sunder_default_ball_def();
  SunderMaterial concrete, light;
  OK(sunder_builtin_material("concrete", &concrete));
  OK(sunder_world_material_def(other, concrete, &def));
  OK(sunder_world_add_material(other, &def, &light));
  REFUSED(sunder_world_add_solid(other, ring, &solid, NULL), ARGUMENT,
          "lead glass of another world");
  ball.material = heavy;
  REFUSED(sunder_world_add_ball(other, &ball, NULL), ARGUMENT, "lead glass of another world");
  REFUSED(sunder_world_material_def(other, heavy, &def), ARGUMENT, "lead glass of another world");
  part = sunder_default_part_def();
  part.material.index = 1000;
  REFUSED(sunder_asset_create_parts(&part, 1, &never), ARGUMENT, "parts[0].material is 1000");
  uint32_t count = 1;
  OK(sunder_world_body_count(other, &count));
  EXPECT(count == 0);
  // The same material in the same place is the same, in copies and elsewhere.
  const SunderWorld same = make_world();
  SunderWorld copy;
  OK(sunder_world_material_def(world, heavy, &def));
  OK(sunder_world_add_material(same, &def, &again));
  EXPECT(again.index == heavy.index);
  OK(sunder_world_add_solid(same, ring, &solid, NULL));
  OK(sunder_world_copy(world, &copy));
  OK(sunder_world_add_ball(copy, &ball, NULL));
  SunderCastHit hit;
  bool found = false;
  OK(sunder_world_cast(same, vec(1, 5, 0), vec(0, -1, 0), 9, 0, NULL, &hit, &found));
  EXPECT(found && hit.material.index == heavy.index);
  OK(sunder_world_destroy(copy));
  OK(sunder_world_destroy(same));
  OK(sunder_world_destroy(other));
  for (int i = 0; i < 3; ++i) OK(sunder_asset_destroy(assets[i]));
  OK(sunder_world_step(world, 0.01));
  OK(sunder_world_destroy(world));
}

// Refuses wrong handles and arguments, and leaves the world as it was.
static void refusals(void) {
  SunderWorldDef world_def = sunder_default_world_def();
  SunderWorld world = {0, 0}, gone = make_world();
  const SunderWorld null_world = {0, 0}, foreign = {0, 12345678}, beyond = {4000000000u, 1};
  OK(sunder_world_destroy(gone));
  REFUSED(sunder_world_destroy(gone), HANDLE, "sunder_world_destroy(): world does not exist");
  REFUSED(sunder_world_step(null_world, 0.01), HANDLE, "sunder_world_step(): world is null");
  REFUSED(sunder_world_step(foreign, 0.01), HANDLE, "world does not exist");
  REFUSED(sunder_world_step(beyond, 0.01), HANDLE, "world does not exist");
  EXPECT(!sunder_world_is_valid(null_world) && !sunder_world_is_valid(foreign));

  REFUSED(sunder_world_copy(gone, &world), HANDLE, "sunder_world_copy(): world does not exist");
  const void* bytes;
  size_t size;
  REFUSED(sunder_world_save(gone, &bytes, &size), HANDLE,
          "sunder_world_save(): world does not exist");
  REFUSED(sunder_world_restore("x", 1, 0, &world), INPUT,
          "sunder_world_restore(): bytes: these bytes are no saved state");
  REFUSED(sunder_world_create(NULL, &world), ARGUMENT, "def is null");
  REFUSED(sunder_world_create(&world_def, NULL), ARGUMENT, "world is null");
  world_def.threads = -1;
  REFUSED(sunder_world_create(&world_def, &world), ARGUMENT, "def.threads is -1");
  world_def = sunder_default_world_def();
  world_def.preset = "careless";
  REFUSED(sunder_world_create(&world_def, &world), INPUT, "careless");
  world_def = sunder_default_world_def();
  world_def.scene = "no_such_scene";
  REFUSED(sunder_world_create(&world_def, &world), INPUT, "no_such_scene");
  world_def.scene_text = "[scene]";
  REFUSED(sunder_world_create(&world_def, &world), ARGUMENT, "def.scene and def.scene_text");
  world_def.scene = NULL;
  REFUSED(sunder_world_create(&world_def, &world), INPUT, "description");
  world_def = sunder_default_world_def();
  world_def.has_gravity = true;
  world_def.gravity_W.y = NAN;
  REFUSED(sunder_world_create(&world_def, &world), ARGUMENT, "def.gravity_W.y is nan");
  world_def.cookie = 0;
  REFUSED(sunder_world_create(&world_def, &world), ARGUMENT, "sunder_default_world_def()");
  EXPECT(world.index == 0 && world.generation == 0);

  world = make_world();
  EXPECT(sunder_world_is_valid(world) && !sunder_world_is_valid(gone));
  SunderBallDef ball = sunder_default_ball_def();
  SunderBody body, none = {SUNDER_NO_KEY}, later = {99};
  ball.center_W = vec(0, 2, 0);
  OK(sunder_world_add_ball(world, &ball, &body));
  uint64_t before = 0, after = 1;
  OK(sunder_world_state_hash(world, &before));

  REFUSED(sunder_world_step(world, 0), ARGUMENT, "sunder_world_step(): time_s is 0");
  REFUSED(sunder_world_step(world, 1), ARGUMENT, "time_s is 1");
  REFUSED(sunder_world_step(world, NAN), ARGUMENT, "time_s is nan");
  ball.radius_m = -1;
  REFUSED(sunder_world_add_ball(world, &ball, NULL), ARGUMENT, "ball.radius_m is -1");
  ball.radius_m = NAN;
  REFUSED(sunder_world_add_ball(world, &ball, NULL), ARGUMENT, "ball.radius_m is nan");
  ball = sunder_default_ball_def();
  ball.material.index = 1000;
  REFUSED(sunder_world_add_ball(world, &ball, NULL), ARGUMENT, "has material 1000");
  ball = sunder_default_ball_def();
  ball.velocity_W.z = INFINITY;
  REFUSED(sunder_world_add_ball(world, &ball, NULL), ARGUMENT, "ball.velocity_W.z is inf");
  ball.velocity_W.z = -1.1e5;
  REFUSED(sunder_world_add_ball(world, &ball, NULL), ARGUMENT, "ball.velocity_W.z is -110000");
  REFUSED(sunder_world_add_ball(world, NULL, NULL), ARGUMENT, "ball is null");
  SunderShotDef shot = sunder_default_shot_def();
  shot.ball.cookie = 0;
  REFUSED(sunder_world_shoot(world, &shot), ARGUMENT, "shot.ball was not filled");
  SunderBlastDef blast = sunder_default_blast_def();
  blast.tnt_kg = -3;
  REFUSED(sunder_world_blast(world, &blast), ARGUMENT, "blast.tnt_kg is -3");
  SunderMotion motion = sunder_default_motion();
  motion.X_WR.rotation.w = 3;
  REFUSED(sunder_world_set_motion(world, body, &motion), ARGUMENT, "rotation is 3");
  motion = sunder_default_motion();
  REFUSED(sunder_world_set_motion(world, none, &motion), HANDLE, "SUNDER_NO_KEY");
  REFUSED(sunder_world_set_motion(world, later, &motion), HANDLE, "body has the key 99");
  REFUSED(sunder_world_set_motion(world, body, NULL), ARGUMENT, "motion is null");
  REFUSED(sunder_world_move_to(world, body, motion.X_WR, -1), ARGUMENT, "duration_s is -1");
  REFUSED(sunder_world_release(world, later), HANDLE, "body");
  REFUSED(sunder_world_apply_impulse(world, body, vec(NAN, 0, 0), vec(0, 0, 0)), ARGUMENT,
          "impulse_W.x is nan");
  REFUSED(sunder_world_break_at(world, body, vec(0, 0, 0), vec(0, 0, 0), 1, NULL), ARGUMENT,
          "direction_W is zero");
  REFUSED(sunder_world_break_at(world, body, vec(0, 0, 0), vec(1, 0, 0), -1, NULL), ARGUMENT,
          "energy_J is -1");
  SunderPatternDef pattern = sunder_default_pattern_def();
  pattern.kind = 12;
  REFUSED(sunder_world_break_at(world, body, vec(0, 0, 0), vec(1, 0, 0), 1, &pattern), ARGUMENT,
          "pattern.kind is 12");
  pattern.kind = SUNDER_PATTERN_GRID;
  pattern.cells = 100000;
  REFUSED(sunder_world_break_at(world, body, vec(0, 0, 0), vec(1, 0, 0), 1, &pattern), ARGUMENT,
          "number of cells");
  REFUSED(sunder_world_report_hits(world, -1), ARGUMENT, "least_m_s is -1");
  SunderJointDef joint = sunder_default_joint_def();
  REFUSED(sunder_world_add_joint(world, &joint, NULL), ARGUMENT, "joint has no body");
  joint.a = joint.b = body;
  REFUSED(sunder_world_add_joint(world, &joint, NULL), ARGUMENT, "joins a body to itself");
  joint.b = later;
  REFUSED(sunder_world_add_joint(world, &joint, NULL), HANDLE, "joint.b has the key 99");
  joint = sunder_default_joint_def();
  joint.a = body;
  joint.kind = -1;
  REFUSED(sunder_world_add_joint(world, &joint, NULL), ARGUMENT, "joint.kind is -1");

  SunderCastHit hit;
  bool found;
  uint32_t count = 0;
  REFUSED(sunder_world_cast(world, vec(0, 0, 0), vec(0, 0, 0), 1, 0, NULL, &hit, &found), ARGUMENT,
          "direction_W is zero");
  REFUSED(sunder_world_cast(world, vec(0, 0, 0), vec(1, 0, 0), NAN, 0, NULL, &hit, &found),
          ARGUMENT, "most_m is nan");
  REFUSED(sunder_world_cast(world, vec(0, 0, 0), vec(1, 0, 0), 1, 0, NULL, NULL, &found), ARGUMENT,
          "hit is null");
  REFUSED(sunder_world_cast_all(world, vec(0, 0, 0), vec(1, 0, 0), 1, 0, NULL, &hit, NULL),
          ARGUMENT, "count is null");
  REFUSED(sunder_world_overlap_box(world, vec(1, 0, 0), vec(0, 1, 1), NULL, NULL, &count), ARGUMENT,
          "box_W is empty");
  REFUSED(sunder_world_overlap_ball(world, vec(1, 0, 0), -1, NULL, NULL, &count), ARGUMENT,
          "radius_m is -1");
  SunderQuery query = sunder_default_query();
  query.cookie = 0;
  REFUSED(sunder_world_overlap_ball(world, vec(1, 0, 0), 1, &query, NULL, &count), ARGUMENT,
          "query was not filled");
  REFUSED(sunder_world_body(world, body, NULL), ARGUMENT, "info is null");
  REFUSED(sunder_world_time(world, NULL), ARGUMENT, "time_s is null");
  REFUSED(sunder_world_events(world, NULL), ARGUMENT, "events is null");
  REFUSED(sunder_world_report(world, NULL), ARGUMENT, "report is null");
  REFUSED(sunder_world_frame(world, NULL), ARGUMENT, "frame is null");
  REFUSED(sunder_run_hash(NULL, 3, NULL), ARGUMENT, "hex is null");
  SunderMesh mesh;
  REFUSED(sunder_world_mesh(world, 0, &mesh), ARGUMENT, "there is no frame");
  SunderAppearance appearance;
  REFUSED(sunder_world_appearance(world, 0, &appearance), ARGUMENT, "there is no frame");
  REFUSED(sunder_world_appearance(world, 0, NULL), ARGUMENT, "appearance is null");
  SunderAsset asset = {0, 0};
  const SunderSolidDef solid = sunder_default_solid_def();
  REFUSED(sunder_world_add_solid(world, asset, &solid, NULL), HANDLE, "asset is null");
  const SunderAsset forged = {world.index, world.generation};
  REFUSED(sunder_world_add_solid(world, forged, &solid, NULL), HANDLE, "asset does not exist");
  REFUSED(sunder_asset_create_parts(NULL, 1, &asset), ARGUMENT, "parts is null");
  const SunderPartDef part = sunder_default_part_def();
  REFUSED(sunder_asset_create_parts(&part, 0, &asset), ARGUMENT, "count is 0");
  REFUSED(sunder_asset_destroy(forged), HANDLE, "asset does not exist");
  REFUSED(sunder_set_allocator(NULL, NULL, NULL), ARGUMENT, "there are worlds or assets");

  OK(sunder_world_state_hash(world, &after));
  EXPECT(before == after);
  OK(sunder_world_destroy(world));
}

static size_t live = 0, most = 0, budget = 0;

static void* counted_alloc(size_t bytes, void* user) {
  EXPECT(user == &live);
  if (budget > 0 && live >= budget) return NULL;
  most = ++live > most ? live : most;
  return malloc(bytes);
}

static void counted_free(void* memory, void* user) {
  EXPECT(user == &live);
  if (memory) --live;
  free(memory);
}

static void allocator(void) {
  REFUSED(sunder_set_allocator(counted_alloc, NULL, NULL), ARGUMENT, "one of allocate and release");
  OK(sunder_set_allocator(counted_alloc, counted_free, &live));
  const SunderWorld world = make_world();
  SunderBallDef ball = sunder_default_ball_def();
  OK(sunder_world_add_ball(world, &ball, NULL));
  OK(sunder_world_step(world, 0.01));
  SunderFrame frame;
  OK(sunder_world_frame(world, &frame));
  EXPECT(frame.instance_count == 1);
  EXPECT(most >= 3);
  budget = live - 1;  // no more than there is without the arrays of the frame
  OK(sunder_world_step(world, 0.01));
  REFUSED(sunder_world_frame(world, &frame), MEMORY, "sunder_world_frame(): there is not enough");
  budget = 0;
  OK(sunder_world_frame(world, &frame));
  EXPECT(frame.instance_count == 1);
  OK(sunder_world_destroy(world));

  budget = live;  // no more than the table of handles
  SunderWorld second = {0, 0};
  const SunderWorldDef def = sunder_default_world_def();
  REFUSED(sunder_world_create(&def, &second), MEMORY, "not enough memory");
  EXPECT(second.generation == 0);
  budget = 0;
  OK(sunder_set_allocator(NULL, NULL, NULL));
  EXPECT(live == 0);
}

static void warned(const char* warning, void* user) {
  EXPECT(strlen(warning) > 0);
  ++*(int*)user;
}

static void a_scene_by_name(const char* folder) {
  int warnings = 0;
  SunderWorldDef def = sunder_default_world_def();
  const char* settings[] = {"scene.seed=5"};
  def.scene = "stack";
  def.scenes_folder = folder;
  def.preset = "draft";
  def.settings = settings;
  def.setting_count = 1;
  def.threads = 1;
  def.particles = false;
  def.has_gravity = true;
  def.gravity_W = vec(0, -1.62, 0);
  def.warn = warned;
  def.warn_user = &warnings;
  SunderWorld world;
  OK(sunder_world_create(&def, &world));
  uint32_t count = 0;
  OK(sunder_world_body_count(world, &count));
  EXPECT(count > 1);
  OK(sunder_world_step(world, 1.0 / 60));
  OK(sunder_world_destroy(world));
  def = sunder_default_world_def();
  def.warn = warned;
  def.warn_user = &warnings;
  warnings = 0;
  OK(sunder_world_create(&def, &world));
  EXPECT(warnings >= 1);  // an empty scene
  OK(sunder_world_destroy(world));
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  EXPECT(strcmp(sunder_last_error(), "") == 0);
  EXPECT(strcmp(sunder_version(), SUNDER_EXPECTED_VERSION) == 0);
  EXPECT(strcmp(sunder_result_name(SUNDER_ERROR_FILE), "SUNDER_ERROR_FILE") == 0);
  a_short_game();
  acts();
  materials_and_meshes();
  refusals();
  allocator();
  a_scene_by_name(argv[1]);
  printf("%s\n", wrong == 0 ? "all as expected" : "some checks failed");
  return wrong == 0 ? 0 : 1;
}
