#include "engine/geometry/repair/clean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/base/disjoint_sets.h"
#include "engine/base/hash.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/close_points.h"
#include "engine/geometry/double_area.h"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Least doubled area of a polygon over its longest edge squared; below, it has no area.
constexpr double kMinAreaRatio = 1e-12;

void rename_vertices(RawMesh& mesh, std::span<const std::uint32_t> new_of_old) {
  for (std::uint32_t& v : mesh.corners) v = new_of_old[v];
}

bool has_area(const RawMesh& mesh, const std::vector<std::uint32_t>& corners) {
  const auto at = [&](std::size_t i) -> const Vec3& {
    return mesh.vertices[mesh.corners[corners[i % corners.size()]]];
  };
  Vec3 area = Vec3::Zero();
  double longest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    area += (at(i) - at(0)).cross(at(i + 1) - at(0));
    longest = std::max(longest, (at(i + 1) - at(i)).squaredNorm());
  }
  return area.norm() > kMinAreaRatio * longest;
}

/// Removes repeated corners and spikes, where the contour goes along an edge and straight back.
void remove_spikes(const RawMesh& mesh, std::vector<std::uint32_t>& corners) {
  std::vector<std::uint32_t> kept;
  const auto vertex = [&](std::size_t back) { return mesh.corners[kept[kept.size() - back]]; };
  for (const std::uint32_t c : corners) {
    kept.push_back(c);
    if (kept.size() >= 2 && vertex(1) == vertex(2)) kept.pop_back();
    if (kept.size() >= 3 && vertex(1) == vertex(3)) kept.resize(kept.size() - 2);
  }
  std::size_t first = 0;  // also removes spikes across the end of the list
  while (kept.size() - first >= 3) {
    const auto& v = mesh.corners;
    if (v[kept.back()] == v[kept[first]]) {
      kept.pop_back();
    } else if (v[kept.back()] == v[kept[first + 1]]) {
      ++first;
      kept.pop_back();
    } else if (v[kept[kept.size() - 2]] == v[kept[first]]) {
      kept.resize(kept.size() - 2);
    } else {
      break;
    }
  }
  corners.assign(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end());
}

/// The sorted vertices of a polygon, and its orientation.
struct PolygonKey {
  std::vector<std::uint32_t> sorted;
  bool flipped = false;
};

PolygonKey key_of(std::span<const std::uint32_t> vertices) {
  PolygonKey key{{vertices.begin(), vertices.end()}, false};
  std::sort(key.sorted.begin(), key.sorted.end());
  const auto least = std::min_element(vertices.begin(), vertices.end()) - vertices.begin();
  const std::size_t at = static_cast<std::size_t>(least), n = vertices.size();
  key.flipped = vertices[(at + 1) % n] > vertices[(at + n - 1) % n];
  return key;
}

}  // namespace

Vec3 double_area(const RawMesh& mesh, std::size_t polygon) {
  return double_area(mesh.vertices, mesh.polygon_corners(polygon));
}

void rewrite_polygons(
    RawMesh& mesh,
    const std::function<void(std::size_t polygon, std::vector<std::uint32_t>& corners)>& rewrite) {
  RawMesh result;
  std::vector<std::uint32_t> corners;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    RawMesh::Polygon polygon = mesh.polygons[p];
    corners.resize(polygon.corner_count);
    std::iota(corners.begin(), corners.end(), polygon.first_corner);
    rewrite(p, corners);
    if (corners.empty()) continue;
    polygon.first_corner = static_cast<std::uint32_t>(result.corners.size());
    polygon.corner_count = static_cast<std::uint32_t>(corners.size());
    result.polygons.push_back(polygon);
    for (const std::uint32_t c : corners) {
      result.corners.push_back(mesh.corners[c]);
      if (!mesh.corner_normals.empty()) result.corner_normals.push_back(mesh.corner_normals[c]);
      if (!mesh.corner_uvs.empty()) result.corner_uvs.push_back(mesh.corner_uvs[c]);
    }
  }
  mesh.polygons.swap(result.polygons);
  mesh.corners.swap(result.corners);
  mesh.corner_normals.swap(result.corner_normals);
  mesh.corner_uvs.swap(result.corner_uvs);
}

