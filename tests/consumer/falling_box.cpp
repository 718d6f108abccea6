// A program that uses the installed library: a box falls for a second, then rests on the ground.
#include <cmath>
#include <cstdio>

#include "engine/world/simulation.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/pattern_breaker.h"
#include "solver/rigid/rigid_physics.h"

int main() {
  sunder::Scene scene;
  scene.duration_s = 4;
  scene.materials.push_back({.name = "stone"});
  sunder::fracture::Part part;
  part.polyhedron = sunder::make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  part.material = sunder::MaterialIndex(0);
  sunder::Solid box;
  box.name = "box";
  box.compound = sunder::fracture::make_compound({part});
  box.X_WR.position = {0, 10, 0};
  scene.solids.push_back(box);

  sunder::Simulation simulation(scene, sunder::solver::make_rigid_physics({}),
                                sunder::fracture::make_pattern_breaker());
  double after_a_second = 0, at_the_end = 0;
  while (const sunder::FramePtr frame = simulation.next()) {
    for (const sunder::FrameBody& body : frame->bodies) {
      if (!body.is_static) at_the_end = body.X_WB.position.y();
    }
    if (frame->index == 60) after_a_second = at_the_end;
  }
  std::printf("height after 1 s: %.3f m, at the end: %.3f m\n", after_a_second, at_the_end);
  const bool fell = std::abs(after_a_second - (10 - 9.81 / 2)) < 0.1;
  const bool rests = std::abs(at_the_end - 0.5) < 0.02;
  return fell && rests ? 0 : 1;
}
