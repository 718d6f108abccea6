#include "scenes/sculpture/implicit_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"

namespace sunder::scenes {
namespace {

constexpr double kMaxGradient = 2;        ///< Largest gradient of a Field.
constexpr double kDifferenceStep = 1e-4;  ///< Step of central differences, of a cell.
constexpr int kProjectionSteps = 2;       ///< Steps that move a vertex onto the surface.
constexpr std::uint32_t kBlock = 4;       ///< Cells along the edge of a block.
constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::array<std::size_t, 3> kAxes = {0, 1, 2};

using Corner = std::array<std::uint32_t, 3>;  ///< Grid coordinates of a corner of cells.
/// A number for each edge of a cell; see edge().
using CellEdges = std::array<std::uint32_t, 12>;

/// Returns a corner of a cell; bit a of `corner` is 1 if it is the far one along axis a.
Corner corner_of(Corner cell, std::uint32_t corner) {
  for (const std::size_t a : kAxes) cell[a] += corner >> a & 1;
  return cell;
}

/// Returns the index of the edge of a cell along an axis that begins or ends at a corner.
std::uint32_t edge(std::size_t axis, std::uint32_t corner) {
  const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
  return static_cast<std::uint32_t>(4 * axis) + (corner >> b & 1) + 2 * (corner >> c & 1);
}

class SurfaceNet {
 public:
  SurfaceNet(const Field& field, const Box& box, double cell_m) : field_(field), cell_(cell_m) {
    for (const std::size_t a : kAxes) {
      // Whole blocks, with at least two cells around the box.
      const double cells = box.extent()[static_cast<Eigen::Index>(a)] / cell_ + 4;
      size_[a] = kBlock * static_cast<std::uint32_t>(std::ceil(cells / kBlock));
    }
    origin_ = box.center() - 0.5 * cell_ * Vec3(size_[0], size_[1], size_[2]);
  }

  RawMesh surface() {
    sample();
    place_vertices();
    move_onto_surface();
    for_points([&](Corner at) { cross_edges(at); });
    return std::move(mesh_);
  }

 private:
  /// Returns the index of a corner, or of the cell whose corners begin there.
  std::size_t index(Corner at) const {
    return (std::size_t{at[2]} * size_[1] + at[1]) * size_[0] + at[0];
  }
  Vec3 position(Corner at) const { return origin_ + cell_ * Vec3(at[0], at[1], at[2]); }
  template <class Use>
  void for_points(const Use& use) const {
    for (std::uint32_t z = 0; z < size_[2]; ++z)
      for (std::uint32_t y = 0; y < size_[1]; ++y)
        for (std::uint32_t x = 0; x < size_[0]; ++x) use(Corner{x, y, z});
  }

  /// Evaluates the field at all corners of blocks that the surface may pass through. Other blocks
  /// have the value at their middle in all corners, which has the correct sign.
  void sample() {
    values_.resize(std::size_t{size_[0]} * size_[1] * size_[2]);
    const std::size_t blocks = values_.size() / (kBlock * kBlock * kBlock);
    const std::uint32_t along_x = size_[0] / kBlock, along_y = size_[1] / kBlock;
    for_chunks(blocks, 4, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (auto b = static_cast<std::uint32_t>(begin); b < end; ++b) {
        sample(
            {b % along_x * kBlock, b / along_x % along_y * kBlock, b / along_x / along_y * kBlock});
      }
    });
  }

  void sample(Corner block) {
    const double reach_m = 0.5 * std::sqrt(3.0) * cell_ * kBlock;
    const double middle = field_(position(block) + Vec3::Constant(0.5 * cell_ * kBlock));
    const bool near = std::abs(middle) < kMaxGradient * reach_m;
    for (std::uint32_t z = block[2]; z < block[2] + kBlock; ++z)
      for (std::uint32_t y = block[1]; y < block[1] + kBlock; ++y)
        for (std::uint32_t x = block[0]; x < block[0] + kBlock; ++x)
          values_[index({x, y, z})] = near ? field_(position({x, y, z})) : middle;
  }

  /// Adds a vertex for each sheet of the surface in a cell: the mean of its crossings with edges.
  void place_vertices() {
    cell_at_.assign(values_.size(), kNone);
    for_points([&](Corner at) {
      for (const std::size_t a : kAxes)
        if (at[a] + 1 == size_[a]) return;
      unsigned inside = 0;
      for (std::uint32_t c = 0; c < 8; ++c)
        inside |= unsigned{values_[index(corner_of(at, c))] < 0} << c;
      if (inside == 0 || inside == 255) return;
      cell_at_[index(at)] = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(sheets(inside));
      place_vertices(at, cells_.back());
    });
  }

