// What breaks laid bare, on its way to the particles. Internal to engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/particles.h"
#include "engine/world/actors/actor.h"

namespace sunder {

struct World;

/// What breaks laid bare since the particles last moved.
struct Exposed {
  /// The solid that a break took apart, as it was then.
  struct Parent {
    Motion motion;
    double back_s = 0;  ///< Since this frame began.
  };
  struct Face {
    std::uint32_t parent = 0;     ///< Index in `parents`.
    std::uint32_t owner_key = 0;  ///< The actor that it is a face of; none may have this key.
    Vec3 normal_R = Vec3::UnitY();
    MaterialIndex material;
    std::size_t corners_end = 0;
  };
  std::vector<Parent> parents;
  std::vector<Face> faces;
  std::vector<Vec3> corners_R;
  std::vector<Chip> chips;  ///< Where they were when this frame began.

  /// It goes on as it moves for that long, unseen.
  void wait(double time_s);
};

/// Notes what a break laid bare, once it is carried out: `edit` was applied to `structure`, and its
/// pieces are the actors with these keys (kNoActorKey: too small for one).
void note_exposed(World& world, const Structure& structure, const BreakEdit& edit,
                  const Motion& before, std::span<const std::uint32_t> piece_keys);
/// Notes a piece that is too small to be a body.
void note_chip(World& world, const Compound& piece, const Motion& motion);

}  // namespace sunder
