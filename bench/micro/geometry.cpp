// Timing of geometry: clipping, mass properties, hulls and bounding volume hierarchies.
#include <algorithm>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "engine/geometry/mesh_islands.h"
#include "engine/geometry/split_mesh.h"

namespace sunder {
namespace {

Vec3 random_point(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

/// Returns the bisector planes of each cell of a Voronoi diagram, nearest neighbour first.
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

/// Returns a box with corners cut off, about as complex as a cell of a Voronoi diagram.
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

/// Times cuts of a solid by random planes within `reach` of its centre.
template <class Solid, class Scratch>
void time_clips(benchmark::State& state, const Solid& solid, double reach) {
  const std::vector<Plane> planes = random_planes(reach);
  Solid result;
  Scratch scratch;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(clip(solid, planes[i++ % 256], {2}, 1e-12, result, scratch));
  }
  state.counters["faces"] = static_cast<double>(solid.faces.size());
}

void clip_convex(benchmark::State& state) {
  time_clips<ConvexPolyhedron, ClipScratch>(state, rounded_box(static_cast<int>(state.range(0))),
                                            0.6);
}
BENCHMARK(clip_convex)->Name("geometry/clip_convex")->Arg(0)->Arg(10)->Arg(30)->Arg(200);

void clip_missed(benchmark::State& state) {
  const ConvexPolyhedron solid = rounded_box(10);
  ConvexPolyhedron result;
  ClipScratch scratch;
  const Plane plane{Vec3(0.6, 0.64, 0.48), -2};
  for (auto _ : state) {
    benchmark::DoNotOptimize(clip(solid, plane, {2}, 1e-12, result, scratch));
  }
}
BENCHMARK(clip_missed)->Name("geometry/clip_missed");

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
BENCHMARK(voronoi_against_box)
    ->Name("geometry/voronoi_against_box")
    ->Arg(50)
    ->Unit(benchmark::kMicrosecond);

void weigh_convex(benchmark::State& state) {
  const ConvexPolyhedron solid = rounded_box(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(mass_properties(solid));
}
BENCHMARK(weigh_convex)->Name("geometry/weigh_convex")->Arg(0)->Arg(10)->Arg(30);

void hull_of_points(benchmark::State& state) {
  Random random(4);
  std::vector<Vec3> points(static_cast<std::size_t>(state.range(0)));
  for (Vec3& p : points) p = random_point(random, 1);
  for (auto _ : state) benchmark::DoNotOptimize(make_hull(points));
}
BENCHMARK(hull_of_points)
    ->Name("geometry/hull_of_points")
    ->Arg(30)
    ->Arg(1000)
    ->Arg(10000)
    ->Unit(benchmark::kMicrosecond);

/// Returns a torus of 2 * around * tube triangles, rotated so that no edge is parallel to an axis.
PolygonMesh torus(std::uint32_t around, std::uint32_t tube) {
  PolygonMesh mesh;
  const Quat turn = Quat(0.8, 0.2, 0.4, 0.4).normalized();
  for (std::uint32_t i = 0; i < around * tube; ++i) {
    const SinCos u = sin_cos(6.283185307179586 * (i / tube) / around);
    const SinCos v = sin_cos(6.283185307179586 * (i % tube) / tube);
    const double r = 0.7 + 0.3 * v.cos;
    mesh.vertices.push_back(turn * Vec3(r * u.cos, 0.3 * v.sin, -r * u.sin));
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3& p = mesh.vertices[a];
    const Vec3 normal = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).normalized();
    const auto index = static_cast<std::uint32_t>(mesh.contours.size());
    mesh.faces.push_back({Plane::through(p, normal), {}, index, 1, FaceKind::kSurface});
    mesh.contours.push_back({3 * index, 3});
    mesh.corners.insert(mesh.corners.end(), {a, b, c});
    mesh.corner_normals.resize(mesh.corners.size(), normal.cast<float>());
  };
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * tube + j % tube; };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < tube; ++j) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

void clip_torus(benchmark::State& state) {
  const auto around = static_cast<std::uint32_t>(state.range(0));
  time_clips<PolygonMesh, MeshClipScratch>(state, torus(around, 30), 0.3);
}
BENCHMARK(clip_torus)
    ->Name("geometry/clip_torus")
    ->Arg(20)
    ->Arg(200)
    ->Unit(benchmark::kMicrosecond);

void voronoi_against_torus(benchmark::State& state) {
  const PolygonMesh mesh = torus(200, 30);
  const auto cells = voronoi_planes(static_cast<std::size_t>(state.range(0)));
  const ConvexPolyhedron box = make_box(-Vec3::Ones(), Vec3::Ones());
  std::vector<std::vector<NamedPlane>> planes(cells.size());
  std::vector<MeshRegion> regions;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    ClipScratch scratch;
    ConvexPolyhedron cell = box, next;
    for (const Plane& plane : cells[c]) {
      if (clip(cell, plane, {2}, 0, next, scratch) != PlaneSide::kCut) continue;
      std::swap(cell, next);
      planes[c].push_back({plane, {2}});
    }
    regions.push_back({bounds(cell), planes[c]});
  }
  for (auto _ : state) {
    for (PolygonMesh& part : split(mesh, regions, 0)) {
      benchmark::DoNotOptimize(islands(std::move(part)));
    }
  }
}
BENCHMARK(voronoi_against_torus)
    ->Name("geometry/voronoi_against_torus")
    ->Arg(20)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

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
BENCHMARK(build_bvh)
    ->Name("geometry/build_bvh")
    ->Arg(1000)
    ->Arg(20000)
    ->Unit(benchmark::kMicrosecond);

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
BENCHMARK(query_bvh)->Name("geometry/query_bvh");

}  // namespace
}  // namespace sunder
