// Physics that hands every call on to another: what tests look at it through starts from this.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "engine/model/physics.h"

namespace sunder::bench {

class ForwardingPhysics : public Physics {
 public:
  explicit ForwardingPhysics(std::unique_ptr<Physics> physics) : physics_(std::move(physics)) {}

  std::vector<BodyId> replace(std::span<const BodyId> remove,
                              std::span<const BodyDesc> add) override {
    return physics_->replace(remove, add);
  }
  void edit(const BodyEdit& edit) override { physics_->edit(edit); }
  void collide(double horizon_s) override { physics_->collide(horizon_s); }
  std::vector<SpeculativeContact> speculative_contacts() override {
    return physics_->speculative_contacts();
  }
  std::vector<Touch> touches(std::span<const BodyId> bodies) override {
    return physics_->touches(bodies);
  }
  std::unique_ptr<ImpactProbe> probe(ProbeCluster cluster) const override {
    return physics_->probe(std::move(cluster));
  }
  void set_state(BodyId body, const BodyState& state) override { physics_->set_state(body, state); }
  void apply_impulse(BodyId body, const Vec3& impulse_W, const Vec3& point_W) override {
    physics_->apply_impulse(body, impulse_W, point_W);
  }
  void pause(std::span<const BodyId> bodies) override { physics_->pause(bodies); }
  JointId join(const JointDesc& joint) override { return physics_->join(joint); }
  void attach(JointId joint, bool end_a, BodyId body,
              std::span<const std::uint32_t> quiet_tags) override {
    physics_->attach(joint, end_a, body, quiet_tags);
  }
  void strengthen(JointId joint, const SectionStrength& strength) override {
    physics_->strengthen(joint, strength);
  }
  std::vector<PlasticFlow> plastic_flows() const override { return physics_->plastic_flows(); }
  void cut(JointId joint) override { physics_->cut(joint); }
  std::vector<JointId> take_broken() override { return physics_->take_broken(); }
  SolveReport solve(double dt_s, int substeps) override { return physics_->solve(dt_s, substeps); }
  BodyStates states() const override { return physics_->states(); }
  std::vector<ContactImpulse> contact_impulses() const override {
    return physics_->contact_impulses();
  }
  std::vector<JointImpulse> joint_impulses() const override { return physics_->joint_impulses(); }
  std::vector<float> penetrations() const override { return physics_->penetrations(); }
  std::vector<WorkItem> take_work() override { return physics_->take_work(); }

 protected:
  std::unique_ptr<Physics> physics_;
};

}  // namespace sunder::bench
