// Two passes, each through memory in order. Faces are laid flat while their convexes go by, into
// bins by the names of their planes; then each bin, small enough to stay near, is sorted and swept.
#include "fracture/adjacency.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "engine/base/check.h"
#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/geometry/polygon_mesh.h"
#include "fracture/polygon.h"

namespace sunder::fracture {
namespace {

constexpr double kLeastOverlap = 1e-10;  // of the squared size of the smaller convex
// Corners of caps this near are one, over the size of the smaller convex: from either side, the
// cuts that made them came in another order.
constexpr double kSameMeshCorner = 1e-10;

/// A face without the coordinate in which its normal is longest.
struct FlatFace {
  PlaneId id;
  const Vec2* points = nullptr;  ///< Its polygon, once its bin is complete.
  double scale = 1;              ///< Its area is this times that of the polygon.
  double size = 0;               ///< Of its convex.
  std::uint32_t convex = 0, face = 0;
  std::uint32_t first_point = 0, point_count = 0;  ///< In its bin.
  std::uint32_t cap = FaceEntry::kNoCap;
  std::uint8_t dropped = 0;  ///< That coordinate.
  bool known = false;

  std::span<const Vec2> polygon() const { return {points, point_count}; }
};

double size_of(const Convex& convex) { return convex.box.extent().maxCoeff(); }

/// Appends the polygon of a face, or of the cap in it, without coordinate `dropped`,
/// counter-clockwise from either side.
void lay_flat(const Convex& convex, std::size_t face, std::uint32_t cap, int dropped,
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

/// Faces of some planes.
struct Bin {
  std::vector<FlatFace> faces;
  std::vector<Vec2> points;

  void add(const Convex& convex, const FaceEntry& entry) {
    const Vec3& normal = convex.polyhedron.faces[entry.face].plane.normal;
    int dropped = 0;
    const double longest = normal.cwiseAbs().maxCoeff(&dropped);
    FlatFace flat;
    flat.id = entry.id;
    flat.scale = 1 / longest;
    flat.size = size_of(convex);
    flat.convex = entry.convex;
    flat.face = entry.face;
    flat.first_point = static_cast<std::uint32_t>(points.size());
    flat.cap = entry.cap;
    lay_flat(convex, entry.face, entry.cap, dropped, points);
    flat.point_count = static_cast<std::uint32_t>(points.size()) - flat.first_point;
    flat.dropped = static_cast<std::uint8_t>(dropped);
    flat.known = entry.known;
    faces.push_back(flat);
  }
};

/// Finds the contacts within planes.
class PlaneSweep {
 public:
  PlaneSweep(std::span<const ConvexPtr> convexes, std::vector<FlatFace>& faces)
      : convexes_(convexes), faces_(faces) {}

  /// `plane` numbers the faces of one plane, either side.
  void run(std::span<const std::uint32_t> plane, std::vector<Bond>& bonds) {
    if (plane.size() < 2) return;
    for (const std::uint32_t i : plane) turn(faces_[i], faces_[plane[0]].dropped);
    if (plane.size() == 2) return match(faces_[plane[0]], faces_[plane[1]], bonds);
    spread_.clear();
    for (const std::uint32_t i : plane) {
      Spread spread{i, Vec2::Constant(1e300), Vec2::Constant(-1e300)};
      for (const Vec2& point : faces_[i].polygon()) {
        spread.min = spread.min.cwiseMin(point);
        spread.max = spread.max.cwiseMax(point);
      }
      spread_.push_back(spread);
    }
    std::sort(spread_.begin(), spread_.end(),
              [](const Spread& a, const Spread& b) { return a.min.x() < b.min.x(); });
    active_.clear();
    for (std::uint32_t i = 0; i < spread_.size(); ++i) {
      std::size_t kept = 0;
      for (const std::uint32_t other : active_) {
        if (spread_[other].max.x() <= spread_[i].min.x()) continue;
        active_[kept++] = other;
        const bool apart = spread_[other].max.y() <= spread_[i].min.y() ||
                           spread_[i].max.y() <= spread_[other].min.y();
        if (!apart) match(faces_[spread_[other].face], faces_[spread_[i].face], bonds);
      }
      active_.resize(kept);
      active_.push_back(i);
    }
  }

 private:
  struct Spread {
    std::uint32_t face;
    Vec2 min, max;
  };

  /// Lays a face flat the other way: rounding may tell the sides of one plane apart.
  void turn(FlatFace& face, std::uint8_t dropped) {
    if (face.dropped == dropped) return;
    const ConvexPolyhedron& polyhedron = convexes_[face.convex]->polyhedron;
    turned_.emplace_back();
    lay_flat(*convexes_[face.convex], face.face, face.cap, dropped, turned_.back());
    face.points = turned_.back().data();
    face.dropped = dropped;
    face.scale = 1 / std::abs(polyhedron.faces[face.face].plane.normal[dropped]);
  }

  void match(const FlatFace& a, const FlatFace& b, std::vector<Bond>& bonds) {
    if (a.id == b.id || (a.known && b.known) || a.convex == b.convex) return;
    // The even side first: the same bits whichever convex was given first.
    const FlatFace& even = a.id < b.id ? a : b;
    const FlatFace& odd = a.id < b.id ? b : a;
    const double size = std::min(a.size, b.size);
    const double area = even.scale * flat_overlap(even, odd, size);
    if (area <= kLeastOverlap * size * size) return;
    const FlatFace& low = a.convex < b.convex ? a : b;
    const FlatFace& high = a.convex < b.convex ? b : a;
    bonds.push_back({low.convex, high.convex, low.face, high.face, area});
  }

  double flat_overlap(const FlatFace& even, const FlatFace& odd, double size) {
    if (even.cap != FaceEntry::kNoCap || odd.cap != FaceEntry::kNoCap) {
      contours_of(even, contours_even_);
      contours_of(odd, contours_odd_);
      return overlap_area(contours_even_, contours_odd_, kSameMeshCorner * size);
    }
    return are_twins(even.polygon(), odd.polygon(), size)
               ? polygon_area(even.polygon())
               : overlap_area(even.polygon(), odd.polygon(), scratch_);
  }

  void contours_of(const FlatFace& face, std::vector<std::span<const Vec2>>& contours) const {
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

  /// The common case of two faces that are one polygon seen from either side.
  static bool are_twins(std::span<const Vec2> a, std::span<const Vec2> b, double size) {
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
  std::vector<FlatFace>& faces_;
  std::vector<Spread> spread_;
  std::vector<std::uint32_t> active_;
  std::vector<std::vector<Vec2>> turned_;
  std::vector<std::span<const Vec2>> contours_even_, contours_odd_;
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

/// The contacts within a bin's planes.
void sweep_planes(std::span<const ConvexPtr> convexes, std::vector<FlatFace>& faces,
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
  // Bins took the low bits of the hash.
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

/// All contacts, where `add(begin, end, bins)` lays the faces of items [begin, end) flat.
template <class Add>
std::vector<Bond> contacts(std::span<const ConvexPtr> convexes, std::size_t items,
                           std::size_t items_at_once, std::size_t faces, const Add& add) {
  constexpr std::size_t kFacesInBin = 1024, kMostBins = 256;
  const std::size_t bins = std::min(std::bit_ceil(faces / kFacesInBin + 1), kMostBins);
  const std::size_t chunks = (items + items_at_once - 1) / items_at_once;
  std::vector<std::vector<Bin>> flat(chunks);
  for_chunks(items, items_at_once, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    flat[chunk].resize(bins);
    for (Bin& bin : flat[chunk]) {
      const std::size_t expected = 3 * faces / (2 * chunks * bins);
      bin.faces.reserve(expected);
      bin.points.reserve(6 * expected);
    }
    add(begin, end, flat[chunk]);
  });
  std::vector<std::vector<Bond>> found(bins);
  for_chunks(bins, 1, [&](std::size_t b, std::size_t, std::size_t) {
    std::vector<FlatFace> in_bin;
    std::size_t count = 0;
    for (const std::vector<Bin>& chunk : flat) count += chunk[b].faces.size();
    in_bin.reserve(count);
    for (const std::vector<Bin>& chunk : flat) {
      for (FlatFace face : chunk[b].faces) {
        face.points = chunk[b].points.data() + face.first_point;
        in_bin.push_back(face);
      }
    }
    sweep_planes(convexes, in_bin, found[b]);
  });
  std::vector<Bond> bonds;
  for (const std::vector<Bond>& part : found) bonds.insert(bonds.end(), part.begin(), part.end());
  sort_bonds(bonds);
  return bonds;
}

/// Asks for the convexes after the first: they are strewn over memory, and waiting for them is most
/// of the work.
void fetch_ahead(std::span<const ConvexPtr> convexes) {
  constexpr std::size_t kHead = 6, kBody = 3;
  if (kHead < convexes.size()) __builtin_prefetch(convexes[kHead].get());
  if (kBody >= convexes.size()) return;
  const ConvexPolyhedron& next = convexes[kBody]->polyhedron;
  const auto fetch = [](const void* start, std::size_t bytes) {
    const char* line = static_cast<const char*>(start);
    for (std::size_t at = 0; at < bytes; at += 64) __builtin_prefetch(line + at);
  };
  fetch(next.faces.data(), next.faces.size() * sizeof(next.faces[0]));
  fetch(next.corners.data(), next.corners.size() * sizeof(next.corners[0]));
  fetch(next.vertices.data(), next.vertices.size() * sizeof(next.vertices[0]));
}

void add_to_bins(const Convex& convex, const FaceEntry& entry, std::vector<Bin>& bins) {
  bins[mix(entry.id.value >> 1) & (bins.size() - 1)].add(convex, entry);
}

}  // namespace

double least_overlap(const Convex& a, const Convex& b) {
  const double size = std::min(size_of(a), size_of(b));
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

void add_faces(const Convex& convex, std::uint32_t index, std::vector<FaceEntry>& entries) {
  const std::vector<ConvexPolyhedron::Face>& faces = convex.polyhedron.faces;
  if (convex.is_internal()) {
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      if (!faces[f].id.none()) entries.push_back({faces[f].id, index, f});
    }
    return;
  }
  const PolygonMesh& visual = *convex.visual;
  for (std::size_t cap = first_cap(visual); cap < visual.faces.size(); ++cap) {
    const PlaneId id = visual.faces[cap].id;
    const auto face = std::find_if(faces.begin(), faces.end(),
                                   [&](const ConvexPolyhedron::Face& f) { return f.id == id; });
    if (face == faces.end()) continue;
    const auto f = static_cast<std::uint32_t>(face - faces.begin());
    entries.push_back({id, index, f, false, static_cast<std::uint32_t>(cap)});
  }
}

FaceEntry known_face(const Convex& convex, std::uint32_t index, std::uint32_t face) {
  FaceEntry entry{convex.polyhedron.faces[face].id, index, face, true};
  if (convex.is_internal()) return entry;
  std::size_t cap = convex.visual->faces.size();
  while (cap > 0 && convex.visual->faces[cap - 1].id != entry.id) --cap;
  SUNDER_CHECK(cap > 0);
  entry.cap = static_cast<std::uint32_t>(cap - 1);
  return entry;
}

std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes,
                                std::span<const FaceEntry> faces) {
  constexpr std::size_t kFacesAtOnce = 8192;
  return contacts(convexes, faces.size(), kFacesAtOnce, faces.size(),
                  [&](std::size_t begin, std::size_t end, std::vector<Bin>& bins) {
                    for (const FaceEntry& entry : faces.subspan(begin, end - begin)) {
                      add_to_bins(*convexes[entry.convex], entry, bins);
                    }
                  });
}

std::vector<Bond> find_contacts(std::span<const ConvexPtr> convexes) {
  constexpr std::size_t kConvexesAtOnce = 1024;
  std::size_t faces = 0;
  for (const ConvexPtr& convex : convexes) faces += convex->polyhedron.faces.size();
  return contacts(convexes, convexes.size(), kConvexesAtOnce, faces,
                  [&](std::size_t begin, std::size_t end, std::vector<Bin>& bins) {
                    std::vector<FaceEntry> entries;
                    for (std::size_t c = begin; c < end; ++c) {
                      fetch_ahead(convexes.subspan(c, end - c));
                      entries.clear();
                      add_faces(*convexes[c], static_cast<std::uint32_t>(c), entries);
                      for (const FaceEntry& entry : entries) add_to_bins(*convexes[c], entry, bins);
                    }
                  });
}

}  // namespace sunder::fracture
