#include "fracture/adjacency.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "fracture/polygon.h"

namespace sunder::fracture {
namespace {

/// A face laid flat into two of the three axes.
struct FlatFace {
  std::uint32_t entry = 0;
  std::uint32_t first_point = 0;
  std::uint32_t point_count = 0;
  Vec2 min, max;
};

/// Finds the contacts within one plane.
class PlaneSweep {
 public:
  explicit PlaneSweep(std::span<const ConvexPtr> convexes) : convexes_(convexes) {}

  /// `entries` name one plane, either side.
  void run(std::span<const FaceEntry> entries, std::vector<Bond>& bonds) {
    if (entries.size() < 2 || (entries.size() == 2 && match_twins(entries, bonds))) return;
    flatten(entries);
    std::sort(faces_.begin(), faces_.end(), [](const FlatFace& a, const FlatFace& b) {
      return a.min.x() != b.min.x() ? a.min.x() < b.min.x() : a.entry < b.entry;
    });
    active_.clear();
    for (std::uint32_t i = 0; i < faces_.size(); ++i) {
      std::size_t kept = 0;
      for (const std::uint32_t other : active_) {
        if (faces_[other].max.x() <= faces_[i].min.x()) continue;
        active_[kept++] = other;
        match(entries, faces_[other], faces_[i], bonds);
      }
      active_.resize(kept);
      active_.push_back(i);
    }
  }

 private:
  const ConvexPolyhedron::Face& face_of(const FaceEntry& entry) const {
    return convexes_[entry.convex]->polyhedron.faces[entry.face];
  }

  /// All faces seen against the first one's normal, so that its own side is counter-clockwise.
  void flatten(std::span<const FaceEntry> entries) {
    const Vec3 normal = face_of(entries[0]).plane.normal;
    int drop = 0;
    normal.cwiseAbs().maxCoeff(&drop);
    scale_ = 1 / std::abs(normal[drop]);
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    const bool mirrored = normal[drop] < 0;
    const ConvexPolyhedron& first = convexes_[entries[0].convex]->polyhedron;
    const Vec3 origin = first.vertices[first.face_corners(entries[0].face)[0]];
    points_.clear();
    faces_.clear();
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
      const ConvexPolyhedron& polyhedron = convexes_[entries[i].convex]->polyhedron;
      const auto corners = polyhedron.face_corners(entries[i].face);
      FlatFace flat{i, static_cast<std::uint32_t>(points_.size()),
                    static_cast<std::uint32_t>(corners.size()), Vec2::Constant(1e300),
                    Vec2::Constant(-1e300)};
      const bool same_side = entries[i].id == entries[0].id;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const std::size_t at = same_side != mirrored ? k : corners.size() - 1 - k;
        const Vec3 point = polyhedron.vertices[corners[at]] - origin;
        points_.emplace_back(point[u], point[v]);
        flat.min = flat.min.cwiseMin(points_.back());
        flat.max = flat.max.cwiseMax(points_.back());
      }
      faces_.push_back(flat);
    }
  }

  std::span<const Vec2> points_of(const FlatFace& face) const {
    return std::span(points_).subspan(face.first_point, face.point_count);
  }

  /// The common case of two faces that are one polygon seen from either side. False if they are
  /// not.
  bool match_twins(std::span<const FaceEntry> entries, std::vector<Bond>& bonds) const {
    const FaceEntry& a = entries[0];
    const FaceEntry& b = entries[1];
    if (a.id == b.id || (a.known && b.known) || a.convex == b.convex) return true;
    const Convex& p = *convexes_[a.convex];
    const Convex& q = *convexes_[b.convex];
    const auto corners_p = p.polyhedron.face_corners(a.face);
    const auto corners_q = q.polyhedron.face_corners(b.face);
    const std::size_t n = corners_p.size();
    if (n != corners_q.size()) return false;
    const double size = p.box.extent().maxCoeff(), near = 1e-26 * size * size;
    const auto same = [&](std::size_t i, std::size_t j) {
      const Vec3& point = p.polyhedron.vertices[corners_p[i]];
      return (point - q.polyhedron.vertices[corners_q[j]]).squaredNorm() <= near;
    };
    std::size_t start = 0;
    while (start < n && !same(0, start)) ++start;
    if (start == n) return false;
    for (std::size_t i = 1; i < n; ++i) {
      if (!same(i, (start + n - i) % n)) return false;
    }
    add_bond(a, b, face_area(p.polyhedron, a.face), bonds);
    return true;
  }

  void add_bond(const FaceEntry& a, const FaceEntry& b, double area,
                std::vector<Bond>& bonds) const {
    if (area <= least_overlap(*convexes_[a.convex], *convexes_[b.convex])) return;
    const FaceEntry& low = a.convex < b.convex ? a : b;
    const FaceEntry& high = a.convex < b.convex ? b : a;
    bonds.push_back({low.convex, high.convex, low.face, high.face, area});
  }

