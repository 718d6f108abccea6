// Implements Particles (engine/model/particles.h): debris and dust, paper section 5.
#pragma once

#include <memory>

#include "engine/model/particles.h"

namespace sunder::solver {

struct DebrisAndDustOptions {
  Vec3 gravity_W = Vec3(0, -9.81, 0);
  std::uint64_t seed = 1;
  ParticleLimits limits;
  /// Greatest number of air cells per axis, used while there is dust: multiples of 8, at most 128
  /// along x. The cost of dust grows with their product.
  Eigen::Vector3i max_air_cells = Eigen::Vector3i(64, 32, 64);
};

/// Makes the solver. Results are bit-identical for any number of threads (engine/base/parallel.h).
std::unique_ptr<Particles> make_debris_and_dust(const DebrisAndDustOptions& options);

}  // namespace sunder::solver
