// What an arena is made of: wedges of bays, and a stand. Internal to the arena.
#pragma once

#include "scenes/structures/arena_members.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {

struct Arena {
  int ends = 8;
  int sides = 6;
  int bays = 2;
  double bay_m = 4;
  int storeys = 3;
  double storey_m = 5.4;
  int tiers = 14;
  int detail = 28;
  bool stand = true;
  MaterialRef stone{"marble", {}};
  MaterialRef wall{"stone", {}};
};

constexpr double kPodium = 2.2;  // m, height
constexpr double kRise = 0.55;   // m, height of a tier

/// A wedge in numbers: radii are about the middle of its arc.
struct WedgePlan {
  WedgePlan(const Arena& arena, double bay_rad);

  double bay_rad;
  Bay bay;
  double outer;    ///< The fronts of the piers.
  double front;    ///< Of the wall between them, at the middle of a bay; as those below.
  double back;     ///< Of that wall.
  double passage;  ///< The outer face of the inner wall.
  double seats;    ///< The edge of the lowest tier, along an arc.
  double opening;  ///< Half the width of an arch.
  ArchedWall arch;
  double springing;  ///< Of an arch, over its floor.
};
/// `arena.bays` bays, the middle at z; the world holds what stands on the ground.
Parts wedge(const Arena& arena, const WedgePlan& plan);

/// A temple on a round stand, its middle at the origin.
struct Stand {
  double radius_m = 6;
  double height_m = 2.2;
  double column_m = 4.4;
  int columns = 12;
};
Parts stand(const Stand& stand, const Chisel& chisel, MaterialIndex wall);

}  // namespace sunder::scenes
