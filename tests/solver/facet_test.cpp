// Tests of static triangle surfaces: no ghost collisions at inner edges, and no tunnelling.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "engine/model/facets.h"
#include "tests/fixtures/rigid_world.h"
#include "tests/fixtures/threads.h"

namespace sunder::solver::facet_test {
namespace {

using W = RigidWorld;
constexpr double kG = 9.81, kDt_s = 1.0 / 120;
constexpr int kSubsteps = 4;

using Height = std::function<double(double x, double z)>;

/// Returns squares of a side about the origin, each of two triangles, at the given heights.
GroundMesh make_surface(int squares, double side_m, const Height& height) {
  GroundMesh mesh;
  const auto row = static_cast<std::uint32_t>(squares + 1);
  for (int k = 0; k <= squares; ++k) {
    for (int i = 0; i <= squares; ++i) {
      const double x = side_m * (i - 0.5 * squares), z = side_m * (k - 0.5 * squares);
      mesh.vertices_W.emplace_back(x, height(x, z), z);
    }
  }
  for (std::uint32_t k = 0; k + 1 < row; ++k) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t at = k * row + i;
      mesh.triangles.push_back({at, at + row, at + row + 1});
      mesh.triangles.push_back({at, at + row + 1, at + 1});
    }
  }
  return mesh;
}

double flat(double, double) { return 0; }

/// Hills with slopes of up to 50 degrees.
double bumpy(double x, double z) {
  return 0.6 * (sin_cos(1.3 * x).sin + sin_cos(1.7 * z + 0.4 * x).cos);
}

/// Returns the height of the triangle surface at a point, not of the function that it samples.
double height_at(const GroundMesh& mesh, double x, double z) {
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices_W[t[0]], &b = mesh.vertices_W[t[1]], &c = mesh.vertices_W[t[2]];
    const Vec3 n = (b - a).cross(c - a);
    const auto inside = [&](const Vec3& p, const Vec3& q) {
      return (q.x() - p.x()) * (z - p.z()) - (q.z() - p.z()) * (x - p.x()) <= 1e-12;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a))
      return a.y() - (n.x() * (x - a.x()) + n.z() * (z - a.z())) / n.y();
  }
  return -1e30;
}

void add_surface(RigidWorld& world, const GroundMesh& mesh, double friction = 0.6,
                 double restitution = 0) {
  const std::vector<Facet> facets = make_facets(mesh);
  BodyDesc body;
  body.is_static = true;
  for (const Facet& facet : facets) {
    ShapeDesc shape;
    shape.hull = W::keep(facet.prism);
    shape.bends = facet.bends;
    shape.tag = static_cast<std::uint32_t>(body.shapes.size());
    body.shapes.push_back(shape);
  }
  world.add(W::with_friction(body, friction, restitution));
}

/// Returns a world whose ground is about a thousand triangles, or the plane.
RigidWorld floor_world(bool triangles, double friction) {
  RigidWorld world;
  if (triangles) {
    add_surface(world, make_surface(24, 0.5, flat), friction);
  } else {
    world.add(W::with_friction(W::ground(), friction));
  }
  return world;
}

/// State of a box at the end of a slide of more than 6 m over 40 edges, and its largest deviations
/// from a straight line.
struct Slide {
  BodyState end;
  double aside_m = 0, up_m = 0;
};

Slide slide(bool triangles, double friction) {
  RigidWorld world = floor_world(triangles, friction);
  const BodyDesc box = W::with_friction(W::box(Vec3(0.5, 0.4, 0.5), Vec3(-5, 0.2, -1.5)), friction);
  const BodyId id = world.add(W::moving(box, Vec3(5, 0, 1.5)));
  Slide slide;
  for (int i = 0; i < 180; ++i) {
    world.step(kDt_s, kSubsteps);
    const Vec3 travel = world.state(id).X_WB.position - box.X_WB.position;
    slide.aside_m = std::max(slide.aside_m, std::abs(travel.z() - 0.3 * travel.x()));
    slide.up_m = std::max(slide.up_m, std::abs(travel.y()));
  }
  slide.end = world.state(id);
  return slide;
}

