// Meshes of the actors. Internal to engine/world.
#pragma once

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/world/actors/actors.h"

namespace sunder {

/// Mesh of a convex, and its hidden faces.
struct Drawn {
  MeshIndex mesh;  ///< none() if invisible.
  std::vector<std::uint8_t> hidden;
};
using DrawnConvexes = std::unordered_map<const Convex*, Drawn>;

/// All meshes of a run. New meshes are made by draw(), before a snapshot.
class Meshes {
 public:
  MeshIndex add(std::shared_ptr<const Mesh> mesh);
  /// Requests meshes for new actors; convexes with the same hidden faces as in `old` keep theirs.
  void add_to(std::span<Actor> actors, const DrawnConvexes& old);
  /// Requests new meshes for convexes of an actor whose hidden faces have changed; slots may be
  /// new.
  void update(Actor& actor, std::span<const ConvexSlot> slots);
  /// Replaces the mesh of a convex; null restores its own mesh.
  void override_mesh(Actor& actor, ConvexSlot slot, std::shared_ptr<const Mesh> mesh);
  /// Makes a convex invisible.
  void hide(Actor& actor, ConvexSlot slot) { actor.meshes[slot.value] = {}; }
  /// Makes the requested meshes.
  void draw(Actors& actors);
  /// Returns all meshes for a frame, which do not change afterwards. Those that neither this frame
  /// nor the one before draws, on `actors` or as `others`, may be null, to free memory.
  std::shared_ptr<const MeshStore> publish(const Actors& actors, std::span<const MeshIndex> others);

 private:
  MeshStore& changeable();
  void free_unused(const Actors& actors, std::span<const MeshIndex> others);

  /// A convex whose mesh has been requested.
  struct Pending {
    std::uint32_t key = 0;
    ConvexSlot slot;
    auto operator<=>(const Pending&) const = default;
  };

  std::shared_ptr<MeshStore> store_ = std::make_shared<MeshStore>();
  bool searched_ = false;             ///< True after the first search of a pair.
  std::vector<std::uint8_t> unused_;  ///< 1 for each mesh that the last search found unused.
  std::size_t kept_ = 0;              ///< Meshes that are not null.
  std::size_t most_ = 0;              ///< Number of them from which unused ones are sought.
  bool published_ = false;            ///< A frame shares the store: copy before a change.
  std::vector<Pending> pending_;      ///< Requests since the last draw().
};

}  // namespace sunder
