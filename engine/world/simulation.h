// The simulation: a World that runs by its script, as a source of frames.
#pragma once

#include <memory>

#include "engine/model/breaker.h"
#include "engine/model/frame.h"
#include "engine/model/particles.h"
#include "engine/model/physics.h"
#include "engine/model/scene.h"
#include "engine/world/world.h"

namespace sunder {

/// Frame source that simulates: frame 0 is the scene as given, followed by one frame every 1/60 s
/// for the scene's duration.
class Simulation final : public FrameSource {
 public:
  explicit Simulation(World world) : world_(std::move(world)) {}
  Simulation(Scene scene, std::unique_ptr<Physics> physics, std::unique_ptr<Breaker> breaker,
             std::unique_ptr<Particles> particles = nullptr)
      : world_(std::move(scene), std::move(physics), std::move(breaker), std::move(particles)) {}

  FramePtr next() override;
  World& world() { return world_; }

 private:
  World world_;
  bool started_ = false;  ///< Frame 0 has been returned.
};

}  // namespace sunder
