// A convex hull in the layout of collision tests: floats about the body's centre of mass, in chunks
// of eight.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"
#include "solver/base/prefetch.h"
#include "solver/base/wide.h"

namespace sunder::solver {

/// Immutable. Arrays are padded to whole chunks by repeating the last item, which changes no
/// minimum and no maximum.
class Hull {
 public:
  Hull() = default;
  /// Makes a hull with `com_R` as its origin and the axes of the rest frame.
  Hull(const ConvexPolyhedron& convex, const Vec3& com_R);

  struct PlaneChunk {
    Wide3 normal;
    Wide d;
  };
  /// Edge between two vertices, counter-clockwise in its left face. `bulge` is an upper bound: a
  /// unit normal between those of the two faces reaches at most `bulge` times as far as the better
  /// of them.
  struct Edge {
    std::uint16_t from, to, left, right;
    float bulge;
  };

  std::uint32_t vertex_count() const { return vertex_count_; }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(face_first_.size() - 1); }
  std::uint32_t edge_count() const { return static_cast<std::uint32_t>(edges_.size()); }
  std::span<const Wide3> vertices() const { return vertices_; }
  std::span<const PlaneChunk> planes() const { return planes_; }
  std::span<const Edge> edges() const { return edges_; }

  Vec3f vertex(std::uint32_t i) const { return lane(vertices_[i / kLanes], i % kLanes); }
  Vec3f normal(std::uint32_t f) const { return lane(planes_[f / kLanes].normal, f % kLanes); }
  float plane_d(std::uint32_t f) const { return planes_[f / kLanes].d[f % kLanes]; }
  std::span<const std::uint16_t> face_corners(std::uint32_t f) const {
    return std::span(corners_).subspan(face_first_[f], face_first_[f + 1] - face_first_[f]);
  }
  std::pair<std::uint16_t, std::uint16_t> edge_vertices(std::uint32_t e) const {
    return {edges_[e].from, edges_[e].to};
  }

  /// Prefetches the memory that a test reads.
  void prefetch() const {
    solver::prefetch(vertices(), 4);
    solver::prefetch(planes(), 4);
    solver::prefetch(edges(), 4);
    solver::prefetch(std::span(face_first_), 1);
    solver::prefetch(std::span(corners_), 2);
  }

  const Vec3f& center() const { return center_; }
  /// Radius of a sphere about the origin (the body's centre of mass) that encloses the hull.
  float reach_m() const { return reach_; }
  /// Radius of a ball about the centre that lies within the hull.
  float core_radius_m() const { return core_radius_; }
  /// Distance from the centre to the nearest face, at least kMinInnerRadius of the reach: the unit
  /// of tolerances.
  float inner_radius_m() const { return inner_radius_; }

  static Vec3f lane(const Wide3& v, std::uint32_t i) { return {v.x[i], v.y[i], v.z[i]}; }

  static auto fields(auto& self) {
    return std::tie(self.vertices_, self.planes_, self.edges_, self.face_first_, self.corners_,
                    self.vertex_count_, self.center_, self.reach_, self.core_radius_,
                    self.inner_radius_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  struct HalfEdge {
    std::uint16_t least, most;  ///< Vertices of the edge, the smaller index first.
    std::uint16_t face;
    bool forward;  ///< True if it runs from the smaller vertex index to the greater.
  };
  std::vector<HalfEdge> half_edges() const;
  void add_edges();

  std::vector<Wide3> vertices_;
  std::vector<PlaneChunk> planes_;
  std::vector<Edge> edges_;
  std::vector<std::uint16_t> face_first_;
  std::vector<std::uint16_t> corners_;
  std::uint32_t vertex_count_ = 0;
  Vec3f center_ = Vec3f::Zero();
  float reach_ = 0;
  float core_radius_ = 0;
  float inner_radius_ = 0;
};

}  // namespace sunder::solver
