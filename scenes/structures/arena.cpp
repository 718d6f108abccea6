// An arena: wedges of bays around an oval, and a stand with a temple in its middle.
//
// Read first: build_arena(), then WedgeBuilder::build(). As Roman builders laid them out, the oval
// is drawn from four centres: two arcs of 120° at its ends, two of 60° and of a larger radius along
// its sides. All bays of an arc are alike, so there are but two kinds of wedges, and all of a kind
// share their convexes. Wedges are solids of their own, that stand by themselves.
//
// From the outside inwards, a bay has a wall of arches in storeys, with columns before it; a
// passage, storey over storey, up to an inner wall; and tiers of seats on walls that run along the
// radii, down to the parapet of the podium.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/structures/arena_bay.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct Arena {
  int ends = 4;
  int sides = 3;
  int bays = 4;
  double bay_m = 4;
  int storeys = 3;
  double storey_m = 5.4;
  int tiers = 14;
  int detail = 40;
  bool stand = true;
  MaterialRef stone{"marble", {}};
  MaterialRef wall{"stone", {}};
};

constexpr double kWall = 1.2;         // m, thickness of the outer wall
constexpr double kRecess = 0.12;      // m, of the wall behind its piers
constexpr double kOpening = 0.31;     // of a bay: half the width of an arch
constexpr double kVoussoir = 0.0875;  // of a bay: thickness of an arch
constexpr double kSpandrel = 0.25;    // m, over an arch
constexpr double kEntablature = 0.6;  // m, height
constexpr double kFloor = 0.35;       // m, thickness
constexpr double kPassage = 2.6;      // m, width
constexpr double kInnerWall = 0.5;    // m, thickness
constexpr double kBeam = 0.45;        // m, height of those on the columns of the gallery
constexpr double kTread = 0.85;       // m, depth of a tier
constexpr double kRise = 0.55;        // m, height of a tier
constexpr double kLap = 0.3;          // m, by which a tier lies on the one below
constexpr double kPodium = 2.2;       // m, height
constexpr double kRadial = 0.35;      // m, half the thickness of the walls under the tiers
constexpr double kCourse = 2.2;       // m, most height of a block
constexpr double kColumn = 0.27;      // m, radius

/// The parts of a wedge: `bays` bays, its middle at z.
class WedgeBuilder {
 public:
  WedgeBuilder(const Arena& arena, double bay_rad)
      : arena_(arena),
        chisel_{arena.detail, arena.stone.index},
        bay_rad_(bay_rad),
        bay_(0.5 * bay_rad),
        outer_(0.5 * arena.bay_m / (bay_.flank(1))),
        front_(outer_ * bay_.cosine() - kRecess),
        back_(front_ - kWall + 0.05),
        passage_(back_ - kPassage),
        seats_(passage_ - kInnerWall - kLap - 0.05 - arena.tiers * kTread),
        opening_(kOpening * arena.bay_m),
        voussoir_(kVoussoir * arena.bay_m) {
    arch_ = {opening_, voussoir_, opening_ + voussoir_ + kSpandrel, back_, front_};
  }

  /// From the middle of the arc to the podium.
  double inner_m() const { return seats_; }
  double outer_m() const { return outer_; }
  /// Of an arch's springing over its floor.
  double springing_m() const { return arena_.storey_m - kEntablature - arch_.top_m; }

  Parts build() {
    for (int k = 0; k <= arena_.bays; ++k) {
      const double angle = (k - 0.5 * arena_.bays) * bay_rad_;
      move_to(ray(angle), radius(k), parts_);
      if (k < arena_.bays) move_to(ray(angle + 0.5 * bay_rad_), bay(), parts_);
    }
    for (Part& part : parts_) part.anchored = bounds(part.polyhedron).min.y() < 1e-9;
    return std::move(parts_);
  }

 private:
  double floor_of(int storey) const { return storey * arena_.storey_m; }
  double top() const { return floor_of(arena_.storeys); }
  double gallery() const { return floor_of(arena_.storeys - 1); }
  double tier_y(int i) const { return kPodium + i * kRise; }
  double tier_z(int i) const { return seats_ + i * kTread; }

