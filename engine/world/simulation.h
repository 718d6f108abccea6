// The simulation: a scene advanced step by step, seen as frames.
//
// Read first: Simulation::advance() in simulation.cpp, the list of a step's stages.
#pragma once

#include <memory>

#include "engine/model/breaker.h"
#include "engine/model/frame.h"
#include "engine/model/particles.h"
#include "engine/model/physics.h"
#include "engine/model/scene.h"

namespace sunder {

/// A FrameSource that simulates: frame 0 is the scene as given, then one frame every 1/60 s until
/// the scene's duration has passed.
class Simulation final : public FrameSource {
 public:
  /// Without `particles` there is no debris and no dust.
  Simulation(Scene scene, std::unique_ptr<Physics> physics, std::unique_ptr<Breaker> breaker,
             std::unique_ptr<Particles> particles = nullptr);
  ~Simulation() override;

  FramePtr next() override;
  /// Frames from now on say what happens inside (Frame::inspection); the run is the same.
  void inspect();
  /// One step of the scene's dt.
  void advance();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sunder
