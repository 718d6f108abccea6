// The parts of an arena: wedges of bays, and a temple in the middle. Internal to the arena.
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

constexpr double kPodium = 2.2;  // m, height of the wall below the lowest tier
constexpr double kRise = 0.55;   // m, height of a tier

/// The dimensions of a wedge, in m; radii are about the centre of its arc.
struct WedgePlan {
  WedgePlan(const Arena& arena, double bay_rad);

  double bay_rad;
  Bay bay;
  double outer;    ///< Radius of the fronts of the piers.
  double front;    ///< Radius of the front of the wall between piers, at the middle of a bay.
  double back;     ///< Radius of the back of this wall, at the middle of a bay.
  double passage;  ///< Radius of the outer face of the inner wall, at the middle of a bay.
  double seats;    ///< Radius of the edge of the lowest tier, which is an arc.
  double opening;  ///< Half the width of an arch.
  ArchedWall arch;
  double springing;  ///< Height of an arch's springing over its floor.
};
/// Returns `arena.bays` bays, centred on the z-axis; parts at the ground are anchored.
Parts wedge(const Arena& arena, const WedgePlan& plan);

/// A round temple on a stepped base.
struct Stand {
  double radius_m = 6;
  double height_m = 2.2;
  double column_m = 4.4;
  int columns = 12;
};
/// Returns the parts of a temple, its axis at x = z = 0.
Parts stand(const Stand& stand, const StoneOptions& options, MaterialIndex wall);

}  // namespace sunder::scenes