  /// On a radius, the k-th of the wedge: at its edges, half of what two wedges have in common.
  Parts radius(int k) const {
    Parts parts;
    const double left = k == 0 ? 0 : -1, right = k == arena_.bays ? 0 : 1;
    for (int s = 0; s < arena_.storeys; ++s) add_pier(floor_of(s), left, right, parts);
    add_radial_wall(left * kRadial, right * kRadial, parts);
    add_parapet_pier(left, right, parts);
    if (right == 0) return parts;  // the next wedge has what stands before and on it
    for (int s = 0; s < arena_.storeys; ++s) add_order(floor_of(s), s == 0 ? 0.7 : 0.25, parts);
    if (arena_.storeys > 1) add_gallery_column(parts);
    if (k == arena_.bays / 2) add_stairs(left, parts);
    return parts;
  }

  Parts bay() const {
    Parts parts;
    for (int s = 0; s < arena_.storeys; ++s) {
      add_wall(floor_of(s), parts);
      add_floor(floor_of(s + 1), parts);
      if (s > 0) add_opening(floor_of(s), s % 2 == 1, parts);
    }
    add_balustrade(arch_.shoulder_x(), top(), front_ - 0.25, parts);
    for (int s = 0; s + 1 < arena_.storeys; ++s) add_inner_wall(floor_of(s), parts);
    const double beam = top() - kFloor;
    if (arena_.storeys > 1) {
      parts.push_back(
          bay_.bar(passage_ - kInnerWall, passage_, beam - kBeam, beam, arena_.stone.index));
    }
    add_podium(parts);
    for (int i = 0; i < arena_.tiers; ++i) add_tier(i, parts);
    return parts;
  }

  /// From a radius to where, in the bay beside it, x is `from_middle`.
  double pier_x(double from_middle, double z) const { return bay_.flank(z, from_middle); }

  void add_block(std::span<const Vec2> plan, double bottom, double top, Parts& parts) const {
    const int courses = std::max(1, static_cast<int>(std::ceil((top - bottom) / kCourse - 1e-9)));
    const auto level = [&](int i) { return bottom + (top - bottom) * i / courses; };
    for (int i = 0; i < courses; ++i)
      parts.push_back({block(plan, level(i), level(i + 1)), arena_.wall.index});
  }

  std::array<Vec2, 4> pier_plan(double from_middle, double left, double right) const {
    const double z0 = outer_ - kWall, z1 = outer_;
    const double x0 = pier_x(from_middle, z0), x1 = pier_x(from_middle, z1);
    return {Vec2(left * x0, z0), Vec2(right * x0, z0), Vec2(right * x1, z1), Vec2(left * x1, z1)};
  }

  /// Between two arches; beside the voussoirs it is narrower by them.
  void add_pier(double y, double left, double right, Parts& parts) const {
    const double spring = y + springing_m(), shoulder = spring + arch_.shoulder_y();
    add_block(pier_plan(opening_, left, right), y, spring, parts);
    add_block(pier_plan(arch_.outer_m(), left, right), spring, shoulder, parts);
    add_block(pier_plan(arch_.shoulder_x(), left, right), shoulder, y + arena_.storey_m, parts);
  }

  /// A column before a pier, and the block of the entablature on it.
  void add_order(double y, double pedestal, Parts& parts) const {
    const double axis = outer_ + 0.43, under = arena_.storey_m - kEntablature;
    move_to({Vec3(0, y, axis), Quat::Identity()},
            column({kColumn, under, pedestal, 3}, chisel_), parts);
    const double from = y + under, to = y + arena_.storey_m;
    constexpr double kReach = 0.14;  // m, of its cornice: it ends beside those of the wall
    const double half = pier_x(arch_.shoulder_x(), outer_) - kReach - 0.01;
    parts.push_back(moulded_block(half, outer_, axis + 0.36,
                                  entablature(0, from, to, kReach), arena_.stone.index));
  }

  /// How far it stands out at a height: architrave, frieze and cornice.
  std::vector<Vec2> entablature(double x, double from, double to, double reach) const {
    const int n = chisel_.arc();
    Profile p(0, 0);
    p.to(0, 0.16).to(0.1, 0.16).to(0.1, 0.3).curve({0.25, 0.32}, 0.25, 0.36, n);
    p.to(0.08, 0.36).to(0.08, 0.62).curve({0.15, 0.7}, 0.35, 0.72, n).to(0.6, 0.74);
    p.to(0.6, 0.8).curve({0.6, 0.88}, 0.8, 0.9, n).curve({1, 0.92}, 1, 1, n);
    std::vector<Vec2> points = p.points();
    for (Vec2& at : points) at = Vec2(x + reach * at.x(), from + (to - from) * at.y());
    return points;
  }

