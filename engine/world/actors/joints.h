// Joints of the running world, with the actors at their ends. When an actor breaks, its joints are
// reassigned to the pieces. Internal to engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "engine/geometry/mitre.h"
#include "engine/model/joint.h"
#include "engine/model/physics.h"
#include "engine/model/scene.h"
#include "engine/world/actors/actors.h"

namespace sunder {

/// Faces of one side of a hinge: entries per bond of the section.
struct HingeSide {
  std::vector<ConvexPtr> convexes;
  std::vector<std::uint32_t> faces;
  std::vector<std::uint32_t> slots;  ///< Slots of the convexes in their actor.
  /// Convexes that are drawn cut off at the plane midway between the sides.
  std::vector<ConvexPtr> redrawn;

  /// Returns true if an actor has all convexes of the side, and updates `slots`.
  bool find_slots(const Actor& actor);
};

/// Plastic hinge: a yielding section (engine/world/actors/hinges.h).
struct Hinge {
  PlasticSection section;  ///< In the rest frame of a.
  Pose X_AB;               ///< Pose of b's rest frame in a's before bending.
  HingeSide a, b;
  std::vector<double> areas_m2;
  double strain = 0;              ///< Accumulated plastic strain of the outermost fibre.
  double solver_strain = 0;       ///< Strain for which the joint's strength was last set.
  std::uint64_t flowed_step = 0;  ///< Last step in which it yielded.
  Pose drawn_X_AB;                ///< X_AB for which it was last drawn.
  bool rejoin_failed = false;     ///< Its sides could not be rejoined since it last yielded.

  /// Strength of the section after hardening.
  SectionStrength strength() const;
  /// Ends of the two sides, each in the rest frame of its side.
  SectionEnd end_a() const { return {section.centroid_R, section.strength.axes_R.col(0)}; }
  SectionEnd end_b() const {
    const Pose X_BA = X_AB.inverse();
    return {X_BA * section.centroid_R, X_BA.rotation * -section.strength.axes_R.col(0)};
  }
  /// Distance from the centroid to the outermost point of the section.
  double reach_m() const { return section.reach_m.maxCoeff(); }
};

/// Returns the pose of b's rest frame in a's.
Pose relative_rest(const Physics& physics, const Actor& a, const Actor& b);

class Joints {
 public:
  static constexpr std::uint32_t kNoKey = 0xffffffff;

  /// End of a joint: an actor, or the world.
  struct End {
    std::uint32_t key = 0;         ///< kGroundKey: the world.
    Vec3 anchor_R = Vec3::Zero();  ///< In the rest frame of the actor; in W at the world's end.
  };
  struct Live {
    JointId id;
    std::uint32_t key =
        kNoKey;      ///< Of a joint of the scene or the program; plastic hinges have none.
    JointDesc desc;  ///< As made; bodies may have changed.
    End a, b;
    std::optional<Hinge> hinge;  ///< Set for kPlastic.

    bool is_between(std::uint32_t x, std::uint32_t y) const {
      return (a.key == x && b.key == y) || (a.key == y && b.key == x);
    }
  };

  /// Joins two actors, or one and the world, at their current poses; `joint.a` and `joint.b` are
  /// keys. Returns the joint's key: keys ascend from 0, and are never used again.
  std::uint32_t add(Physics& physics, const Actors& actors, const Joint& joint);
  /// Joins two actors, at their current poses, by a plastic hinge.
  void add(Physics& physics, const Actor& a, const Actor& b, Hinge hinge);
  /// Reattaches the joints of an actor to its new body.
  void reattach(Physics& physics, const Actor& actor);
  /// Transfers the joints of actor `from`, which has been merged into `into` and will be erased.
  /// X_IF is the pose of its rest frame in that of `into`; `slot_of` maps its slots to those of
  /// `into`.
  void transfer(Physics& physics, const Actors& actors, std::uint32_t from, const Actor& into,
                const Pose& X_IF, std::span<const ConvexSlot> slot_of);
  /// Reassigns the joint ends of `parent`, which has been broken into pieces, or has lost pieces
  /// and stays, to the actors that contain the anchors. Cuts joints without such an actor and
  /// returns their number.
  std::uint32_t reassign_ends(Physics& physics, const Actor& parent, bool stays,
                              std::span<const Actor> pieces);
  /// Cuts an existing joint.
  void cut(Physics& physics, JointId joint);
  /// Cuts all joints of an actor that will be erased, and returns their number.
  std::uint32_t cut(Physics& physics, std::uint32_t key);
  /// Removes the joints that broke under their load in the last solve, and returns their number.
  std::uint32_t take_broken(Physics& physics);
  /// Returns the keys of joints that were lost since the last call; ascending.
  std::vector<std::uint32_t> take_lost();
  /// Returns the joint with a key; null if there is none.
  const Live* find(std::uint32_t key) const;
  /// All joints; ends name the current actors.
  const std::vector<Live>& live() const { return live_; }
  std::vector<Live>& live() { return live_; }
  /// Returns the convexes of an actor that belong to hinges; ascending.
  std::vector<ConvexSlot> hinged_convexes(std::uint32_t key) const;
  /// Returns an existing joint.
  Live& at(JointId joint);

  static auto fields(auto& self) { return std::tie(self.live_, self.lost_, self.next_key_); }

 private:
  static Live make_hinge(Physics& physics, const Actor& a, const Actor& b, Hinge hinge);
  static Live transferred(Physics& physics, const Actors& actors, Live joint, bool is_a,
                          const Actor& into, const Pose& X_IF, std::span<const ConvexSlot> slot_of);
  std::uint32_t erase(const std::vector<JointId>& gone);

  std::vector<Live> live_;
  std::vector<std::uint32_t> lost_;  ///< Keys, since the last take_lost().
  std::uint32_t next_key_ = 0;
};

}  // namespace sunder
