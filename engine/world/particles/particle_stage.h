// Stage `particles`: debris and dust come off what breaks laid bare, and move among the bodies.
// Internal to engine/world.
//
// Read first: ParticleStage::run(). Particles move once a frame, whatever the step, as they are for
// the eye; what breaks within a frame is noted as if it had been there from the frame's start.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "engine/model/frame.h"
#include "engine/model/particles.h"
#include "engine/world/actors/world.h"

namespace sunder {

class ParticleStage {
 public:
  /// Null: there is no debris and no dust.
  explicit ParticleStage(std::unique_ptr<Particles> particles) : particles_(std::move(particles)) {}

  bool any() const { return particles_ != nullptr; }
  /// Debris and dust in the air and at rest.
  std::uint64_t alive() const {
    const ParticleReport report = particles_->report();
    return std::uint64_t{report.debris.alive} + report.dust.alive;
  }
  /// At the end of a frame's last step: what the frame's breaks laid bare comes off, and moves.
  void run(const World& world, const Exposed& exposed);
  /// Debris and dust as they are, and what there was no room for since the last frame.
  void show(Frame& frame);

 private:
  std::unique_ptr<Particles> particles_;
  std::uint64_t ignored_ = 0;  ///< Up to the last frame, for want of room.
};

}  // namespace sunder
