// Tests that bodies at rest at the end of a scene are supported by the ground or by static bodies,
// through contacts and joints.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "engine/world/simulation.h"
#include "fracture/pattern_breaker.h"
#include "scenes/load.h"
#include "solver/rigid/rigid_physics.h"
#include "tests/fixtures/forwarding_physics.h"

namespace sunder::tests {
namespace {

// Limits of contacts that support a body, by separation and by the y of the normal towards the
// body, and of the motion of a body at rest in half a second.
constexpr double kMaxSeparation_m = 0.01, kMaxRestMotion_m = 0.01, kMinSupportNormal_y = -0.5;

/// Physics that records its bodies and joints.
class ObservedPhysics final : public ForwardingPhysics {
 public:
  struct Body {
    BodyId id;
    bool is_static = false;
  };
  struct JointBodies {
    BodyId a, b;
  };

  using ForwardingPhysics::ForwardingPhysics;

  std::vector<BodyId> replace(std::span<const BodyId> remove,
                              std::span<const BodyDesc> add) override {
    const std::vector<BodyId> ids = physics_->replace(remove, add);
    for (const BodyId id : remove)
      std::erase_if(bodies, [&](auto& b) { return b.second.id == id; });
    for (std::size_t i = 0; i < ids.size(); ++i) bodies[add[i].tag] = {ids[i], add[i].is_static};
    return ids;
  }
  JointId join(const JointDesc& joint) override {
    const JointId id = physics_->join(joint);
    joints[id.slot] = {joint.a, joint.b};
    return id;
  }
  void attach(JointId joint, bool end_a, BodyId body,
              std::span<const std::uint32_t> quiet_tags) override {
    physics_->attach(joint, end_a, body, quiet_tags);
    (end_a ? joints[joint.slot].a : joints[joint.slot].b) = body;
  }
  void cut(JointId joint) override {
    physics_->cut(joint);
    joints.erase(joint.slot);
  }
  std::vector<JointId> take_broken() override {
    const std::vector<JointId> broken = physics_->take_broken();
    for (const JointId joint : broken) joints.erase(joint.slot);
    return broken;
  }

  std::map<std::uint32_t, Body> bodies;  ///< By tag.
  std::map<std::uint32_t, JointBodies> joints;
};

/// Returns the tags of supported bodies: static ones, and those that another supported body
/// supports by a joint, or by a contact that does not press from above.
std::set<std::uint32_t> supported(ObservedPhysics& physics) {
  std::vector<BodyId> ids;
  std::map<std::uint32_t, std::uint32_t> tag_of_slot;
  std::set<std::uint32_t> held;
  for (const auto& [tag, body] : physics.bodies) {
    ids.push_back(body.id);
    tag_of_slot[body.id.slot] = tag;
    if (body.is_static) held.insert(tag);
  }
  std::multimap<std::uint32_t, std::uint32_t> supports;  // a body, and a body that it may support
  for (const Touch& touch : physics.touches(ids)) {
    if (touch.separation_m > kMaxSeparation_m) continue;
    if (touch.normal_W.y() > kMinSupportNormal_y)
      supports.emplace(touch.body_tag_a, touch.body_tag_b);
    if (-touch.normal_W.y() > kMinSupportNormal_y)
      supports.emplace(touch.body_tag_b, touch.body_tag_a);
  }
  for (const auto& [slot, joint] : physics.joints) {
    const auto a = tag_of_slot.find(joint.a.slot), b = tag_of_slot.find(joint.b.slot);
    const bool has_a = !joint.a.none() && a != tag_of_slot.end();
    const bool has_b = !joint.b.none() && b != tag_of_slot.end();
    if (has_a && has_b)
      supports.emplace(a->second, b->second), supports.emplace(b->second, a->second);
    if (has_a != has_b) held.insert(has_a ? a->second : b->second);
  }
  std::vector<std::uint32_t> next(held.begin(), held.end());
  while (!next.empty()) {
    const std::uint32_t below = next.back();
    next.pop_back();
    for (auto [it, end] = supports.equal_range(below); it != end; ++it)
      if (held.insert(it->second).second) next.push_back(it->second);
  }
  return held;
}

struct Settled {
  const char* scene;
  std::vector<std::string> set;
};

class Support : public testing::TestWithParam<Settled> {};

TEST_P(Support, BodiesAtRestAreSupported) {
  Scene scene = scenes::load_scene(GetParam().scene, {"draft", GetParam().set});
  solver::RigidOptions options;
  options.gravity_W = scene.gravity_W;
  auto observed = std::make_unique<ObservedPhysics>(solver::make_rigid_physics(options));
  ObservedPhysics& physics = *observed;
  const double end_s = scene.duration_s;
  Simulation simulation(std::move(scene), std::move(observed), fracture::make_pattern_breaker());
  FramePtr last;
  std::map<std::uint64_t, Vec3> before;  // half a second before the end
  while (const FramePtr frame = simulation.next()) {
    last = frame;
    EXPECT_EQ(frame->report.frozen, 0u) << frame->time_s;
    if (std::abs(frame->time_s - (end_s - 0.5)) < 1e-3)
      for (const FrameBody& body : frame->bodies) before[body.key] = body.X_WB.position;
  }
  const std::set<std::uint32_t> held = supported(physics);
  std::size_t at_rest = 0;
  for (const FrameBody& body : last->bodies) {
    if (body.is_static || !before.contains(body.key)) continue;
    if ((body.X_WB.position - before[body.key]).norm() > kMaxRestMotion_m) continue;
    ++at_rest;
    EXPECT_TRUE(held.contains(static_cast<std::uint32_t>(body.key)))
        << "body " << body.key << " floats at " << body.X_WB.position.transpose()
        << (body.asleep ? ", asleep" : "");
  }
  EXPECT_GT(at_rest, 5u);
}

// Buildings collapse into larger pieces than in the shipped scenes, at a tenth of the cost.
const std::vector<std::string> kCoarseHouse = {
    "scene.duration_s=4.5",
    "material.0.pattern.cells=25",
    "material.1.pattern.cells=25",
    "material.0.smallest_piece_m3=0.008",
    "material.1.smallest_piece_m3=0.008",
};
const std::vector<std::string> kCoarseBridge = {
    "scene.duration_s=4",
    "material.0.pattern.cells=30",
    "material.0.smallest_piece_m3=0.01",
    "material.0.smallest_break_m3=0.1",
};
const std::vector<std::string> kCoarseTemple = {
    "scene.duration_s=6",
    "solid.0.columns_x=3",
    "material.0.smallest_piece_m3=0.01",
    "material.0.smallest_break_m3=0.1",
};

INSTANTIATE_TEST_SUITE_P(Scenes, Support,
                         testing::Values(Settled{"brick_wall", {"scene.duration_s=8"}},
                                         Settled{"column_row", {}}, Settled{"dominoes", {}},
                                         Settled{"flywheel", {}}, Settled{"glass", {}},
                                         Settled{"blast", {}}, Settled{"wrecking_ball", {}},
                                         Settled{"house", kCoarseHouse},
                                         Settled{"bridge", kCoarseBridge},
                                         Settled{"temple", kCoarseTemple}),
                         [](const auto& settled) { return std::string(settled.param.scene); });

}  // namespace
}  // namespace sunder::tests
