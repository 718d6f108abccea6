// Joints: what holds bodies together, and the rules of who wakes, sleeps and touches whom by them.
// How they are solved: joint_solver.h.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/physics.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Rows of a joint at most: three of place, three of rotation.
inline constexpr int kMostJointRows = 6;

/// What a joint did to b, and the opposite of what it did to a.
struct JointImpulse {
  Vec3 linear_W = Vec3::Zero();   ///< At the anchors.
  Vec3 angular_W = Vec3::Zero();  ///< Besides that of the linear one.

  JointImpulse& operator+=(const JointImpulse& o) {
    linear_W += o.linear_W, angular_W += o.angular_W;
    return *this;
  }
  JointImpulse operator-() const { return {-linear_W, -angular_W}; }
};

/// What a plastic joint keeps from substep to substep: see plastic.h.
struct PlasticState {
  double axial = 0;  ///< Impulse, of what the section bears.
  double speed = 0;  ///< Of flow along; in turned rows.
};

struct Joint {
  JointDesc desc;  ///< `a` and `b` as they are now.
  bool present = false;
  std::uint32_t generation = 0;
  BodySlot body_a = {}, body_b = {};                ///< None: the world, or a lost end.
  bool lost = false;                                ///< An end's body is gone: it holds nothing.
  std::array<double, kMostJointRows> impulse = {};  ///< Of the last substep, by row.
  JointImpulse total = {};                          ///< Over the last step it was solved in.
  JointFlow flow = {};                              ///< Of the last solve.
  PlasticState plastic = {};

  bool holds() const { return present && !lost; }
  /// It bore load in the last step that it was solved in.
  bool bears() const { return !total.linear_W.isZero(0) || !total.angular_W.isZero(0); }
};

class Joints {
 public:
  JointId add(const JointDesc& desc, Bodies& bodies);
  void attach(JointId id, bool end_a, BodyId body, std::span<const std::uint32_t> quiet_tags,
              Bodies& bodies);
  void strengthen(JointId id, const SectionStrength& strength);
  void cut(JointId id, Bodies& bodies);
  /// Before a body goes: its ends are lost, and what they held wakes.
  void lose(BodySlot body, Bodies& bodies);
  /// A body and what is joined to it, through others, as far as it is awake.
  std::vector<BodySlot> joined_to(BodySlot body, const Bodies& bodies) const;
  /// Wakes every sleeper that is joined to something on the move, through others.
  void wake(Bodies& bodies) const;
  /// Whether two shapes ignore each other because their bodies are joined.
  bool apart(const Pair& pair, const Shapes& shapes, const Bodies& bodies) const;
  /// A joint that bore too much goes, and is remembered for take_broken().
  void break_off(std::uint32_t joint, Bodies& bodies);
  std::vector<JointId> take_broken();
  /// See Physics::joint_loads().
  std::vector<JointLoad> loads(const Bodies& bodies) const;
  /// See Physics::joint_flows().
  std::vector<JointFlow> flows() const;
  /// Nothing has flowed yet.
  void forget_flows();

  bool empty() const { return items_.size() == free_slots_.size(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(items_.size()); }
  const Joint& operator[](std::uint32_t i) const { return items_[i]; }
  Joint& operator[](std::uint32_t i) { return items_[i]; }
  /// The joint of that name, which must be there.
  Joint& at(JointId id);
  std::span<const Joint> all() const { return items_; }

 private:
  void wake_ends(const Joint& joint, Bodies& bodies) const;
  void note_pairs(const Bodies& bodies);

  std::vector<Joint> items_;
  std::vector<std::uint32_t> free_slots_;
  /// A shape of a pair of bodies.
  struct Quiet {
    std::uint64_t pair;
    BodySlot body;
    std::uint32_t tag;
    auto operator<=>(const Quiet&) const = default;
  };
  std::vector<std::uint64_t> apart_;  ///< Keys of body pairs that ignore each other, ascending.
  std::vector<Quiet> quiet_;          ///< What the other body of the pair ignores, ascending.
  std::vector<JointId> broken_;
};

}  // namespace sunder::solver
