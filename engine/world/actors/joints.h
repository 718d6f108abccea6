// Joints of the running world: who they hold, and where they go when that breaks. Internal to
// engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/mitre.h"
#include "engine/model/joint.h"
#include "engine/model/physics.h"
#include "engine/model/scene.h"
#include "engine/world/actors/actors.h"

namespace sunder {

/// What a hinge is of on one side; per bond of its section.
struct HingeSide {
  std::vector<ConvexPtr> convexes;
  std::vector<std::uint32_t> faces;
  std::vector<std::uint32_t> slots;  ///< Of the actor that has the convexes now.
  /// Convexes that are drawn otherwise than they are, as they end in the midplane.
  std::vector<ConvexPtr> redrawn;

  /// Whether an actor has all of them; if so notes their slots.
  bool is_of(const Actor& actor);
};

/// A section that flows (engine/world/actors/hinges.h).
struct Hinge {
  PlasticSection section;  ///< In the rest frame of a.
  Pose X_AB;               ///< Of b's rest frame in a's before it bent.
  HingeSide a, b;
  std::vector<double> areas_m2;
  double strain = 0;              ///< Of its outermost, so far, however it came to it.
  double known_strain = 0;        ///< For which its joint is as strong as it is.
  std::uint64_t flowed_step = 0;  ///< The last in which it did.
  Pose drawn_X_AB;                ///< As it is drawn.
  bool stays = false;             ///< Until it flows again: its sides do not become one.

  /// As it has hardened.
  SectionStrength strength() const;
  /// Where either side ends, in its own rest frame.
  SectionEnd end_a() const { return {section.centroid_R, section.strength.axes_R.col(0)}; }
  SectionEnd end_b() const {
    const Pose X_BA = X_AB.inverse();
    return {X_BA * section.centroid_R, X_BA.rotation * -section.strength.axes_R.col(0)};
  }
  /// From its centroid to what is farthest in it.
  double reach_m() const { return section.reach_m.maxCoeff(); }
};

/// Where b's rest frame lies in a's.
Pose relative_rest(const Physics& physics, const Actor& a, const Actor& b);

class Joints {
 public:
  /// An actor, or the world.
  struct End {
    std::uint32_t key = 0;         ///< kGroundKey: the world.
    Vec3 anchor_R = Vec3::Zero();  ///< In W at the world's end.
  };
  struct Live {
    JointId id;
    JointDesc desc;  ///< As it was made; bodies apart.
    End a, b;
    std::optional<Hinge> hinge;  ///< kPlastic.

    bool is_between(std::uint32_t x, std::uint32_t y) const {
      return (a.key == x && b.key == y) || (a.key == y && b.key == x);
    }
  };

  /// Joins two things as they stand; `joint.a` and `joint.b` are keys here.
  void add(Physics& physics, const Actors& actors, const Joint& joint);
  /// Holds two actors together, as they lie, by a section.
  void add(Physics& physics, const Actor& a, const Actor& b, Hinge hinge);
  /// After an actor's body was made anew: its joints hold that.
  void hold_on(Physics& physics, const Actor& actor);
  /// Before actor `from` goes, which `into` has taken in: its joints hold that. X_IF is where its
  /// rest frame is in that of `into`, `slot_of` where its convexes are there, by slot.
  void move(Physics& physics, const Actors& actors, std::uint32_t from, const Actor& into,
            const Pose& X_IF, std::span<const ConvexSlot> slot_of);
  /// After `parent` gave way to pieces, or lost them and stays: its ends go to what has the anchor
  /// now, and joints without one are cut. How many were.
  std::uint32_t follow(Physics& physics, const Actor& parent, bool stays,
                       std::span<const Actor> pieces);
  /// Lets go of what a joint holds; it is there.
  void cut(Physics& physics, JointId joint);
  /// Before an actor goes: cuts its joints. How many there were.
  std::uint32_t cut(Physics& physics, std::uint32_t key);
  /// After a solve: how many broke under their load.
  std::uint32_t take_broken(Physics& physics);
  /// As they were made, but for who has their ends now.
  const std::vector<Live>& live() const { return live_; }
  std::vector<Live>& live() { return live_; }
  /// The convexes of an actor that hinges are of; ascending.
  std::vector<ConvexSlot> hinged(std::uint32_t key) const;
  /// One of them, that is there.
  Live& at(JointId joint);

 private:
  static Live hold(Physics& physics, const Actor& a, const Actor& b, Hinge hinge);
  static Live moved(Physics& physics, const Actors& actors, Live joint, bool is_a,
                    const Actor& into, const Pose& X_IF, std::span<const ConvexSlot> slot_of);
  std::uint32_t forget(const std::vector<JointId>& gone);

  std::vector<Live> live_;
};

}  // namespace sunder