void append_polygon(RawMesh& mesh, std::span<const std::uint32_t> vertices, std::uint32_t group) {
  mesh.polygons.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                           static_cast<std::uint32_t>(vertices.size()), group});
  mesh.corners.insert(mesh.corners.end(), vertices.begin(), vertices.end());
  if (!mesh.corner_normals.empty()) mesh.corner_normals.resize(mesh.corners.size(), Vec3f::Zero());
  if (!mesh.corner_uvs.empty()) mesh.corner_uvs.resize(mesh.corners.size(), Vec2f::Zero());
}

void reverse_polygon(RawMesh& mesh, std::size_t polygon) {
  const auto first = static_cast<std::ptrdiff_t>(mesh.polygons[polygon].first_corner);
  const auto last = first + static_cast<std::ptrdiff_t>(mesh.polygons[polygon].corner_count);
  const auto reverse = [&](auto& values) {
    if (!values.empty()) std::reverse(values.begin() + first, values.begin() + last);
  };
  reverse(mesh.corners);
  reverse(mesh.corner_normals);
  reverse(mesh.corner_uvs);
}

void drop_unused_vertices(RawMesh& mesh) {
  std::vector<std::uint32_t> new_of_old(mesh.vertices.size(), kNone);
  for (const std::uint32_t v : mesh.corners) new_of_old[v] = 0;
  std::uint32_t used = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (new_of_old[v] == kNone) continue;
    mesh.vertices[used] = mesh.vertices[v];
    new_of_old[v] = used++;
  }
  mesh.vertices.resize(used);
  rename_vertices(mesh, new_of_old);
}

std::size_t join_identical(RawMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto position = [&](std::uint32_t v) {
    const Vec3& p = mesh.vertices[v];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(position(a), std::tuple(a)) < std::tuple_cat(position(b), std::tuple(b));
  });
  std::vector<std::uint32_t> new_of_old(mesh.vertices.size());
  std::size_t joined = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && position(order[i]) == position(order[i - 1]);
    new_of_old[order[i]] = same ? new_of_old[order[i - 1]] : order[i];
    joined += same ? 1 : 0;
  }
  rename_vertices(mesh, new_of_old);
  return joined;
}

std::size_t join_close(RawMesh& mesh, std::span<const std::uint32_t> vertices, double tolerance_m) {
  using Cell = std::array<std::int64_t, 3>;
  const auto cell_of = [&](std::uint32_t v) {
    const Vec3 p = mesh.vertices[v] / tolerance_m;
    return Cell{std::llround(p.x()), std::llround(p.y()), std::llround(p.z())};
  };
  std::vector<std::pair<Cell, std::uint32_t>> cells;
  for (const std::uint32_t v : vertices) cells.emplace_back(cell_of(v), v);
  std::sort(cells.begin(), cells.end());
  DisjointSets joined(mesh.vertices.size());
  std::size_t count = 0;
  for (const auto& [cell, v] : cells) {
    for (int neighbor = 0; neighbor < 27; ++neighbor) {
      const Cell other{cell[0] + neighbor % 3 - 1, cell[1] + neighbor / 3 % 3 - 1,
                       cell[2] + neighbor / 9 - 1};
      // Tests only the first vertex of a cell, so that the cost is linear in dense clusters.
      const auto found = std::lower_bound(cells.begin(), cells.end(), std::pair(other, 0u));
      if (found == cells.end() || found->first != other || found->second == v) continue;
      if ((mesh.vertices[found->second] - mesh.vertices[v]).norm() > tolerance_m) continue;
      count += joined.join(found->second, v) ? 1 : 0;
    }
  }
  rename_vertices(mesh, joined.roots());
  return count;
}

