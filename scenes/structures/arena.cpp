// The structure `arena`: wedges of bays around an oval, and a temple in the middle.
//
// Read first: build_arena(), then arena_wedge.cpp. As in Roman arenas, the oval consists of arcs
// about four centres: two of 120° at its ends, and two of 60° and of a larger radius along its
// sides. All bays of an arc are equal, so there are only two kinds of wedges, and all wedges of a
// kind share their convexes. Each wedge is a solid of its own that is stable by itself.
#include "scenes/structures/arena.h"

#include <algorithm>
#include <numbers>

namespace sunder::scenes {
namespace {

void check_arena(const Arena& arena, const WedgePlan& end) {
  if (arena.ends > 2 * arena.sides) {
    throw InputError("arena: ends = " + format(arena.ends) + " would be less curved than sides = " +
                     format(arena.sides) + "; allowed: ends up to twice the sides");
  }
  if (end.springing < 1) {
    throw InputError("arena: storey_m = " + format(arena.storey_m) +
                     " is too low for arches of bay_m = " + format(arena.bay_m) +
                     "; make storeys higher, or bays narrower");
  }
  const double seats = kPodium + arena.tiers * kRise;
  const double floor = std::max(1, arena.storeys - 1) * arena.storey_m;
  if (seats > floor) {
    throw InputError("arena: tiers = " + format(arena.tiers) + " reach a height of " +
                     format(seats) + " m, above the gallery at " + format(floor) +
                     " m; use fewer tiers, or higher storeys");
  }
  if (end.seats < 2) {
    throw InputError("arena: tiers = " + format(arena.tiers) + " leave " + format(end.seats) +
                     " m from the middle of an end to the podium; allowed: at least 2 m. Use fewer "
                     "tiers, or more bays");
  }
}

/// Adds poses of an arc's wedges about `center`; `towards_rad` is the direction of its middle.
void add_copies(Piece& piece, int wedges, double arc_rad, double towards_rad, const Vec3& center) {
  for (int i = 0; i < wedges; ++i) {
    const double angle = towards_rad + arc_rad * ((i + 0.5) / wedges - 0.5);
    piece.copies.push_back({center, radial_frame(angle).rotation});
  }
}

std::vector<Piece> build_arena(const Arena& arena) {
  constexpr double kEnd = 2 * std::numbers::pi / 3, kSide = std::numbers::pi / 3;
  const WedgePlan end(arena, kEnd / (arena.ends * arena.bays));
  const WedgePlan side(arena, kSide / (arena.sides * arena.bays));
  check_arena(arena, end);
  const double half = 0.5 * (side.outer - end.outer);  // half the distance of the ends' centres
  const double rise = 2 * half * sin_cos(kSide).sin;
  std::vector<Piece> pieces = {{wedge(arena, end), Vec3::Zero(), {}},
                               {wedge(arena, side), Vec3::Zero(), {}}};
  for (const double sign : {-1.0, 1.0}) {
    add_copies(pieces[0], arena.ends, kEnd, sign * std::numbers::pi / 2, Vec3(sign * half, 0, 0));
    add_copies(pieces[1], arena.sides, kSide, sign < 0 ? std::numbers::pi : 0,
               Vec3(0, 0, -sign * rise));
  }
  if (arena.stand && end.seats > 9) {
    pieces.push_back(
        {stand({}, {arena.detail, arena.stone.index}, arena.wall.index), Vec3::Zero()});
  }
  for (const Piece& piece : pieces)
    check_parts(static_cast<double>(piece.parts.size() * piece.copies.size()));
  return pieces;
}

}  // namespace

StructureType arena_structure() {
  return make_structure<Arena, build_arena>(
      "arena",
      "A Roman arena: arcades around tiers of seats, and a round temple; the long axis is x.",
      {key<&Arena::ends>("ends", "", Range{1, 20},
                         "Number of wedges at each end; each is a solid."),
       key<&Arena::sides>("sides", "", Range{1, 20}, "Number of wedges at each side."),
       key<&Arena::bays>("bays", "", Range{1, 20}, "Number of bays in a wedge."),
       key<&Arena::bay_m>("bay_m", "m", Range{3, 8}, "Outer width of a bay."),
       key<&Arena::storeys>("storeys", "", Range{1, 6}, "Number of storeys of the outer wall."),
       key<&Arena::storey_m>("storey_m", "m", Range{3, 12}, "Height of a storey."),
       key<&Arena::tiers>("tiers", "", Range{1, 60}, "Number of tiers of seats."),
       key<&Arena::detail>("detail", "", Range{8, 160},
                           "Number of sides of round parts that are drawn."),
       key<&Arena::stand>("stand", "true: a temple in the middle, where there is room."),
       key<&Arena::stone>("stone", "Material of columns, arches and seats."),
       key<&Arena::wall>("wall", "Material of walls and floors.")});
}

}  // namespace sunder::scenes
