// Tests that the cache of closing contacts has no effect on the results of queries.
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 60;
constexpr std::uint32_t kBoxes = 60, kShelves = 8;

/// Boxes that fly about between the shelves of one static body, with the changes that breaks make.
class Flight {
 public:
  explicit Flight(bool queries_often) : queries_often_(queries_often) {
    BodyDesc shelves;
    shelves.is_static = true;
    shelves.tag = kBoxes;
    for (std::uint32_t i = 0; i < kShelves; ++i) shelves.shapes.push_back(shelf(i));
    shelves_ = world_.add(shelves);
    for (std::uint32_t i = 0; i < kBoxes; ++i) boxes_.push_back(world_.add(box(i)));
  }

  /// Returns the closing contacts after four rounds of changes within one step.
  std::vector<SpeculativeContact> step() {
    collide();
    for (int round = 0; round < 4; ++round) {
      push_two();
      replace_one();
      edit();
      collide();
    }
    const std::vector<JointId> joints = join_touching();
    collide();
    push_two();
    std::vector<SpeculativeContact> all = world_.physics().speculative_contacts();
    for (const JointId joint : joints) world_.physics().cut(joint);
    world_.physics().solve(kDt_s, 2);
    return all;
  }

 private:
  static ShapeDesc shelf(std::uint32_t number) {
    const Vec3 low(0, 0.9 * number, 0);
    ShapeDesc shape;
    shape.hull = W::keep(make_box(low, low + Vec3(4, 0.1, 4)));
    shape.tag = number;
    return shape;
  }
  double random(double most) { return random_.uniform(0, most); }
  Vec3 within(double most) {
    const double x = random(most), y = random(most), z = random(most);
    return {x, y, z};
  }
  Vec3 somewhere() { return within(4) + Vec3(0, 0.3, 0); }
  Vec3 motion() { return within(12) - Vec3::Constant(6); }
  BodyDesc box(std::uint32_t tag) {
    const Vec3 center_W = somewhere(), velocity_W = motion();
    BodyDesc desc = W::moving(W::box(Vec3::Constant(0.3), center_W), velocity_W, motion());
    desc.tag = tag;
    return desc;
  }
  BodyId any() { return boxes_[static_cast<std::size_t>(random(kBoxes))]; }

  void collide() {
    world_.physics().collide(kDt_s);
    query();
  }
  void query() {
    if (queries_often_) world_.physics().speculative_contacts();
  }
  void push_two() {
    const BodyId moved = any(), pushed = any();
    BodyState state = world_.physics().state(moved);
    state.X_WB.position += Vec3(0.02, 0, 0);
    state.velocity_W = motion();
    world_.physics().set_state(moved, state);
    const Vec3 impulse_W = 50 * motion();
    world_.physics().apply_impulse(pushed, impulse_W, somewhere());
    query();
  }
  void replace_one() {
    const auto number = static_cast<std::uint32_t>(random(kBoxes));
    BodyId& gone = boxes_[number];
    const BodyDesc comes = box(number);
    gone = world_.physics().replace(std::span(&gone, 1), std::span(&comes, 1)).front();
    query();
  }
  /// Removes a shelf, or adds it again.
  void edit() {
    const auto number = static_cast<std::uint32_t>(random(kShelves));
    const ShapeDesc back = shelf(number);
    const std::span<const std::uint32_t> gone(&number, gone_[number] ? 0 : 1);
    const std::span<const ShapeDesc> comes(&back, gone_[number] ? 1 : 0);
    gone_[number] = !gone_[number];
    world_.physics().edit({shelves_, gone, comes});
    query();
  }
  /// Joins bodies that touch, which excludes them from collision.
  std::vector<JointId> join_touching() {
    std::vector<JointId> joints;
    for (const TouchingBodies& touch : world_.physics().touching(boxes_)) {
      if (touch.tag_a >= kBoxes || touch.tag_b >= kBoxes) continue;
      JointDesc joint;
      joint.a = boxes_[touch.tag_a], joint.b = boxes_[touch.tag_b];
      joints.push_back(world_.physics().join(joint));
    }
    return joints;
  }

  RigidWorld world_;
  Random random_{7};
  bool queries_often_;
  BodyId shelves_;
  std::array<bool, kShelves> gone_ = {};
  std::vector<BodyId> boxes_;  ///< Indexed by tag.
};

auto values(const SpeculativeContact& a) {
  return std::tuple(a.body_tag_a, a.body_tag_b, a.shape_tag_a, a.shape_tag_b, a.separation_m,
                    a.speed_m_s, a.effective_mass_kg, a.point_W.x(), a.point_W.y(), a.point_W.z(),
                    a.normal_W.x(), a.normal_W.y(), a.normal_W.z());
}

void expect_same(Flight& one, Flight& other) {
  std::size_t seen = 0;
  for (int step = 0; step < 12; ++step) {
    const std::vector<SpeculativeContact> a = one.step(), b = other.step();
    ASSERT_EQ(a.size(), b.size()) << "step " << step;
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(values(a[i]), values(b[i]));
    seen += a.size();
  }
  EXPECT_GT(seen, 100u);
}

TEST(ClosingContacts, DoNotDependOnHowOftenTheyAreQueried) {
  Flight often(true), once(false);
  expect_same(often, once);
}

}  // namespace
}  // namespace sunder::solver