  /// An arch between its piers, and the entablature over it.
  void add_wall(double y, Parts& parts) const {
    move_to({Vec3(0, y + springing_m(), 0), Quat::Identity()},
            arched_wall(arch_, chisel_, arena_.wall.index), parts);
    const double x = arch_.shoulder_x(), from = y + arena_.storey_m - kEntablature;
    const double to = y + arena_.storey_m;
    for (const double side : {-1.0, 0.0})
      parts.push_back(slab({side * x, from, back_}, {(side + 1) * x, to, front_}, arena_.wall.index));
    const std::vector<Vec2> profile = entablature(0.06, from, to, 0.2);
    std::vector<Ring> rings(2);
    double most = 0;
    for (std::size_t end = 0; end < 2; ++end) {
      const double at = end == 0 ? -x : x;
      rings[end].emplace_back(at, from, front_);
      for (const Vec2& p : profile) {
        rings[end].emplace_back(at, p.y(), front_ + p.x());
        most = std::max(most, p.x());
      }
      rings[end].emplace_back(at, to, front_);
    }
    const ConvexPolyhedron region = make_box(Vec3(-x, from, front_), Vec3(x, to, front_ + most));
    parts.push_back(lofted(rings, region, arena_.stone.index));
  }

  /// Over the passage, from the outer wall to the inner one.
  void add_floor(double top, Parts& parts) const {
    const double inner = passage_ - (arena_.storeys > 1 ? kInnerWall : 0);
    parts.push_back(bay_.bar(inner, back_, top - kFloor, top, arena_.wall.index));
  }

  /// With a door in it.
  void add_inner_wall(double y, Parts& parts) const {
    constexpr double kDoor = 0.55, kHead = 2.4;  // m, half the width; height
    const double z0 = passage_ - kInnerWall, z1 = passage_, under = y + arena_.storey_m - kFloor;
    for (const double side : {-1.0, 1.0}) {
      const std::array plan = {Vec2(side * kDoor, z0), Vec2(side * bay_.flank(z0), z0),
                               Vec2(side * bay_.flank(z1), z1), Vec2(side * kDoor, z1)};
      add_block(plan, y, y + kHead, parts);
    }
    parts.push_back(bay_.bar(z0, z1, y + kHead, under, arena_.wall.index));
  }

  /// In an upper arch: a statue, or a balustrade.
  void add_opening(double y, bool has_statue, Parts& parts) const {
    const double z = front_ - 0.5;
    if (!has_statue) return add_balustrade(opening_, y, z + 0.1, parts);
    const double height = std::min(2.1, 0.45 * (springing_m() + opening_));
    constexpr double kHalf = 0.5;  // m, of its pedestal
    parts.push_back(slab({-kHalf, y, z - kHalf}, {kHalf, y + 0.7, z + kHalf}, arena_.stone.index));
    move_to({Vec3(0, y + 0.7, z), Quat::Identity()}, {statue(height, chisel_)}, parts);
  }

  /// Balusters between two rails, from -x to x.
  void add_balustrade(double x, double y, double z, Parts& parts) const {
    constexpr double kFoot = 0.14, kHand = 0.14, kHeight = 0.95, kHalf = 0.14, kApart = 0.27;
    const double from = y + kFoot, to = y + kHeight - kHand;
    parts.push_back(slab({-x, y, z - kHalf}, {x, from, z + kHalf}, arena_.stone.index));
    const int count = std::max(1, static_cast<int>(2 * x / kApart));
    const Part one = baluster(to - from, chisel_);
    for (int i = 0; i < count; ++i)
      move_to({Vec3(x * ((2 * i + 1.0) / count - 1), from, z), Quat::Identity()}, {one}, parts);
    parts.push_back(slab({-x, to, z - kHalf}, {x, to + kHand, z + kHalf}, arena_.stone.index));
  }

  /// On a pier, between two balustrades; an urn on it.
  void add_parapet_pier(double left, double right, Parts& parts) const {
    constexpr double kHeight = 1.05;  // m
    const double z0 = outer_ - 0.6, z1 = outer_;
    const double x0 = pier_x(arch_.shoulder_x(), z0), x1 = pier_x(arch_.shoulder_x(), z1);
    const std::array plan = {Vec2(left * x0, z0), Vec2(right * x0, z0), Vec2(right * x1, z1),
                             Vec2(left * x1, z1)};
    add_block(plan, top(), top() + kHeight, parts);
    if (right == 0) return;
    move_to({Vec3(0, top() + kHeight, outer_ - 0.3), Quat::Identity()}, {urn(1.2, chisel_)}, parts);
  }