std::vector<std::array<std::uint32_t, 2>> find_twins(const RawMesh& mesh, double distance_m) {
  std::vector<std::uint32_t> used = mesh.corners;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Vec3> points;
  points.reserve(used.size());
  for (const std::uint32_t v : used) points.push_back(mesh.vertices[v]);
  std::vector<std::array<std::uint32_t, 2>> twins;
  each_close_pair(points, distance_m, [&](std::uint32_t a, std::uint32_t b) {
    twins.push_back({std::min(used[a], used[b]), std::max(used[a], used[b])});
  });
  if (twins.empty()) return twins;
  DisjointSets chains(mesh.vertices.size());
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const auto corners = mesh.polygon_corners(p);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % corners.size()];
      if ((mesh.vertices[a] - mesh.vertices[b]).norm() <= distance_m) chains.join(a, b);
    }
  }
  std::erase_if(twins,
                [&](const auto& pair) { return chains.root(pair[0]) == chains.root(pair[1]); });
  return twins;
}

std::size_t join_twins(RawMesh& mesh, double distance_m) {
  const auto twins = find_twins(mesh, distance_m);
  if (twins.empty()) return 0;
  DisjointSets joined(mesh.vertices.size());
  std::size_t count = 0;
  for (const auto& [a, b] : twins) count += joined.join(a, b) ? 1 : 0;
  rename_vertices(mesh, joined.roots());
  return count;
}

std::size_t drop_degenerate(RawMesh& mesh) {
  const std::size_t before = mesh.polygons.size();
  rewrite_polygons(mesh, [&](std::size_t, std::vector<std::uint32_t>& corners) {
    remove_spikes(mesh, corners);
    if (corners.size() < 3 || !has_area(mesh, corners)) corners.clear();
  });
  return before - mesh.polygons.size();
}

std::size_t drop_duplicates(RawMesh& mesh) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> hashes;
  for (std::uint32_t p = 0; p < mesh.polygons.size(); ++p) {
    std::uint64_t sum = mesh.polygons[p].corner_count;  // independent of the order of vertices
    for (const std::uint32_t v : mesh.polygon_corners(p)) sum += mix(v);
    hashes.emplace_back(sum, p);
  }
  std::sort(hashes.begin(), hashes.end());
  enum class Duplicate : std::uint8_t { kUnique, kSame, kOpposite };
  std::vector<Duplicate> duplicates(mesh.polygons.size(), Duplicate::kUnique);
  std::size_t opposite = 0;
  for (std::size_t i = 1, first = 0; i < hashes.size(); ++i) {
    if (hashes[i].first != hashes[first].first) first = i;
    if (i == first) continue;
    const PolygonKey key = key_of(mesh.polygon_corners(hashes[i].second));
    // Four candidates suffice: more coincident polygons are copies of one pair.
    for (std::size_t j = first; j < std::min(i, first + 4); ++j) {
      const PolygonKey other = key_of(mesh.polygon_corners(hashes[j].second));
      if (other.sorted != key.sorted) continue;
      Duplicate& duplicate = duplicates[hashes[i].second];
      if (other.flipped == key.flipped) {
        duplicate = Duplicate::kSame;
        break;
      }
      duplicate = Duplicate::kOpposite;
    }
    if (duplicates[hashes[i].second] == Duplicate::kOpposite) ++opposite;
  }
  const bool double_sided = opposite > mesh.polygons.size() / 4;
  const std::size_t before = mesh.polygons.size();
  rewrite_polygons(mesh, [&](std::size_t p, std::vector<std::uint32_t>& corners) {
    if (duplicates[p] == Duplicate::kSame ||
        (duplicates[p] == Duplicate::kOpposite && double_sided))
      corners.clear();
  });
  return before - mesh.polygons.size();
}

