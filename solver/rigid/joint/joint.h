// Joints, and their rules of waking, sleep and collision. For their solution see joint_solver.h.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "engine/model/physics.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Maximum number of rows of a joint: three of position, three of rotation.
inline constexpr int kMostJointRows = 6;

/// Impulse of a joint on b, and its opposite on a.
struct AnchorImpulse {
  Vec3 linear_W = Vec3::Zero();   ///< At the anchors.
  Vec3 angular_W = Vec3::Zero();  ///< Besides the moment of the linear impulse.

  AnchorImpulse& operator+=(const AnchorImpulse& o) {
    linear_W += o.linear_W, angular_W += o.angular_W;
    return *this;
  }
  AnchorImpulse operator-() const { return {-linear_W, -angular_W}; }
};

/// State of a plastic joint from substep to substep: see plastic.h.
struct PlasticState {
  double axial = 0;  ///< Axial impulse, as a fraction of the strength of the section.
  double speed = 0;  ///< Speed of plastic flow along the first turned row.
};

struct Joint {
  JointDesc desc;  ///< `a` and `b` are the current bodies.
  bool present = false;
  std::uint32_t generation = 0;
  BodySlot body_a = {}, body_b = {};  ///< None: the world, or a lost end.
  bool lost = false;                  ///< The body of an end was removed: the joint has no effect.
  std::array<double, kMostJointRows> impulse = {};  ///< By row, of the last substep.
  AnchorImpulse total = {};  ///< Over the last step in which the joint was solved.
  PlasticFlow flow = {};     ///< Plastic flow in the last solve.
  PlasticState plastic = {};

  bool holds() const { return present && !lost; }
  /// True if the joint had an impulse in the last step in which it was solved.
  bool has_load() const { return !total.linear_W.isZero(0) || !total.angular_W.isZero(0); }
};

class Joints {
 public:
  JointId add(const JointDesc& desc, Bodies& bodies);
  void attach(JointId id, bool end_a, BodyId body, std::span<const std::uint32_t> quiet_tags,
              Bodies& bodies);
  void strengthen(JointId id, const SectionStrength& strength);
  void cut(JointId id, Bodies& bodies);
  /// Must be called before a body is removed: its ends are lost, and the bodies at the other ends
  /// wake.
  void detach(BodySlot body, Bodies& bodies);
  /// Returns a body and all awake bodies joined to it, directly or through others.
  std::vector<BodySlot> joined_to(BodySlot body, const Bodies& bodies) const;
  /// Wakes each sleeping body that is joined to a moving one, directly or through others.
  void wake(Bodies& bodies) const;
  /// Must be called after joints changed, before ignores().
  void update_ignored_pairs(const Bodies& bodies);
  /// True if two shapes ignore each other because their bodies are joined.
  bool ignores(const Pair& pair, const Shapes& shapes, const Bodies& bodies) const;
  /// Removes a joint that broke, and adds it to take_broken().
  void break_off(std::uint32_t joint, Bodies& bodies);
  std::vector<JointId> take_broken();
  /// See Physics::joint_impulses().
  std::vector<JointImpulse> loads(const Bodies& bodies) const;
  /// See Physics::plastic_flows().
  std::vector<PlasticFlow> flows() const;
  /// Clears the flow of all joints.
  void clear_flows();

  bool empty() const { return items_.size() == free_slots_.size(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(items_.size()); }
  const Joint& operator[](std::uint32_t i) const { return items_[i]; }
  Joint& operator[](std::uint32_t i) { return items_[i]; }
  /// Returns a joint, which must exist.
  Joint& at(JointId id);
  std::span<const Joint> all() const { return items_; }
  /// Returns the indices of the joints of a body; ascending.
  std::span<const std::uint32_t> of(BodySlot body) const {
    return body.value < of_body_.size() ? std::span<const std::uint32_t>(of_body_[body])
                                        : std::span<const std::uint32_t>();
  }
  /// Must be called after a state was read.
  void list_by_body();

  static auto fields(auto& self) {
    return std::tie(self.items_, self.free_slots_, self.ignored_pairs_, self.ignored_shapes_,
                    self.broken_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field(const Bodies& bodies) const;

 private:
  void wake_ends(const Joint& joint, Bodies& bodies) const;
  void find_ignored_pairs(const Bodies& bodies);
  void list(std::uint32_t joint, BodySlot body);
  void unlist(std::uint32_t joint, BodySlot body);

  std::vector<Joint> items_;
  std::vector<std::uint32_t> free_slots_;
  ByBody<std::vector<std::uint32_t>> of_body_;  ///< See of(); for the first bodies only.
  bool ignored_pairs_are_stale_ = false;        ///< Joints have changed since they were found.
  /// A shape that is ignored within a pair of bodies.
  struct IgnoredShape {
    std::uint64_t pair;
    BodySlot body;
    std::uint32_t tag;
    auto operator<=>(const IgnoredShape&) const = default;
  };
  /// Keys of body pairs that ignore each other, ascending.
  std::vector<std::uint64_t> ignored_pairs_;
  /// Shapes that the other body of a pair ignores, ascending.
  std::vector<IgnoredShape> ignored_shapes_;
  std::vector<JointId> broken_;
};

}  // namespace sunder::solver
