// The simulation: advances a scene step by step and returns frames.
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

/// Frame source that simulates: frame 0 is the scene as given, followed by one frame every 1/60 s
/// for the scene's duration.
class Simulation final : public FrameSource {
 public:
  /// Without `particles` there are neither debris nor dust.
  Simulation(Scene scene, std::unique_ptr<Physics> physics, std::unique_ptr<Breaker> breaker,
             std::unique_ptr<Particles> particles = nullptr);
  ~Simulation() override;

  FramePtr next() override;
  /// Adds inspections to all later frames (Frame::inspection); the run is unchanged.
  void inspect();
  /// Runs all later frames on the thread that calls next(), and reports what their parallel loops
  /// would take with more threads (FrameReport::stage_loops).
  void count_loops();
  /// Advances by one step of the scene's dt.
  void advance();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sunder