  void add_gallery_column(Parts& parts) const {
    const double z = (passage_ - 0.5 * kInnerWall) / bay_.cosine();
    move_to({Vec3(0, gallery(), z), Quat::Identity()},
            column({0.25, arena_.storey_m - kFloor - kBeam, 0, 3}, chisel_), parts);
  }

  /// Under the tiers, in steps as they are.
  void add_radial_wall(double left, double right, Parts& parts) const {
    const double wall = passage_ - kInnerWall;  // which is straight from radius to radius
    const double end = (wall - kRadial * bay_.flank(bay_.cosine())) / bay_.cosine() - 0.02;
    // Beyond the tiers' convexes, which are straight at the back.
    const auto edge = [&](int i) { return (tier_z(i) + kLap) / bay_.cosine() + 0.01; };
    for (int i = 0; i < arena_.tiers; ++i) {
      const double z0 = edge(i), z1 = std::min(end, edge(i + 1));
      const std::array plan = {Vec2(left, z0), Vec2(right, z0), Vec2(right, z1), Vec2(left, z1)};
      add_block(plan, 0, tier_y(i), parts);
    }
  }

  /// Half steps, from tier to tier.
  void add_stairs(double left, Parts& parts) const {
    constexpr double kHalf = 0.5, kDepth = 0.38;  // m
    const double clear = kHalf * bay_.flank(1) + 0.01;  // of the tier, which turns away
    for (int i = 1; i < arena_.tiers; ++i) {
      const double z1 = tier_z(i) - clear, y = tier_y(i);
      parts.push_back(slab({left * kHalf, y, z1 - kDepth}, {kHalf, y + 0.5 * kRise, z1},
                           arena_.stone.index));
    }
  }

  /// A seat, with a round edge.
  void add_tier(int i, Parts& parts) const {
    const double z0 = tier_z(i), z1 = tier_z(i + 1) + kLap, y0 = tier_y(i), y1 = tier_y(i + 1);
    const int n = chisel_.arc();
    Profile seat(z1, y1);
    seat.to(z0 + 0.05, y1).curve({z0, y1}, z0, y1 - 0.06, n);
    seat.curve({z0, y1 - 0.12}, z0 + 0.05, y1 - 0.13, n);
    seat.curve({z0 + 0.09, y1 - 0.2}, z0 + 0.09, y1 - 0.3, n).to(z0 + 0.09, y0).to(z1, y0);
    parts.push_back(bay_.ring(seat, chisel_));
  }

  /// A wall with a foot and a cornice, and a balustrade on it.
  void add_podium(Parts& parts) const {
    const double z0 = seats_ - 0.35, z1 = seats_ + kLap, half = 0.5 * kPodium;
    const int n = chisel_.arc();
    Profile foot(z1, half);
    foot.to(z0 + 0.08, half).to(z0 + 0.08, 0.4).curve({z0 + 0.08, 0.32}, z0, 0.3, n);
    parts.push_back(bay_.ring(foot.to(z0, 0).to(z1, 0), chisel_));
    Profile top(z1, kPodium);
    top.to(z0 - 0.06, kPodium).curve({z0 - 0.06, kPodium - 0.14}, z0 + 0.02, kPodium - 0.16, n);
    top.curve({z0 + 0.08, kPodium - 0.18}, z0 + 0.08, kPodium - 0.26, n);
    parts.push_back(bay_.ring(top.to(z0 + 0.08, half).to(z1, half), chisel_));
    constexpr double kHeight = 0.7, kApart = 0.26;  // m
    const double z = seats_ - 0.16;
    const int count = std::max(1, static_cast<int>(bay_rad_ * z / kApart));
    const Part one = baluster(kHeight, chisel_);
    for (int i = 0; i < count; ++i)
      move_to(ray(bay_rad_ * ((i + 0.5) / count - 0.5), 0, kPodium, z), {one}, parts);
    const double y = kPodium + kHeight;
    Profile rail(z + 0.12, y + 0.14);
    rail.to(z - 0.1, y + 0.14).curve({z - 0.15, y + 0.07}, z - 0.1, y, n).to(z + 0.12, y);
    parts.push_back(bay_.ring(rail, chisel_));
  }

  const Arena& arena_;
  const Chisel chisel_;
  const double bay_rad_;
  const Bay bay_;
  const double outer_;    ///< The fronts of the piers.
  const double front_;    ///< Of the wall between them, at the middle of a bay; as those below.
  const double back_;     ///< Of that wall.
  const double passage_;  ///< The outer face of the inner wall.
  const double seats_;    ///< The edge of the lowest tier, along an arc.
  const double opening_, voussoir_;
  ArchedWall arch_;
  Parts parts_;
};

