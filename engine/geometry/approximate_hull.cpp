#include "engine/geometry/approximate_hull.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "engine/geometry/clip.h"
#include "engine/geometry/farthest.h"

namespace sunder {
namespace {

/// Volumes below this fraction of the bounding cube's count as rounding errors.
constexpr double kVolumeRoundoff = 1e-13;
/// A face is coplanar with a point if their tetrahedron is below this fraction of that volume.
constexpr double kCoplanarFraction = 1e-2;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Returns the first four vertices of algorithm 1; the last lies above the triangle of the others.
std::array<std::uint32_t, 4> first_tetrahedron(std::span<const Vec3> points) {
  const auto a = farthest(points, [](const Vec3& p) { return p.x(); });
  const auto b = farthest(points, [&](const Vec3& p) { return (p - points[a]).squaredNorm(); });
  const Vec3 ab = points[b] - points[a];
  const auto c =
      farthest(points, [&](const Vec3& p) { return ab.cross(p - points[a]).squaredNorm(); });
  const Vec3 normal = ab.cross(points[c] - points[a]);
  const auto d =
      farthest(points, [&](const Vec3& p) { return std::abs(normal.dot(p - points[a])); });
  if (normal.dot(points[d] - points[a]) > 0) return {a, b, c, d};
  return {a, c, b, d};
}

/// The hull of algorithm 1 under construction, and the points outside it.
class GrowingHull {
 public:
  explicit GrowingHull(std::span<const Vec3> points) : points_(points) {
    Box box;
    for (const Vec3& p : points) box.extend(p);
    origin_ = box.center();
    const double size = box.extent().maxCoeff();
    volume_tolerance_ = kVolumeRoundoff * size * size * size;
    const auto [a, b, c, d] = first_tetrahedron(points);
    hull_.vertices = {a, b, c, d};
    for (const Face& face :
         {make_face(a, c, b), make_face(a, b, d), make_face(b, c, d), make_face(c, a, d)}) {
      faces_.push_back(face);
    }
    hull_.volume_m3 = faces_[0].volume_to(points[d] - origin_) * -1;
    if (!(hull_.volume_m3 > volume_tolerance_)) return;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const Vec3 p = points[i] - origin_;
      outside_.index.push_back(i);
      outside_.x.push_back(p.x());
      outside_.y.push_back(p.y());
      outside_.z.push_back(p.z());
    }
    outside_.gain.assign(points.size(), 0);
    for (const Face& face : faces_) outside_.add(face, 1);
    outside_.remove_below(volume_tolerance_);
  }

  bool is_flat() const { return !(hull_.volume_m3 > volume_tolerance_); }
  bool is_done() const { return outside_.index.empty(); }

  /// Adds the point that adds most volume. Discards it instead if rounding errors make it unclear
  /// which faces are visible from it, as for a point in the plane of several faces.
  void grow() {
    const auto most = std::max_element(outside_.gain.begin(), outside_.gain.end());
    const auto k = outside_.index[static_cast<std::size_t>(most - outside_.gain.begin())];
    const Vec3 apex = points_[k] - origin_;
    const auto visible = std::stable_partition(faces_.begin(), faces_.end(), [&](const Face& face) {
      return face.volume_to(apex) <= kCoplanarFraction * volume_tolerance_;
    });
    // The border of a disc of n triangles has at most n + 2 edges.
    const std::vector<Edge> border = border_of(std::span(visible, faces_.end()));
    if (border.size() > static_cast<std::size_t>(faces_.end() - visible) + 2) {
      *most = 0;
    } else {
      hull_.vertices.push_back(k);
      hull_.volume_m3 += *most;
      for (auto face = visible; face != faces_.end(); ++face) outside_.add(*face, -1);
      faces_.erase(visible, faces_.end());
      for (const auto& [from, to] : border) {
        faces_.push_back(make_face(from, to, k));
        outside_.add(faces_.back(), 1);
      }
    }
    outside_.remove_below(volume_tolerance_);
  }
  std::size_t vertex_count() const { return hull_.vertices.size(); }

  ApproximateHull result() && {
    for (const Face& face : faces_) {
      const double size = face.normal.norm();
      if (size > 0) hull_.directions.push_back(face.normal / size);
    }
    return std::move(hull_);
  }

 private:
  struct Face {
    std::array<std::uint32_t, 3> vertices;
    Vec3 normal;  ///< A third of the area vector, so that its dot products are volumes.
    double d;
    /// Returns the signed volume of the tetrahedron with a point, positive above the face.
    double volume_to(const Vec3& p) const { return normal.dot(p) + d; }
  };

  /// Points outside the hull, and the volume that each would add (V_i of the paper).
  struct Outside {
    std::vector<std::uint32_t> index;
    std::vector<double> x, y, z, gain;

    /// Adds `sign` times the volume of the tetrahedra of a face and the points it is visible from.
    void add(const Face& face, double sign) {
      const double nx = face.normal.x(), ny = face.normal.y(), nz = face.normal.z(), d = face.d;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double volume = nx * x[i] + ny * y[i] + nz * z[i] + d;
        gain[i] += sign * (volume > 0 ? volume : 0);
      }
    }

