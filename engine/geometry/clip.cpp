// One pass over the faces: corners that stay are renumbered, edges that change side get one vertex
// each, and every edge this leaves without an opposite is, reversed, an edge of the cap. The signs
// of the vertices decide all of it. Should rounding have made the convex so crooked that the cap is
// not one loop, more vertices are taken as lying on the plane, until it is.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/check.h"
#include "engine/geometry/convex_polyhedron.h"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A corner of a kept face; kOn and kCrossing lie on the plane.
enum class Place { kIn, kOn, kCrossing };
struct Corner {
  std::uint32_t vertex = kNone;
  Place place = Place::kIn;
};

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  if (a.x() != b.x()) return a.x() < b.x();
  if (a.y() != b.y()) return a.y() < b.y();
  return a.z() < b.z();
}

Vec3f blend(const Vec3f& a, const Vec3f& b, double t, const Vec3& fallback) {
  if (a == b) return a;
  const Vec3f sum = a + static_cast<float>(t) * (b - a);
  const float square = sum.squaredNorm();
  return square > 1e-12f ? Vec3f(sum / std::sqrt(square)) : Vec3f(fallback.cast<float>());
}

/// One attempt at a cut. Vertices of the result are numbered: inside ones first, in their old
/// order, then those on the plane as faces meet them.
class Cut {
 public:
  Cut(const ConvexPolyhedron& convex, double tolerance, ConvexPolyhedron& result,
      ClipScratch& scratch);

  /// Fills the result; false if the signs do not give one cap.
  bool make(const Plane& plane, PlaneId id);

 private:
  void cut_face(const ConvexPolyhedron::Face& face);
  void keep_face(const ConvexPolyhedron::Face& face);
  void close_face(const ConvexPolyhedron::Face& face, std::uint32_t first_corner);
  std::uint32_t on_vertex(std::uint32_t old);
  const ClipScratch::Crossing& crossing(std::uint32_t inside, std::uint32_t outside);
  void link(const Corner& from, const Corner& to);
  void add_cap_edge(std::uint32_t from, std::uint32_t to);
  void add_unmatched_on_edges();
  bool add_cap(const Plane& plane, PlaneId id);

  const ConvexPolyhedron& convex_;
  ConvexPolyhedron& result_;
  ClipScratch& scratch_;
  std::uint32_t vertex_count_ = 0;
  std::uint32_t corner_count_ = 0;
  std::uint32_t face_count_ = 0;
  std::uint32_t cap_count_ = 0;
  std::uint32_t cap_start_ = kNone;
  bool sound_ = true;
};

Cut::Cut(const ConvexPolyhedron& convex, double tolerance, ConvexPolyhedron& result,
         ClipScratch& scratch)
    : convex_(convex), result_(result), scratch_(scratch) {
  const std::size_t vertices = convex.vertices.size(), corners = convex.corners.size();
  // Upper bounds: every edge cut, a corner of a face at most two of the result's, and the cap.
  result.vertices.resize(vertices + corners / 2);
  result.corners.resize(3 * corners);
  result.corner_normals.resize(3 * corners);
  result.faces.resize(convex.faces.size() + 1);
  scratch.sides.resize(vertices);
  scratch.new_of_old.resize(vertices);
  scratch.first_crossing.assign(vertices, kNone);
  scratch.cap_next.assign(vertices + corners / 2, kNone);
  scratch.crossings.clear();
  scratch.on_edges.clear();
  for (std::size_t v = 0; v < vertices; ++v) {
    const double distance = scratch.distances[v];
    scratch.sides[v] = static_cast<std::int8_t>((distance > tolerance) - (distance < -tolerance));
    scratch.new_of_old[v] = kNone;
    if (scratch.sides[v] >= 0) continue;
    scratch.new_of_old[v] = vertex_count_;
    result.vertices[vertex_count_++] = convex.vertices[v];
  }
}

