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
inline constexpr std::uint8_t kMaxColors = 64;  ///< As a colour of a manifold: none was free.
/// Number of values of Manifold::sweep_key().
inline constexpr std::size_t kSweepKeys = (kMaxColors + 1) * 4;

inline std::uint64_t pair_key(ShapeSlot shape_a, ShapeSlot shape_b) {
  return std::uint64_t{shape_a.value} << 32 | shape_b.value;
}

/// Two shapes whose fat boxes overlap. Shape a is the half-space if there is one, else the hull if
/// b is a sphere, else the facet if there is one, else the shape of the lower slot.
struct Pair {
  ShapeSlot shape_a, shape_b;  ///< None: a free slot.
  BodySlot body_a, body_b;
  ManifoldSlot manifold;       ///< None: no contact, not even a speculative one.
  float clearance_m = -1;      ///< Lower bound on the distance at the last test.
  float margin_m = 0;          ///< Distance within which they have a contact, plus their motion.
  double rotation_path_m = 0;  ///< Sum of Bodies::rotation_path_m of both at the last test.
  Vec3f offset_W = Vec3f::Zero();  ///< Centre of b minus centre of a at the last test.
  Vec3f axis_A = Vec3f::Zero();    ///< Last separating axis, in A; zero if none.
  bool needs_test = true;          ///< True until the first test, or if a test was requested.

  bool present() const { return !shape_a.none(); }
  bool touching() const { return !manifold.none(); }
  std::uint64_t key() const { return pair_key(shape_a, shape_b); }
};

struct ManifoldPoint {
  Vec3f anchor_A = Vec3f::Zero(), anchor_B = Vec3f::Zero();  ///< Positions fixed to the bodies.
  /// Lever arms from the centres of mass, in W.
  Vec3f arm_A = Vec3f::Zero(), arm_B = Vec3f::Zero();
  float separation_m = 0;
  float impulse_Ns = 0;  ///< Normal impulse of the last substep.
  float rest_m = 0;      ///< Separation at which the contact has no force: see static_warm_start.h.
  std::uint32_t feature = 0;
};

/// Up to four points with one normal. Friction acts at the mean of the points, with a torque about
/// the normal.
struct Manifold {
  PairSlot pair;  ///< None: a free slot.
  BodySlot body_a, body_b;
  std::uint8_t count = 0;  ///< Number of points; 0: a free slot.
  std::uint8_t color = kNoColor;
  bool normal_on_b = false;   ///< The normal is fixed to B instead of A.
  bool reusable = false;      ///< Points may be kept while the pair barely moves.
  bool is_ball_pair = false;  ///< Both shapes are spheres.
  bool deep = false;          ///< The overlap is so deep that the normal is unreliable.
  bool sticking = false;      ///< No friction anchor has slipped since the last build.
  bool cold = false;  ///< Belongs to a new body: gets a static warm start in the next solve.
  float friction = 0;
  float restitution = 0;
  /// Factor on the compliance; below 1 while a large load stiffens the contact.
  float compliance_scale = 1;
  float size_m = 0;                      ///< Lesser inner radius; tolerances are fractions of it.
  Vec3f normal_W = Vec3f::UnitY();       ///< Unit normal from a to b.
  Vec3f normal_body = Vec3f::UnitY();    ///< In B if normal_on_b, else in A.
  Vec3f built_position = Vec3f::Zero();  ///< Position of B in A when the points were built.
  Quatf built_rotation = Quatf::Identity();
  Vec3f friction_anchor_A = Vec3f::Zero(), friction_anchor_B = Vec3f::Zero();
  Vec3f friction_arm_A = Vec3f::Zero(), friction_arm_B = Vec3f::Zero();
  /// Displacement of the friction anchor of b from that of a since they were set.
  Vec3f drift_W = Vec3f::Zero();
  Vec3f friction_impulse_W = Vec3f::Zero();
  float twist_impulse = 0;
  float rolling_m = 0;  ///< Lever arm of rolling resistance.
  Vec3f roll_impulse_W = Vec3f::Zero();
  Vec3f step_impulse_W = Vec3f::Zero();  ///< Impulse on b over the last step.
  /// Moving average of the force on b, N, over about a quarter of the time at rest before sleep.
  Vec3f mean_force_W = Vec3f::Zero();
  Vec3f rest_force_W = Vec3f::Zero();  ///< Force on b, N, when a or b last fell asleep.
  std::array<ManifoldPoint, 4> points;

  /// Sort key in the order of sweeps: by colour, then by falling number of points.
  std::uint32_t sweep_key() const { return color * 4u + 4u - count; }
  float least_separation() const {
    float least = 1e30f;
    for (int i = 0; i < count; ++i) least = std::min(least, points[i].separation_m);
    return least;
  }
  /// Returns the mean of the points weighted by their impulses, from the centre of mass of a.
  Vec3f center_of_load() const {
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
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
};

/// True if a solve includes the manifold: it has points, and a or b is awake.
inline bool touches_awake(const Manifold& m, const Bodies& bodies) {
  return m.count > 0 && (bodies.awake(m.body_a) || bodies.awake(m.body_b));
}

/// All pairs, the manifolds of those that touch, and the colours that bodies have in use.
struct Contacts {
  SlotVector<PairSlot, Pair> pairs;
  SlotVector<ManifoldSlot, Manifold> manifolds;
  std::vector<PairSlot> free_pairs;
  std::vector<ManifoldSlot> free_manifolds;
  std::uint8_t colors = kMaxColors;   ///< Number of colours that manifolds may get.
  ByBody<std::uint64_t> body_colors;  ///< Bit c: a manifold of colour c touches the body.
  std::vector<ManifoldSlot> cold;     ///< Manifolds of new bodies: see static_warm_start.h.
  KeyMap slot_of;                     ///< Pair slots by key.

  /// Returns the slot of the pair with that key, or none.
  PairSlot slot(std::uint64_t key) const { return PairSlot(slot_of.find(key)); }
  void add(const Pair& pair);
  // Reserve memory for `more` items.
  void expect_pairs(std::size_t more);
  void expect_manifolds(std::size_t more);
  /// Removes a pair and its manifold, if it has one.
  void remove(PairSlot pair);
  /// Adds the manifold of a pair that began to touch. It gets the lowest colour that neither body
  /// has, or `kMaxColors` if none is free.
  void add_manifold(PairSlot pair, const Manifold& manifold, const Bodies& bodies);
  /// Removes the manifold of a pair that ceased to touch.
  void remove_manifold(PairSlot pair);

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
  /// As wrong_field(), of the bodies and shapes that touch.
  const char* wrong_field(const Bodies& bodies, const Shapes& shapes) const;
};

}  // namespace sunder::solver
