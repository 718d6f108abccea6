// Read first: sweep_planes(). The faces of a plane are sorted along one axis, and those that
// overlap along it are compared.
#include "fracture/adjacency/plane_sweep.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/hash.h"
#include "engine/geometry/polygon_mesh.h"
#include "fracture/adjacency/bucket_sort.h"
#include "fracture/adjacency/polygon_overlap.h"

namespace sunder::fracture {
namespace {

// Corners of caps within this distance, over the size of the smaller convex, are identical: the
// cuts that made the caps came in different order on the two sides.
constexpr double kSameMeshCorner = 1e-10;

/// Finds the contacts within one plane after the other.
class PlaneSweep {
 public:
  PlaneSweep(std::span<const ConvexPtr> convexes, std::vector<ProjectedFace>& faces)
      : convexes_(convexes), faces_(faces) {}

  /// Appends the contacts of the faces numbered in `plane`, which are all in one plane.
  void run(std::span<const std::uint32_t> plane, std::vector<Bond>& bonds) {
    if (plane.size() < 2) return;
    for (const std::uint32_t i : plane) reproject(faces_[i], faces_[plane[0]].dropped);
    if (plane.size() == 2) return match(faces_[plane[0]], faces_[plane[1]], bonds);
    extents_.clear();
    for (const std::uint32_t i : plane) {
      Extent extent{i, Vec2::Constant(1e300), Vec2::Constant(-1e300)};
      for (const Vec2& point : faces_[i].polygon()) {
        extent.min = extent.min.cwiseMin(point);
        extent.max = extent.max.cwiseMax(point);
      }
      extents_.push_back(extent);
    }
    std::sort(extents_.begin(), extents_.end(),
              [](const Extent& a, const Extent& b) { return a.min.x() < b.min.x(); });
    active_.clear();
    for (std::uint32_t i = 0; i < extents_.size(); ++i) {
      std::size_t kept = 0;
      for (const std::uint32_t other : active_) {
        if (extents_[other].max.x() <= extents_[i].min.x()) continue;
        active_[kept++] = other;
        const bool apart = extents_[other].max.y() <= extents_[i].min.y() ||
                           extents_[i].max.y() <= extents_[other].min.y();
        if (!apart) match(faces_[extents_[other].face], faces_[extents_[i].face], bonds);
      }
      active_.resize(kept);
      active_.push_back(i);
    }
  }

 private:
  struct Extent {
    std::uint32_t face;
    Vec2 min, max;
  };

  /// Projects a face along another axis: rounding may give the sides of a plane different axes.
  void reproject(ProjectedFace& face, std::uint8_t dropped) {
    if (face.dropped == dropped) return;
    const ConvexPolyhedron& polyhedron = convexes_[face.convex]->polyhedron;
    reprojected_.emplace_back();
    project_face(*convexes_[face.convex], face.face, face.cap, dropped, reprojected_.back());
    face.points = reprojected_.back().data();
    face.dropped = dropped;
    face.scale = 1 / std::abs(polyhedron.faces[face.face].plane.normal[dropped]);
  }

  void match(const ProjectedFace& a, const ProjectedFace& b, std::vector<Bond>& bonds) {
    if (a.id == b.id || (a.known && b.known) || a.convex == b.convex) return;
    // The even side is first, so that results do not depend on the order of convexes.
    const ProjectedFace& even = a.id < b.id ? a : b;
    const ProjectedFace& odd = a.id < b.id ? b : a;
    const double size = std::min(a.size, b.size);
    const double area = even.scale * flat_overlap(even, odd, size);
    if (area <= kMinContactArea * size * size) return;
    const ProjectedFace& low = a.convex < b.convex ? a : b;
    const ProjectedFace& high = a.convex < b.convex ? b : a;
    bonds.push_back({low.convex, high.convex, low.face, high.face, area});
  }

