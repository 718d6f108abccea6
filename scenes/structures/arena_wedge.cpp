// A wedge of an arena.
//
// Read first: WedgeBuilder::build(). From the outside inwards, a bay has a wall of arches in
// storeys, with columns in front of it; a passage in every storey, up to an inner wall; and tiers
// of seats on walls along the radii, down to the parapet of the podium. Arcades and seats do not
// touch, so they are separate solids.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scenes/structures/arena.h"

namespace sunder::scenes {
namespace {

constexpr double kWall = 1.2;         // m, thickness of the outer wall
constexpr double kRecess = 0.12;      // m, recess of the wall behind the fronts of its piers
constexpr double kOpening = 0.31;     // half the width of an arch, of the width of a bay
constexpr double kVoussoir = 0.0875;  // thickness of an arch, of the width of a bay
constexpr double kSpandrel = 0.25;    // m, height of the wall over the crown of an arch
constexpr double kEntablature = 0.6;  // m, height
constexpr double kFloor = 0.35;       // m, thickness
constexpr double kPassage = 2.6;      // m, width
constexpr double kInnerWall = 0.5;    // m, thickness
constexpr double kArchitrave = 0.45;  // m, height of the beams on the columns of the gallery
constexpr double kTread = 0.85;       // m, depth of a tier
constexpr double kTierOverlap = 0.3;  // m, overlap of a tier with the one below
constexpr double kRadial = 0.35;      // m, half the thickness of the walls under the tiers
constexpr double kMaxCourse = 2.2;    // m, greatest height of a block
constexpr double kColumn = 0.27;      // m, radius

class WedgeBuilder {
 public:
  WedgeBuilder(const Arena& arena, const WedgePlan& plan)
      : arena_(arena), plan_(plan), options_{arena.detail, arena.stone.index} {}

  Parts build() {
    for (int k = 0; k <= arena_.bays; ++k) {
      const double angle = (k - 0.5 * arena_.bays) * plan_.bay_rad;
      append_moved(radial_frame(angle), radius_parts(k), parts_);
      if (k < arena_.bays)
        append_moved(radial_frame(angle + 0.5 * plan_.bay_rad), bay_parts(), parts_);
    }
    for (Part& part : parts_) part.anchored = bounds(part.polyhedron).min.y() < 1e-9;
    return std::move(parts_);
  }

 private:
  double floor_of(int storey) const { return storey * arena_.storey_m; }
  double top() const { return floor_of(arena_.storeys); }
  double gallery() const { return floor_of(arena_.storeys - 1); }
  double tier_y(int i) const { return kPodium + i * kRise; }
  double tier_z(int i) const { return plan_.seats + i * kTread; }

  /// Returns the parts on the k-th radius; at the wedge's edges, half of what two wedges share.
  Parts radius_parts(int k) const {
    Parts parts;
    const double left = k == 0 ? 0 : -1, right = k == arena_.bays ? 0 : 1;
    for (int s = 0; s < arena_.storeys; ++s) add_pier(floor_of(s), left, right, parts);
    add_radial_wall(left * kRadial, right * kRadial, parts);
    add_parapet_pier(left, right, parts);
    if (right == 0) return parts;  // the next wedge has the parts in front of and on the pier
    for (int s = 0; s < arena_.storeys; ++s) add_order(floor_of(s), s == 0 ? 0.7 : 0.25, parts);
    if (arena_.storeys > 1) add_gallery_column(parts);
    if (k == arena_.bays / 2) add_stairs(left, parts);
    return parts;
  }

  Parts bay_parts() const {
    Parts parts;
    for (int s = 0; s < arena_.storeys; ++s) {
      add_wall(floor_of(s), parts);
      add_floor(floor_of(s + 1), parts);
      if (s > 0) add_opening(floor_of(s), s % 2 == 1, parts);
    }
    add_balustrade(plan_.arch.shoulder_x(), top(), plan_.front - 0.25, parts);
    for (int s = 0; s + 1 < arena_.storeys; ++s) add_inner_wall(floor_of(s), parts);
    const double beam = top() - kFloor;
    if (arena_.storeys > 1) {
      parts.push_back(plan_.bay.bar(plan_.passage - kInnerWall, plan_.passage, beam - kArchitrave,
                                    beam, arena_.stone.index));
    }
    add_podium(parts);
    for (int i = 0; i < arena_.tiers; ++i) add_tier(i, parts);
    return parts;
  }

