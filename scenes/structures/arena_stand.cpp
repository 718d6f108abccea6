// The round temple in the middle of an arena, on a stepped base, its stand.
//
// Read first: StandBuilder::build(). Every ring has one block for each column; only layers of the
// stand extend to the axis. The dome is corbelled: its bed joints are level, so that each ring
// rests on the one below.
#include <algorithm>
#include <numbers>
#include <utility>

#include "scenes/structures/arena.h"

namespace sunder::scenes {
namespace {

constexpr double kHub = 1.2;     // m, radius of the block at the axis
constexpr double kMiddle = 0.6;  // inner radius of the stand's outer blocks, of its radius
constexpr int kStandSteps = 3;
constexpr double kStandStep = 0.22;  // m, height and depth of a step

class StandBuilder {
 public:
  StandBuilder(const Stand& stand, const StoneOptions& options, MaterialIndex wall)
      : stand_(stand), options_(options), wall_(wall), bay_(std::numbers::pi / stand.columns) {}

  Parts build() {
    const double height = stand_.height_m - kStandSteps * kStandStep;
    add_stand(height);
    double y = height;
    for (int i = 1; i <= kStandSteps; ++i, y += kStandStep)
      add_layer(Profile(inner(), y)
                    .to(step(i), y)
                    .to(step(i), y + kStandStep)
                    .to(inner(), y + kStandStep),
                y, y + kStandStep);
    for (Part& part : parts_) part.anchored = bounds(part.polyhedron).min.y() == 0;
    add_colonnade(y);
    add_cella(y);
    y += stand_.column_m;
    add_entablature(y);
    add_dome(y + 0.85);
    return std::move(parts_);
  }

 private:
  double inner() const { return kMiddle * stand_.radius_m; }
  double step(int i) const { return stand_.radius_m - 0.2 - kStandStep * i; }
  double columns_at() const { return step(kStandSteps) - 0.5; }
  double cella_at() const { return 0.48 * stand_.radius_m; }

  /// Adds a part to every bay.
  void add_round(const Part& part) {
    for (int i = 0; i < stand_.columns; ++i) add(i + 0.5, {part});
  }
  void add(double bays, Parts members) {
    append_moved(radial_frame(2 * std::numbers::pi * bays / stand_.columns), std::move(members),
                 parts_);
  }

  /// Adds a layer of the stand, from the axis to the edge with the profile `edge`.
  void add_layer(const Profile& edge, double bottom, double top) {
    add_round(bay_.ring(edge, options_, true));
    add_round(bay_.bar(kHub, inner(), bottom, top, wall_));
    std::vector<Vec2> plan;
    for (int i = 0; i < stand_.columns; ++i) {
      const Vec3 corner = radial_frame(2 * std::numbers::pi * i / stand_.columns) *
                          Vec3(0, 0, kHub / bay_.cosine());
      plan.emplace_back(corner.x(), corner.z());
    }
    parts_.push_back({block(plan, bottom, top), wall_});
  }

  /// Adds the stand: a foot, a wall and a cornice.
  void add_stand(double height) {
    const double r = stand_.radius_m, in = inner(), half = 0.5 * height;
    const int n = options_.arc();
    Profile foot(in, 0);
    foot.to(r, 0).to(r, 0.2).curve({r, 0.3}, r - 0.1, 0.32, n);
    foot.curve({r - 0.2, 0.33}, r - 0.2, 0.42, n).to(r - 0.2, half).to(in, half);
    add_layer(foot, 0, half);
    Profile top(in, half);
    top.to(r - 0.2, half).to(r - 0.2, height - 0.35).to(r - 0.16, height - 0.35);
    top.curve({r - 0.16, height - 0.24}, r - 0.06, height - 0.22, n);
    top.curve({r + 0.06, height - 0.2}, r + 0.06, height - 0.1, n).to(r + 0.06, height);
    add_layer(top.to(in, height), half, height);
  }

