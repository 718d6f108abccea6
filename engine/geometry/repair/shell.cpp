// Marching tetrahedra: each cube of the grid is divided into six tetrahedra around a diagonal,
// whose faces match those of adjacent cubes, so the surface is closed.
#include "engine/geometry/repair/shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/winding.h"
#include "engine/geometry/triangulate.h"

namespace sunder {
namespace {

/// Winding number above which a point is inside; next to a single triangle it is 1/2.
constexpr double kInsideThreshold = 0.6;
constexpr double kMaxWork = 1.5e7;  ///< Bound on the triangles and dipoles to sum over the grid.
constexpr std::uint32_t kMinCellsAlong = 4;  ///< The grid is not made coarser than about this.
constexpr int kBisections = 4;  ///< Bisection steps to find the crossing of a grid edge.

using GridEdge = std::pair<std::uint32_t, std::uint32_t>;  ///< Grid points inside and outside.

std::vector<std::array<Vec3, 3>> triangles_of(const RawMesh& mesh) {
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<Vec3> contour;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    contour.clear();
    for (const std::uint32_t v : mesh.polygon_corners(p)) contour.push_back(mesh.vertices[v]);
    for (const Triangle& t : triangulate(contour)) {
      triangles.push_back({contour[t[0]], contour[t[1]], contour[t[2]]});
    }
  }
  return triangles;
}

class WindingGrid {
 public:
  WindingGrid(const RawMesh& mesh, std::uint32_t cells_along) : field_(triangles_of(mesh)) {
    Box box;
    for (const std::uint32_t v : mesh.corners) box.extend(mesh.vertices[v]);
    do {
      lay_out(box, cells_along);
    } while (too_much_work() && (cells_along -= cells_along / 4) > kMinCellsAlong);
    sample();
  }

  RawMesh surface() {
    for (std::uint32_t z = 0; z + 1 < size_[2]; ++z) {
      for (std::uint32_t y = 0; y + 1 < size_[1]; ++y) {
        for (std::uint32_t x = 0; x + 1 < size_[0]; ++x) march(x, y, z);
      }
    }
    return build();
  }

 private:
  void lay_out(const Box& box, std::uint32_t cells_along) {
    cell_ = box.extent().maxCoeff() / cells_along;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      size_[k] = static_cast<std::uint32_t>(std::ceil(box.extent()[axis] / cell_)) + 4;
    }
    const Vec3 span = cell_ * Vec3(size_[0] - 1, size_[1] - 1, size_[2] - 1);
    origin_ = box.center() - 0.5 * span;
  }

  std::uint32_t point_count() const { return size_[0] * size_[1] * size_[2]; }

  /// Returns true if samples predict more work than kMaxWork, as for overlapping triangles.
  bool too_much_work() const {
    constexpr std::uint32_t kWorkSamples = 64;
    std::size_t work = 0;
    for (std::uint32_t i = 0; i < kWorkSamples; ++i) {
      const auto grid_point = static_cast<std::uint32_t>(mix(i) % point_count());
      work += field_.work_at(place(grid_point));
    }
    return static_cast<double>(work) / kWorkSamples * point_count() > kMaxWork;
  }

