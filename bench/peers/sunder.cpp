#include "bench/peers/peer.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::bench {
namespace {

class Sunder final : public Peer {
 public:
  Sunder(std::span<const BodyDesc> bodies, const Effort& effort) : substeps_(effort.passes) {
    solver::RigidOptions options;
    options.sleeping = false;
    physics_ = solver::make_rigid_physics(options);
    ids_ = physics_->replace({}, bodies);
  }
  void step(double dt_s) override {
    physics_->collide(dt_s);
    physics_->solve(dt_s, substeps_);
  }
  BodyState state(std::size_t i) const override { return physics_->state(ids_[i]); }

 private:
  int substeps_;
  std::unique_ptr<Physics> physics_;
  std::vector<BodyId> ids_;
};

}  // namespace

std::unique_ptr<Peer> make_sunder(std::span<const BodyDesc> bodies, const Effort& effort) {
  return std::make_unique<Sunder>(bodies, effort);
}

}  // namespace sunder::bench
