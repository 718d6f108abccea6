// The stand in the middle of an arena, and the round temple on it.
//
// Read first: stand(). All rings are of as many blocks as there are columns; none but the stand's
// reaches the axis, and the dome is corbelled: its beds are level, so that each ring lies on the
// one below.
#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "scenes/structures/arena.h"

namespace sunder::scenes {
namespace {

constexpr double kHub = 1.2;     // m, radius
constexpr double kMiddle = 0.6;  // of the radius: where the stand's outer blocks end
constexpr int kStandSteps = 3;
constexpr double kStandStep = 0.22;  // m, height and depth

class StandBuilder {
 public:
  StandBuilder(const Stand& of, const Chisel& chisel, MaterialIndex wall)
      : of_(of), chisel_(chisel), wall_(wall), bay_(std::numbers::pi / of.columns) {}

  Parts build() {
    const double height = of_.height_m - kStandSteps * kStandStep;
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
    y += of_.column_m;
    add_entablature(y);
    add_dome(y + 0.85);
    return std::move(parts_);
  }

 private:
  double inner() const { return kMiddle * of_.radius_m; }
  double step(int i) const { return of_.radius_m - 0.2 - kStandStep * i; }
  double columns_at() const { return step(kStandSteps) - 0.5; }
  double cella_at() const { return 0.48 * of_.radius_m; }

  /// Once a bay.
  void add_round(const Part& part) {
    for (int i = 0; i < of_.columns; ++i) add(i + 0.5, {part});
  }
  void add(double bays, Parts members) {
    move_to(ray(2 * std::numbers::pi * bays / of_.columns), std::move(members), parts_);
  }

  /// From the axis to the edge, which is as the profile says.
  void add_layer(const Profile& edge, double bottom, double top) {
    add_round(bay_.ring(edge, chisel_, true));
    add_round(bay_.bar(kHub, inner(), bottom, top, wall_));
    std::vector<Vec2> plan;
    for (int i = 0; i < of_.columns; ++i) {
      const Vec3 corner =
          ray(2 * std::numbers::pi * i / of_.columns) * Vec3(0, 0, kHub / bay_.cosine());
      plan.emplace_back(corner.x(), corner.z());
    }
    parts_.push_back({block(plan, bottom, top), wall_});
  }

  /// A foot, a wall and a cornice.
  void add_stand(double height) {
    const double r = of_.radius_m, in = inner(), half = 0.5 * height;
    const int n = chisel_.arc();
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
    const Column of{0.06 * of_.column_m, of_.column_m, 0, 3};
    const Parts members = column(of, chisel_);
    for (int i = 0; i < of_.columns; ++i) {
      Parts raised;
      move_to({Vec3(0, y, columns_at()), Quat::Identity()}, members, raised);
      add(i, std::move(raised));
    }
  }

  /// A round wall with a door.
  void add_cella(double y) {
    constexpr int kCourses = 3;
    const double course = of_.column_m / kCourses, r = cella_at();
    for (int i = 0; i < kCourses; ++i) {
      Profile wall(r - 0.45, y + i * course);
      wall.to(r, y + i * course).to(r, y + (i + 1) * course).to(r - 0.45, y + (i + 1) * course);
      const Part stone = bay_.ring(wall, {chisel_.detail, wall_});
      for (int b = 0; b < of_.columns; ++b) {
        const bool door = b == 0 && i + 1 < kCourses;
        if (!door) add(b + 0.5, {stone});
      }
    }
  }

  /// Over the columns, and a ceiling from there to the wall of the cella.
  void add_entablature(double y) {
    const double in = columns_at() - 0.36, r = columns_at() + 0.36;
    const int n = chisel_.arc();
    Profile beam(in, y);
    beam.to(r - 0.06, y).to(r - 0.06, y + 0.2).to(r, y + 0.2).to(r, y + 0.4);
    beam.curve({r + 0.08, y + 0.42}, r + 0.08, y + 0.5, n).to(in, y + 0.5);
    add_round(bay_.ring(beam, chisel_));
    const double wall = cella_at(), up = y + 0.5;
    Profile lining(wall - 0.45, y);
    lining.to(wall, y).to(wall, up).to(wall - 0.45, up);
    add_round(bay_.ring(lining, {chisel_.detail, wall_}));
    Profile cornice(wall - 0.45, up);
    cornice.to(r + 0.1, up)
        .to(r + 0.1, up + 0.08)
        .curve({r + 0.12, up + 0.2}, r + 0.3, up + 0.2, n);
    cornice.curve({r + 0.42, up + 0.22}, r + 0.4, up + 0.35, n).to(wall - 0.45, up + 0.35);
    add_round(bay_.ring(cornice, chisel_));
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
      const int n = std::max(1, chisel_.arc());
      for (int k = 1; k <= n; ++k) {
        const Vec2 p = at(i + k / static_cast<double>(n));
        stone.to(p.x(), p.y());
      }
      add_round(bay_.ring(stone.to(in, head.y()), chisel_));
    }
    const Vec2 eye = at(kRings);
    const double r = eye.x();
    Profile cap(r, eye.y());
    cap.curve({0.6 * r, eye.y() + 0.28 * r}, 0.3 * r, eye.y() + 0.32 * r, 2 * chisel_.arc());
    cap.to(0.3 * r, eye.y() + 0.45 * r);
    const std::vector<Ring> rings = turned(circle(chisel_.detail), cap.points());
    parts_.push_back(lofted(rings, prism_around(rings, 16), chisel_.stone));
    move_to({Vec3(0, eye.y() + 0.45 * r, 0), Quat::Identity()}, {urn(1.3, chisel_)}, parts_);
  }

  const Stand& of_;
  const Chisel& chisel_;
  const MaterialIndex wall_;
  const Bay bay_;
  Parts parts_;
};

}  // namespace

Parts stand(const Stand& of, const Chisel& chisel, MaterialIndex wall) {
  return StandBuilder(of, chisel, wall).build();
}

}  // namespace sunder::scenes
