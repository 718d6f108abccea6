#include "engine/geometry/repair/surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/repair/clean.h"

namespace sunder {
namespace {

/// The half-edges of a mesh, grouped by edge.
class EdgeTable {
 public:
  explicit EdgeTable(const RawMesh& mesh) : start_(mesh.vertices.size() + 1, 0) {
    to_.resize(mesh.corners.size());
    for (const RawMesh::Polygon& p : mesh.polygons) {
      for (std::uint32_t i = 0; i < p.corner_count; ++i) {
        to_[p.first_corner + i] = mesh.corners[p.first_corner + (i + 1) % p.corner_count];
      }
    }
    for (std::size_t c = 0; c < to_.size(); ++c) ++start_[std::min(mesh.corners[c], to_[c]) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    entries_.resize(to_.size());
    std::vector<std::uint32_t> at(start_.begin(), start_.end() - 1);
    for (std::uint32_t c = 0; c < to_.size(); ++c) {
      const auto [low, high] = std::minmax(mesh.corners[c], to_[c]);
      entries_[at[low]++] = {high, c};
    }
    for (std::size_t v = 0; v + 1 < start_.size(); ++v) {
      std::sort(entries_.begin() + start_[v], entries_.begin() + start_[v + 1]);
    }
  }

  /// Calls `visit(half_edges)` for each edge, in a deterministic order.
  template <class Visit>
  void each(const Visit& visit) const {
    std::vector<std::uint32_t> group;
    for (std::size_t v = 0; v + 1 < start_.size(); ++v) {
      for (std::size_t i = start_[v]; i < start_[v + 1];) {
        group.clear();
        const std::uint32_t high = entries_[i].first;
        for (; i < start_[v + 1] && entries_[i].first == high; ++i) {
          group.push_back(entries_[i].second);
        }
        visit(std::span<const std::uint32_t>(group));
      }
    }
  }

 private:
  std::vector<std::uint32_t> to_;     ///< End vertex of each half-edge.
  std::vector<std::uint32_t> start_;  ///< First entry of each lower vertex.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> entries_;  ///< Higher vertex, half-edge.
};

std::vector<std::uint32_t> polygon_of_corners(const RawMesh& mesh) {
  std::vector<std::uint32_t> polygon(mesh.corners.size());
  for (std::uint32_t p = 0; p < mesh.polygons.size(); ++p) {
    const auto first = polygon.begin() + mesh.polygons[p].first_corner;
    std::fill(first, first + mesh.polygons[p].corner_count, p);
  }
  return polygon;
}

/// A half-edge with its angle about the edge.
struct SortedHalfEdge {
  std::int64_t angle;  ///< In steps of 1e-7 rad, so that coincident faces have equal angles.
  bool backward;       ///< Starts at the higher vertex: there is solid at larger angles.
  std::uint32_t half_edge;
  auto operator<=>(const SortedHalfEdge&) const = default;
};

/// Returns the half-edges of a non-manifold edge by angle; at equal angles, ends of solid first.
std::vector<SortedHalfEdge> sort_around_edge(const Surface& surface,
                                             std::span<const std::uint32_t> group,
                                             std::span<const Vec3> normals) {
  const RawMesh& mesh = surface.mesh;
  const std::uint32_t low = std::min(mesh.corners[group[0]], mesh.corners[surface.next(group[0])]);
  Vec3 axis = Vec3::Zero(), side = Vec3::Zero();
  std::vector<SortedHalfEdge> around;
  for (const std::uint32_t c : group) {
    const bool backward = mesh.corners[c] != low;
    const Vec3 along = surface.point(surface.next(c)) - surface.point(c);
    // Direction in the face, perpendicular to the edge, into the polygon.
    const Vec3 in = normals[surface.polygon[c]].cross(along.normalized());
    if (around.empty()) {
      axis = (backward ? -along : Vec3(along)).normalized();
      side = in;
    }
    const double angle = arc_tangent(axis.dot(side.cross(in)), side.dot(in));
    const std::int64_t step = std::llround(angle * 1e7);
    around.push_back({step < -31415920 ? -step : step, backward, c});
  }
  std::sort(around.begin(), around.end());
  return around;
}

/// Pairs each backward half-edge with the forward one that ends its solid, like brackets.
void pair_around_edge(const std::vector<SortedHalfEdge>& around, std::vector<std::uint32_t>& twin) {
  std::vector<std::uint32_t> begun;
  for (int turn = 0; turn < 2; ++turn) {
    for (const SortedHalfEdge& sorted : around) {
      if (twin[sorted.half_edge] != Surface::kNone) continue;
      if (sorted.backward) {
        if (turn == 0) begun.push_back(sorted.half_edge);
      } else if (!begun.empty()) {
        twin[sorted.half_edge] = begun.back();
        twin[begun.back()] = sorted.half_edge;
        begun.pop_back();
      }
    }
  }
}

}  // namespace

std::vector<std::uint32_t> Surface::open_half_edges() const {
  std::vector<std::uint32_t> open;
  for (std::uint32_t c = 0; c < twin.size(); ++c) {
    if (twin[c] == kNone) open.push_back(c);
  }
  return open;
}

EdgeFaults edge_faults(const RawMesh& mesh) {
  EdgeFaults faults;
  EdgeTable(mesh).each([&](std::span<const std::uint32_t> group) {
    if (group.size() == 1) ++faults.open;
    if (group.size() > 2) ++faults.non_manifold;
    if (group.size() == 2 && mesh.corners[group[0]] == mesh.corners[group[1]]) {
      ++faults.inconsistent;
    }
  });
  return faults;
}

std::size_t orient(RawMesh& mesh) {
  struct Link {
    std::uint32_t polygon;
    bool disagree;
  };
  const std::vector<std::uint32_t> polygon = polygon_of_corners(mesh);
  std::vector<std::vector<Link>> links;
  const EdgeTable edges(mesh);
  bool any_disagree = false;
  const auto each_link = [&](const auto& visit) {
    edges.each([&](std::span<const std::uint32_t> group) {
      if (group.size() == 2 && polygon[group[0]] != polygon[group[1]]) {
        visit(polygon[group[0]], polygon[group[1]],
              mesh.corners[group[0]] == mesh.corners[group[1]]);
      }
    });
  };
  each_link([&](std::uint32_t, std::uint32_t, bool disagree) { any_disagree |= disagree; });
  if (!any_disagree) return 0;
  links.resize(mesh.polygons.size());
  each_link([&](std::uint32_t a, std::uint32_t b, bool disagree) {
    links[a].push_back({b, disagree});
    links[b].push_back({a, disagree});
  });

  std::size_t flipped = 0;
  std::vector<std::int8_t> sense(mesh.polygons.size(), 0);
  std::vector<std::uint32_t> patch;
  for (std::uint32_t seed = 0; seed < mesh.polygons.size(); ++seed) {
    if (sense[seed] != 0) continue;
    sense[seed] = 1;
    patch.assign(1, seed);
    double kept_area = 0, flipped_area = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const std::int8_t mine = sense[patch[i]];
      (mine > 0 ? kept_area : flipped_area) += double_area(mesh, patch[i]).norm();
      for (const Link& link : links[patch[i]]) {
        if (sense[link.polygon] != 0) continue;
        sense[link.polygon] = static_cast<std::int8_t>(link.disagree ? -mine : mine);
        patch.push_back(link.polygon);
      }
    }
    const std::int8_t flip = flipped_area > kept_area ? 1 : -1;
    for (const std::uint32_t p : patch) {
      if (sense[p] != flip) continue;
      reverse_polygon(mesh, p);
      ++flipped;
    }
  }
  return flipped;
}

Surface pair_edges(RawMesh mesh) {
  Surface surface;
  surface.mesh = std::move(mesh);
  surface.polygon = polygon_of_corners(surface.mesh);
  surface.twin.assign(surface.mesh.corners.size(), Surface::kNone);
  std::vector<Vec3> normals;  // of the polygons, computed when first needed
  EdgeTable(surface.mesh).each([&](std::span<const std::uint32_t> group) {
    if (group.size() > 2) {
      for (std::size_t p = normals.size(); p < surface.mesh.polygons.size(); ++p) {
        normals.push_back(double_area(surface.mesh, p).normalized());
      }
      pair_around_edge(sort_around_edge(surface, group, normals), surface.twin);
    } else if (group.size() == 2 &&
               surface.mesh.corners[group[0]] != surface.mesh.corners[group[1]]) {
      surface.twin[group[0]] = group[1];
      surface.twin[group[1]] = group[0];
    }
  });
  return surface;
}

std::size_t split_vertices(Surface& surface) {
  DisjointSets fans(surface.mesh.corners.size());
  for (std::uint32_t c = 0; c < surface.twin.size(); ++c) {
    const std::uint32_t back = surface.twin[c];
    if (back != Surface::kNone) fans.join(c, surface.next(back));
  }
  std::vector<std::uint32_t> first_fan(surface.mesh.vertices.size(), Surface::kNone);
  std::vector<std::uint32_t> vertex_of_fan(surface.mesh.corners.size(), Surface::kNone);
  const std::size_t before = surface.mesh.vertices.size();
  for (std::uint32_t c = 0; c < surface.mesh.corners.size(); ++c) {
    const std::uint32_t fan = fans.root(c);
    std::uint32_t& v = surface.mesh.corners[c];
    if (vertex_of_fan[fan] == Surface::kNone) {
      if (first_fan[v] == Surface::kNone) {
        first_fan[v] = fan;
        vertex_of_fan[fan] = v;
      } else {
        vertex_of_fan[fan] = static_cast<std::uint32_t>(surface.mesh.vertices.size());
        surface.mesh.vertices.push_back(Vec3(surface.mesh.vertices[v]));
      }
    }
    v = vertex_of_fan[fan];
  }
  return surface.mesh.vertices.size() - before;
}

std::size_t divide_repeated_edges(Surface& surface) {
  std::vector<Insertion> insertions;
  EdgeTable(surface.mesh).each([&](std::span<const std::uint32_t> group) {
    for (const std::uint32_t c : group.size() > 2 ? group : group.first(0)) {
      const std::uint32_t back = surface.twin[c];
      if (back == Surface::kNone || c > back || c == group[0] || back == group[0]) continue;
      const auto middle = static_cast<std::uint32_t>(surface.mesh.vertices.size());
      const Vec3 place = 0.5 * (surface.point(c) + surface.point(surface.next(c)));
      surface.mesh.vertices.push_back(place);
      insertions.push_back({c, 0.5, middle});
      insertions.push_back({back, 0.5, middle});
    }
  });
  if (insertions.empty()) return 0;
  std::sort(insertions.begin(), insertions.end());
  insert_in_edges(surface.mesh, insertions);
  surface = pair_edges(std::move(surface.mesh));
  return insertions.size() / 2;
}

std::vector<std::uint32_t> shells_of(const Surface& surface, std::uint32_t& count) {
  DisjointSets sets(surface.mesh.polygons.size());
  for (std::uint32_t c = 0; c < surface.twin.size(); ++c) {
    if (surface.twin[c] != Surface::kNone) {
      sets.join(surface.polygon[c], surface.polygon[surface.twin[c]]);
    }
  }
  count = 0;
  std::vector<std::uint32_t> shell(surface.mesh.polygons.size());
  for (std::uint32_t p = 0; p < shell.size(); ++p) {
    const std::uint32_t root = sets.root(p);
    shell[p] = root == p ? count++ : shell[root];
  }
  return shell;
}

std::vector<double> volumes(const RawMesh& mesh, const std::vector<std::uint32_t>& part,
                            std::uint32_t count) {
  std::vector<double> volume(count, 0);
  std::vector<std::uint32_t> origin(count,
                                    Surface::kNone);  // a vertex of each part
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const auto corners = mesh.polygon_corners(p);
    if (origin[part[p]] == Surface::kNone) origin[part[p]] = corners[0];
    const Vec3& o = mesh.vertices[origin[part[p]]];
    volume[part[p]] += (mesh.vertices[corners[0]] - o).dot(double_area(mesh, p)) / 6;
  }
  return volume;
}

}  // namespace sunder
