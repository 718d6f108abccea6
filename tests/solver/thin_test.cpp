// Thin plates and bars, and balls that are fast: whether they pass through what they meet.
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

/// The rectangle in the middle of a box, across its least side: a centre and half of two sides.
struct Sheet {
  Vec3 center, u, v;

  Vec3 normal() const { return u.cross(v); }
};

Sheet sheet_of(const Vec3& size, const Pose& X) {
  Eigen::Index thin = 0;
  size.minCoeff(&thin);
  const Eigen::Index u = (thin + 1) % 3, v = (thin + 2) % 3;
  return {X.position, X.rotation * (0.5 * size[u] * Vec3::Unit(u)),
          X.rotation * (0.5 * size[v] * Vec3::Unit(v))};
}

int sign(double x) { return x > 0 ? 1 : -1; }

/// Counts by side what has gone through two sheets: points of each through the other, and edges
/// through edges.
class Crossings {
 public:
  /// True if the centre of either is on another side than at the start.
  bool centers() const { return net_[kCenters] != 0 || net_[kCenters + 1] != 0; }
  /// True if any part is.
  bool any() const {
    return std::any_of(net_.begin(), net_.end(), [](int net) { return net != 0; });
  }

  void move(const Sheet& a0, const Sheet& a1, const Sheet& b0, const Sheet& b1) {
    std::size_t i = 0;
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        net_[i++] += through(a0, a1, point(b0, x, y), point(b1, x, y));
        net_[i++] += through(b0, b1, point(a0, x, y), point(a1, x, y));
      }
    }
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < 4; ++l)
        net_[i++] += past(edge(a0, k), edge(a1, k), edge(b0, l), edge(b1, l));
  }

 private:
  struct Edge {
    Vec3 from, along;
  };

  static Vec3 point(const Sheet& s, int x, int y) { return s.center + 0.5 * (x * s.u + y * s.v); }
  static Edge edge(const Sheet& s, int k) {
    const double side = k % 2 == 0 ? 1 : -1;
    if (k < 2) return {s.center + side * s.u - s.v, 2 * s.v};
    return {s.center + side * s.v - s.u, 2 * s.u};
  }
  static constexpr std::size_t kCenters = 2 * 12;

  static int through(const Sheet& s0, const Sheet& s1, const Vec3& p0, const Vec3& p1) {
    const double was = s0.normal().dot(p0 - s0.center), is = s1.normal().dot(p1 - s1.center);
    if (sign(was) == sign(is)) return 0;
    const Vec3 at = p1 - s1.center;
    const bool within =
        std::abs(at.dot(s1.u)) < s1.u.squaredNorm() && std::abs(at.dot(s1.v)) < s1.v.squaredNorm();
    return within ? sign(is) : 0;
  }
  static int past(const Edge& a0, const Edge& a1, const Edge& b0, const Edge& b1) {
    const auto volume = [](const Edge& a, const Edge& b) {
      return a.along.cross(b.along).dot(b.from - a.from);
    };
    const int is = sign(volume(a1, b1));
    if (sign(volume(a0, b0)) == is) return 0;
    const Vec3 gap = b1.from - a1.from;
    const double aa = a1.along.squaredNorm(), bb = b1.along.squaredNorm(),
                 ab = a1.along.dot(b1.along), det = aa * bb - ab * ab;
    if (!(det > 0)) return 0;
    const double s = (gap.dot(a1.along) * bb - gap.dot(b1.along) * ab) / det,
                 t = (gap.dot(a1.along) * ab - gap.dot(b1.along) * aa) / det;
    return s > 0 && s < 1 && t > 0 && t < 1 ? is : 0;
  }

  std::array<int, 2 * 25 + 16> net_{};
};

struct Thin {
  Vec3 size;
  BodyDesc desc;
};

struct Meeting {
  Thin a, b;
  std::string text;
};

/// Returns a plate of 0.2 to 1 m or a bar of 0.5 to 1.5 m across the x axis, turned by `tilt`.
Thin thin_body(Random& random, const Vec3& at, double tilt) {
  Vec3 size(random.uniform(0.02, 0.1), random.uniform(0.2, 1), random.uniform(0.2, 1));
  if (random.below(3) == 0) size = Vec3(size.x(), size.x(), random.uniform(0.5, 1.5));
  Thin thin{size, W::box(size, at, 2000)};
  const double around = random.uniform(0, 2 * kPi);
  const Vec3 axis(0, std::cos(around), std::sin(around));
  thin.desc.X_WB.rotation = Quat(Eigen::AngleAxisd(tilt, axis) *
                                 Eigen::AngleAxisd(random.uniform(0, kPi), Vec3::UnitX()));
  return thin;
}

