// Begin with make_facets().
#include "engine/model/facets.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>

#include "engine/base/parallel.h"
#include "engine/geometry/bvh.h"

namespace sunder {
namespace {

constexpr double kMinDepth = 0.05;  // least depth of facets, over the surface's diagonal
// least depth of one facet, over the largest, where sides meet at an edge
constexpr double kMinRelativeDepth = 1e-3;
constexpr double kCreaseCosine = 0.766;  // cosine of 40 degrees, as for other meshes
constexpr std::size_t kTrianglesPerMesh = 16384;
constexpr std::size_t kChunk = 256;

/// Corners and unit normals of a surface's triangles.
class Surface {
 public:
  explicit Surface(const GroundMesh& ground) : ground_(ground) {
    normals_.reserve(size());
    for (std::size_t t = 0; t < size(); ++t) normals_.push_back(double_area(t).normalized());
  }

  std::size_t size() const { return ground_.triangles.size(); }
  const Vec3& corner(std::size_t t, std::size_t i) const {
    return ground_.vertices_W[ground_.triangles[t][i % 3]];
  }
  const Vec3& normal(std::size_t t) const { return normals_[t]; }
  Vec3 double_area(std::size_t t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  }
  Vec3 middle(std::size_t t) const { return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3; }

 private:
  const GroundMesh& ground_;
  std::vector<Vec3> normals_;
};

/// Edge `side` of a triangle, to the next corner.
struct HalfEdge {
  std::uint32_t least, most;  ///< Its vertices, ascending.
  std::uint32_t triangle, side;
  auto operator<=>(const HalfEdge&) const = default;
};

/// Returns the angle, as in EdgeAngles, by which `other` bends away beyond an edge of a triangle.
Vec2 bend_to(const Surface& surface, const HalfEdge& edge, std::size_t other) {
  const Vec3 &n = surface.normal(edge.triangle), &m = surface.normal(other);
  const Vec3 along =
      surface.corner(edge.triangle, edge.side + 1) - surface.corner(edge.triangle, edge.side);
  const double sine = n.cross(m).dot(along.normalized()), cosine = n.dot(m);
  if (sine <= 0) return Vec2::UnitX();
  return cosine <= 0 ? Vec2(Vec2::UnitY()) : Vec2(cosine, sine).normalized();
}

std::vector<EdgeAngles> bends_of(const GroundMesh& ground, const Surface& surface) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * surface.size());
  for (std::uint32_t t = 0; t < surface.size(); ++t) {
    for (std::uint32_t side = 0; side < 3; ++side) {
      const std::uint32_t from = ground.triangles[t][side],
                          to = ground.triangles[t][(side + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, side});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<EdgeAngles> bends(surface.size(), {Vec2::UnitY(), Vec2::UnitY(), Vec2::UnitY()});
  const auto ends = [](const HalfEdge& edge) { return std::tie(edge.least, edge.most); };
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(),
                                   [&](const HalfEdge& e) { return ends(e) != ends(*first); });
    for (auto edge = first; edge != last; ++edge) {
      Vec2& bend = bends[edge->triangle][edge->side];
      // an edge of three or more triangles has the smallest angle
      for (auto other = first; other != last; ++other) {
        if (other == edge) continue;
        const Vec2 to = bend_to(surface, *edge, other->triangle);
        if (to.y() < bend.y()) bend = to;
      }
    }
    first = last;
  }
  return bends;
}

/// Returns the distance behind a point at which the surface is met from its back; at most `most_m`.
double clearance_behind(const Surface& surface, const Bvh& tree, std::size_t t, const Vec3& point,
                        double max_depth_m, std::vector<std::uint32_t>& near) {
  const Vec3 down = -surface.normal(t);
  Box segment_box;
  segment_box.extend(point);
  segment_box.extend(Vec3(point + max_depth_m * down));
  near.clear();
  tree.overlaps(segment_box, near);
  double clearance_m = max_depth_m;
  for (const std::uint32_t other : near) {
    const double facing = down.dot(surface.normal(other));
    if (other == t || facing <= 0) continue;
    const double distance_m = surface.normal(other).dot(surface.corner(other, 0) - point) / facing;
    if (distance_m < 0 || distance_m >= clearance_m) continue;
    const Vec3 there = point + distance_m * down;
    bool within = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& from = surface.corner(other, i);
      const Vec3 inward = surface.normal(other).cross(surface.corner(other, i + 1) - from);
      within = within && inward.dot(there - from) >= 0;
    }
    if (within) clearance_m = distance_m;
  }
  return clearance_m;
}