  /// Returns the distance at z from a radius to the place in the bay beside it that is
  /// `from_middle` from the middle of the bay.
  double pier_x(double from_middle, double z) const { return plan_.bay.half_width(z, from_middle); }

  void add_block(std::span<const Vec2> plan, double bottom, double top, Parts& parts) const {
    const int courses =
        std::max(1, static_cast<int>(std::ceil((top - bottom) / kMaxCourse - 1e-9)));
    const auto level = [&](int i) { return bottom + (top - bottom) * i / courses; };
    for (int i = 0; i < courses; ++i)
      parts.push_back({block(plan, level(i), level(i + 1)), arena_.wall.index});
  }

  std::array<Vec2, 4> pier_plan(double from_middle, double left, double right) const {
    const double z0 = plan_.outer - kWall, z1 = plan_.outer;
    const double x0 = pier_x(from_middle, z0), x1 = pier_x(from_middle, z1);
    return {Vec2(left * x0, z0), Vec2(right * x0, z0), Vec2(right * x1, z1), Vec2(left * x1, z1)};
  }

  /// Adds the pier between two arches; beside the voussoirs it is narrower by their thickness.
  void add_pier(double y, double left, double right, Parts& parts) const {
    const double spring = y + plan_.springing, shoulder = spring + plan_.arch.shoulder_y();
    add_block(pier_plan(plan_.opening, left, right), y, spring, parts);
    add_block(pier_plan(plan_.arch.outer_m(), left, right), spring, shoulder, parts);
    add_block(pier_plan(plan_.arch.shoulder_x(), left, right), shoulder, y + arena_.storey_m,
              parts);
  }

  /// Adds a column in front of a pier, and the block of the entablature on it.
  void add_order(double y, double pedestal, Parts& parts) const {
    const double axis = plan_.outer + 0.43, under = arena_.storey_m - kEntablature;
    append_moved({Vec3(0, y, axis), Quat::Identity()},
                 column({kColumn, under, pedestal, 3}, options_), parts);
    const double from = y + under, to = y + arena_.storey_m;
    constexpr double kReach = 0.14;  // m, projection of its cornice, which ends beside the wall's
    const double half = pier_x(plan_.arch.shoulder_x(), plan_.outer) - kReach - 0.01;
    parts.push_back(moulded_block(half, plan_.outer, axis + 0.36, entablature(0, from, to, kReach),
                                  arena_.stone.index));
  }

  /// Returns the profile (projection, height) of an entablature: architrave, frieze and cornice.
  std::vector<Vec2> entablature(double x, double from, double to, double reach) const {
    const int n = options_.arc();
    Profile p(0, 0);
    p.to(0, 0.16).to(0.1, 0.16).to(0.1, 0.3).curve({0.25, 0.32}, 0.25, 0.36, n);
    p.to(0.08, 0.36).to(0.08, 0.62).curve({0.15, 0.7}, 0.35, 0.72, n).to(0.6, 0.74);
    p.to(0.6, 0.8).curve({0.6, 0.88}, 0.8, 0.9, n).curve({1, 0.92}, 1, 1, n);
    std::vector<Vec2> points = p.points();
    for (Vec2& at : points) at = Vec2(x + reach * at.x(), from + (to - from) * at.y());
    return points;
  }

  /// Adds an arch between two piers, and the entablature over it.
  void add_wall(double y, Parts& parts) const {
    append_moved({Vec3(0, y + plan_.springing, 0), Quat::Identity()},
                 arched_wall(plan_.arch, options_, arena_.wall.index), parts);
    const double x = plan_.arch.shoulder_x(), from = y + arena_.storey_m - kEntablature;
    const double to = y + arena_.storey_m;
    for (const double side : {-1.0, 0.0})
      parts.push_back(
          slab({side * x, from, plan_.back}, {(side + 1) * x, to, plan_.front}, arena_.wall.index));
    const std::vector<Vec2> profile = entablature(0.06, from, to, 0.2);
    std::vector<Ring> rings(2);
    double most = 0;
    for (std::size_t end = 0; end < 2; ++end) {
      const double at = end == 0 ? -x : x;
      rings[end].emplace_back(at, from, plan_.front);
      for (const Vec2& p : profile) {
        rings[end].emplace_back(at, p.y(), plan_.front + p.x());
        most = std::max(most, p.x());
      }
      rings[end].emplace_back(at, to, plan_.front);
    }
    const ConvexPolyhedron region =
        make_box(Vec3(-x, from, plan_.front), Vec3(x, to, plan_.front + most));
    parts.push_back(lofted(rings, region, arena_.stone.index));
  }

