// Stage `particles`: exposed faces and chips become debris and dust, which move among the bodies.
// Internal to engine/world.
//
// Read first: ParticleStage::run(). Particles advance once a frame, whatever the step, as they are
// only seen; breaks within a frame count from the frame's start.
#pragma once

#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>

#include "engine/base/copied_ptr.h"
#include "engine/model/frame.h"
#include "engine/model/particles.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

class ParticleStage {
 public:
  /// Without particles (null), there are neither debris nor dust.
  explicit ParticleStage(std::unique_ptr<Particles> particles) : particles_(std::move(particles)) {}

  bool any() const { return static_cast<bool>(particles_); }
  /// Number of particles of debris and dust, moving or at rest.
  std::uint64_t alive() const {
    const ParticleReport report = particles_->report();
    return std::uint64_t{report.debris.alive} + report.dust.alive;
  }
  /// Emits the particles of the frame's breaks and advances all, at the end of a frame's last step.
  void run(const WorldState& world, const Exposed& exposed);
  /// Adds debris and dust to a frame, and counts a limit reached since the last frame.
  void show(Frame& frame);

  static auto fields(auto& self) {
    return std::tie(self.particles_, self.ignored_debris_, self.ignored_dust_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field(const WorldState& world) const;

 private:
  CopiedPtr<Particles> particles_;
  /// Particles not emitted because the limit was reached, up to the last frame.
  std::uint64_t ignored_debris_ = 0, ignored_dust_ = 0;
};

}  // namespace sunder