TEST(Facets, ABoxSlidesOverAThousandAsOverThePlane) {
  const Slide over = slide(true, 0), on = slide(false, 0);
  EXPECT_LT(over.aside_m, 1e-5);
  EXPECT_LT(over.up_m, 1e-4) << "on the plane " << on.up_m;
  EXPECT_LT(over.end.angular_velocity_W.norm(), 0.002);
  EXPECT_NEAR(over.end.velocity_W.norm(), on.end.velocity_W.norm(), 1e-4);
  EXPECT_GT(over.end.X_WB.position.x(), 2) << "the box crossed the triangles";
}

TEST(Facets, FrictionOnThemEqualsThatOnThePlane) {
  const Slide over = slide(true, 0.1), on = slide(false, 0.1);
  EXPECT_LT(over.up_m, 1e-4);
  // If several triangles share the load, friction is not exactly opposite to the motion.
  EXPECT_LT(over.aside_m, 0.04);
  EXPECT_NEAR(over.end.velocity_W.norm(), on.end.velocity_W.norm(), 0.02 * 0.1 * kG * 1.5);
}

TEST(Facets, ABallRollsOverThemAsOverThePlane) {
  const auto roll = [](bool triangles, double& worst_m) {
    RigidWorld world = floor_world(triangles, 0.8);
    const double radius_m = 0.15;
    const BodyDesc ball = W::with_friction(W::sphere(radius_m, Vec3(-5, radius_m, 1)), 0.8);
    const BodyId id = world.add(W::moving(ball, Vec3(4, 0, -1), Vec3(-1, 0, -4) / radius_m));
    for (int i = 0; i < 240; ++i) {
      world.step(kDt_s, kSubsteps);
      const Vec3 at = world.state(id).X_WB.position - ball.X_WB.position;
      worst_m = std::max({worst_m, std::abs(at.y()), std::abs(at.z() + 0.25 * at.x())});
    }
    return world.state(id);
  };
  double worst_m = 0, least_m = 0;
  const BodyState over = roll(true, worst_m), on = roll(false, least_m);
  EXPECT_LT(worst_m, 0.001) << "on the plane " << least_m;
  EXPECT_NEAR(over.velocity_W.norm(), on.velocity_W.norm(), 0.001 * on.velocity_W.norm());
  EXPECT_GT(over.X_WB.position.x(), 2);
}

TEST(Facets, ABallRollsDownASlopeOfThem) {
  RigidWorld world;
  add_surface(world, make_surface(24, 0.5, [](double x, double) { return -0.3 * x; }), 1);
  const double slope = std::atan(0.3), radius_m = 0.2;
  const Vec3 start = Vec3(-5, 1.5, 0.2) + radius_m * Vec3(std::sin(slope), std::cos(slope), 0);
  const BodyId id = world.add(W::with_friction(W::sphere(radius_m, start), 1));
  world.run(1.5, kDt_s, kSubsteps);
  const double rolls_m = 5.0 / 7 * kG * std::sin(slope) * 1.5 * 1.5 / 2;
  EXPECT_NEAR((world.state(id).X_WB.position - start).norm(), rolls_m, 0.02 * rolls_m);
}

TEST(Facets, AStackStandsOnThem) {
  RigidWorld world;
  add_surface(world, make_surface(10, 0.35, flat));
  std::vector<BodyId> ids;
  for (int i = 0; i < 5; ++i)
    ids.push_back(world.add(W::box(Vec3(1, 1, 1), Vec3(0.1, 0.5 + i, 0))));
  world.run(5, kDt_s, kSubsteps);
  for (int i = 0; i < 5; ++i)
    EXPECT_LT((world.state(ids[static_cast<std::size_t>(i)]).X_WB.position - Vec3(0.1, 0.5 + i, 0))
                  .norm(),
              0.005)
        << i;
  EXPECT_TRUE(world.state(ids[4]).asleep);
}

TEST(Facets, APlankLiesAcrossARidge) {
  RigidWorld world;
  add_surface(world, make_surface(8, 0.5, [](double x, double) { return -0.5 * std::abs(x); }));
  const BodyId id = world.add(W::box(Vec3(3, 0.1, 0.6), Vec3(0, 0.05, 0.1)));
  world.run(2, kDt_s, kSubsteps);
  EXPECT_LT((world.state(id).X_WB.position - Vec3(0, 0.05, 0.1)).norm(), 0.01);
}