  /// Adds the floor over the passage, from the outer wall to the inner one.
  void add_floor(double top, Parts& parts) const {
    const double inner = plan_.passage - (arena_.storeys > 1 ? kInnerWall : 0);
    parts.push_back(plan_.bay.bar(inner, plan_.back, top - kFloor, top, arena_.wall.index));
  }

  /// Adds the inner wall of a storey, with a door.
  void add_inner_wall(double y, Parts& parts) const {
    constexpr double kDoor = 0.55, kHead = 2.4;  // m, half the width and height of the door
    const double z0 = plan_.passage - kInnerWall, z1 = plan_.passage,
                 under = y + arena_.storey_m - kFloor;
    for (const double side : {-1.0, 1.0}) {
      const std::array plan = {Vec2(side * kDoor, z0), Vec2(side * plan_.bay.half_width(z0), z0),
                               Vec2(side * plan_.bay.half_width(z1), z1), Vec2(side * kDoor, z1)};
      add_block(plan, y, y + kHead, parts);
    }
    parts.push_back(plan_.bay.bar(z0, z1, y + kHead, under, arena_.wall.index));
  }

  /// Adds a statue or a balustrade in an arch of an upper storey.
  void add_opening(double y, bool has_statue, Parts& parts) const {
    const double z = plan_.front - 0.5;
    if (!has_statue) return add_balustrade(plan_.opening, y, z + 0.1, parts);
    const double height = std::min(2.1, 0.45 * (plan_.springing + plan_.opening));
    constexpr double kHalf = 0.5;  // m, half the width of the pedestal
    parts.push_back(slab({-kHalf, y, z - kHalf}, {kHalf, y + 0.7, z + kHalf}, arena_.stone.index));
    append_moved({Vec3(0, y + 0.7, z), Quat::Identity()}, {statue(height, options_)}, parts);
  }

  /// Adds balusters between two rails, from -x to x.
  void add_balustrade(double x, double y, double z, Parts& parts) const {
    constexpr double kFoot = 0.14, kHand = 0.14, kHeight = 0.95, kHalf = 0.14, kApart = 0.27;
    const double from = y + kFoot, to = y + kHeight - kHand;
    parts.push_back(slab({-x, y, z - kHalf}, {x, from, z + kHalf}, arena_.stone.index));
    const int count = std::max(1, static_cast<int>(2 * x / kApart));
    const Part one = baluster(to - from, options_);
    for (int i = 0; i < count; ++i)
      append_moved({Vec3(x * ((2 * i + 1.0) / count - 1), from, z), Quat::Identity()}, {one},
                   parts);
    parts.push_back(slab({-x, to, z - kHalf}, {x, to + kHand, z + kHalf}, arena_.stone.index));
  }

  /// Adds the pier of the parapet between two balustrades, with an urn on it.
  void add_parapet_pier(double left, double right, Parts& parts) const {
    constexpr double kHeight = 1.05;  // m
    const double z0 = plan_.outer - 0.6, z1 = plan_.outer;
    const double x0 = pier_x(plan_.arch.shoulder_x(), z0), x1 = pier_x(plan_.arch.shoulder_x(), z1);
    const std::array plan = {Vec2(left * x0, z0), Vec2(right * x0, z0), Vec2(right * x1, z1),
                             Vec2(left * x1, z1)};
    add_block(plan, top(), top() + kHeight, parts);
    if (right == 0) return;
    append_moved({Vec3(0, top() + kHeight, plan_.outer - 0.3), Quat::Identity()},
                 {urn(1.2, options_)}, parts);
  }

  void add_gallery_column(Parts& parts) const {
    const double z = (plan_.passage - 0.5 * kInnerWall) / plan_.bay.cosine();
    append_moved({Vec3(0, gallery(), z), Quat::Identity()},
                 column({0.25, arena_.storey_m - kFloor - kArchitrave, 0, 3}, options_), parts);
  }

  /// Adds the wall under the tiers, with their steps.
  void add_radial_wall(double left, double right, Parts& parts) const {
    const double wall = plan_.passage - kInnerWall;  // the inner wall's face, a straight line
    const double end =
        (wall - kRadial * plan_.bay.half_width(plan_.bay.cosine())) / plan_.bay.cosine() - 0.02;
    // Each step begins behind the convex of the tier below, whose back is straight.
    const auto edge = [&](int i) { return (tier_z(i) + kTierOverlap) / plan_.bay.cosine() + 0.01; };
    for (int i = 0; i < arena_.tiers; ++i) {
      const double z0 = edge(i), z1 = std::min(end, edge(i + 1));
      const std::array plan = {Vec2(left, z0), Vec2(right, z0), Vec2(right, z1), Vec2(left, z1)};
      add_block(plan, 0, tier_y(i), parts);
    }
  }

