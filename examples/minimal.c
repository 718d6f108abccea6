// Builds a wall of bricks, shoots a steel ball at it, and prints what broke.
#include <stdio.h>
#include <stdlib.h>
#include <sunder/sunder_c.h>

enum { kCourses = 8, kBricks = 6 };

static void need(SunderResult result) {
  if (result == SUNDER_OK) return;
  fprintf(stderr, "%s: %s\n", sunder_result_name(result), sunder_last_error());
  exit(1);
}

// Makes a wall of bricks of 40 x 20 x 20 cm, of which every other course is offset by half a brick.
static SunderAsset make_wall(void) {
  SunderPartDef bricks[kCourses * kBricks];
  for (int i = 0; i < kCourses * kBricks; ++i) {
    const int course = i / kBricks;
    const double left_m = 0.4 * (i % kBricks) + (course % 2) * 0.2 - 1.3;
    bricks[i] = sunder_default_part_def();
    bricks[i].box_min = (SunderVec3){left_m, 0.2 * course, -0.1};
    bricks[i].box_max = (SunderVec3){left_m + 0.4, 0.2 * (course + 1), 0.1};
    bricks[i].anchored = course == 0;
    need(sunder_builtin_material("brick", &bricks[i].material));
  }
  SunderAsset wall;
  need(sunder_asset_create_parts(bricks, kCourses * kBricks, &wall));
  return wall;
}

int main(void) {
  const SunderWorldDef def = sunder_default_world_def();
  SunderWorld world;
  need(sunder_world_create(&def, &world));
  const SunderAsset wall = make_wall();
  const SunderSolidDef solid = sunder_default_solid_def();
  need(sunder_world_add_solid(world, wall, &solid, NULL));
  need(sunder_asset_destroy(wall));

  SunderShotDef shot = sunder_default_shot_def();
  shot.ball.radius_m = 0.15;
  shot.ball.center_W = (SunderVec3){0, 1, 3};
  shot.ball.velocity_W = (SunderVec3){0, 0, -25};
  need(sunder_world_shoot(world, &shot));

  for (int step = 0; step < 120; ++step) {
    need(sunder_world_step(world, 1.0 / 60));
    SunderEvents events;
    need(sunder_world_events(world, &events));
    for (uint32_t i = 0; i < events.break_count; ++i) {
      const SunderBreak* one = &events.breaks[i];
      printf("%.3f s: body %u broke into %u pieces at (%.2f, %.2f, %.2f) m by %.0f J\n",
             one->time_s, one->parent.key, one->pieces, one->point_W.x, one->point_W.y,
             one->point_W.z, one->energy_J);
    }
  }
  uint32_t bodies;
  need(sunder_world_body_count(world, &bodies));
  printf("bodies after 2 s: %u\n", bodies);
  need(sunder_world_destroy(world));
  return 0;
}
