// A scripted Physics and Breaker: the world's stages under test, with the solver's impact probe
// but without its motion, and without fracture.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "engine/world/simulation.h"
#include "solver/impact/event_probe.h"

namespace sunder::testing {

/// Bodies that fly straight on; speculative_contacts are whatever `script` says for the number of
/// collides.
class ScriptedPhysics : public Physics {
 public:
  struct Body {
    BodyDesc desc;
    BodyState state;
    bool alive = true;
    bool paused = false;  ///< For the next solve.
  };
  using Script =
      std::function<std::vector<SpeculativeContact>(const ScriptedPhysics&, int collides)>;

  explicit ScriptedPhysics(Script script) : script_(std::move(script)) {}

  std::vector<BodyId> replace(std::span<const BodyId> remove,
                              std::span<const BodyDesc> add) override {
    for (const BodyId id : remove) bodies[id.slot].alive = false;
    std::vector<BodyId> ids;
    for (const BodyDesc& desc : add) {
      ids.push_back({static_cast<std::uint32_t>(bodies.size()), 0});
      bodies.push_back({desc, {desc.X_WB, desc.velocity_W, desc.angular_velocity_W}});
    }
    return ids;
  }
  void edit(const BodyEdit& edit) override {
    std::vector<ShapeDesc>& shapes = bodies[edit.body.slot].desc.shapes;
    for (const std::uint32_t tag : edit.removed_tags)
      std::erase_if(shapes, [&](const ShapeDesc& shape) { return shape.tag == tag; });
    shapes.insert(shapes.end(), edit.added.begin(), edit.added.end());
  }
  void collide(double) override { approaches_ = script_(*this, collides_++); }
  std::vector<SpeculativeContact> speculative_contacts() override { return approaches_; }
  std::vector<Touch> touches(std::span<const BodyId> of) override {
    std::vector<Touch> touches;
    for (const SpeculativeContact& approach : approaches_) {
      const auto among = [&](std::uint32_t tag) {
        return std::any_of(of.begin(), of.end(),
                           [&](BodyId id) { return bodies[id.slot].desc.tag == tag; });
      };
      if (!among(approach.body_tag_a) && !among(approach.body_tag_b)) continue;
      const auto arm = [&](std::uint32_t tag) {
        return Vec3(approach.point_W - find(tag)->state.X_WB.position);
      };
      touches.push_back({approach.body_tag_a, approach.body_tag_b, approach.shape_tag_a,
                         approach.shape_tag_b, arm(approach.body_tag_a), arm(approach.body_tag_b),
                         approach.normal_W, approach.separation_m});
    }
    return touches;
  }
  std::unique_ptr<ImpactProbe> probe(ProbeCluster cluster) const override {
    return solver::make_event_probe(std::move(cluster));
  }
  void set_state(BodyId id, const BodyState& state) override {
    if (!bodies[id.slot].desc.is_static) bodies[id.slot].state = state;
  }
  void apply_impulse(BodyId id, const Vec3& impulse_W, const Vec3& point_W) override {
    Body& body = bodies[id.slot];
    if (body.desc.is_static) return;
    body.state.velocity_W += impulse_W / body.desc.mass_kg;
    const Quat& q = body.state.X_WB.rotation;
    const Vec3 twist = (point_W - body.state.X_WB.position).cross(impulse_W);
    body.state.angular_velocity_W += q * (body.desc.inertia_B.inverse() * (q.conjugate() * twist));
  }
  void pause(std::span<const BodyId> paused) override {
    for (const BodyId id : paused) bodies[id.slot].paused = true;
  }
  JointId join(const JointDesc& joint) override {
    joints.push_back(joint);
    cut_joints.push_back(false);
    return {static_cast<std::uint32_t>(joints.size() - 1), 0};
  }
  void attach(JointId id, bool end_a, BodyId body, std::span<const std::uint32_t>) override {
    (end_a ? joints[id.slot].a : joints[id.slot].b) = body;
  }
  void cut(JointId id) override { cut_joints[id.slot] = true; }
  SolveReport solve(double dt_s, int) override {
    SolveReport report;
    for (Body& body : bodies) {
      if (!body.paused) body.state.X_WB.position += dt_s * body.state.velocity_W;
      body.paused = false;
      if (!body.alive || body.desc.is_static) continue;
      report.mass_kg += body.desc.mass_kg;
      report.momentum_before_Ns += body.desc.mass_kg * body.state.velocity_W;
    }
    report.momentum_after_Ns = report.momentum_before_Ns;
    return report;
  }
  BodyStates states() const override {
    for (std::uint32_t slot = 0; slot < bodies.size(); ++slot) {
      const Body& body = bodies[slot];
      const BodyMode mode = !body.alive           ? BodyMode::kAbsent
                            : body.desc.is_static ? BodyMode::kStatic
                            : body.state.asleep   ? BodyMode::kAsleep
                                                  : BodyMode::kAwake;
      table_.set({slot, 0}, mode, body.state);
    }
    return table_.states();
  }
  std::vector<ContactImpulse> contact_impulses() const override { return loads; }
  std::vector<JointImpulse> joint_impulses() const override { return pulls; }
  std::vector<float> penetrations() const override { return {}; }

