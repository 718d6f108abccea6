// Read first: column(), arched_wall().
#include "scenes/structures/arena_members.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "scenes/file/moved_part.h"

namespace sunder::scenes {
namespace {

constexpr int kDrumSides = 16, kBalusterSides = 8;

/// Returns a solid of revolution whose convex is a prism with `sides` sides.
Part turned_part(std::span<const Vec2> outline, std::span<const Vec2> profile, int sides,
                 MaterialIndex material) {
  const std::vector<Ring> rings = turned(outline, profile);
  return lofted(rings, prism_around(rings, sides), material);
}

std::vector<Vec2> shifted(std::vector<Vec2> profile, double up) {
  for (Vec2& p : profile) p.y() += up;
  return profile;
}

/// Returns the profile of a column's base: a torus, a scotia and a second torus.
std::vector<Vec2> base_profile(double r, double from, int n) {
  Profile base(1.28 * r, 0);
  base.curve({1.48 * r, 0}, 1.48 * r, 0.15 * r, n).curve({1.48 * r, 0.3 * r}, 1.3 * r, 0.3 * r, n);
  base.to(1.2 * r, 0.33 * r).curve({1.08 * r, 0.36 * r}, 1.09 * r, 0.45 * r, n);
  base.curve({1.1 * r, 0.52 * r}, 1.18 * r, 0.54 * r, n).to(1.2 * r, 0.57 * r);
  base.curve({1.31 * r, 0.57 * r}, 1.31 * r, 0.67 * r, n);
  base.curve({1.31 * r, 0.77 * r}, 1.12 * r, 0.77 * r, n).to(1.02 * r, 0.8 * r);
  return shifted(base.points(), from);
}

/// Returns the profile of a column's capital: a neck with a ring about it, and an echinus.
std::vector<Vec2> capital_profile(double r, double from, int n) {
  Profile capital(0.84 * r, 0);
  capital.to(0.9 * r, 0.02 * r).curve({0.98 * r, 0.02 * r}, 0.98 * r, 0.09 * r, n);
  capital.curve({0.98 * r, 0.16 * r}, 0.86 * r, 0.16 * r, n).to(0.86 * r, 0.4 * r);
  capital.to(0.94 * r, 0.42 * r).to(0.94 * r, 0.48 * r);
  capital.curve({1.3 * r, 0.52 * r}, 1.4 * r, 0.84 * r, 2 * n);
  return shifted(capital.points(), from);
}

/// Adds the drums of a tapering shaft; its flutes end below the capital and above the base.
void add_shaft(const Column& column, double from, double to, const StoneOptions& options,
               Parts& parts) {
  constexpr int kFlutes = 20;
  const int segments = std::max(1, options.detail / 8);
  const auto outline = [&](double depth) { return fluted(kFlutes, segments, depth); };
  const auto radius = [&](double y) {
    const double t = (y - from) / (to - from);
    return column.radius_m * (1 - 0.16 * t * t);
  };
  const double length = (to - from) / column.drums;
  for (int i = 0; i < column.drums; ++i) {
    std::vector<Vec2> levels = {{1, from + i * length}};  // relative depth of the flutes, height
    if (i == 0) {
      levels = {{0, from}, {0, from + 0.15 * column.radius_m}};
      for (const double t : {0.15, 0.5, 1.0})
        levels.emplace_back(t, from + (0.15 + 0.3 * t * t) * column.radius_m);
    }
    if (i + 1 == column.drums) {
      for (const double t : {1.0, 0.5, 0.15})
        levels.emplace_back(t, to - (0.15 + 0.3 * t * t) * column.radius_m);
      levels.emplace_back(0, to - 0.15 * column.radius_m);
      levels.emplace_back(0, to);
    } else {
      levels.emplace_back(1, from + (i + 1) * length);
    }
    std::vector<Ring> rings;
    for (const Vec2& level : levels) {
      const Vec2 size(radius(level.y()), level.y());
      rings.push_back(turned(outline(0.09 * level.x()), std::span(&size, 1))[0]);
    }
    parts.push_back(lofted(rings, prism_around(rings, kDrumSides), options.stone));
  }
}

Vec2 on_circle(double radius, double angle_rad) {
  const SinCos turn = sin_cos(angle_rad);
  return {radius * turn.cos, radius * turn.sin};
}

/// Returns the rings of a polygon of (x, y) that is extruded along z.
std::vector<Ring> drawn_out(std::span<const Vec2> outline, double back, double front) {
  std::vector<Ring> rings(2);
  for (const Vec2& p : outline) {
    rings[0].emplace_back(p.x(), p.y(), back);
    rings[1].emplace_back(p.x(), p.y(), front);
  }
  return rings;
}

ConvexPolyhedron hull_of(const std::vector<Ring>& rings) {
  std::vector<Vec3> points;
  for (const Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  return make_hull(points);
}

/// One stone of an arch, between joints at two angles.
struct Voussoir {
  const ArchedWall& arch;
  double from_rad, to_rad;

  Vec2 at(double radius, double share) const {
    return on_circle(radius, from_rad + share * (to_rad - from_rad));
  }
  /// Returns the outer corners of the outline; the end stones extend down to the piers.
  std::vector<Vec2> back() const {
    const double outer = arch.outer_m();
    if (from_rad == 0) return {{outer, 0}, {outer, arch.shoulder_y()}, at(outer, 1)};
    if (to_rad == std::numbers::pi) return {at(outer, 0), {-outer, arch.shoulder_y()}, {-outer, 0}};
    return {at(outer, 0), at(outer, 1)};
  }
  Part stone(const StoneOptions& options) const {
    std::vector<Vec2> outline = back(), corners = outline;
    const int segments = std::max(1, options.detail / 6);
    for (int i = segments; i >= 0; --i)
      outline.push_back(at(arch.radius_m, i / static_cast<double>(segments)));
    corners.push_back(at(arch.radius_m, 1));
    corners.push_back(at(arch.radius_m, 0));
    return lofted(drawn_out(outline, arch.back, arch.front),
                  hull_of(drawn_out(corners, arch.back, arch.front)), options.stone);
  }
  /// Returns the moulding in front of the stone, along its arc.
  Part moulding(const StoneOptions& options) const {
    const double r0 = arch.radius_m + 0.02, r1 = arch.outer_m(), w = r1 - r0, z = arch.front;
    const int n = options.arc();
    Profile profile(r0, z);
    profile.to(r0, z + 0.05).to(r0 + 0.35 * w, z + 0.05).to(r0 + 0.35 * w, z + 0.08);
    profile.to(r0 + 0.65 * w, z + 0.08).curve({r0 + 0.68 * w, z + 0.14}, r0 + 0.8 * w, z + 0.14, n);
    profile.curve({r0 + 0.84 * w, z + 0.17}, r1, z + 0.17, n).to(r1, z);
    const int segments = std::max(1, options.detail / 6);
    std::vector<Ring> rings(static_cast<std::size_t>(segments) + 1);
    for (int i = 0; i <= segments; ++i) {
      for (const Vec2& p : profile.points()) {
        const Vec2 place = at(p.x(), i / static_cast<double>(segments));
        rings[static_cast<std::size_t>(i)].emplace_back(place.x(), place.y(), p.y());
      }
    }
    const double beyond = r1 / sin_cos(0.5 * (to_rad - from_rad)).cos;
    const std::array corners = {at(r0, 0), at(beyond, 0), at(beyond, 1), at(r0, 1)};
    return lofted(rings, hull_of(drawn_out(corners, z, z + 0.17)), options.stone);
  }
};

/// A cross-section of a figure, as fractions of its height: an ellipse at the height `y` with the
/// half-axes `x` and `z` about z = `before`. `folds` is the depth of folds, of the half-axes.
struct CrossSection {
  double y, x, z, before, folds;
};
constexpr CrossSection kFigure[] = {
    {0, .19, .17, 0, .09},      {.02, .2, .18, 0, .09},     {.1, .175, .155, .01, .1},
    {.25, .165, .14, .02, .1},  {.4, .17, .145, .015, .08}, {.48, .165, .14, .005, .06},
    {.56, .14, .115, 0, .04},   {.62, .135, .11, 0, .04},   {.7, .16, .125, .005, .03},
    {.76, .175, .12, 0, .02},   {.8, .165, .1, -.005, .01}, {.825, .12, .08, -.005, 0},
    {.84, .06, .06, 0, 0},      {.87, .05, .055, .01, 0},   {.89, .06, .07, .015, 0},
    {.92, .07, .085, .015, 0},  {.95, .07, .082, .012, 0},  {.975, .055, .065, .008, 0},
    {.992, .032, .04, .004, 0}, {1, .01, .012, .003, 0}};

}  // namespace

void append_moved(const Pose& pose, Parts members, Parts& parts) {
  for (Part& part : members) parts.push_back(moved(std::move(part), pose));
}

Pose radial_frame(double angle_rad) {
  const SinCos half = sin_cos(0.5 * angle_rad);
  return {Vec3::Zero(), Quat(half.cos, 0, half.sin, 0)};
}

Pose radial_frame(double angle_rad, double x, double y, double z) {
  return radial_frame(angle_rad) * Pose{{x, y, z}, Quat::Identity()};
}

Part slab(const Vec3& min, const Vec3& max, MaterialIndex material) {
  return {make_box(min, max), material};
}

Part moulded_block(double half_x, double z0, double z1, const std::vector<Vec2>& profile,
                   MaterialIndex material) {
  std::vector<Ring> rings;
  double most = 0;
  for (const Vec2& p : profile) {
    const double x = half_x + p.x(), z = z1 + p.x();
    rings.push_back({{-x, p.y(), z0}, {x, p.y(), z0}, {x, p.y(), z}, {-x, p.y(), z}});
    most = std::max(most, p.x());
  }
  const Vec3 low(-half_x - most, profile.front().y(), z0);
  const Vec3 high(half_x + most, profile.back().y(), z1 + most);
  return lofted(rings, make_box(low, high), material);
}

Parts column(const Column& column, const StoneOptions& options) {
  const double r = column.radius_m, half = 1.5 * r;
  const int n = options.arc();
  const std::vector<Vec2> round = circle(options.detail);
  Parts parts;
  double y = column.pedestal_m;
  if (y > 0) parts.push_back(slab({-half, 0, -half}, {half, y, half}, options.stone));
  parts.push_back(slab({-half, y, -half}, {half, y + 0.3 * r, half}, options.stone));
  const std::vector<Vec2> base = base_profile(r, y + 0.3 * r, n);
  parts.push_back(turned_part(round, base, kDrumSides, options.stone));
  const double abacus = column.height_m - 0.32 * r;
  const std::vector<Vec2> capital = capital_profile(r, abacus - 0.84 * r, n);
  add_shaft(column, base.back().y(), capital.front().y(), options, parts);
  parts.push_back(turned_part(round, capital, kDrumSides, options.stone));
  parts.push_back(slab({-half, abacus, -half}, {half, column.height_m, half}, options.stone));
  return parts;
}

Part baluster(double height_m, const StoneOptions& options) {
  const double h = height_m;
  const int n = options.arc();
  Profile p(0.1 * h, 0);
  p.to(0.1 * h, 0.06 * h).curve({0.115 * h, 0.09 * h}, 0.09 * h, 0.12 * h, n);
  p.to(0.06 * h, 0.14 * h).curve({0.05 * h, 0.17 * h}, 0.07 * h, 0.21 * h, n);
  p.curve({0.15 * h, 0.33 * h}, 0.105 * h, 0.45 * h, 2 * n);
  p.curve({0.05 * h, 0.58 * h}, 0.048 * h, 0.76 * h, 2 * n).to(0.07 * h, 0.78 * h);
  p.curve({0.09 * h, 0.81 * h}, 0.065 * h, 0.84 * h, n).to(0.06 * h, 0.87 * h);
  p.curve({0.06 * h, 0.92 * h}, 0.1 * h, 0.94 * h, n).to(0.1 * h, h);
  return turned_part(circle(std::max(8, options.detail / 2)), p.points(), kBalusterSides,
                     options.stone);
}

Part urn(double height_m, const StoneOptions& options) {
  const double h = height_m;
  const int n = 2 * options.arc();
  Profile p(0.2 * h, 0);
  p.to(0.2 * h, 0.05 * h).curve({0.17 * h, 0.1 * h}, 0.08 * h, 0.13 * h, n).to(0.08 * h, 0.17 * h);
  p.curve({0.34 * h, 0.26 * h}, 0.32 * h, 0.52 * h, n);
  p.curve({0.3 * h, 0.62 * h}, 0.17 * h, 0.66 * h, n).to(0.17 * h, 0.7 * h);
  p.curve({0.27 * h, 0.74 * h}, 0.27 * h, 0.76 * h, n)
      .curve({0.2 * h, 0.84 * h}, 0.06 * h, 0.88 * h, n);
  p.curve({0.12 * h, 0.93 * h}, 0.07 * h, 0.97 * h, n).to(0.02 * h, h);
  return turned_part(circle(options.detail), p.points(), kBalusterSides, options.stone);
}

Part statue(double height_m, const StoneOptions& options) {
  constexpr int kFolds = 11;
  const int around = std::max(12, options.detail), between = std::max(1, options.arc() / 2);
  std::vector<Ring> rings;
  const auto add = [&](const CrossSection& a, const CrossSection& b, double t) {
    const auto mix = [&](double p, double q) { return (p + t * (q - p)) * height_m; };
    const double folds = mix(a.folds, b.folds) / height_m, y = mix(a.y, b.y);
    Ring& ring = rings.emplace_back();
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * std::numbers::pi * i / around;
      const SinCos at = sin_cos(turn);
      const double fold = 1 + folds * sin_cos(kFolds * turn + 2 * y / height_m).sin;
      ring.emplace_back(mix(a.x, b.x) * fold * at.sin, y,
                        mix(a.before, b.before) + mix(a.z, b.z) * fold * at.cos);
    }
  };
  for (std::size_t i = 0; i + 1 < std::size(kFigure); ++i) {
    for (int k = 0; k < between; ++k) add(kFigure[i], kFigure[i + 1], k / double(between));
  }
  add(std::end(kFigure)[-1], std::end(kFigure)[-1], 0);
  return lofted(rings, prism_around(rings, kBalusterSides), options.stone);
}

double ArchedWall::shoulder_x() const {
  return on_circle(outer_m(), std::numbers::pi / voussoirs).x();
}

double ArchedWall::shoulder_y() const {
  return on_circle(outer_m(), std::numbers::pi / voussoirs).y();
}

Parts arched_wall(const ArchedWall& arch, const StoneOptions& options, MaterialIndex wall) {
  Parts parts;
  const auto joint = [&](int i) {
    return i == arch.voussoirs ? std::numbers::pi : std::numbers::pi * i / arch.voussoirs;
  };
  for (int i = 0; i < arch.voussoirs; ++i) {
    const Voussoir voussoir{arch, joint(i), joint(i + 1)};
    parts.push_back(voussoir.stone(options));
    parts.push_back(voussoir.moulding(options));
    if (i == 0 || i + 1 == arch.voussoirs) continue;
    const Vec2 a = voussoir.at(arch.outer_m(), 0), b = voussoir.at(arch.outer_m(), 1);
    const std::array corners = {a, b, Vec2(b.x(), arch.top_m), Vec2(a.x(), arch.top_m)};
    parts.push_back({hull_of(drawn_out(corners, arch.back, arch.front)), wall});
  }
  return parts;
}

Part Bay::bar(double z0, double z1, double bottom, double top, MaterialIndex material) const {
  const std::array plan = {Vec2(-half_width(z0), z0), Vec2(half_width(z0), z0),
                           Vec2(half_width(z1), z1), Vec2(-half_width(z1), z1)};
  return {block(plan, bottom, top), material};
}

Part Bay::ring(const Profile& profile, const StoneOptions& options, bool flat_back) const {
  double least = 1e300, most = 0, bottom = 1e300, top = -1e300;
  for (const Vec2& p : profile.points()) {
    least = std::min(least, p.x()), most = std::max(most, p.x());
    bottom = std::min(bottom, p.y()), top = std::max(top, p.y());
  }
  const int segments = std::max(2, static_cast<int>(half_rad_ * options.detail / 0.8));
  std::vector<Ring> rings;
  for (int i = 0; i <= segments; ++i) {
    const SinCos turn = sin_cos(half_rad_ * (2.0 * i / segments - 1));
    Ring& ring = rings.emplace_back();
    for (const Vec2& p : profile.points()) {
      const double radius = flat_back && p.x() == least ? least / turn.cos : p.x();
      ring.emplace_back(radius * turn.sin, p.y(), radius * turn.cos);
    }
  }
  const double inner = flat_back ? least : least * half_.cos;
  return lofted(rings, bar(inner, most, bottom, top, options.stone).polyhedron, options.stone);
}

}  // namespace sunder::scenes