/// Returns two bodies that will meet near `at` within 5 to 40 ms, near their centres.
Meeting meeting(Random& random, const Vec3& at, bool at_wall) {
  const bool steep = random.below(4) == 0, spins = random.below(2) == 0;
  const double most = (steep ? 60 : 8) * kPi / 180;
  const double speed = 5 * std::pow(20, random.uniform()), share = random.uniform();
  const double friction = random.below(2) == 0 ? 0 : 0.5,
               restitution = random.below(2) == 0 ? 0 : 0.5;
  const double tilt_a = random.uniform(0, most), tilt_b = at_wall ? 0 : random.uniform(0, most);
  Meeting m{thin_body(random, at, tilt_a), thin_body(random, at, tilt_b), ""};
  if (at_wall) {
    const Vec3 size(random.uniform(0.02, 0.3), 4, 4);
    m.b = {size, W::fixed(W::box(size, at, 2000))};
  }
  const auto reach = [](const Thin& thin) {
    return 0.5 * (thin.desc.X_WB.rotation.toRotationMatrix().row(0).transpose().cwiseAbs().dot(
                     thin.size));
  };
  const double gap = reach(m.a) + reach(m.b) + random.uniform(0.005, 0.04) * speed;
  m.a.desc.X_WB.position.x() -= gap;
  m.a.desc.X_WB.position += Vec3(0, random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
  const auto spin = [&] {
    return spins ? Vec3(random.uniform(0, 20) * random.direction()) : Vec3(0, 0, 0);
  };
  const double by_a = at_wall ? 1 : share;
  m.a.desc = W::moving(W::with_friction(m.a.desc, friction, restitution), Vec3(by_a * speed, 0, 0),
                       spin());
  m.b.desc = W::with_friction(m.b.desc, friction, restitution);
  if (!at_wall) m.b.desc = W::moving(m.b.desc, Vec3((by_a - 1) * speed, 0, 0), spin());
  std::ostringstream text;
  text << m.a.size.transpose() << " and " << m.b.size.transpose() << " at " << speed
       << " m/s, tilted by " << tilt_a << " and " << tilt_b << (spins ? ", spinning" : "");
  m.text = text.str();
  return m;
}

Pose between(const Pose& from, const Pose& to, double t) {
  return {from.position + t * (to.position - from.position), from.rotation.slerp(t, to.rotation)};
}

/// Numbers of meetings in which something passes through something.
struct Passed {
  int centers = 0, any = 0;
  std::string first;  ///< What passed first.
};

Passed passed(const Preset& preset, bool at_wall) {
  constexpr int kMeetings = 1000, kParts = 8;
  PresetWorld world(preset, Vec3(0, 0, 0));
  Random random(at_wall ? 2 : 1);
  std::vector<Meeting> meetings;
  std::vector<std::array<BodyId, 2>> bodies;
  for (int i = 0; i < kMeetings; ++i) {
    const Vec3 at(0, 20 * (i % 32), 20 * std::floor(i / 32.));
    const Meeting& m = meetings.emplace_back(meeting(random, at, at_wall));
    const BodyId a = world.add(m.a.desc), b = world.add(m.b.desc);
    bodies.push_back({a, b});
  }
  std::vector<Crossings> crossings(meetings.size());
  const auto poses = [&] {
    std::vector<std::array<Pose, 2>> all;
    for (const auto& [a, b] : bodies) all.push_back({world.state(a).X_WB, world.state(b).X_WB});
    return all;
  };
  auto was = poses();
  world.watch(0.15, [&] {
    auto is = poses();
    for (std::size_t i = 0; i < meetings.size(); ++i) {
      const auto a = [&](double t) {
        return sheet_of(meetings[i].a.size, between(was[i][0], is[i][0], t));
      };
      const auto b = [&](double t) {
        return sheet_of(meetings[i].b.size, between(was[i][1], is[i][1], t));
      };
      for (int part = 0; part < kParts; ++part) {
        const double from = 1. / kParts * part, to = 1. / kParts * (part + 1);
        crossings[i].move(a(from), a(to), b(from), b(to));
      }
    }
    was = std::move(is);
  });
  Passed all;
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    if (!crossings[i].any()) continue;
    if (all.any++ < 4) all.first += meetings[i].text + "\n";
    all.centers += crossings[i].centers();
  }
  return all;
}