  void match(std::span<const FaceEntry> entries, const FlatFace& a, const FlatFace& b,
             std::vector<Bond>& bonds) {
    const FaceEntry& entry_a = entries[a.entry];
    const FaceEntry& entry_b = entries[b.entry];
    if (entry_a.id == entry_b.id || (entry_a.known && entry_b.known)) return;
    if (entry_a.convex == entry_b.convex) return;
    if (a.max.y() <= b.min.y() || b.max.y() <= a.min.y()) return;
    add_bond(entry_a, entry_b, scale_ * overlap_area(points_of(a), points_of(b), scratch_), bonds);
  }

  std::span<const ConvexPtr> convexes_;
  double scale_ = 1;
  std::vector<Vec2> points_;
  std::vector<FlatFace> faces_;
  std::vector<std::uint32_t> active_;
  OverlapScratch scratch_;
};

/// Sorts by scattering into as many buckets as there are items, each then sorted on its own: in
/// linear time if `bucket` (below the count it is given) spreads them. Items of different buckets
/// keep the order of their buckets.
template <class T, class Bucket, class Less>
void bucket_sort(std::vector<T>& items, std::size_t buckets, const Bucket& bucket,
                 const Less& less) {
  std::vector<std::size_t> ends(buckets + 1, 0);
  for (const T& item : items) ++ends[bucket(item) + 1];
  for (std::size_t b = 0; b < buckets; ++b) ends[b + 1] += ends[b];
  std::vector<T> sorted(items.size());
  for (const T& item : items) sorted[ends[bucket(item)]++] = item;
  for (std::size_t b = 0, begin = 0; b < buckets; begin = ends[b++]) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
              sorted.begin() + static_cast<std::ptrdiff_t>(ends[b]), less);
  }
  items = std::move(sorted);
}

/// Where each plane's entries begin, and the end of the last.
std::vector<std::size_t> plane_starts(const std::vector<FaceEntry>& faces) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i == 0 || faces[i].id.value >> 1 != faces[i - 1].id.value >> 1) starts.push_back(i);
  }
  starts.push_back(faces.size());
  return starts;
}

}  // namespace

double least_overlap(const Convex& a, const Convex& b) {
  constexpr double kLeastOverlap = 1e-10;
  const double size = std::min(a.box.extent().maxCoeff(), b.box.extent().maxCoeff());
  return kLeastOverlap * size * size;
}

void sort_bonds(std::vector<Bond>& bonds) {
  std::uint32_t convexes = 0;
  for (const Bond& bond : bonds) convexes = std::max(convexes, bond.a + 1);
  const auto less = [](const Bond& x, const Bond& y) {
    return std::tie(x.a, x.b, x.face_a, x.face_b) < std::tie(y.a, y.b, y.face_a, y.face_b);
  };
  if (convexes > 2 * bonds.size()) {
    std::sort(bonds.begin(), bonds.end(), less);
  } else {
    bucket_sort(
        bonds, convexes, [](const Bond& bond) { return bond.a; }, less);
  }
}

void add_faces(const ConvexPolyhedron& polyhedron, std::uint32_t index,
               std::vector<FaceEntry>& entries) {
  for (std::uint32_t f = 0; f < polyhedron.faces.size(); ++f) {
    if (!polyhedron.faces[f].id.none()) {
      entries.push_back({polyhedron.faces[f].id, index, f, false});
    }
  }
}

std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes, std::vector<FaceEntry> faces) {
  const std::size_t buckets = std::bit_ceil(faces.size() + 1);
  bucket_sort(
      faces, buckets,
      [&](const FaceEntry& entry) { return mix(entry.id.value >> 1) & (buckets - 1); },
      [](const FaceEntry& a, const FaceEntry& b) {
        return std::tie(a.id, a.convex, a.face) < std::tie(b.id, b.convex, b.face);
      });
  const std::vector<std::size_t> starts = plane_starts(faces);
  constexpr std::size_t kPlanesAtOnce = 64;
  const std::size_t planes = starts.size() - 1;
  std::vector<std::vector<Bond>> found((planes + kPlanesAtOnce - 1) / kPlanesAtOnce);
  for_chunks(planes, kPlanesAtOnce, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    PlaneSweep sweep(convexes);
    for (std::size_t p = begin; p < end; ++p) {
      sweep.run(std::span(faces).subspan(starts[p], starts[p + 1] - starts[p]), found[chunk]);
    }
  });
  std::vector<Bond> bonds;
  for (const std::vector<Bond>& part : found) bonds.insert(bonds.end(), part.begin(), part.end());
  sort_bonds(bonds);
  return bonds;
}

std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes) {
  std::vector<FaceEntry> faces;
  for (std::uint32_t i = 0; i < convexes.size(); ++i) {
    add_faces(convexes[i]->polyhedron, i, faces);
  }
  return find_contacts(convexes, std::move(faces));
}

}  // namespace sunder::fracture
