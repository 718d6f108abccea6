// One pass over the faces renumbers the corners that remain and adds a vertex to each edge that
// changes side; each edge without an opposite is then, reversed, an edge of the cap. All decisions
// depend on the sides of the vertices only (docs/decisions/005-robust-clipping.md).
//
// The first attempt reuses vertices on the plane. Where the solid is about as thin as the
// tolerance, the result may not be a sphere; then the cut is repeated without vertices on the
// plane, which always closes: each new vertex has one incoming and one outgoing cap edge.
#include "engine/geometry/clip.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/base/check.h"
#include "engine/base/disjoint_sets.h"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The sides of a plane, as flags, so that the sides of a face's corners combine by |.
enum Side : std::uint8_t { kIn = 1, kOn = 2, kOut = 4 };

/// Origin of a corner of a kept face. kOn (old vertex) and kCrossing (new) lie on the plane.
enum class Place { kIn, kOn, kCrossing };
struct Corner {
  std::uint32_t vertex = kNone;
  Place place = Place::kIn;
};

/// Returns V − E + F, which is 2 for each component of a closed surface.
std::ptrdiff_t euler_characteristic(const ConvexPolyhedron& convex) {
  return std::ssize(convex.vertices) + std::ssize(convex.faces) - std::ssize(convex.corners) / 2;
}

/// Returns six times the signed volume of the cone from a face to a point.
double cone_volume6(const ConvexPolyhedron& convex, std::size_t face, const Vec3& apex) {
  const auto corners = convex.face_corners(face);
  const Vec3 a = convex.vertices[corners[0]] - apex;
  double sum = 0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum +=
        a.dot((convex.vertices[corners[i - 1]] - apex).cross(convex.vertices[corners[i]] - apex));
  }
  return sum;
}

/// Keeps the largest of several closed components; the others are slivers due to rounding errors.
void keep_largest_part(ConvexPolyhedron& solid) {
  DisjointSets parts(solid.vertices.size());
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    for (const std::uint32_t v : solid.face_corners(f)) parts.join(solid.face_corners(f)[0], v);
  }
  const std::vector<std::uint32_t> part = parts.roots();
  std::vector<double> volume(solid.vertices.size());
  for (std::uint32_t v = 0; v < volume.size(); ++v) {
    volume[v] = part[v] == v ? 0 : std::numeric_limits<double>::lowest();
  }
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    volume[part[solid.face_corners(f)[0]]] += cone_volume6(solid, f, solid.vertices[0]);
  }
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(volume.begin(), volume.end()) - volume.begin());

  ConvexPolyhedron kept;
  std::vector<std::uint32_t> new_of_old(solid.vertices.size());
  for (std::size_t v = 0; v < solid.vertices.size(); ++v) {
    new_of_old[v] = static_cast<std::uint32_t>(kept.vertices.size());
    if (part[v] == largest) kept.vertices.push_back(solid.vertices[v]);
  }
  for (ConvexPolyhedron::Face face : solid.faces) {
    const std::uint32_t begin = face.first_corner, end = begin + face.corner_count;
    if (part[solid.corners[begin]] != largest) continue;
    face.first_corner = static_cast<std::uint32_t>(kept.corners.size());
    for (std::uint32_t c = begin; c < end; ++c) {
      kept.corners.push_back(new_of_old[solid.corners[c]]);
      kept.corner_normals.push_back(solid.corner_normals[c]);
    }
    kept.faces.push_back(face);
  }
  solid = std::move(kept);
}

/// One attempt at a cut. In the result the inside vertices come first, in their old order, then
/// those on the plane, in the order in which faces reach them.
class Cut {
 public:
  Cut(const ConvexPolyhedron& convex, ConvexPolyhedron& result, ClipScratch& scratch)
      : convex_(convex), result_(result), scratch_(scratch) {}

  /// Takes vertices within `tolerance` as on the plane. Returns false if the result is no sphere.
  bool cut_reusing_vertices(double tolerance, const Plane& plane, PlaneId id);
  /// Takes distance 0 as on `side_of_zero`. The result is closed, possibly in several components.
  void cut_strictly(Side side_of_zero, const Plane& plane, PlaneId id);

 private:
  template <class SideOf>
  void place_vertices(const SideOf& side_of);
  void cut_faces();
  void cut_face(const ConvexPolyhedron::Face& face);
  void keep_face(const ConvexPolyhedron::Face& face);
  void close_face(const ConvexPolyhedron::Face& face, std::uint32_t end_corner);
  std::uint32_t on_vertex(std::uint32_t old);
  const EdgeCrossing& crossing(std::uint32_t inside, std::uint32_t outside);
  void link(const Corner& from, const Corner& to);
  void add_cap_edge(std::uint32_t from, std::uint32_t to);
  void add_unmatched_on_edges();
  bool add_caps(const Plane& plane, PlaneId id);