  /// Returns the sheets of a cell, of which the corners in the bits of `inside` are inside: for
  /// each crossed edge the lowest index of an edge of its sheet, otherwise kNone. Two crossed edges
  /// of one side are in one sheet; if four are, the two at each inner corner.
  static CellEdges sheets(unsigned inside) {
    CellEdges sheet;
    const auto is_inside = [inside](std::uint32_t corner) { return (inside >> corner & 1) != 0; };
    for (const std::size_t a : kAxes)
      for (std::uint32_t c = 0; c < 8; ++c)
        if ((c >> a & 1) == 0)
          sheet[edge(a, c)] = is_inside(c) != is_inside(c | 1u << a) ? edge(a, c) : kNone;
    const auto join = [&sheet](std::uint32_t one, std::uint32_t other) {
      const std::uint32_t to = std::min(sheet[one], sheet[other]);
      const std::uint32_t from = std::max(sheet[one], sheet[other]);
      std::replace(sheet.begin(), sheet.end(), from, to);
    };
    for (const std::size_t a : kAxes) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      for (const std::uint32_t side : {0u, 1u << a}) {
        std::vector<std::uint32_t> crossed;
        for (const std::uint32_t e :
             {edge(b, side), edge(b, side | 1u << c), edge(c, side), edge(c, side | 1u << b)}) {
          if (sheet[e] != kNone) crossed.push_back(e);
        }
        if (crossed.size() == 2) join(crossed[0], crossed[1]);
        if (crossed.size() != 4) continue;
        for (const std::uint32_t corner : {0u, 1u << b, 1u << c, 1u << b | 1u << c}) {
          if (is_inside(side | corner)) join(edge(b, side | corner), edge(c, side | corner));
        }
      }
    }
    return sheet;
  }

  /// Replaces the sheets of a cell by the indices of their vertices.
  void place_vertices(Corner at, CellEdges& sheet_of) {
    const CellEdges sheets = sheet_of;
    for (std::uint32_t sheet = 0; sheet < sheets.size(); ++sheet) {
      if (sheets[sheet] != sheet) continue;
      Vec3 sum = Vec3::Zero();
      int crossed = 0;
      for (const std::size_t a : kAxes) {
        for (std::uint32_t c = 0; c < 8; ++c) {
          if ((c >> a & 1) != 0 || sheets[edge(a, c)] != sheet) continue;
          const Corner from = corner_of(at, c), to = corner_of(at, c | 1u << a);
          const double v = values_[index(from)], w = values_[index(to)];
          sum += position(from) + v / (v - w) * (position(to) - position(from));
          ++crossed;
          sheet_of[edge(a, c)] = static_cast<std::uint32_t>(mesh_.vertices.size());
        }
      }
      mesh_.vertices.push_back(sum / crossed);
    }
  }

  Vec3 gradient(const Vec3& point) const {
    const double step = kDifferenceStep * cell_;
    Vec3 slope;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const Vec3 aside = step * Vec3::Unit(a);
      slope[a] = (field_(point + aside) - field_(point - aside)) / (2 * step);
    }
    return slope;
  }

  /// Moves vertices along the gradient onto the surface, by at most half a cell in each step, and
  /// sets their normals to the gradient there.
  void move_onto_surface() {
    normals_.resize(mesh_.vertices.size());
    for_chunks(normals_.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t v = begin; v < end; ++v) {
        Vec3& point = mesh_.vertices[v];
        const Vec3 slope = gradient(point);
        const double steepness = std::max(slope.norm(), 0.1);
        for (int i = 0; i < kProjectionSteps; ++i) {
          const double distance = std::clamp(-field_(point) / steepness, -0.5 * cell_, 0.5 * cell_);
          point += distance / steepness * slope;
        }
        normals_[v] = gradient(point).normalized().cast<float>();
      }
    });
  }

  /// Adds two triangles around each grid edge from `at` that the surface crosses.
  void cross_edges(Corner at) {
    for (const std::size_t a : kAxes) {
      if (at[a] + 1 == size_[a]) continue;
      auto next = at;
      ++next[a];
      const bool inside = values_[index(at)] < 0;
      if (inside == (values_[index(next)] < 0)) continue;
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      std::array<std::uint32_t, 4> quad;  // counter-clockwise about the axis
      for (std::uint32_t k = 0; k < 4; ++k) {
        // The edge is on the far side of the cell in b if far_b, and in c if far_c.
        const std::uint32_t far_b = k == 1 || k == 2 ? 0 : 1, far_c = k >= 2 ? 0 : 1;
        Corner cell = at;
        cell[b] -= far_b;
        cell[c] -= far_c;
        quad[k] = cells_[cell_at_[index(cell)]][edge(a, far_b << b | far_c << c)];
      }
      if (!inside) std::swap(quad[1], quad[3]);
      const auto diagonal = [&](std::size_t i, std::size_t j) {
        return (mesh_.vertices[quad[i]] - mesh_.vertices[quad[j]]).squaredNorm();
      };
      const std::size_t first = diagonal(0, 2) <= diagonal(1, 3) ? 0 : 1;
      add({quad[first], quad[first + 1], quad[first + 2]});
      add({quad[first], quad[first + 2], quad[(first + 3) % 4]});
    }
  }

  void add(std::array<std::uint32_t, 3> triangle) {
    mesh_.polygons.push_back({static_cast<std::uint32_t>(mesh_.corners.size()), 3, 0});
    for (const std::uint32_t v : triangle) {
      mesh_.corners.push_back(v);
      mesh_.corner_normals.push_back(normals_[v]);
    }
  }

  const Field& field_;
  const double cell_;
  Vec3 origin_;
  std::array<std::uint32_t, 3> size_{};  ///< Number of corners along each axis.
  std::vector<double> values_;           ///< Field at each corner.
  std::vector<std::uint32_t>
      cell_at_;                   ///< Index into cells_; kNone where the surface does not pass.
  std::vector<CellEdges> cells_;  ///< Vertex of the sheet that crosses each edge.
  std::vector<Vec3f> normals_;    ///< Normal of each vertex.
  RawMesh mesh_;
};

}  // namespace

RawMesh triangulate(const Field& field, const Box& box, double cell_m) {
  return SurfaceNet(field, box, cell_m).surface();
}

}  // namespace sunder::scenes
