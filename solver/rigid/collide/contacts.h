// Pairs of shapes that are near each other, and the manifolds of those that touch.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/key_map.h"

namespace sunder::solver {

inline constexpr std::uint8_t kNoColor = 0xff;
inline constexpr std::uint8_t kMaxColors = 64;                   ///< As a colour: none was free.
inline constexpr std::size_t kSweepKeys = (kMaxColors + 1) * 4;  ///< Of manifolds that touch.

inline std::uint64_t pair_key(ShapeSlot shape_a, ShapeSlot shape_b) {
  return std::uint64_t{shape_a.value} << 32 | shape_b.value;
}

/// Two shapes whose fat boxes overlap. If their kinds differ, a is the half-space, or the hull; a
/// facet is a.
struct Pair {
  ShapeSlot shape_a, shape_b;  ///< None: a free slot.
  BodySlot body_a, body_b;
  ManifoldSlot manifold;           ///< None: not touching.
  float clearance_m = -1;          ///< Lower bound on the distance when last looked at closely.
  float margin_m = 0;              ///< Within which it matters, besides what the bodies move.
  double turned_m = 0;             ///< Of both bodies when last looked at closely.
  Vec3f offset_W = Vec3f::Zero();  ///< Of b's centre from a's then.
  Vec3f axis_A = Vec3f::Zero();    ///< Last axis that parted them, in A; zero if none.
  bool fresh = true;               ///< Not looked at closely yet.

  bool present() const { return !shape_a.none(); }
  bool touching() const { return !manifold.none(); }
  std::uint64_t key() const { return pair_key(shape_a, shape_b); }
};

struct ManifoldPoint {
  Vec3f anchor_A = Vec3f::Zero(), anchor_B = Vec3f::Zero();  ///< Fixed to the bodies.
  Vec3f arm_A = Vec3f::Zero(), arm_B = Vec3f::Zero();        ///< From the centres of mass, in W.
  float separation_m = 0;
  float impulse_Ns = 0;  ///< Of the last substep, along the normal.
  float rest_m = 0;      ///< Separation at which it rests without load: see static_warm_start.h.
  std::uint32_t feature = 0;
};

/// Up to four points on one normal. Friction acts at their middle, with twist about the normal.
struct Manifold {
  PairSlot pair;  ///< None: a free slot.
  BodySlot body_a, body_b;
  std::uint8_t count = 0;  ///< 0: a free slot.
  std::uint8_t color = kNoColor;
  bool normal_on_b = false;  ///< The normal is fixed to B instead of A.
  bool reusable = false;     ///< Points may be carried along while the pair barely moves.
  bool round = false;        ///< Of two balls.
  bool deep = false;         ///< They overlap so far that the normal says little.
  bool sticking = false;     ///< The friction anchors hold since the last rebuild.
  bool cold = false;         ///< Came with a new body: gets its load before the next solve.
  float friction = 0;
  float restitution = 0;
  float compliance_scale = 1;       ///< How soft its springs are; less where it bears much.
  float size_m = 0;                 ///< Yardstick: inner radius of the smaller shape.
  Vec3f normal_W = Vec3f::UnitY();  ///< From a to b.
  Vec3f normal_body = Vec3f::UnitY();
  Vec3f built_position = Vec3f::Zero();  ///< Of B in A when the points were made.
  Quatf built_rotation = Quatf::Identity();
  Vec3f friction_anchor_A = Vec3f::Zero(), friction_anchor_B = Vec3f::Zero();
  Vec3f friction_arm_A = Vec3f::Zero(), friction_arm_B = Vec3f::Zero();
  Vec3f drift_W = Vec3f::Zero();  ///< Of the friction anchors, b from a, since they were set.
  Vec3f friction_impulse_W = Vec3f::Zero();
  float twist_impulse = 0;
  float rolling_m = 0;  ///< Arm of resistance to rolling.
  Vec3f roll_impulse_W = Vec3f::Zero();
  Vec3f step_impulse_W = Vec3f::Zero();  ///< On b over the last step, if a or b bears load.
  Vec3f mean_force_W = Vec3f::Zero();    ///< On b, N, over a quarter of the time of rest, about.
  Vec3f rest_force_W = Vec3f::Zero();    ///< On b, N, when a body of the two last fell asleep.
  std::array<ManifoldPoint, 4> points;

  /// Its place in the order of sweeps: by colour, and in each those of most points first.
  std::uint32_t sweep_key() const { return color * 4u + 4u - count; }
  float least_separation() const {
    float least = 1e30f;
    for (int i = 0; i < count; ++i) least = std::min(least, points[i].separation_m);
    return least;
  }
  /// Where its points press, from the middle of a.
  Vec3f middle_of_load() const {
    Vec3f sum = Vec3f::Zero();
    for (int i = 0; i < count; ++i) sum += points[i].impulse_Ns * points[i].arm_A;
    const float all = normal_impulse();
    return all > 0 ? Vec3f(sum / all) : friction_arm_A;
  }
  float normal_impulse() const {
    float sum = 0;
    for (int i = 0; i < count; ++i) sum += points[i].impulse_Ns;
    return sum;
  }
  Vec3f impulse_W() const { return normal_impulse() * normal_W + friction_impulse_W; }
};

/// Whether a solve has to do with it: it touches, and one of both may move.
inline bool touches_awake(const Manifold& m, const Bodies& bodies) {
  return m.count > 0 && (bodies.awake(m.body_a) || bodies.awake(m.body_b));
}

/// All pairs, the manifolds of those that touch, and the colours bodies have in use.
struct Contacts {
  SlotVector<PairSlot, Pair> pairs;
  SlotVector<ManifoldSlot, Manifold> manifolds;
  std::vector<PairSlot> free_pairs;
  std::vector<ManifoldSlot> free_manifolds;
  std::uint8_t colors = kMaxColors;   ///< That may be given out.
  ByBody<std::uint64_t> body_colors;  ///< Bit c: a manifold of colour c touches the body.
  std::vector<ManifoldSlot> cold;     ///< Came with new bodies: see static_warm_start.h.
  KeyMap slot_of;                     ///< Pair slots by key.

  /// The slot of the pair with that key, or none.
  PairSlot slot(std::uint64_t key) const { return PairSlot(slot_of.find(key)); }
  void add(const Pair& pair);
  // Make room for so many more.
  void expect_pairs(std::size_t more);
  void expect_manifolds(std::size_t more);
  /// Removes a pair and its manifold, if it has one.
  void remove(PairSlot pair);
  /// The pair came to touch. Its manifold gets the least colour neither body has, or `kMaxColors`
  /// if none was free.
  void touch(PairSlot pair, const Manifold& manifold, const Bodies& bodies);
  /// The pair no longer touches.
  void part(PairSlot pair);
};

}  // namespace sunder::solver
