// Faces exposed by breaks, and chips, collected for the particles. Internal to engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/particles.h"
#include "engine/world/actors/actor.h"

namespace sunder {

struct WorldState;

/// Faces that breaks have exposed, and chips, since the particles last moved.
struct Exposed {
  /// A broken solid at the time of the break.
  struct Parent {
    Motion motion;
    double since_frame_start_s = 0;  ///< Time of the break.
  };
  struct Face {
    std::uint32_t parent = 0;     ///< Index in `parents`.
    std::uint32_t owner_key = 0;  ///< Key of the actor with the face; the actor may be gone.
    Vec3 normal_R = Vec3::UnitY();
    MaterialIndex material;
    std::size_t corners_end = 0;
  };
  std::vector<Parent> parents;
  std::vector<Face> faces;
  std::vector<Vec3> corners_R;
  std::vector<DebrisPiece> chips;  ///< Positions at the start of the frame.

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const {
    std::size_t end = 0;
    for (const Face& face : faces) {
      if (face.parent >= parents.size() || face.corners_end < end + 3 ||
          face.corners_end > corners_R.size())
        return "faces";
      end = face.corners_end;
    }
    return end == corners_R.size() ? nullptr : "corners_R";
  }

  /// Moves the time reference on by `time_s`, when the emission is delayed by a frame.
  void delay(double time_s);
};

/// Collects the faces that a break has exposed. `edit` has been applied to `structure`; its pieces
/// are the actors with these keys (kNoActorKey: too small for an actor).
void note_exposed(WorldState& world, const Structure& structure, const BreakEdit& edit,
                  const Motion& before, std::span<const std::uint32_t> piece_keys);
/// Collects a piece that is too small for a body.
void note_chip(WorldState& world, const Compound& piece, const Motion& motion);

}  // namespace sunder