  const ConvexPolyhedron& convex_;
  ConvexPolyhedron& result_;
  ClipScratch& scratch_;
  std::uint32_t inside_count_ = 0;
  std::uint32_t vertex_count_ = 0;
  std::uint32_t corner_count_ = 0;
  std::uint32_t face_count_ = 0;
  bool forked_ = false;  ///< True if two cap edges begin at one vertex.
};

bool Cut::cut_reusing_vertices(double tolerance, const Plane& plane, PlaneId id) {
  place_vertices([&](double distance) {
    return distance > tolerance ? kOut : distance < -tolerance ? kIn : kOn;
  });
  cut_faces();
  if (!scratch_.on_edges.empty()) add_unmatched_on_edges();
  return !forked_ && add_caps(plane, id) && euler_characteristic(result_) == 2;
}

void Cut::cut_strictly(Side side_of_zero, const Plane& plane, PlaneId id) {
  place_vertices([&](double distance) {
    return distance > 0 ? kOut : distance < 0 ? kIn : side_of_zero;
  });
  cut_faces();
  SUNDER_CHECK(!forked_ && add_caps(plane, id));  // fails if the convex was not closed
}

template <class SideOf>
void Cut::place_vertices(const SideOf& side_of) {
  const std::size_t vertices = convex_.vertices.size(), corners = convex_.corners.size();
  // Upper bounds: each edge is cut, each corner yields at most two corners, and the caps add more.
  result_.vertices.resize(vertices + corners / 2);
  result_.corners.resize(3 * corners);
  result_.corner_normals.resize(3 * corners);
  scratch_.sides.resize(vertices);
  scratch_.new_of_old.assign(vertices, kNone);
  scratch_.cap_next.assign(vertices + corners / 2, kNone);
  scratch_.crossings.restart(vertices);
  scratch_.on_edges.clear();
  for (std::size_t v = 0; v < vertices; ++v) {
    const Side side = side_of(scratch_.distances[v]);
    scratch_.sides[v] = side;
    if (side != kIn) continue;
    scratch_.new_of_old[v] = vertex_count_;
    result_.vertices[vertex_count_++] = convex_.vertices[v];
  }
  inside_count_ = vertex_count_;
}

void Cut::cut_faces() {
  result_.faces.resize(convex_.faces.size());
  for (const ConvexPolyhedron::Face& face : convex_.faces) {
    const std::uint32_t* corner = convex_.corners.data() + face.first_corner;
    int sides = 0;
    for (std::uint32_t i = 0; i < face.corner_count; ++i) sides |= scratch_.sides[corner[i]];
    if (sides == kIn) {
      keep_face(face);
    } else if (sides & kIn) {
      cut_face(face);
    }
  }
  result_.faces.resize(face_count_);
}

void Cut::keep_face(const ConvexPolyhedron::Face& face) {
  const std::uint32_t* corner = convex_.corners.data() + face.first_corner;
  const Vec3f* normal = convex_.corner_normals.data() + face.first_corner;
  std::uint32_t* kept = result_.corners.data() + corner_count_;
  for (std::uint32_t i = 0; i < face.corner_count; ++i) kept[i] = scratch_.new_of_old[corner[i]];
  std::copy_n(normal, face.corner_count, result_.corner_normals.data() + corner_count_);
  close_face(face, corner_count_ + face.corner_count);
}

void Cut::cut_face(const ConvexPolyhedron::Face& face) {
  const std::uint32_t* corner = convex_.corners.data() + face.first_corner;
  const Vec3f* normal = convex_.corner_normals.data() + face.first_corner;
  std::uint32_t* kept = result_.corners.data() + corner_count_;
  Vec3f* kept_normal = result_.corner_normals.data() + corner_count_;
  Corner first, last;
  const auto emit = [&](const Corner& here, const Vec3f& shading) {
    *kept++ = here.vertex;
    *kept_normal++ = shading;
    if (last.place != Place::kIn && here.place != Place::kIn) link(last, here);
    if (first.vertex == kNone) first = here;
    last = here;
  };
  std::uint32_t before = face.corner_count - 1;
  int side_before = scratch_.sides[corner[before]];
  for (std::uint32_t i = 0; i < face.corner_count; before = i++) {
    const int side = scratch_.sides[corner[i]];
    if ((side | side_before) == (kIn | kOut)) {
      const std::uint32_t inside = side == kIn ? i : before, outside = side == kIn ? before : i;
      const EdgeCrossing& cut = crossing(corner[inside], corner[outside]);
      const Vec3f& start = normal[cut.inside_first ? inside : outside];
      const Vec3f& end = normal[cut.inside_first ? outside : inside];
      emit({cut.vertex, Place::kCrossing},
           interpolate_normal(start, end, cut.t, face.plane.normal));
    }
    if (side == kIn) emit({scratch_.new_of_old[corner[i]], Place::kIn}, normal[i]);
    if (side == kOn) emit({on_vertex(corner[i]), Place::kOn}, normal[i]);
    side_before = side;
  }
  if (last.place != Place::kIn && first.place != Place::kIn) link(last, first);
  close_face(face, static_cast<std::uint32_t>(kept - result_.corners.data()));
}