    /// Removes the points that would add `least` or less: they are inside the hull.
    void remove_below(double least) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < gain.size(); ++i) {
        if (!(gain[i] > least)) continue;
        index[kept] = index[i];
        x[kept] = x[i];
        y[kept] = y[i];
        z[kept] = z[i];
        gain[kept++] = gain[i];
      }
      index.resize(kept);
      for (auto* column : {&x, &y, &z, &gain}) column->resize(kept);
    }
  };

  /// Returns the edges between the given faces and all others.
  static std::vector<Edge> border_of(std::span<const Face> faces) {
    std::vector<Edge> edges, border;
    for (const Face& face : faces) {
      for (std::size_t i = 0; i < 3; ++i) {
        edges.emplace_back(face.vertices[i], face.vertices[(i + 1) % 3]);
      }
    }
    std::sort(edges.begin(), edges.end());
    for (const auto& [from, to] : edges) {
      // An edge between two of the given faces occurs in both directions.
      if (!std::binary_search(edges.begin(), edges.end(), Edge(to, from))) {
        border.emplace_back(from, to);
      }
    }
    return border;
  }

  Face make_face(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    const Vec3 a = points_[i] - origin_, b = points_[j] - origin_, c = points_[k] - origin_;
    const Vec3 normal = (b - a).cross(c - a) / 6;
    return {{i, j, k}, normal, -normal.dot(a)};
  }

  std::span<const Vec3> points_;
  Vec3 origin_;
  double volume_tolerance_ = 0;
  ApproximateHull hull_;
  std::vector<Face> faces_;
  Outside outside_;
};

std::array<Vec3, 26> make_dop_directions() {
  constexpr int kAxes[13][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},  {-1, 1, 1},
                                {1, -1, 1}, {1, 1, -1}, {0, 1, 1}, {0, -1, 1}, {1, 0, 1},
                                {1, 0, -1}, {1, 1, 0},  {-1, 1, 0}};
  std::array<Vec3, 26> directions;
  for (std::size_t i = 0; i < 13; ++i) {
    directions[2 * i] = Vec3(kAxes[i][0], kAxes[i][1], kAxes[i][2]).normalized();
    directions[2 * i + 1] = -directions[2 * i];
  }
  return directions;
}

}  // namespace

std::string name_of(const Fit& fit) {
  switch (fit.kind) {
    case Fit::Kind::kAabb:
      return "aabb";
    case Fit::Kind::k14Dop:
      return "14dop";
    case Fit::Kind::k26Dop:
      return "26dop";
    case Fit::Kind::kHull:
      break;
  }
  return "hull:" + std::to_string(fit.vertex_count);
}

std::optional<Fit> parse_fit(std::string_view name) {
  for (const Fit::Kind kind : {Fit::Kind::kAabb, Fit::Kind::k14Dop, Fit::Kind::k26Dop}) {
    if (name == name_of({kind})) return Fit{kind};
  }
  constexpr std::string_view kHull = "hull:";
  if (!name.starts_with(kHull)) return std::nullopt;
  Fit fit{Fit::Kind::kHull};
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + kHull.size(), end, fit.vertex_count);
  const bool is_valid = error == std::errc() && rest == end && fit.vertex_count >= 4 &&
                        fit.vertex_count <= kMaxFitVertices;
  return is_valid ? std::optional(fit) : std::nullopt;
}

std::span<const Vec3> dop_directions() {
  static const std::array<Vec3, 26> directions = make_dop_directions();
  return directions;
}

ApproximateHull approximate_hull(std::span<const Vec3> points, std::size_t vertex_count) {
  if (points.size() < 4) return {};
  GrowingHull hull(points);
  if (hull.is_flat()) return {};
  while (hull.vertex_count() < vertex_count && !hull.is_done()) hull.grow();
  return std::move(hull).result();
}

std::vector<Vec3> fit_directions(std::span<const Vec3> points, const Fit& fit) {
  const std::span<const Vec3> dop = dop_directions();
  std::size_t count = 26;
  if (fit.kind == Fit::Kind::kAabb) count = 6;
  if (fit.kind == Fit::Kind::k14Dop) count = 14;
  if (fit.kind == Fit::Kind::kHull) {
    ApproximateHull hull = approximate_hull(points, fit.vertex_count);
    if (!hull.directions.empty()) return std::move(hull.directions);
  }
  return {dop.begin(), dop.begin() + static_cast<std::ptrdiff_t>(count)};
}

std::vector<Plane> touching_planes(std::span<const Vec3> points, std::span<const Vec3> directions) {
  std::vector<Plane> planes;
  planes.reserve(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vec3& direction = directions[i];
    double least = 1e300, most = -1e300;
    for (const Vec3& p : points) {
      const double at = direction.dot(p);
      least = std::min(least, at);
      most = std::max(most, at);
    }
    planes.push_back({direction, -most});
    if (i + 1 < directions.size() && directions[i + 1] == -direction) {  // as in dop_directions()
      planes.push_back({directions[++i], least});
    }
  }
  return planes;
}

ConvexPolyhedron clip_all(const ConvexPolyhedron& convex, std::span<const Plane> planes,
                          std::span<const PlaneId> ids, double tolerance_m) {
  ConvexPolyhedron kept = convex, next;
  ClipScratch scratch;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (clip(kept, planes[i], ids[i], tolerance_m, next, scratch) == PlaneSide::kCut) {
      std::swap(kept, next);
    }
  }
  return kept;
}

ConvexPolyhedron fitted_hull(std::span<const Vec3> points, const Fit& fit) {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  if (box.empty()) return {};
  const double size = box.extent().maxCoeff();
  const double reach = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  const double thin = 1e-9 * size + 1e-12 * reach + 1e-30;
  const Vec3 thick = (box.extent().array() > thin).select(Vec3::Zero(), Vec3::Constant(thin));
  const std::vector<Plane> planes = touching_planes(points, fit_directions(points, fit));
  const std::vector<PlaneId> ids(planes.size());
  return clip_all(make_box(box.min - thick, box.max + thick), planes, ids, 1e-12 * size);
}

}  // namespace sunder