using ByPreset = std::array<int, kPresets.size()>;

/// Expects that the centres of at most so many of 1,000 pass, and a part of at most so many: bodies
/// that an impact turns by radians in a step may.
void expect_few(bool at_wall, const ByPreset& most_centers, const ByPreset& most) {
  for (std::size_t i = 0; i < kPresets.size(); ++i) {
    const Passed all = passed(kPresets[i], at_wall);
    EXPECT_LE(all.centers, most_centers[i]) << kPresets[i].name << "\n" << all.first;
    EXPECT_LE(all.any, most[i]) << kPresets[i].name << "\n" << all.first;
  }
}

TEST(Thin, HardlyAnyPlateOrBarPassesThroughAnother) {
  expect_few(false, {6, 4, 5, 0}, {60, 30, 30, 8});
}

TEST(Thin, HardlyAnyPlateOrBarPassesThroughAWall) { expect_few(true, {3, 3, 2, 1}, {8, 8, 8, 4}); }

TEST(Thin, TheCentreOfMassOfEachPairGoesOnStraight) {
  constexpr double kTime_s = 0.15;
  const Vec3 along_m_s(0, 0, 80);
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset, Vec3(0, 0, 0));
    Random random(1);
    std::vector<std::array<BodyId, 2>> bodies;
    std::vector<Vec3> ends;  // of the mean of each pair, weighted by volume
    const auto mean = [](const Meeting& m, const Vec3& of_a, const Vec3& of_b) -> Vec3 {
      const double a = m.a.size.prod(), b = m.b.size.prod();
      return (a * of_a + b * of_b) / (a + b);
    };
    std::vector<Meeting> meetings;
    for (int i = 0; i < 1000; ++i) {
      Meeting m = meeting(random, Vec3(0, 20 * (i % 32), 20 * std::floor(i / 32.)), false);
      BodyDesc &a = m.a.desc, &b = m.b.desc;
      a.velocity_W += along_m_s, b.velocity_W += along_m_s;
      const BodyId id_a = world.add(a), id_b = world.add(b);
      bodies.push_back({id_a, id_b});
      ends.push_back(mean(m, a.X_WB.position + kTime_s * a.velocity_W,
                          b.X_WB.position + kTime_s * b.velocity_W));
      meetings.push_back(m);
    }
    world.run(kTime_s);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto& [a, b] = bodies[i];
      const Vec3 end =
          mean(meetings[i], world.state(a).X_WB.position, world.state(b).X_WB.position);
      EXPECT_LT((end - ends[i]).norm(), 2e-4) << preset.name << " " << i;
    }
  }
}

TEST(Thin, ARodLiesOnTheGroundAndRests) {
  constexpr double kLength = 2;
  for (const Preset& preset : kPresets) {
    int wrong = 0;
    for (const int sides : {5, 8, 16}) {
      for (const double lean : {90., 85., 40.}) {
        for (const double radius : {0.01, 0.05}) {
          PresetWorld world(preset);
          world.add(W::with_friction(W::ground(), 0.4));
          std::vector<Vec3> corners;
          for (int i = 0; i < sides; ++i) {
            const SinCos a = sin_cos(2 * kPi * i / sides);
            for (const double z : {-0.5 * kLength, 0.5 * kLength})
              corners.emplace_back(radius * a.cos, radius * a.sin, z);
          }
          BodyDesc rod = W::with_friction(W::hull(make_hull(corners), Vec3(0, 1.5, 0), 2000), 0.4);
          rod.X_WB.rotation = Quat(Eigen::AngleAxisd((90 - lean) * kPi / 180, Vec3::UnitX()));
          const BodyId id = world.add(rod);
          world.run(5);
          const double height = radius * sin_cos(kPi / sides).cos;
          double least = radius, fastest = 0;
          world.watch(1, [&] {
            const BodyState s = world.state(id);
            least = std::min(least, s.X_WB.position.y());
            fastest = std::max(fastest, s.velocity_W.norm());
          });
          if (least > 0.97 * height && fastest < 1e-3) continue;
          ++wrong;
          std::printf("%s, %d sides, leaning by %g degrees, of radius %g: at %g of %g m, %g m/s\n",
                      preset.name, sides, lean, radius, least, height, fastest);
        }
      }
    }
    EXPECT_LE(wrong, preset.dt_s > 0.01 ? 1 : 0) << preset.name << ", of 18";
  }
}

