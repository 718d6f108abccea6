#include "fracture/solids.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/pattern/pattern.h"
#include "fracture/pattern/voronoi.h"

namespace sunder::fracture {
namespace {

constexpr MaterialIndex kMaterial(0u);
// Limits of a grid's boxes, of Voronoi cells (which take half a minute), and of a hall's columns,
// each of which overlaps with the roof.
constexpr double kMostBoxes = 1e6, kMostCells = 1e5, kMostColumns = 5000;

Vec2 on_circle(double radius, int i, int segments) {
  const SinCos angle = sin_cos(2 * std::numbers::pi * (i % segments) / segments);
  return radius * Vec2(angle.cos, angle.sin);
}

Compound column_compound(double radius, double height) {
  constexpr int kSides = 24;
  std::vector<Vec2> polygon;
  // Counter-clockwise seen from +y is clockwise in (x, z).
  for (int i = kSides; i > 0; --i) polygon.push_back(on_circle(radius, i, kSides));
  return make_compound({{make_prism(polygon, -height / 2, height / 2, true), kMaterial, 0}});
}

/// Returns a torus around y, one hull of two neighbouring circles per segment.
Compound torus_compound(double large, double small) {
  constexpr int kSegments = 16, kSides = 8;
  std::vector<Part> parts;
  for (int s = 0; s < kSegments; ++s) {
    std::vector<Vec3> points;
    for (const int end : {s, s + 1}) {
      for (int i = 0; i < kSides; ++i) {
        const Vec2 around = on_circle(small, i, kSides);
        const Vec2 along = on_circle(large + around.x(), end, kSegments);
        points.emplace_back(along.x(), around.y(), along.y());
      }
    }
    parts.push_back({make_hull(points), kMaterial, 0});
  }
  return make_compound(std::move(parts));
}

/// Returns columns that overlap with the roof, as artists model them (paper, figure 12).
Compound hall_compound(int columns) {
  constexpr double kSpan = 3, kHeight = 3, kRadius = 0.3, kRoof = 0.5, kReach = 0.2;
  constexpr int kSides = 12;
  std::vector<Vec2> circle;
  for (int i = kSides; i > 0; --i) circle.push_back(on_circle(kRadius, i, kSides));
  std::vector<Part> parts;
  for (int c = 0; c < columns; ++c) {
    ConvexPolyhedron column = make_prism(circle, 0, kHeight + kReach, true);
    column = transformed(column, Pose{Vec3(c * kSpan, 0, 0), Quat::Identity()});
    parts.push_back({std::move(column), kMaterial, 1});
  }
  const Vec3 low(-1, kHeight, -1), high((columns - 1) * kSpan + 1, kHeight + kRoof, 1);
  parts.push_back({make_box(low, high), kMaterial, 0});
  return make_compound(std::move(parts));
}

}  // namespace

Compound box_compound(const Vec3& min, const Vec3& max, std::uint8_t anchored) {
  return make_compound({{make_box(min, max), kMaterial, anchored}});
}

Compound grid_compound(int nx, int ny, int nz, const Vec3& size, bool anchored) {
  std::vector<Part> parts;
  for (int x = 0; x < nx; ++x) {
    for (int y = 0; y < ny; ++y) {
      for (int z = 0; z < nz; ++z) {
        const Vec3 min = size.cwiseProduct(Vec3(x, y, z));
        const Vec3 max = size.cwiseProduct(Vec3(x + 1, y + 1, z + 1));
        const bool is_anchored = anchored && y == 0;
        parts.push_back({make_box(min, max), kMaterial, static_cast<std::uint8_t>(is_anchored)});
      }
    }
  }
  return make_compound(std::move(parts));
}

Compound voronoi_compound(int count, std::uint64_t seed) {
  Random random(seed, 77);
  std::vector<Vec3> sites;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-.5, .5), y = random.uniform(-.5, .5);
    sites.emplace_back(x, y, random.uniform(-.5, .5));
  }
  std::vector<Plane> planes = box_planes();
  const ConvexPolyhedron solid = make_box(Vec3::Constant(-.5), Vec3::Constant(.5));
  std::vector<Part> parts;
  for (ConvexPolyhedron& cell : voronoi_cells(sites, solid, planes)) {
    if (!cell.empty()) parts.push_back({std::move(cell), kMaterial, 0});
  }
  return make_compound(std::move(parts), 1e-9);
}

Compound make_solid(const std::string& name) {
  const auto colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  std::vector<double> sizes;
  std::istringstream numbers(colon == std::string::npos ? "" : name.substr(colon + 1));
  bool good = true;
  for (std::string number; std::getline(numbers, number, ',');) {
    std::istringstream text(number);
    double value = 0;
    good &= (text >> value) && text.eof() && value > 0 && value <= 1e6;
    sizes.push_back(value);
  }
  const auto is = [&](const char* wanted, std::size_t count) {
    return good && kind == wanted && sizes.size() == count;
  };
  const auto whole = [&](std::size_t i) { return sizes[i] == std::floor(sizes[i]); };
  if (is("box", 3)) {
    const Vec3 half = 0.5 * Vec3(sizes[0], sizes[1], sizes[2]);
    return box_compound(-half, half);
  }
  if (is("column", 2)) return column_compound(sizes[0], sizes[1]);
  if (is("torus", 2) && sizes[1] < sizes[0]) return torus_compound(sizes[0], sizes[1]);
  if (is("grid", 3) && whole(0) && whole(1) && whole(2) &&
      sizes[0] * sizes[1] * sizes[2] <= kMostBoxes) {
    return grid_compound(static_cast<int>(sizes[0]), static_cast<int>(sizes[1]),
                         static_cast<int>(sizes[2]));
  }
  if (is("voronoi", 1) && whole(0) && sizes[0] <= kMostCells) {
    return voronoi_compound(static_cast<int>(sizes[0]), 1);
  }
  if (is("hall", 1) && whole(0) && sizes[0] <= kMostColumns) {
    return hall_compound(static_cast<int>(sizes[0]));
  }
  throw InputError("'" + name +
                   "' is not a built-in solid; expected box:X,Y,Z, column:R,H, torus:R,r (r < R), "
                   "grid:NX,NY,NZ (at most 1,000,000 boxes), voronoi:N (at most 100,000) or hall:N "
                   "(at most 5,000), with sizes above 0 and at most 1,000,000");
}

}  // namespace sunder::fracture
