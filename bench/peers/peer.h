// Interface to a rigid-body engine, so that all engines simulate the same pile.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "engine/model/physics.h"

namespace sunder::bench {

/// Step rate and iterations of an engine.
struct Effort {
  double rate_Hz = 60;  ///< Steps per second.
  int passes = 0;       ///< Substeps per step (Sunder) or iterations per step (the others).
};

class Peer {
 public:
  virtual ~Peer() = default;
  virtual void step(double dt_s) = 0;
  /// Returns the state of body i of the constructor's list, in the body frame of its description.
  virtual BodyState state(std::size_t i) const = 0;
};

// Each function makes an engine with the bodies (hulls and half-spaces), on one thread without
// sleeping; friction is the geometric mean of both shapes. It is undefined for a missing engine.
std::unique_ptr<Peer> make_sunder(std::span<const BodyDesc> bodies, const Effort& effort);
std::unique_ptr<Peer> make_bullet(std::span<const BodyDesc> bodies, const Effort& effort);
std::unique_ptr<Peer> make_ode(std::span<const BodyDesc> bodies, const Effort& effort);

}  // namespace sunder::bench
