// An engine that settles a pile, so that all are given the same and asked the same.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "engine/model/physics.h"

namespace sunder::bench {

/// What an engine is asked to do with its time.
struct Effort {
  double rate_Hz = 60;  ///< Steps a second.
  int passes = 0;       ///< Substeps (ours) or iterations a step (theirs).
};

class Peer {
 public:
  virtual ~Peer() = default;
  virtual void step(double dt_s) = 0;
  /// Of body i of those it was made with; its B is that of the description.
  virtual BodyState state(std::size_t i) const = 0;
};

// Each takes hulls and half-spaces, without sleeping, on one thread; friction is the geometric mean
// of the two shapes'. Null where the engine was not found when the bench was configured.
std::unique_ptr<Peer> make_sunder(std::span<const BodyDesc> bodies, const Effort& effort);
std::unique_ptr<Peer> make_bullet(std::span<const BodyDesc> bodies, const Effort& effort);
std::unique_ptr<Peer> make_ode(std::span<const BodyDesc> bodies, const Effort& effort);

}  // namespace sunder::bench