void insert_in_edges(RawMesh& mesh, const std::vector<Insertion>& sorted) {
  // New corners are first copies of the corner at the edge's start. Then they get their vertices,
  // and attributes interpolated by the positions of the vertices along the edge.
  struct Between {
    std::size_t corner, start, end;
  };
  std::vector<Between> inserted;
  std::vector<std::uint32_t> vertices;
  rewrite_polygons(mesh, [&](std::size_t, std::vector<std::uint32_t>& corners) {
    const std::vector<std::uint32_t> old = corners;
    const std::size_t first = vertices.size();
    corners.clear();
    for (const std::uint32_t c : old) {
      const std::size_t start = vertices.size(), known = inserted.size();
      corners.push_back(c);
      vertices.push_back(mesh.corners[c]);
      auto it = std::lower_bound(sorted.begin(), sorted.end(), Insertion{c, -1, 0});
      for (; it != sorted.end() && it->half_edge == c; ++it) {
        inserted.push_back({vertices.size(), start, 0});
        corners.push_back(c);
        vertices.push_back(it->vertex);
      }
      const std::size_t end = c == old.back() ? first : vertices.size();
      for (std::size_t i = known; i < inserted.size(); ++i) inserted[i].end = end;
    }
  });
  mesh.corners = std::move(vertices);
  for (const Between& b : inserted) {
    const Vec3& start = mesh.vertices[mesh.corners[b.start]];
    const Vec3 edge = mesh.vertices[mesh.corners[b.end]] - start;
    const double along = (mesh.vertices[mesh.corners[b.corner]] - start).dot(edge);
    const auto fraction =
        static_cast<float>(std::clamp(along / std::max(edge.squaredNorm(), 1e-300), 0.0, 1.0));
    const auto interpolate = [&](auto& values) {
      if (values.empty()) return;
      values[b.corner] = (1 - fraction) * values[b.start] + fraction * values[b.end];
    };
    interpolate(mesh.corner_normals);
    interpolate(mesh.corner_uvs);
  }
}

std::size_t join_t_junctions(RawMesh& mesh, std::span<const std::uint32_t> open_half_edges,
                             double tolerance_m) {
  constexpr std::size_t kMaxCandidates = 2'000'000;
  std::vector<std::uint32_t> next(mesh.corners.size());
  for (const RawMesh::Polygon& polygon : mesh.polygons) {
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      next[polygon.first_corner + i] = polygon.first_corner + (i + 1) % polygon.corner_count;
    }
  }
  std::vector<Box> boxes(open_half_edges.size());
  std::vector<std::uint32_t> open_vertices;
  for (std::size_t e = 0; e < boxes.size(); ++e) {
    for (const std::uint32_t c : {open_half_edges[e], next[open_half_edges[e]]}) {
      boxes[e].extend(mesh.vertices[mesh.corners[c]]);
      open_vertices.push_back(mesh.corners[c]);
    }
  }
  std::sort(open_vertices.begin(), open_vertices.end());
  open_vertices.erase(std::unique(open_vertices.begin(), open_vertices.end()), open_vertices.end());

  const Bvh bvh(boxes);
  std::vector<Insertion> found;
  std::vector<std::uint32_t> near;
  std::size_t candidates = 0;
  for (const std::uint32_t v : open_vertices) {
    near.clear();
    bvh.within(mesh.vertices[v], tolerance_m, near);
    candidates += near.size();
    if (candidates > kMaxCandidates) return 0;  // a polygon soup: not worth the work
    for (const std::uint32_t e : near) {
      const std::uint32_t c = open_half_edges[e];
      const Vec3 a = mesh.vertices[mesh.corners[c]];
      const Vec3 ab = mesh.vertices[mesh.corners[next[c]]] - a, ap = mesh.vertices[v] - a;
      const double length = ab.norm(), along = ab.dot(ap) / length;
      if (!(along > tolerance_m && along < length - tolerance_m)) continue;
      if ((ap - along / length * ab).norm() <= tolerance_m) found.push_back({c, along, v});
    }
  }
  std::sort(found.begin(), found.end());

  insert_in_edges(mesh, found);
  return found.size();
}

}  // namespace sunder
