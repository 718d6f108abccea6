// Meshes of the actors. Internal to engine/world.
#pragma once

#include <memory>
#include <span>
#include <tuple>
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
  /// Frees memory at the end of a step: of requests for actors that are gone, and of meshes that
  /// neither this step nor the one before needs, on `actors` or as `others`; these become null.
  void tidy(const Actors& actors, std::span<const MeshIndex> others);
  /// Returns all meshes for a frame, which do not change afterwards.
  std::shared_ptr<const MeshStore> publish() const {
    return std::make_shared<const MeshStore>(store_);
  }

  static auto fields(auto& self) {
    return std::tie(self.store_, self.searched_, self.unused_, self.kept_, self.most_,
                    self.pending_, self.most_pending_);
  }
  /// Returns true if a mesh is in the store and has not been released.
  bool has(MeshIndex mesh) const { return mesh.value < store_.size() && store_[mesh.value]; }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field(const Actors& actors) const;
  /// Calls `visit(mesh)` for each mesh.
  template <class Visit>
  void for_each(const Visit& visit) const {
    store_.for_each([&](std::size_t i) { visit(*store_[i]); });
  }

 private:
  void free_unused(const Actors& actors, std::span<const MeshIndex> others);
  /// A convex whose mesh has been requested.
  struct Pending {
    std::uint32_t key = 0;
    ConvexSlot slot;
    auto operator<=>(const Pending&) const = default;
  };
  static std::vector<std::size_t> find_first_alike(std::span<const Pending> todo,
                                                   const Actors& actors);
  /// True if a request is of an actor that still needs it.
  static bool is_needed(const Actors& actors, const Pending& one);

  MeshStore store_;
  bool searched_ = false;              ///< True after the first search of a pair.
  std::vector<std::uint32_t> unused_;  ///< Meshes that the last search found unused; ascending.
  std::size_t kept_ = 0;               ///< Meshes that are not null.
  std::size_t most_ = 0;               ///< Number of them from which unused ones are sought.
  std::vector<Pending> pending_;       ///< Requests since the last draw().
  std::size_t most_pending_ = 0;       ///< Number of them from which unneeded ones are sought.
};

}  // namespace sunder
