// What is drawn of the actors. Internal to engine/world.
#pragma once

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/world/actors/actors.h"

namespace sunder {

/// How a convex is drawn.
struct Drawn {
  MeshIndex mesh;  ///< none() where nothing shows.
  std::vector<std::uint8_t> hidden;
};
using DrawnBefore = std::unordered_map<const Convex*, Drawn>;

/// The meshes of a run. What is new is drawn when somebody looks: by draw(), before a snapshot.
class Meshes {
 public:
  MeshIndex add(std::shared_ptr<const Mesh> mesh);
  /// Gives new actors their meshes; convexes that look as they did in `old` keep theirs.
  void add_to(std::span<Actor> actors, const DrawnBefore& old);
  /// Draws convexes of an actor anew whose faces are hidden otherwise than before; slots may be
  /// new.
  void renew(Actor& actor, std::span<const ConvexSlot> slots);
  /// Draws a convex of an actor otherwise than it is; null: as it is.
  void show(Actor& actor, ConvexSlot slot, std::shared_ptr<const Mesh> mesh);
  /// Leaves it out.
  void hide(Actor& actor, ConvexSlot slot) { actor.meshes[slot.value] = {}; }
  /// Makes the meshes that are still missing.
  void draw(Actors& actors);
  /// All there are, for a frame: they stay as they are.
  std::shared_ptr<const MeshStore> publish();

 private:
  /// A convex of an actor that is to be drawn anew.
  struct Undrawn {
    std::uint32_t key = 0;
    ConvexSlot slot;
    auto operator<=>(const Undrawn&) const = default;
  };

  std::shared_ptr<MeshStore> store_ = std::make_shared<MeshStore>();
  bool published_ = false;        ///< A frame holds the store: copy before the next change.
  std::vector<Undrawn> undrawn_;  ///< Since the last draw().
};

}  // namespace sunder
