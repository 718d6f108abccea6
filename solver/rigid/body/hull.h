// A convex hull laid out for collision: floats about the body's centre of mass, eight at a time.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"
#include "solver/base/prefetch.h"
#include "solver/base/wide.h"

namespace sunder::solver {

/// Immutable once made. Arrays are padded to whole chunks by repeating the last item, which
/// changes no minimum and no maximum.
class Hull {
 public:
  Hull() = default;
  /// `com_R` becomes the origin; axes stay those of the rest frame.
  Hull(const ConvexPolyhedron& convex, const Vec3& com_R);

  struct PlaneChunk {
    Wide3 normal;
    Wide d;
  };
  /// From vertex to vertex, counter-clockwise in the left of its faces. `bulge` bounds how much
  /// further a unit normal between the two faces' may reach than the better of them.
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

  /// Asks for what a look at it reads.
  void prefetch() const {
    solver::prefetch(vertices(), 4);
    solver::prefetch(planes(), 4);
    solver::prefetch(edges(), 4);
    solver::prefetch(std::span(face_first_), 1);
    solver::prefetch(std::span(corners_), 2);
  }

  const Vec3f& center() const { return center_; }
  /// Of a sphere about the origin (the centre of mass of the body) that holds the hull.
  float reach_m() const { return reach_; }
  /// Of a ball about the centre that lies within.
  float core_radius_m() const { return core_radius_; }
  /// Least distance from the centre to a face, but not absurdly little: the yardstick of
  /// tolerances.
  float inner_radius_m() const { return inner_radius_; }

  static Vec3f lane(const Wide3& v, std::uint32_t i) { return {v.x[i], v.y[i], v.z[i]}; }

 private:
  struct HalfEdge {
    std::uint16_t least, most;  ///< Its vertices.
    std::uint16_t face;
    bool forward;  ///< From the lesser to the greater.
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
