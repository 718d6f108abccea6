// Debris and dust behind the Particles seam (paper section 5).
#pragma once

#include <memory>

#include "engine/model/particles.h"

namespace sunder::solver {

struct DebrisAndDustOptions {
  Vec3 gravity_W = Vec3(0, -9.81, 0);
  std::uint64_t seed = 1;
  ParticleLimits limits;
  /// Of the air while there is dust: multiples of 8, along x at most 128; what dust costs.
  Eigen::Vector3i air_cells = Eigen::Vector3i(64, 32, 64);
};

/// The same bits for any number of threads (engine/base/parallel.h sets it).
std::unique_ptr<Particles> make_debris_and_dust(const DebrisAndDustOptions& options);

}  // namespace sunder::solver