/// Returns the depth of facets where the solid is thick enough.
double depth_of(const Surface& surface) {
  Box box;
  double lengths_m = 0;
  for (std::size_t t = 0; t < surface.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      box.extend(surface.corner(t, i));
      lengths_m += (surface.corner(t, i + 1) - surface.corner(t, i)).norm();
    }
  }
  return std::max(kMinDepth * box.extent().norm(),
                  lengths_m / (3 * static_cast<double>(surface.size())));
}

double depth_of(const Surface& surface, const Bvh& tree, std::size_t t, double max_depth_m,
                std::vector<std::uint32_t>& near) {
  const Vec3 middle = surface.middle(t);
  double clearance_m = clearance_behind(surface, tree, t, middle, 2 * max_depth_m, near);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 point = 0.8 * surface.corner(t, i) + 0.2 * middle;
    clearance_m =
        std::min(clearance_m, clearance_behind(surface, tree, t, point, 2 * max_depth_m, near));
  }
  return std::clamp(0.5 * clearance_m, kMinRelativeDepth * max_depth_m, max_depth_m);
}

ConvexPolyhedron prism_behind(const Surface& surface, std::size_t t, double depth_m) {
  ConvexPolyhedron prism;
  for (std::size_t i = 0; i < 3; ++i) prism.vertices.push_back(surface.corner(t, i));
  for (std::size_t i = 0; i < 3; ++i)
    prism.vertices.push_back(surface.corner(t, i) - depth_m * surface.normal(t));
  const auto add = [&](std::initializer_list<std::uint32_t> corners) {
    add_face(prism, std::span(corners.begin(), corners.size()));
  };
  add({0, 1, 2});
  add({1, 0, 3, 4});
  add({2, 1, 4, 5});
  add({0, 2, 5, 3});
  add({5, 4, 3});
  return prism;
}

/// Returns shading normals of the triangles' corners: the mean, weighted by area, of the faces
/// around a vertex that no crease separates from the triangle.
std::vector<std::array<Vec3f, 3>> corner_normals(const GroundMesh& ground, const Surface& surface) {
  std::vector<std::vector<std::uint32_t>> around(ground.vertices_W.size());
  for (std::uint32_t t = 0; t < surface.size(); ++t)
    for (const std::uint32_t vertex : ground.triangles[t]) around[vertex].push_back(t);
  std::vector<std::array<Vec3f, 3>> normals(surface.size());
  for (std::size_t t = 0; t < surface.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 sum = Vec3::Zero();
      for (const std::uint32_t other : around[ground.triangles[t][i]])
        if (surface.normal(other).dot(surface.normal(t)) >= kCreaseCosine)
          sum += surface.double_area(other);
      normals[t][i] = sum.normalized().cast<float>();
    }
  }
  return normals;
}

}  // namespace

std::vector<Facet> make_facets(const GroundMesh& ground) {
  const Surface surface(ground);
  const std::vector<EdgeAngles> bends = bends_of(ground, surface);
  std::vector<Box> boxes(surface.size());
  for (std::size_t t = 0; t < surface.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) boxes[t].extend(surface.corner(t, i));
  const Bvh tree(boxes);
  const double max_depth_m = depth_of(surface);
  std::vector<Facet> facets(surface.size());
  for_chunks(facets.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::uint32_t> near;
    for (std::size_t t = begin; t < end; ++t) {
      const double depth_m = depth_of(surface, tree, t, max_depth_m, near);
      facets[t] = {prism_behind(surface, t, depth_m), bends[t], ground.material};
    }
  });
  return facets;
}

std::vector<std::shared_ptr<const Mesh>> make_meshes(const GroundMesh& ground) {
  const Surface surface(ground);
  const std::vector<std::array<Vec3f, 3>> normals = corner_normals(ground, surface);
  std::vector<std::shared_ptr<const Mesh>> meshes;
  for (std::size_t first = 0; first < surface.size(); first += kTrianglesPerMesh) {
    const std::size_t last = std::min(first + kTrianglesPerMesh, surface.size());
    auto mesh = std::make_shared<Mesh>();
    mesh->material = ground.material;
    Box box;
    for (std::size_t t = first; t < last; ++t)
      for (std::size_t i = 0; i < 3; ++i) box.extend(surface.corner(t, i));
    mesh->origin_T = box.center();
    // latest drawn vertex of each ground vertex
    std::unordered_map<std::uint32_t, std::uint32_t> latest;
    for (std::size_t t = first; t < last; ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto next = static_cast<std::uint32_t>(mesh->vertices.size());
        std::uint32_t& drawn = latest.try_emplace(ground.triangles[t][i], next).first->second;
        if (drawn == next || mesh->vertices[drawn].normal != normals[t][i]) {
          drawn = next;
          const Vec3f position = (surface.corner(t, i) - mesh->origin_T).cast<float>();
          mesh->vertices.push_back({position, normals[t][i], 0});
        }
        mesh->indices.push_back(drawn);
      }
    }
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace sunder