bool Cut::make(const Plane& plane, PlaneId id) {
  for (const ConvexPolyhedron::Face& face : convex_.faces) {
    const std::uint32_t* corner = convex_.corners.data() + face.first_corner;
    int lowest = 1, highest = -1;
    for (std::uint32_t i = 0; i < face.corner_count; ++i) {
      const int side = scratch_.sides[corner[i]];
      lowest = std::min(lowest, side);
      highest = std::max(highest, side);
    }
    if (highest < 0) {
      keep_face(face);
    } else if (lowest < 0) {
      cut_face(face);
    }
  }
  if (!scratch_.on_edges.empty()) add_unmatched_on_edges();
  return sound_ && add_cap(plane, id);
}

void Cut::keep_face(const ConvexPolyhedron::Face& face) {
  const std::uint32_t first = corner_count_;
  for (std::uint32_t i = 0; i < face.corner_count; ++i) {
    const std::uint32_t old = face.first_corner + i;
    result_.corners[corner_count_] = scratch_.new_of_old[convex_.corners[old]];
    result_.corner_normals[corner_count_++] = convex_.corner_normals[old];
  }
  close_face(face, first);
}

void Cut::cut_face(const ConvexPolyhedron::Face& face) {
  const std::uint32_t* corner = convex_.corners.data() + face.first_corner;
  const Vec3f* normal = convex_.corner_normals.data() + face.first_corner;
  const std::uint32_t first_corner = corner_count_;
  Corner first, last;
  const auto emit = [&](const Corner& here, const Vec3f& shading) {
    result_.corners[corner_count_] = here.vertex;
    result_.corner_normals[corner_count_++] = shading;
    link(last, here);
    if (first.vertex == kNone) first = here;
    last = here;
  };
  std::uint32_t before = face.corner_count - 1;
  for (std::uint32_t i = 0; i < face.corner_count; before = i++) {
    const int side_before = scratch_.sides[corner[before]], side = scratch_.sides[corner[i]];
    if (side_before * side < 0) {
      const std::uint32_t inside = side < 0 ? i : before, outside = side < 0 ? before : i;
      const ClipScratch::Crossing& cut = crossing(corner[inside], corner[outside]);
      const Vec3f& start = normal[cut.inside_first ? inside : outside];
      const Vec3f& end = normal[cut.inside_first ? outside : inside];
      emit({cut.vertex, Place::kCrossing}, blend(start, end, cut.t, face.plane.normal));
    }
    if (side < 0) emit({scratch_.new_of_old[corner[i]], Place::kIn}, normal[i]);
    if (side == 0) emit({on_vertex(corner[i]), Place::kOn}, normal[i]);
  }
  link(last, first);
  close_face(face, first_corner);
}

void Cut::close_face(const ConvexPolyhedron::Face& face, std::uint32_t first_corner) {
  ConvexPolyhedron::Face& kept = result_.faces[face_count_++];
  kept = face;
  kept.first_corner = first_corner;
  kept.corner_count = corner_count_ - first_corner;
}

std::uint32_t Cut::on_vertex(std::uint32_t old) {
  std::uint32_t& vertex = scratch_.new_of_old[old];
  if (vertex == kNone) {
    vertex = vertex_count_++;
    result_.vertices[vertex] = convex_.vertices[old];
  }
  return vertex;
}

const ClipScratch::Crossing& Cut::crossing(std::uint32_t inside, std::uint32_t outside) {
  std::uint32_t& head = scratch_.first_crossing[inside];
  for (std::uint32_t c = head; c != kNone; c = scratch_.crossings[c].next) {
    if (scratch_.crossings[c].outside == outside) return scratch_.crossings[c];
  }
  // From the end that comes first, so that whoever shares the edge gets the same bits.
  const bool inside_first =
      lexicographically_less(convex_.vertices[inside], convex_.vertices[outside]);
  const std::uint32_t a = inside_first ? inside : outside, b = inside_first ? outside : inside;
  const double distance_a = scratch_.distances[a];
  const double t = distance_a / (distance_a - scratch_.distances[b]);
  const Vec3& start = convex_.vertices[a];
  result_.vertices[vertex_count_] = start + t * (convex_.vertices[b] - start);
  scratch_.crossings.push_back({outside, vertex_count_++, head, t, inside_first});
  head = static_cast<std::uint32_t>(scratch_.crossings.size() - 1);
  return scratch_.crossings.back();
}