  std::uint32_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (z * size_[1] + y) * size_[0] + x;
  }
  Vec3 place(std::uint32_t i) const {
    return origin_ + cell_ * Vec3(i % size_[0], i / size_[0] % size_[1], i / size_[0] / size_[1]);
  }
  bool encloses(const Vec3& point) const { return sense_ * field_.at(point) > kInsideThreshold; }

  bool is_on_boundary(std::uint32_t i) const {
    const std::uint32_t at[3] = {i % size_[0], i / size_[0] % size_[1], i / size_[0] / size_[1]};
    bool boundary = false;
    for (std::size_t k = 0; k < 3; ++k) boundary = boundary || at[k] == 0 || at[k] + 1 == size_[k];
    return boundary;
  }

  void sample() {
    std::vector<double> winding(point_count(), 0);
    for_chunks(winding.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
        if (!is_on_boundary(i)) winding[i] = field_.at(place(i));
      }
    });
    const auto count_inside = [&](double sense) {
      return std::count_if(winding.begin(), winding.end(),
                           [sense](double w) { return sense * w > kInsideThreshold; });
    };
    sense_ = count_inside(1) >= count_inside(-1) ? 1 : -1;
    for (const double w : winding) inside_.push_back(sense_ * w > kInsideThreshold ? 1 : 0);
  }

  void march(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::array<std::uint32_t, 8> cube;
    unsigned count = 0;
    for (std::uint32_t k = 0; k < 8; ++k) {
      cube[k] = index(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
      count += inside_[cube[k]];
    }
    if (count == 0 || count == 8) return;
    // Each goes from corner 0 to corner 7 along the three axes in one order; all are right-handed.
    constexpr std::uint32_t kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 4, 5, 7},
                                                 {0, 6, 4, 7}, {0, 2, 6, 7}, {0, 3, 2, 7}};
    for (const auto& t : kTetrahedra) tetrahedron({cube[t[0]], cube[t[1]], cube[t[2]], cube[t[3]]});
  }

  void tetrahedron(std::array<std::uint32_t, 4> t) {
    // Sorts inside corners first; an odd permutation reverses the orientation of the triangles.
    std::array<std::uint32_t, 4> sorted = t;
    std::stable_partition(sorted.begin(), sorted.end(),
                          [&](std::uint32_t i) { return inside_[i] != 0; });
    int swaps = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at =
          static_cast<std::size_t>(std::find(t.begin(), t.end(), sorted[i]) - t.begin());
      if (at == i) continue;
      std::swap(t[i], t[at]);
      ++swaps;
    }
    const auto [a, b, c, d] = sorted;
    const unsigned count = inside_[a] + inside_[b] + inside_[c] + inside_[d];
    const bool even = swaps % 2 == 0;
    if (count == 1) {
      add({GridEdge{a, b}, {a, c}, {a, d}}, even);
    } else if (count == 2) {
      add({GridEdge{a, c}, {a, d}, {b, d}}, even);
      add({GridEdge{a, c}, {b, d}, {b, c}}, even);
    } else if (count == 3) {
      add({GridEdge{a, d}, {c, d}, {b, d}}, !even);
    }
  }

  void add(std::array<GridEdge, 3> triangle, bool even) {
    if (!even) std::swap(triangle[1], triangle[2]);
    for (const GridEdge& edge : triangle) corners_.push_back(edge);
  }

  RawMesh build() {
    std::vector<GridEdge> edges = corners_;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    RawMesh mesh;
    mesh.vertices.resize(edges.size());
    for_chunks(edges.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t e = begin; e < end; ++e) mesh.vertices[e] = crossing(edges[e]);
    });
    for (std::size_t c = 0; c < corners_.size(); c += 3) {
      std::array<std::uint32_t, 3> vertices;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = std::lower_bound(edges.begin(), edges.end(), corners_[c + k]);
        vertices[k] = static_cast<std::uint32_t>(at - edges.begin());
      }
      append_polygon(mesh, vertices, RawMesh::kNoGroup);
    }
    return mesh;
  }

  Vec3 crossing(const GridEdge& edge) const {
    const Vec3 from = place(edge.first), to = place(edge.second);
    double low = 0, high = 1;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (encloses(from + middle * (to - from)) ? low : high) = middle;
    }
    return from + 0.5 * (low + high) * (to - from);
  }

  WindingField field_;
  Vec3 origin_;
  double cell_ = 0;
  double sense_ = 1;  ///< Factor of winding numbers: -1 if the mesh is inside out.
  std::array<std::uint32_t, 3> size_{};
  std::vector<std::uint8_t> inside_;
  std::vector<GridEdge> corners_;  ///< Three for each triangle.
};

}  // namespace

RawMesh winding_shell(const RawMesh& mesh, std::uint32_t cells_along) {
  return WindingGrid(mesh, cells_along).surface();
}

}  // namespace sunder
