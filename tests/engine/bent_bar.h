// A bar of blocks that bends in its middle, for tests of mitres.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/mitre.h"
#include "tests/engine/geometry_fixtures.h"

namespace sunder::test {

inline constexpr double kRadian = 3.14159265358979323846 / 180;
inline constexpr double kTolerance = 1e-14;

/// Returns the index of the face whose normal is closest to `direction`.
inline std::uint32_t face_towards(const ConvexPolyhedron& convex, const Vec3& direction) {
  const auto is_less_aligned = [&](const ConvexPolyhedron::Face& a,
                                   const ConvexPolyhedron::Face& b) {
    return a.plane.normal.dot(direction) < b.plane.normal.dot(direction);
  };
  return static_cast<std::uint32_t>(
      std::max_element(convex.faces.begin(), convex.faces.end(), is_less_aligned) -
      convex.faces.begin());
}

/// One side of a bar: columns of convexes, each listed from the section outwards.
struct Side {
  std::vector<std::vector<ConvexPolyhedron>> columns;
  SectionEnd end;
  PlaneId section;

  /// Calls `visit(convex, face index)` for each face that lies in the section.
  template <class Visit>
  void for_each_end(const Visit& visit) const {
    for (const auto& column : columns) {
      for (const ConvexPolyhedron& convex : column) {
        for (std::size_t f = 0; f < convex.faces.size(); ++f) {
          if (convex.faces[f].id == section) visit(convex, f);
        }
      }
    }
  }
  std::size_t size() const {
    std::size_t sum = 0;
    for (const auto& column : columns) sum += column.size();
    return sum;
  }
  double volume() const {
    double sum = 0;
    for (const auto& column : columns) {
      for (const ConvexPolyhedron& convex : column) sum += test::volume(convex);
    }
    return sum;
  }
  double section_area() const {
    double sum = 0;
    for_each_end(
        [&](const ConvexPolyhedron& convex, std::size_t f) { sum += face_area(convex, f); });
    return sum;
  }
  /// Returns the largest coordinate of the section's corners along `direction`.
  double reach(const Pose& X_AB, const Vec3& direction) const {
    double farthest = -1e300;
    for_each_end([&](const ConvexPolyhedron& convex, std::size_t f) {
      for (const std::uint32_t v : convex.face_corners(f)) {
        farthest = std::max(farthest, direction.dot(X_AB * convex.vertices[v]));
      }
    });
    return farthest;
  }
};

/// A bar of blocks from x = −2 to 2 with a section at x = 0.
struct Bar {
  int length, depth, width;  ///< Number of blocks of one side along x, y and z.
  double height = 1, breadth = 0.5;
  SectionEnd a{{0, 0.5, 0.25}, Vec3::UnitX()}, b{{0, 0.5, 0.25}, -Vec3::UnitX()};

  /// Returns the id of the grid plane `place` along `axis`, as a face of the block below or above.
  static PlaneId plane_id(int axis, int place, bool above) {
    return {2 * static_cast<std::uint64_t>(1000 * (axis + 1) + place) + (above ? 1 : 0)};
  }

  Side side(bool is_a) const {
    Side side{{}, is_a ? a : b, plane_id(0, 0, !is_a)};
    for (int j = 0; j < depth; ++j) {
      for (int k = 0; k < width; ++k) {
        auto& column = side.columns.emplace_back();
        for (int i = 0; i < length; ++i) column.push_back(block(is_a ? -1 - i : i, j, k));
      }
    }
    return side;
  }
  ConvexPolyhedron block(int i, int j, int k) const {
    const Vec3 size(2.0 / length, height / depth, breadth / width);
    ConvexPolyhedron box =
        make_box(Vec3(i, j, k).cwiseProduct(size), Vec3(i + 1, j + 1, k + 1).cwiseProduct(size));
    const int at[] = {i, j, k};
    for (int axis = 0; axis < 3; ++axis) {
      const auto f = static_cast<std::size_t>(2 * axis);
      box.faces[f].id = plane_id(axis, at[axis], true);
      box.faces[f + 1].id = plane_id(axis, at[axis] + 1, false);
    }
    return box;
  }
};

/// Returns `side` with its columns ended in `midplane`, whose faces get the id `id`.
inline Side mitred(const Side& side, const Plane& midplane, PlaneId id) {
  MitreScratch scratch;
  Side ended{{}, side.end, id};
  for (const std::vector<ConvexPolyhedron>& column : side.columns) {
    std::vector<ColumnCell> cells;
    for (const ConvexPolyhedron& convex : column) {
      cells.push_back({&convex, face_towards(convex, side.end.along)});
    }
    ConvexPolyhedron last;
    const auto kept = mitre(cells, midplane, id, kTolerance, last, scratch);
    if (!kept) continue;
    auto& shorter =
        ended.columns.emplace_back(column.begin() + std::ptrdiff_t(*kept), column.end());
    shorter.front() = last;
  }
  return ended;
}

/// Returns the pose of side B in A's frame: turned about B's section centroid, then moved by `gap`.
inline Pose turned(const Bar& bar, const Quat& turn, const Vec3& gap = Vec3::Zero()) {
  return {bar.a.centroid - turn * bar.b.centroid + gap, turn};
}

}  // namespace sunder::test