  double flat_overlap(const ProjectedFace& even, const ProjectedFace& odd, double size) {
    if (even.cap != FaceEntry::kNoCap || odd.cap != FaceEntry::kNoCap) {
      contours_of(even, contours_even_);
      contours_of(odd, contours_odd_);
      return overlap_area(contours_even_, contours_odd_, kSameMeshCorner * size);
    }
    return are_identical(even.polygon(), odd.polygon(), size)
               ? polygon_area(even.polygon())
               : overlap_area(even.polygon(), odd.polygon(), scratch_);
  }

  void contours_of(const ProjectedFace& face, std::vector<std::span<const Vec2>>& contours) const {
    contours.clear();
    if (face.cap == FaceEntry::kNoCap) return contours.push_back(face.polygon());
    const PolygonMesh& visual = *convexes_[face.convex]->visual;
    const PolygonMesh::Face& cap = visual.faces[face.cap];
    std::size_t first = 0;
    for (std::uint32_t k = cap.first_contour; k < cap.first_contour + cap.contour_count; ++k) {
      contours.push_back(face.polygon().subspan(first, visual.contours[k].corner_count));
      first += visual.contours[k].corner_count;
    }
  }

  /// Returns true in the common case of two faces with identical outlines, seen from either side.
  static bool are_identical(std::span<const Vec2> a, std::span<const Vec2> b, double size) {
    if (a.size() != b.size()) return false;
    const double near = 1e-26 * size * size;
    const auto same = [&](const Vec2& p, const Vec2& q) { return (p - q).squaredNorm() <= near; };
    std::size_t start = 0;
    while (start < b.size() && !same(a[0], b[start])) ++start;
    if (start == b.size()) return false;
    for (std::size_t i = 1; i < a.size(); ++i) {
      if (++start == b.size()) start = 0;
      if (!same(a[i], b[start])) return false;
    }
    return true;
  }

  std::span<const ConvexPtr> convexes_;
  std::vector<ProjectedFace>& faces_;
  std::vector<Extent> extents_;
  std::vector<std::uint32_t> active_;
  std::vector<std::vector<Vec2>> reprojected_;
  std::vector<std::span<const Vec2>> contours_even_, contours_odd_;
  OverlapScratch scratch_;
};

}  // namespace

void project_face(const Convex& convex, std::size_t face, std::uint32_t cap, int dropped,
                  std::vector<Vec2>& points) {
  const bool mirrored = convex.polyhedron.faces[face].plane.normal[dropped] < 0;
  const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
  const auto add = [&](const std::vector<Vec3>& vertices, std::span<const std::uint32_t> corners) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3& point = vertices[corners[mirrored ? corners.size() - 1 - k : k]];
      points.emplace_back(point[u], point[v]);
    }
  };
  if (cap == FaceEntry::kNoCap) {
    return add(convex.polyhedron.vertices, convex.polyhedron.face_corners(face));
  }
  const PolygonMesh::Face& of = convex.visual->faces[cap];
  for (std::uint32_t k = of.first_contour; k < of.first_contour + of.contour_count; ++k) {
    add(convex.visual->vertices, convex.visual->contour_corners(k));
  }
}

void sweep_planes(std::span<const ConvexPtr> convexes, std::vector<ProjectedFace>& faces,
                  std::vector<Bond>& bonds) {
  struct Key {
    std::uint64_t plane;
    std::uint32_t face;
  };
  std::vector<Key> keys;
  keys.reserve(faces.size());
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    keys.push_back({faces[i].id.value >> 1, i});
  }
  const std::size_t buckets = std::bit_ceil(keys.size() + 1);
  // The low bits of the hash select the bin, so they are used up.
  bucket_sort(
      keys, buckets, [&](const Key& key) { return (mix(key.plane) >> 32) & (buckets - 1); },
      [](const Key& a, const Key& b) {
        return a.plane != b.plane ? a.plane < b.plane : a.face < b.face;
      });
  PlaneSweep sweep(convexes, faces);
  std::vector<std::uint32_t> order;
  for (std::size_t i = 0, end = 0; i < keys.size(); i = end) {
    order.clear();
    for (; end < keys.size() && keys[end].plane == keys[i].plane; ++end) {
      order.push_back(keys[end].face);
    }
    sweep.run(order, bonds);
  }
}

}  // namespace sunder::fracture
