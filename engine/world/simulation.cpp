#include "engine/world/simulation.h"

#include "engine/world/actors/clock.h"

namespace sunder {

FramePtr Simulation::next() {
  if (started_) {
    const Scene& scene = world_.scene();
    const double frame_s = Clock(scene.accuracy).frame_s();
    if (world_.time_s() + frame_s > scene.duration_s + 0.5 * frame_s) return nullptr;
    world_.step(frame_s);
  }
  started_ = true;
  return world_.frame();
}

}  // namespace sunder