  /// Returns a speculative contact of the living bodies with these tags at a point, along a normal
  /// from a to b.
  std::vector<SpeculativeContact> approach(std::uint32_t tag_a, std::uint32_t tag_b,
                                           const Vec3& point_W, const Vec3& normal_W) const {
    const Body *a = find(tag_a), *b = find(tag_b);
    if (!a || !b) return {};
    SpeculativeContact approach;
    approach.body_tag_a = tag_a;
    approach.body_tag_b = tag_b;
    approach.point_W = point_W;
    approach.normal_W = normal_W;
    approach.speed_m_s = normal_W.dot(a->state.velocity_W - b->state.velocity_W);
    if (approach.speed_m_s <= 0) return {};
    approach.effective_mass_kg =
        1 / (inverse_mass(*a, point_W, normal_W) + inverse_mass(*b, point_W, normal_W));
    return {approach};
  }
  const Body* find(std::uint32_t tag) const {
    for (const Body& body : bodies) {
      if (body.alive && body.desc.tag == tag) return &body;
    }
    return nullptr;
  }

  std::vector<Body> bodies;
  std::vector<JointDesc> joints;  ///< All there ever were.
  std::vector<bool> cut_joints;
  std::vector<ContactImpulse> loads;  ///< Result of contact_impulses().
  std::vector<JointImpulse> pulls;    ///< Result of joint_impulses().

 private:
  static double inverse_mass(const Body& body, const Vec3& point_W, const Vec3& normal_W) {
    if (body.desc.is_static) return 0;
    const Vec3 beta_B =
        body.state.X_WB.rotation.conjugate() * (point_W - body.state.X_WB.position).cross(normal_W);
    return 1 / body.desc.mass_kg + beta_B.dot(body.desc.inertia_B.inverse() * beta_B);
  }

  Script script_;
  std::vector<SpeculativeContact> approaches_;
  int collides_ = 0;
  mutable BodyTable table_;  ///< Table of `bodies`, which tests change directly.
};

/// Parts every compound into its convexes; reports `area_m2` of crack for each part.
class ScriptedBreaker final : public Breaker {
 public:
  explicit ScriptedBreaker(double area_m2) : area_m2_(area_m2) {}
  BreakCommand command(const Convex& convex, std::span<const Material> materials,
                       const StructureImpact& hit, std::uint64_t event,
                       std::uint64_t seed) const override {
    BreakCommand command;
    command.event = event;
    command.seed = seed;
    command.pattern = materials[convex.material.value].pattern;
    command.X_RP.position = hit.point_R;
    return command;
  }
  BreakEdit plan(const Structure& structure, const BreakCommand&) const override {
    BreakEdit edit = part(structure);
    for (std::uint32_t p = 1; p <= edit.loose.pieces.size(); ++p) {
      const MaterialIndex material = edit.loose.pieces[p - 1].convexes[0]->material;
      edit.loose.exposed.push_back({p, 0, 0, area_m2_, material});
    }
    return edit;
  }
  StressResult stress(const Structure& structure, const LoadCase& load) const override {
    return stressed ? stressed(structure, load) : StressResult{};
  }

  /// Every convex comes off, if there are several.
  static BreakEdit part(const Structure& structure) {
    BreakEdit edit;
    edit.changed = structure.size() > 1;
    if (!edit.changed) return edit;
    structure.for_each([&](ConvexSlot slot, const Convex&) {
      edit.removed.push_back(slot);
      edit.loose.pieces.push_back({{structure.convex(slot)}, {structure.anchored(slot)}, {}, {}});
    });
    return edit;
  }

  /// Computes the result of stress().
  std::function<StressResult(const Structure&, const LoadCase&)> stressed;

 private:
  double area_m2_;
};

}  // namespace sunder::testing
