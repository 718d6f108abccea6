// Runs a scene that was installed with the library. Its exit code is 1 if that fails.
#include <stdio.h>
#include <sunder/sunder_c.h>

int main(void) {
  SunderWorldDef def = sunder_default_world_def();
  SunderWorld world;
  uint32_t bodies = 0;
  def.scene = "stack";
  if (sunder_world_create(&def, &world) != SUNDER_OK ||
      sunder_world_step(world, 1.0 / 60) != SUNDER_OK ||
      sunder_world_body_count(world, &bodies) != SUNDER_OK ||
      sunder_world_destroy(world) != SUNDER_OK) {
    printf("%s\n", sunder_last_error());
    return 1;
  }
  printf("%s: %u bodies\n", def.scene, bodies);
  return bodies > 1 ? 0 : 1;
}
