// Two passes, each through memory in order: faces are projected in the order of their convexes,
// into bins by plane id; then each bin, small enough for the cache, is sorted and swept.
#include "fracture/adjacency/adjacency.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "engine/base/check.h"
#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/geometry/polygon_mesh.h"
#include "fracture/adjacency/bucket_sort.h"
#include "fracture/adjacency/plane_sweep.h"

namespace sunder::fracture {
namespace {

/// Projected faces of some of the planes.
struct Bin {
  std::vector<ProjectedFace> faces;
  std::vector<Vec2> points;

  void add(const Convex& convex, const FaceEntry& entry) {
    const Vec3& normal = convex.polyhedron.faces[entry.face].plane.normal;
    int dropped = 0;
    const double longest = normal.cwiseAbs().maxCoeff(&dropped);
    ProjectedFace flat;
    flat.id = entry.id;
    flat.scale = 1 / longest;
    flat.size = size_of(convex);
    flat.convex = entry.convex;
    flat.face = entry.face;
    flat.first_point = static_cast<std::uint32_t>(points.size());
    flat.cap = entry.cap;
    project_face(convex, entry.face, entry.cap, dropped, points);
    flat.point_count = static_cast<std::uint32_t>(points.size()) - flat.first_point;
    flat.dropped = static_cast<std::uint8_t>(dropped);
    flat.known = entry.known;
    faces.push_back(flat);
  }
};

/// Returns all contacts; `add(begin, end, bins)` projects the faces of items [begin, end).
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
  const auto sweep = [&](std::size_t b, std::size_t, std::vector<Bond>& found) {
    std::vector<ProjectedFace> in_bin;
    std::size_t count = 0;
    for (const std::vector<Bin>& chunk : flat) count += chunk[b].faces.size();
    in_bin.reserve(count);
    for (const std::vector<Bin>& chunk : flat) {
      for (ProjectedFace face : chunk[b].faces) {
        face.points = chunk[b].points.data() + face.first_point;
        in_bin.push_back(face);
      }
    }
    sweep_planes(convexes, in_bin, found);
  };
  auto bonds = collect_chunks<Bond>(bins, 1, sweep);
  sort_bonds(bonds);
  return bonds;
}

/// Prefetches the convexes after the first: they are scattered, and cache misses are most of the
/// cost.
void prefetch_convexes(std::span<const ConvexPtr> convexes) {
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

FaceEntry face_in_contact(const Convex& convex, std::uint32_t index, std::uint32_t face) {
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
                      prefetch_convexes(convexes.subspan(c, end - c));
                      entries.clear();
                      add_faces(*convexes[c], static_cast<std::uint32_t>(c), entries);
                      for (const FaceEntry& entry : entries) add_to_bins(*convexes[c], entry, bins);
                    }
                  });
}

}  // namespace sunder::fracture