TEST(Facets, ABoxStopsAtAWallOfThemAndStandsOnItsFloor) {
  // The floor and the wall are one surface with a concave edge.
  GroundMesh mesh = make_surface(8, 0.5, flat);
  const auto first = static_cast<std::uint32_t>(mesh.vertices_W.size());
  for (const double y : {0.0, 2.0})
    for (const double z : {2.0, -2.0}) mesh.vertices_W.emplace_back(1, y, z);
  mesh.triangles.push_back({first, first + 2, first + 3});
  mesh.triangles.push_back({first, first + 3, first + 1});
  RigidWorld world;
  add_surface(world, mesh);
  const BodyDesc box = W::box(Vec3(0.5, 0.5, 0.5), Vec3(-1, 0.25, 0));
  const BodyId id = world.add(W::moving(box, Vec3(5, 0, 0)));
  world.run(2, kDt_s, kSubsteps);
  EXPECT_LT(world.state(id).X_WB.position.x(), 0.751) << "the box passed the wall";
  EXPECT_NEAR(world.state(id).X_WB.position.y(), 0.25, 0.005);
  EXPECT_LT(world.state(id).velocity_W.norm(), 0.01);
}

/// Returns a closed box of triangles about the origin.
GroundMesh closed_box(const Vec3& size) {
  const ConvexPolyhedron box = make_box(-0.5 * size, 0.5 * size);
  GroundMesh mesh;
  mesh.vertices_W = box.vertices;
  for (std::size_t f = 0; f < box.faces.size(); ++f) {
    const auto corners = box.face_corners(f);
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    mesh.triangles.push_back({corners[0], corners[2], corners[3]});
  }
  return mesh;
}

TEST(Facets, OfAThinWallAreHalfAsThickAsTheWall) {
  for (const Facet& facet : make_facets(closed_box(Vec3(4, 3, 0.1)))) {
    EXPECT_LE(bounds(facet.prism).extent().minCoeff(), 2.0);
    if (std::abs(facet.prism.faces[0].plane.normal.z()) < 0.5) continue;
    EXPECT_NEAR(bounds(facet.prism).extent().z(), 0.05, 1e-9);
    for (const Vec2& bend : facet.bends) EXPECT_TRUE(bend == Vec2(1, 0) || bend == Vec2(0, 1));
  }
}

TEST(Facets, AThinWallStopsBodiesFromBothSides) {
  RigidWorld world;
  add_surface(world, closed_box(Vec3(4, 3, 0.1)));
  std::vector<BodyId> ids;
  for (const double side : {-1.0, 1.0}) {
    ids.push_back(
        world.add(W::moving(W::sphere(0.2, Vec3(-0.7, 0, 2 * side)), Vec3(0, 3, -20 * side))));
    ids.push_back(world.add(
        W::moving(W::box(Vec3(0.3, 0.3, 0.3), Vec3(0.7, 0, 2 * side)), Vec3(0, 3, -20 * side))));
  }
  world.run(0.4, kDt_s, kSubsteps);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double z = world.state(ids[i]).X_WB.position.z();
    EXPECT_GT(i < 2 ? -z : z, 0.19) << i;
  }
}

/// Depths of a ball below a surface, at the ends of steps at which it was within the surface's
/// sides.
struct BallDepth {
  double largest_m = 0, last_m = 0;
};
/// Returns the depths of 100 balls of 1 to 5 cm that are shot at hills, for a second.
std::vector<BallDepth> shoot_balls(std::uint64_t seed, double restitution) {
  const GroundMesh mesh = make_surface(16, 0.5, bumpy);
  RigidWorld world;
  add_surface(world, mesh, 0.4, restitution);
  Random random(seed);
  std::vector<BodyId> ids;
  for (int i = 0; i < 100; ++i) {
    const double at_z = random.uniform(-2.5, 2.5), at_y = random.uniform(3, 5);
    const Vec3 at(random.uniform(-2.5, 2.5), at_y, at_z);
    const double to_z = random.uniform(-3, 3);
    const Vec3 to(random.uniform(-3, 3), -1, to_z);
    const Vec3 velocity = random.uniform(20, 100) * (to - at).normalized();
    ids.push_back(world.add(W::moving(W::sphere(random.uniform(0.01, 0.05), at), velocity)));
  }
  std::vector<BallDepth> depths(ids.size());
  for (int step = 0; step < 120; ++step) {
    world.step(kDt_s, kSubsteps);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Vec3 at = world.state(ids[i]).X_WB.position;
      if (std::max(std::abs(at.x()), std::abs(at.z())) > 3.99) continue;
      depths[i].last_m = height_at(mesh, at.x(), at.z()) - at.y();
      depths[i].largest_m = std::max(depths[i].last_m, depths[i].largest_m);  // NaN if the last is
    }
  }
  return depths;
}