void check_arena(const Arena& arena, const WedgeBuilder& end) {
  if (arena.ends > 2 * arena.sides) {
    throw InputError("arena: ends = " + format(arena.ends) + " would be flatter than sides = " +
                     format(arena.sides) + "; allowed: ends up to twice the sides");
  }
  if (end.springing_m() < 1) {
    throw InputError("arena: storey_m = " + format(arena.storey_m) + " is too low for arches of bay_m = " +
                     format(arena.bay_m) + "; make storeys higher, or bays narrower");
  }
  const double seats = kPodium + arena.tiers * kRise;
  const double floor = std::max(1, arena.storeys - 1) * arena.storey_m;
  if (seats > floor) {
    throw InputError("arena: tiers = " + format(arena.tiers) + " reach up to " + format(seats) +
                     " m, above the gallery at " + format(floor) +
                     " m; ask for fewer, or for higher storeys");
  }
  if (end.inner_m() < 2) {
    throw InputError("arena: tiers = " + format(arena.tiers) + " leave " + format(end.inner_m()) +
                     " m from the middle of an end to the podium; allowed: 2 m or more. Ask for "
                     "fewer, or for more bays");
  }
}

/// So many wedges of an arc around its centre, on the left or the right of it.
void add_copies(Piece& piece, int wedges, double arc_rad, double towards_rad, const Vec3& center) {
  for (int i = 0; i < wedges; ++i) {
    const double angle = towards_rad + arc_rad * ((i + 0.5) / wedges - 0.5);
    piece.copies.push_back({center, ray(angle).rotation});
  }
}

std::vector<Piece> build_arena(const Arena& arena) {
  constexpr double kEnd = 2 * std::numbers::pi / 3, kSide = std::numbers::pi / 3;
  WedgeBuilder end(arena, kEnd / (arena.ends * arena.bays));
  WedgeBuilder side(arena, kSide / (arena.sides * arena.bays));
  check_arena(arena, end);
  const double half = 0.5 * (side.outer_m() - end.outer_m());  // between the centres of the ends
  const double rise = 2 * half * sin_cos(kSide).sin;
  const double inner_m = end.inner_m();
  std::vector<Piece> pieces = {{end.build(), Vec3::Zero(), {}}, {side.build(), Vec3::Zero(), {}}};
  for (const double hand : {-1.0, 1.0}) {
    add_copies(pieces[0], arena.ends, kEnd, hand * std::numbers::pi / 2, Vec3(hand * half, 0, 0));
    add_copies(pieces[1], arena.sides, kSide, hand < 0 ? std::numbers::pi : 0,
               Vec3(0, 0, -hand * rise));
  }
  if (arena.stand && inner_m > 9) {
    pieces.push_back({stand({}, {arena.detail, arena.stone.index}, arena.wall.index), Vec3::Zero()});
  }
  for (const Piece& piece : pieces)
    check_parts(static_cast<double>(piece.parts.size() * piece.copies.size()));
  return pieces;
}

}  // namespace

StructureType arena_structure() {
  return make_structure<Arena, build_arena>(
      "arena",
      "A Roman arena: arcades around tiers of seats, and a round temple; its long axis along x.",
      {key<&Arena::ends>("ends", "", Range{1, 20}, "Wedges at either end, each a solid."),
       key<&Arena::sides>("sides", "", Range{1, 20}, "Wedges at either side."),
       key<&Arena::bays>("bays", "", Range{1, 20}, "Bays of a wedge."),
       key<&Arena::bay_m>("bay_m", "m", Range{3, 8}, "Width of a bay, outside."),
       key<&Arena::storeys>("storeys", "", Range{1, 6}, "Storeys of the outer wall."),
       key<&Arena::storey_m>("storey_m", "m", Range{3, 12}, "Height of a storey."),
       key<&Arena::tiers>("tiers", "", Range{1, 60}, "Tiers of seats."),
       key<&Arena::detail>("detail", "", Range{8, 160}, "Sides of what is drawn round."),
       key<&Arena::stand>("stand", "Whether a temple stands in the middle, where there is room."),
       key<&Arena::stone>("stone", "What is carved: columns, arches, seats."),
       key<&Arena::wall>("wall", "What walls and floors are made of.")});
}

}  // namespace sunder::scenes