void Cut::close_face(const ConvexPolyhedron::Face& face, std::uint32_t end_corner) {
  ConvexPolyhedron::Face& kept = result_.faces[face_count_++];
  kept = face;
  kept.first_corner = corner_count_;
  kept.corner_count = end_corner - corner_count_;
  corner_count_ = end_corner;
}

std::uint32_t Cut::on_vertex(std::uint32_t old) {
  std::uint32_t& vertex = scratch_.new_of_old[old];
  if (vertex == kNone) {
    vertex = vertex_count_++;
    result_.vertices[vertex] = convex_.vertices[old];
  }
  return vertex;
}

const EdgeCrossing& Cut::crossing(std::uint32_t inside, std::uint32_t outside) {
  const std::uint32_t known = scratch_.crossings.find(inside, outside);
  if (known != EdgeCrossings::kNone) return scratch_.crossings[known];
  // Interpolates from the lexicographically first end: the same bits for all who share the edge.
  const bool inside_first =
      lexicographically_less(convex_.vertices[inside], convex_.vertices[outside]);
  const std::uint32_t a = inside_first ? inside : outside, b = inside_first ? outside : inside;
  const double distance_a = scratch_.distances[a];
  const double t = distance_a / (distance_a - scratch_.distances[b]);
  const Vec3& start = convex_.vertices[a];
  result_.vertices[vertex_count_] = start + t * (convex_.vertices[b] - start);
  return scratch_
      .crossings[scratch_.crossings.add(inside, outside, vertex_count_++, t, inside_first)];
}

/// Adds the cap edge between two consecutive corners on the plane. An edge between two old vertices
/// is added later, if no other kept face has it.
void Cut::link(const Corner& from, const Corner& to) {
  if (from.place == Place::kOn && to.place == Place::kOn) {
    scratch_.on_edges.emplace_back(from.vertex, to.vertex);
  } else {
    add_cap_edge(to.vertex, from.vertex);
  }
}

void Cut::add_cap_edge(std::uint32_t from, std::uint32_t to) {
  forked_ = forked_ || scratch_.cap_next[from] != kNone;
  scratch_.cap_next[from] = to;
}

void Cut::add_unmatched_on_edges() {
  auto& edges = scratch_.on_edges;
  std::sort(edges.begin(), edges.end());
  forked_ = forked_ || std::adjacent_find(edges.begin(), edges.end()) != edges.end();
  for (const auto& [from, to] : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(to, from))) {
      add_cap_edge(to, from);
    }
  }
}

/// Adds a face for each loop of cap edges. Returns false if a loop does not close. A loop of two
/// edges gets no face: the faces of its edges meet there.
bool Cut::add_caps(const Plane& plane, PlaneId id) {
  const Vec3f normal = plane.normal.cast<float>();
  for (std::uint32_t start = inside_count_; start < vertex_count_; ++start) {
    const std::uint32_t first_corner = corner_count_;
    std::uint32_t v = start;
    for (std::uint32_t next; (next = scratch_.cap_next[v]) != kNone; v = next) {
      result_.corners[corner_count_] = v;
      result_.corner_normals[corner_count_++] = normal;
      scratch_.cap_next[v] = kNone;
    }
    if (v != start) return false;
    const std::uint32_t count = corner_count_ - first_corner;
    if (count > 2) result_.faces.push_back({plane, id, first_corner, count, FaceKind::kInterior});
    if (count == 2) corner_count_ = first_corner;
  }
  result_.vertices.resize(vertex_count_);
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
  const bool none_outside = highest <= tolerance_m, none_inside = lowest >= -tolerance_m;
  const Side side_of_zero = id.value & 1 ? kOut : kIn;  // opposite for the flipped plane
  if (none_outside && none_inside) {
    const double balance = std::accumulate(scratch.distances.begin(), scratch.distances.end(), 0.0);
    const bool inside = balance != 0 ? balance < 0 : side_of_zero == kIn;
    return inside ? PlaneSide::kInside : PlaneSide::kOutside;
  }
  if (none_outside) return PlaneSide::kInside;
  if (none_inside) return PlaneSide::kOutside;
  if (Cut(convex, result, scratch).cut_reusing_vertices(tolerance_m, plane, id))
    return PlaneSide::kCut;
  Cut(convex, result, scratch).cut_strictly(side_of_zero, plane, id);
  if (euler_characteristic(result) != 2) keep_largest_part(result);
  return PlaneSide::kCut;
}

}  // namespace sunder