TEST(Thin, PlatesAndRodsThatAreBuriedComeOutAndRest) {
  constexpr double kThickness = 0.001, kDepth = 0.0155;
  for (const Preset& preset : kPresets) {
    for (const double width : {0.001, 0.5}) {
      for (const double tilt : {0., 0.01, 0.03}) {
        RigidWorld world(options_of(preset));
        world.add(W::ground());
        BodyDesc sliver = W::box(Vec3(1, kThickness, width), Vec3(0, -kDepth, 0), 1000);
        sliver.X_WB.rotation = Quat(Eigen::AngleAxisd(tilt, Vec3(0, 0, 1)));
        const BodyId id = world.add(sliver);
        world.run(2, preset.dt_s, preset.substeps);
        const BodyState end = world.state(id);
        EXPECT_GT(end.X_WB.position.y(), 0) << preset.name << " " << width << " " << tilt;
        EXPECT_LT(end.velocity_W.norm(), 1e-3) << preset.name << " " << width << " " << tilt;
      }
    }
  }
}

TEST(Thin, ABallGoesThroughAHoleWithLittleRoom) {
  // The room is less than the margin within which contacts are made at draft.
  constexpr double kRadius = 0.05, kRoom = 0.004, kDepth = 0.15, kSpeed = 160;
  for (const Preset& preset : kPresets) {
    for (const double tilt : {0., 0.6}) {
      for (const double away : {0.03, 0.1, 0.5, 1., 2.}) {
        PresetWorld world(preset);
        const Quat turn(Eigen::AngleAxisd(tilt, Vec3(1, 0, 0)));
        for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
          const Vec3 at = (kRadius + kRoom + 0.5) * side;
          BodyDesc block = W::fixed(W::box(Vec3(1, 1, kDepth), turn * at));
          block.X_WB.rotation = turn;
          world.add(block);
        }
        const Vec3 way = turn * Vec3(0, 0, -1);
        BodyDesc ball = W::sphere(kRadius, -(away + 0.5 * kDepth) * way, 7800);
        const BodyId id = world.add(W::moving(ball, kSpeed * way));
        world.run(0.05);
        EXPECT_GT(world.state(id).velocity_W.dot(way), 0.995 * kSpeed)
            << preset.name << ", " << tilt << ", " << away << " m away";
      }
    }
  }
}

TEST(Thin, ABallStaysInAClosedRoom) {
  constexpr double kRoom = 4, kWall = 0.2;
  const auto text = [](const Preset& preset, double restitution, double speed, double radius) {
    std::ostringstream out;
    out << preset.name << ", restitution " << restitution << ", " << speed << " m/s, radius "
        << radius;
    return out.str();
  };
  for (const Preset& preset : kPresets) {
    for (const double restitution : {0., 1.}) {
      for (const double speed : {5., 20., 50., 100., 200., 400.}) {
        for (const double radius : {0.05, 0.25}) {
          PresetWorld world(preset);
          for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-1., 1.}) {
              Vec3 size = Vec3::Constant(kRoom + 2 * kWall);
              size[axis] = kWall;
              const Vec3 at = side * 0.5 * (kRoom + kWall) * Vec3::Unit(axis);
              world.add(W::with_friction(W::fixed(W::box(size, at)), 0.3, restitution));
            }
          }
          Random random(static_cast<std::uint64_t>(speed) + (radius < 0.1 ? 1000 : 0));
          BodyDesc ball = W::sphere(radius, Vec3(0.3, -0.2, 0.1), 2000);
          ball = W::moving(W::with_friction(ball, 0.3, restitution), speed * random.direction());
          const BodyId id = world.add(ball);
          double farthest = 0, fastest = 0;
          world.watch(10, [&] {
            farthest = std::max(farthest, world.state(id).X_WB.position.cwiseAbs().maxCoeff());
            fastest = std::max(fastest, world.state(id).velocity_W.norm());
          });
          const std::string of = text(preset, restitution, speed, radius);
          EXPECT_LT(farthest, 0.5 * kRoom) << of;
          EXPECT_LT(fastest, 1.01 * speed + 10) << of;
        }
      }
    }
  }
}

}  // namespace
}  // namespace sunder::solver