  void add_colonnade(double y) {
    const Column size{0.06 * stand_.column_m, stand_.column_m, 0, 3};
    const Parts members = column(size, options_);
    for (int i = 0; i < stand_.columns; ++i) {
      Parts raised;
      append_moved({Vec3(0, y, columns_at()), Quat::Identity()}, members, raised);
      add(i, std::move(raised));
    }
  }

  /// Adds the cella, a round wall with a door.
  void add_cella(double y) {
    constexpr int kCourses = 3;
    const double course = stand_.column_m / kCourses, r = cella_at();
    for (int i = 0; i < kCourses; ++i) {
      Profile wall(r - 0.45, y + i * course);
      wall.to(r, y + i * course).to(r, y + (i + 1) * course).to(r - 0.45, y + (i + 1) * course);
      const Part stone = bay_.ring(wall, {options_.detail, wall_});
      for (int b = 0; b < stand_.columns; ++b) {
        const bool door = b == 0 && i + 1 < kCourses;
        if (!door) add(b + 0.5, {stone});
      }
    }
  }

  /// Adds the entablature over the columns, and a ceiling from there to the wall of the cella.
  void add_entablature(double y) {
    const double in = columns_at() - 0.36, r = columns_at() + 0.36;
    const int n = options_.arc();
    Profile beam(in, y);
    beam.to(r - 0.06, y).to(r - 0.06, y + 0.2).to(r, y + 0.2).to(r, y + 0.4);
    beam.curve({r + 0.08, y + 0.42}, r + 0.08, y + 0.5, n).to(in, y + 0.5);
    add_round(bay_.ring(beam, options_));
    const double wall = cella_at(), up = y + 0.5;
    Profile lining(wall - 0.45, y);
    lining.to(wall, y).to(wall, up).to(wall - 0.45, up);
    add_round(bay_.ring(lining, {options_.detail, wall_}));
    Profile cornice(wall - 0.45, up);
    cornice.to(r + 0.1, up)
        .to(r + 0.1, up + 0.08)
        .curve({r + 0.12, up + 0.2}, r + 0.3, up + 0.2, n);
    cornice.curve({r + 0.42, up + 0.22}, r + 0.4, up + 0.35, n).to(wall - 0.45, up + 0.35);
    add_round(bay_.ring(cornice, options_));
  }

  void add_dome(double y) {
    constexpr int kRings = 7;
    constexpr double kUpTo = 1.28;  // rad
    const double radius = columns_at() - 0.1, rise = 0.75 * radius;
    const auto at = [&](double ring) {
      const SinCos turn = sin_cos(kUpTo * ring / kRings);
      return Vec2(radius * turn.cos, y + rise * turn.sin);
    };
    for (int i = 0; i < kRings; ++i) {
      const Vec2 foot = at(i), head = at(i + 1);
      const double in = head.x() - 0.55;
      Profile stone(in, foot.y());
      stone.to(foot.x(), foot.y());
      const int n = std::max(1, options_.arc());
      for (int k = 1; k <= n; ++k) {
        const Vec2 p = at(i + k / static_cast<double>(n));
        stone.to(p.x(), p.y());
      }
      add_round(bay_.ring(stone.to(in, head.y()), options_));
    }
    const Vec2 eye = at(kRings);
    const double r = eye.x();
    Profile cap(r, eye.y());
    cap.curve({0.6 * r, eye.y() + 0.28 * r}, 0.3 * r, eye.y() + 0.32 * r, 2 * options_.arc());
    cap.to(0.3 * r, eye.y() + 0.45 * r);
    const std::vector<Ring> rings = turned(circle(options_.detail), cap.points());
    parts_.push_back(lofted(rings, prism_around(rings, 16), options_.stone));
    append_moved({Vec3(0, eye.y() + 0.45 * r, 0), Quat::Identity()}, {urn(1.3, options_)}, parts_);
  }

  const Stand& stand_;
  const StoneOptions& options_;
  const MaterialIndex wall_;
  const Bay bay_;
  Parts parts_;
};

}  // namespace

Parts stand(const Stand& stand, const StoneOptions& options, MaterialIndex wall) {
  return StandBuilder(stand, options, wall).build();
}

}  // namespace sunder::scenes
