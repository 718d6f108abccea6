// Layout of a hull. Its topology is that of the polyhedron: no hull is computed here.
#include "solver/rigid/body/hull.h"

#include <algorithm>
#include <cmath>

#include "engine/base/check.h"
#include "engine/base/state_checks.h"
#include "solver/base/lanes.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
Hull::Hull(const ConvexPolyhedron& convex, const Vec3& com_R) {
  SUNDER_CHECK(!convex.empty() && convex.vertices.size() < 0xffff &&
               convex.corners.size() < 0xffff);
  vertex_count_ = static_cast<std::uint32_t>(convex.vertices.size());
  vertices_.resize(lane_groups(vertex_count_));
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < vertices_.size() * kLanes; ++i) {
    const Vec3 v = convex.vertices[std::min(i, vertex_count_ - 1)] - com_R;
    set_lane(vertices_[i / kLanes], i % kLanes, v.cast<float>());
    if (i >= vertex_count_) continue;
    sum += v;
    reach_ = std::max(reach_, static_cast<float>(v.norm()));
  }
  center_ = (sum / vertex_count_).cast<float>();

  const auto faces = static_cast<std::uint32_t>(convex.faces.size());
  planes_.resize(lane_groups(faces));
  core_radius_ = reach_ + center_.norm();
  for (std::uint32_t i = 0; i < planes_.size() * kLanes; ++i) {
    const Plane& plane = convex.faces[std::min(i, faces - 1)].plane;
    PlaneChunk& chunk = planes_[i / kLanes];
    set_lane(chunk.normal, i % kLanes, plane.normal.cast<float>());
    chunk.d[i % kLanes] = static_cast<float>(plane.distance(com_R));
    const auto to_center = static_cast<float>(-plane.distance(com_R + center_.cast<double>()));
    core_radius_ = std::min(core_radius_, to_center);
  }
  core_radius_ = std::max(core_radius_, 0.f);
  inner_radius_ = std::max(core_radius_, kMinInnerRadius * reach_);

  corners_.reserve(convex.corners.size());
  face_first_.reserve(faces + 1);
  for (std::uint32_t f = 0; f < faces; ++f) {
    face_first_.push_back(static_cast<std::uint16_t>(corners_.size()));
    for (const std::uint32_t corner : convex.face_corners(f))
      corners_.push_back(static_cast<std::uint16_t>(corner));
  }
  face_first_.push_back(static_cast<std::uint16_t>(corners_.size()));
  add_edges();
}

const char* Hull::wrong_field() const {
  if (vertex_count_ == 0)
    return vertices_.empty() && face_first_.empty() ? nullptr : "vertex_count_";
  const auto is_length = [](float length) { return is_bounded(length, kMostShape_m); };
  if (vertices_.size() != lane_groups(vertex_count_)) return "vertices_";
  for (std::uint32_t i = 0; i < vertices_.size() * kLanes; ++i) {
    if (!is_length(vertex(i).norm())) return "vertices_";
    if (i >= vertex_count_ && vertex(i) != vertex(vertex_count_ - 1)) return "vertices_";
  }
  if (face_first_.size() < 2 || face_first_[0] != 0 || face_first_.back() != corners_.size())
    return "face_first_";
  if (planes_.size() != lane_groups(face_count())) return "planes_";
  for (std::uint32_t f = 0; f < planes_.size() * kLanes; ++f) {
    if (!(is_unit(normal(f)) && is_length(std::abs(plane_d(f))))) return "planes_";
    if (f >= face_count() &&
        (normal(f) != normal(face_count() - 1) || plane_d(f) != plane_d(face_count() - 1)))
      return "planes_";
  }
  for (std::size_t f = 0; f < face_count(); ++f)
    if (face_first_[f] + 3 > face_first_[f + 1]) return "face_first_";
  if (!all_below(corners_, vertex_count_)) return "corners_";
  for (const Edge& edge : edges_)
    if (edge.from >= vertex_count_ || edge.to >= vertex_count_ || edge.left >= face_count() ||
        edge.right >= face_count())
      return "edges_";
  if (edges_.size() != corners_.size() / 2) return "edges_";
  if (!is_length(reach_)) return "reach_";
  if (!is_length(core_radius_)) return "core_radius_";
  return is_length(inner_radius_) ? nullptr : "inner_radius_";
}

/// Returns the half edges sorted by their vertices, so that the two of an edge are neighbours; two
/// passes of counting sort.
std::vector<Hull::HalfEdge> Hull::half_edges() const {
  std::vector<HalfEdge> halves, sorted(corners_.size());
  halves.reserve(corners_.size());
  for (std::uint32_t f = 0; f < face_count(); ++f) {
    const auto loop = face_corners(f);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint16_t from = loop[i], to = loop[i + 1 < loop.size() ? i + 1 : 0];
      halves.push_back(
          {std::min(from, to), std::max(from, to), static_cast<std::uint16_t>(f), from < to});
    }
  }
  std::vector<std::uint16_t> start(vertex_count_ + 1);
  for (const auto key : {&HalfEdge::most, &HalfEdge::least}) {
    std::fill(start.begin(), start.end(), std::uint16_t{0});
    for (const HalfEdge& half : halves) ++start[half.*key + 1u];
    for (std::uint32_t v = 0; v < vertex_count_; ++v)
      start[v + 1] = static_cast<std::uint16_t>(start[v + 1] + start[v]);
    for (const HalfEdge& half : halves) sorted[start[half.*key]++] = half;
    halves.swap(sorted);
  }
  return halves;
}

void Hull::add_edges() {
  const std::vector<HalfEdge> halves = half_edges();
  edges_.reserve(halves.size() / 2);
  for (std::size_t i = 0; i + 1 < halves.size(); i += 2) {
    const HalfEdge &one = halves[i], &other = halves[i + 1];
    SUNDER_CHECK(one.least == other.least && one.most == other.most);
    const HalfEdge &left = one.forward ? one : other, &right = one.forward ? other : one;
    const float cosine = normal(left.face).dot(normal(right.face));
    edges_.push_back({one.least, one.most, left.face, right.face,
                      1 / std::sqrt(std::max(1e-6f, 0.5f * (1 + cosine)))});
  }
}

}  // namespace sunder::solver