  /// Adds steps of half the height of a tier, for the stairs from tier to tier.
  void add_stairs(double left, Parts& parts) const {
    constexpr double kHalf = 0.5, kDepth = 0.38;                  // m
    const double clear = kHalf * plan_.bay.half_width(1) + 0.01;  // to the edge of the tier, an arc
    for (int i = 1; i < arena_.tiers; ++i) {
      const double z1 = tier_z(i) - clear, y = tier_y(i);
      parts.push_back(
          slab({left * kHalf, y, z1 - kDepth}, {kHalf, y + 0.5 * kRise, z1}, arena_.stone.index));
    }
  }

  /// Adds a tier of seats, with a rounded edge.
  void add_tier(int i, Parts& parts) const {
    const double z0 = tier_z(i), z1 = tier_z(i + 1) + kTierOverlap, y0 = tier_y(i),
                 y1 = tier_y(i + 1);
    const int n = options_.arc();
    Profile seat(z1, y1);
    seat.to(z0 + 0.05, y1).curve({z0, y1}, z0, y1 - 0.06, n);
    seat.curve({z0, y1 - 0.12}, z0 + 0.05, y1 - 0.13, n);
    seat.curve({z0 + 0.09, y1 - 0.2}, z0 + 0.09, y1 - 0.3, n).to(z0 + 0.09, y0).to(z1, y0);
    parts.push_back(plan_.bay.ring(seat, options_));
  }

  /// Adds the podium: a wall with a foot and a cornice, and a balustrade on it.
  void add_podium(Parts& parts) const {
    const double z0 = plan_.seats - 0.35, z1 = plan_.seats + kTierOverlap, half = 0.5 * kPodium;
    const int n = options_.arc();
    Profile foot(z1, half);
    foot.to(z0 + 0.08, half).to(z0 + 0.08, 0.4).curve({z0 + 0.08, 0.32}, z0, 0.3, n);
    parts.push_back(plan_.bay.ring(foot.to(z0, 0).to(z1, 0), options_));
    Profile top(z1, kPodium);
    top.to(z0 - 0.06, kPodium).curve({z0 - 0.06, kPodium - 0.14}, z0 + 0.02, kPodium - 0.16, n);
    top.curve({z0 + 0.08, kPodium - 0.18}, z0 + 0.08, kPodium - 0.26, n);
    parts.push_back(plan_.bay.ring(top.to(z0 + 0.08, half).to(z1, half), options_));
    constexpr double kHeight = 0.7, kApart = 0.26;  // m
    const double z = plan_.seats - 0.16;
    const int count = std::max(1, static_cast<int>(plan_.bay_rad * z / kApart));
    const Part one = baluster(kHeight, options_);
    for (int i = 0; i < count; ++i)
      append_moved(radial_frame(plan_.bay_rad * ((i + 0.5) / count - 0.5), 0, kPodium, z), {one},
                   parts);
    const double y = kPodium + kHeight;
    Profile rail(z + 0.12, y + 0.14);
    rail.to(z - 0.1, y + 0.14).curve({z - 0.15, y + 0.07}, z - 0.1, y, n).to(z + 0.12, y);
    parts.push_back(plan_.bay.ring(rail, options_));
  }

  const Arena& arena_;
  const WedgePlan& plan_;
  const StoneOptions options_;
  Parts parts_;
};

}  // namespace

WedgePlan::WedgePlan(const Arena& arena, double bay_rad)
    : bay_rad(bay_rad),
      bay(0.5 * bay_rad),
      outer(0.5 * arena.bay_m / bay.half_width(1)),
      front(outer * bay.cosine() - kRecess),
      back(front - kWall + 0.05),
      passage(back - kPassage),
      seats(passage - kInnerWall - kTierOverlap - 0.05 - arena.tiers * kTread),
      opening(kOpening * arena.bay_m) {
  const double voussoir = kVoussoir * arena.bay_m;
  arch = {opening, voussoir, opening + voussoir + kSpandrel, back, front};
  springing = arena.storey_m - kEntablature - arch.top_m;
}

Parts wedge(const Arena& arena, const WedgePlan& plan) { return WedgeBuilder(arena, plan).build(); }

}  // namespace sunder::scenes