TEST(Facets, FastSmallBallsDoNotPassThroughThem) {
  for (const double restitution : {0.0, 0.3}) {
    const std::vector<BallDepth> depths = shoot_balls(7, restitution);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      // A ball that a triangle deflects onto a neighbour within a step may penetrate.
      EXPECT_LT(depths[i].largest_m, 0.3) << "ball " << i << ", restitution " << restitution;
      EXPECT_LT(depths[i].last_m, 0.005) << "ball " << i << ", restitution " << restitution;
    }
  }
}

TEST(Facets, NoneOfVeryManyFastSmallBallsPassesThroughThem) {
  int deep = 0, passed = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double restitution : {0.0, 0.3}) {
      for (const BallDepth& depth : shoot_balls(seed, restitution)) {
        deep += !(depth.largest_m <= 0.05);  // NaN counts
        passed += !(depth.last_m <= 0.05);
      }
    }
  }
  EXPECT_EQ(deep, 0) << "of 4,000";
  EXPECT_EQ(passed, 0) << "of 4,000";
}

TEST(Facets, BodiesDroppedOnBumpyGroundStayAboveIt) {
  const GroundMesh mesh = make_surface(24, 0.4, bumpy);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Random random(seed);
    RigidWorld world;
    add_surface(world, mesh);
    std::vector<BodyId> ids;
    for (int i = 0; i < 60; ++i) {
      const Vec3 at(random.uniform(-4, 4), random.uniform(2, 6), random.uniform(-4, 4));
      BodyDesc body = W::sphere(random.uniform(0.05, 0.4), at);
      if (i % 3 == 0) {
        body = W::box(
            Vec3(random.uniform(0.05, 0.8), random.uniform(0.05, 0.8), random.uniform(0.05, 0.8)),
            at);
      } else if (i % 3 == 1) {
        std::vector<Vec3> points;
        for (int p = 0; p < 12; ++p)
          points.push_back(random.uniform(0.1, 0.5) * random.direction());
        body = W::hull(make_hull(points), at);
      }
      body.X_WB.rotation = Quat(Eigen::AngleAxisd(random.uniform(0, 3), random.direction()));
      ids.push_back(world.add(W::moving(body, 10 * random.direction(), 5 * random.direction())));
    }
    for (int i = 0; i < 240; ++i) world.step(kDt_s, kSubsteps);
    for (const BodyId id : ids) {
      const BodyState state = world.state(id);
      const Vec3 at = state.X_WB.position;
      EXPECT_TRUE(at.allFinite());
      if (std::max(std::abs(at.x()), std::abs(at.z())) > 4.7) continue;
      EXPECT_GT(at.y(), height_at(mesh, at.x(), at.z()) - 0.01) << seed << ": body " << id.slot;
      EXPECT_LT(state.velocity_W.norm(), 12) << "no body is thrown up";
    }
  }
}

TEST(Facets, GiveTheSameBitsForAnyNumberOfThreads) {
  const GroundMesh mesh = make_surface(16, 0.5, bumpy);
  expect_same_for_any_threads([&] {
    RigidWorld world;
    add_surface(world, mesh);
    for (int i = 0; i < 30; ++i)
      world.add(
          W::box(Vec3(0.3, 0.2, 0.4), Vec3(0.3 * (i % 6) - 1, 2 + 0.3 * (i / 6), 0.1 * i - 1)));
    world.run(1, kDt_s, kSubsteps);
    return world.hash();
  });
}

}  // namespace
}  // namespace sunder::solver::facet_test
