// What cutting, weighing and finding convexes costs.
#include <algorithm>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/base/random.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/convex_polyhedron.h"

namespace sunder {
namespace {

Vec3 random_point(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

/// The planes of each cell of a Voronoi diagram, nearest first.
std::vector<std::vector<Plane>> voronoi_planes(std::size_t cells) {
  Random random(1);
  std::vector<Vec3> sites(cells);
  for (Vec3& site : sites) site = random_point(random, 1);
  std::vector<std::vector<Plane>> planes(cells);
  for (std::size_t c = 0; c < cells; ++c) {
    std::vector<Vec3> others = sites;
    std::swap(others[c], others.back());
    others.pop_back();
    const Vec3 site = sites[c];
    std::sort(others.begin(), others.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - site).squaredNorm() < (b - site).squaredNorm();
    });
    for (const Vec3& other : others) {
      planes[c].push_back(Plane::through(0.5 * (site + other), (other - site).normalized()));
    }
  }
  return planes;
}

/// A convex about as complex as the cell of a Voronoi diagram, by cutting the corners of a box.
ConvexPolyhedron rounded_box(int cuts) {
  Random random(2);
  ConvexPolyhedron solid = make_box(-Vec3::Ones(), Vec3::Ones()), next;
  ClipScratch scratch;
  for (int i = 0; i < cuts; ++i) {
    const Vec3 normal = random.direction();
    if (clip(solid, Plane{normal, -0.95}, {2}, 0, next, scratch) == PlaneSide::kCut) {
      std::swap(solid, next);
    }
  }
  return solid;
}

std::vector<Plane> random_planes(double reach) {
  Random random(3);
  std::vector<Plane> planes(256);
  for (Plane& plane : planes) {
    const Vec3 normal = random.direction();
    plane = Plane{normal, random.uniform(-reach, reach)};
  }
  return planes;
}

void clip_convex(benchmark::State& state) {
  const ConvexPolyhedron solid = rounded_box(static_cast<int>(state.range(0)));
  const std::vector<Plane> planes = random_planes(0.6);
  ConvexPolyhedron result;
  ClipScratch scratch;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(clip(solid, planes[i++ % 256], {2}, 1e-12, result, scratch));
  }
  state.counters["faces"] = static_cast<double>(solid.faces.size());
}
BENCHMARK(clip_convex)->Arg(0)->Arg(10)->Arg(30)->Arg(200);

void clip_missed(benchmark::State& state) {
  const ConvexPolyhedron solid = rounded_box(10);
  ConvexPolyhedron result;
  ClipScratch scratch;
  const Plane plane{Vec3(0.6, 0.64, 0.48), -2};
  for (auto _ : state) {
    benchmark::DoNotOptimize(clip(solid, plane, {2}, 1e-12, result, scratch));
  }
}
BENCHMARK(clip_missed);

void voronoi_against_box(benchmark::State& state) {
  const auto cells = voronoi_planes(static_cast<std::size_t>(state.range(0)));
  const ConvexPolyhedron box = make_box(-Vec3::Ones(), Vec3::Ones());
  ConvexPolyhedron cell, next;
  ClipScratch scratch;
  std::size_t cuts = 0, clips = 0;
  for (auto _ : state) {
    for (const std::vector<Plane>& planes : cells) {
      const ConvexPolyhedron* current = &box;
      for (const Plane& plane : planes) {
        ++clips;
        if (clip(*current, plane, {2}, 1e-12, next, scratch) != PlaneSide::kCut) continue;
        std::swap(cell, next);
        current = &cell;
        ++cuts;
      }
      benchmark::DoNotOptimize(cell.vertices.data());
    }
  }
  state.counters["cuts"] =
      benchmark::Counter(static_cast<double>(cuts), benchmark::Counter::kAvgIterations);
  state.counters["clips"] =
      benchmark::Counter(static_cast<double>(clips), benchmark::Counter::kAvgIterations);
}
BENCHMARK(voronoi_against_box)->Arg(50)->Unit(benchmark::kMicrosecond);

void weigh_convex(benchmark::State& state) {
  const ConvexPolyhedron solid = rounded_box(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(mass_properties(solid));
}
BENCHMARK(weigh_convex)->Arg(0)->Arg(10)->Arg(30);

void hull_of_points(benchmark::State& state) {
  Random random(4);
  std::vector<Vec3> points(static_cast<std::size_t>(state.range(0)));
  for (Vec3& p : points) p = random_point(random, 1);
  for (auto _ : state) benchmark::DoNotOptimize(make_hull(points));
}
BENCHMARK(hull_of_points)->Arg(30)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

std::vector<Box> random_boxes(std::size_t count) {
  Random random(5);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    box.min = random_point(random, 50);
    box.max = box.min + Vec3::Ones();
  }
  return boxes;
}

void build_bvh(benchmark::State& state) {
  const std::vector<Box> boxes = random_boxes(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(Bvh(boxes));
}
BENCHMARK(build_bvh)->Arg(1000)->Arg(20000)->Unit(benchmark::kMicrosecond);

void query_bvh(benchmark::State& state) {
  const std::vector<Box> boxes = random_boxes(20000);
  const Bvh bvh(boxes);
  std::vector<std::uint32_t> hits;
  std::size_t i = 0;
  for (auto _ : state) {
    hits.clear();
    bvh.overlaps(boxes[i++ % boxes.size()], hits);
    benchmark::DoNotOptimize(hits.data());
  }
}
BENCHMARK(query_bvh);

}  // namespace
}  // namespace sunder
