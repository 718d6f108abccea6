// Physics that forwards to another and records mass, momenta and energy around its calls.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "tests/fixtures/forwarding_physics.h"

namespace sunder::tests {

/// Sums over moving bodies; `spin` is the angular momentum about the origin of W.
struct Motions {
  double mass_kg = 0, kinetic_J = 0;
  Vec3 momentum = Vec3::Zero(), spin = Vec3::Zero();
};

class SpyPhysics final : public ForwardingPhysics {
 public:
  /// Sums before the first and after the last break of a step.
  struct Balance {
    Motions before, after;
  };
  /// Sums before and after a call of replace() that removed bodies.
  using Replacement = Balance;

  using ForwardingPhysics::ForwardingPhysics;

  std::vector<BodyId> replace(std::span<const BodyId> remove,
                              std::span<const BodyDesc> add) override {
    Replacement replacement;
    for (const BodyId id : remove) this->add(id, replacement.before);
    const std::vector<BodyId> ids = physics_->replace(remove, add);
    for (const BodyId id : remove) bodies_.erase(id.slot);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (!add[i].is_static) bodies_[ids[i].slot] = {ids[i], add[i].mass_kg, add[i].inertia_B};
      this->add(ids[i], replacement.after);
    }
    if (!remove.empty()) replacements.push_back(replacement);
    return ids;
  }
  void collide(double horizon_s) override {
    if (!std::exchange(in_step_, true)) breaks.before = sum();
    physics_->collide(horizon_s);
  }
  void apply_impulse(BodyId body, const Vec3& impulse_W, const Vec3& point_W) override {
    note_end_of_breaks();
    physics_->apply_impulse(body, impulse_W, point_W);
  }
  SolveReport solve(double dt_s, int substeps) override {
    note_end_of_breaks();
    before_solve = sum();
    SolveReport report = physics_->solve(dt_s, substeps);
    after_solve = sum();
    return report;
  }

  Motions sum() const {
    Motions all;
    for (const auto& [slot, body] : bodies_) add(body.id, all);
    return all;
  }

  Balance breaks;  ///< Sums around the breaks of the last step.
  std::vector<Replacement> replacements;
  Motions before_solve, after_solve;  ///< Sums around the last solve.

 private:
  struct Body {
    BodyId id;
    double mass_kg = 0;
    Mat3 inertia_B = Mat3::Zero();
  };

  void note_end_of_breaks() {
    if (std::exchange(in_step_, false)) breaks.after = sum();
  }
  void add(BodyId id, Motions& all) const {
    const auto it = bodies_.find(id.slot);
    if (it == bodies_.end()) return;
    const Body& body = it->second;
    const BodyState s = physics_->state(id);
    const Vec3 w_B = s.X_WB.rotation.conjugate() * s.angular_velocity_W;
    const Vec3 spin_B = body.inertia_B * w_B, p = body.mass_kg * s.velocity_W;
    all.mass_kg += body.mass_kg;
    all.kinetic_J += 0.5 * p.dot(s.velocity_W) + 0.5 * w_B.dot(spin_B);
    all.momentum += p;
    all.spin += s.X_WB.position.cross(p) + s.X_WB.rotation * spin_B;
  }

  std::map<std::uint32_t, Body> bodies_;  ///< Bodies that are not static, by slot.
  bool in_step_ = false;
};

}  // namespace sunder::tests