/// Two corners in a row on the plane: an edge of the cap, unless a kept face lies beyond it. That
/// can only be where both are old vertices.
void Cut::link(const Corner& from, const Corner& to) {
  if (from.place == Place::kIn || to.place == Place::kIn) return;
  if (from.place == Place::kOn && to.place == Place::kOn) {
    scratch_.on_edges.emplace_back(from.vertex, to.vertex);
  } else {
    add_cap_edge(to.vertex, from.vertex);
  }
}

void Cut::add_cap_edge(std::uint32_t from, std::uint32_t to) {
  sound_ = sound_ && scratch_.cap_next[from] == kNone;
  scratch_.cap_next[from] = to;
  cap_start_ = from;
  ++cap_count_;
}

void Cut::add_unmatched_on_edges() {
  auto& edges = scratch_.on_edges;
  std::sort(edges.begin(), edges.end());
  sound_ = sound_ && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
  for (const auto& [from, to] : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(to, from))) {
      add_cap_edge(to, from);
    }
  }
}

bool Cut::add_cap(const Plane& plane, PlaneId id) {
  if (cap_count_ < 3) return false;
  ConvexPolyhedron::Face& cap = result_.faces[face_count_++];
  cap = {plane, id, corner_count_, cap_count_, FaceKind::kInterior};
  const Vec3f normal = plane.normal.cast<float>();
  std::uint32_t v = cap_start_;
  for (std::uint32_t i = 0; i < cap_count_; ++i) {
    if (v == kNone || (i > 0 && v == cap_start_)) return false;  // open, or more than one loop
    result_.corners[corner_count_] = v;
    result_.corner_normals[corner_count_++] = normal;
    v = scratch_.cap_next[v];
  }
  if (v != cap_start_) return false;
  result_.vertices.resize(vertex_count_);
  result_.faces.resize(face_count_);
  result_.corners.resize(corner_count_);
  result_.corner_normals.resize(corner_count_);
  return true;
}

}  // namespace

PlaneSide clip(const ConvexPolyhedron& convex, const Plane& plane, PlaneId id, double tolerance_m,
               ConvexPolyhedron& result, ClipScratch& scratch) {
  SUNDER_CHECK(&convex != &result);
  scratch.distances.resize(convex.vertices.size());
  double lowest = 0, highest = 0;
  for (std::size_t v = 0; v < convex.vertices.size(); ++v) {
    const double distance = plane.distance(convex.vertices[v]);
    scratch.distances[v] = distance;
    lowest = std::min(lowest, distance);
    highest = std::max(highest, distance);
  }
  const double rounding = 1e-15 * (highest - lowest);
  for (double tolerance = tolerance_m;; tolerance = std::max(2 * tolerance, rounding)) {
    const bool none_outside = highest <= tolerance, none_inside = lowest >= -tolerance;
    if (none_outside && none_inside) break;
    if (none_outside) return PlaneSide::kInside;
    if (none_inside) return PlaneSide::kOutside;
    if (Cut(convex, tolerance, result, scratch).make(plane, id)) return PlaneSide::kCut;
  }
  // All of it lies on the plane: an answer that turns round with the plane.
  double balance = 0;
  for (const double distance : scratch.distances) balance += distance;
  const bool inside = balance != 0 ? balance < 0 : (id.value & 1) == 0;
  return inside ? PlaneSide::kInside : PlaneSide::kOutside;
}

}  // namespace sunder
