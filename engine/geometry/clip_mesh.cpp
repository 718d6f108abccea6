// Every vertex is inside or outside, none is on the plane, and each edge that changes side gets one
// vertex. In each face, the k-th crossing along the cut line where contours leave the inside is
// joined to the k-th where they return. For a valid polygon this is the even-odd rule; with any
// rounding errors each crossing still has one edge in and one edge out, so all contours close, and
// the joining edges, reversed, form the closed contours of the cap.
#include "engine/geometry/clip_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/check.h"

namespace sunder {
namespace {

constexpr std::uint32_t kUnset = std::numeric_limits<std::uint32_t>::max();

class MeshCut {
 public:
  MeshCut(const PolygonMesh& mesh, const Plane& plane, double tolerance, PolygonMesh& result,
          MeshClipScratch& scratch)
      : mesh_(mesh), plane_(plane), tolerance_(tolerance), result_(result), scratch_(scratch) {}

  void make(PlaneId id);

 private:
  using Run = MeshClipScratch::Run;

  enum class Sides { kInside, kOutside, kBoth };

  Sides sides_of(const PolygonMesh::Face& face) const;
  void keep_faces(std::size_t first, std::size_t end);
  void cut_face(const PolygonMesh::Face& face);
  void keep_contour(std::uint32_t contour);
  void find_runs(std::uint32_t contour, std::uint32_t start);
  void join_runs(const Vec3& face_normal);
  void add_joined_contours(const PolygonMesh::Face& face);
  void add_run(const Run& run, const PolygonMesh::Face& face);
  void add_crossing_corner(const PolygonMesh::Face& face, std::uint32_t crossing,
                           std::uint32_t inside, std::uint32_t outside);
  void copy_corner(std::uint32_t corner);
  std::uint32_t crossing(std::uint32_t inside, std::uint32_t outside);
  void add_cap(PlaneId id);
  std::uint32_t end_contour(std::uint32_t first_corner);

  const PolygonMesh& mesh_;
  const Plane& plane_;
  const double tolerance_;
  PolygonMesh& result_;
  MeshClipScratch& scratch_;
};

void MeshCut::make(PlaneId id) {
  result_.vertices.clear();
  result_.faces.clear();
  result_.contours.clear();
  result_.corners.clear();
  result_.corner_normals.clear();
  result_.corner_uvs.clear();
  result_.vertices.reserve(mesh_.vertices.size());
  result_.faces.reserve(mesh_.faces.size());
  result_.contours.reserve(mesh_.contours.size());
  result_.corners.reserve(mesh_.corners.size());
  result_.corner_normals.reserve(mesh_.corners.size());
  scratch_.new_of_old.assign(mesh_.vertices.size(), kUnset);
  scratch_.crossings.restart(mesh_.vertices.size());
  scratch_.cap_next.clear();
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    if (scratch_.outside[v]) continue;
    scratch_.new_of_old[v] = static_cast<std::uint32_t>(result_.vertices.size());
    result_.vertices.push_back(mesh_.vertices[v]);
  }
  std::size_t f = 0;
  while (f < mesh_.faces.size()) {
    const std::size_t first = f;
    Sides sides{};
    while (f < mesh_.faces.size() && (sides = sides_of(mesh_.faces[f])) == Sides::kInside) ++f;
    if (f > first) keep_faces(first, f);
    if (f < mesh_.faces.size() && sides == Sides::kBoth) cut_face(mesh_.faces[f]);
    ++f;
  }
  add_cap(id);
}

MeshCut::Sides MeshCut::sides_of(const PolygonMesh::Face& face) const {
  const PolygonMesh::Contour& last = mesh_.contours[face.first_contour + face.contour_count - 1];
  std::uint8_t any = 0, all = 1;
  for (std::uint32_t c = mesh_.contours[face.first_contour].first_corner,
                     end = last.first_corner + last.corner_count;
       c < end; ++c) {
    const std::uint8_t outside = scratch_.outside[mesh_.corners[c]];
    any |= outside;
    all &= outside;
  }
  return all ? Sides::kOutside : any ? Sides::kBoth : Sides::kInside;
}

/// Copies faces [first, end), all inside, in bulk: they are most of a large mesh.
void MeshCut::keep_faces(std::size_t first, std::size_t end) {
  const PolygonMesh::Face &from = mesh_.faces[first], &to = mesh_.faces[end - 1];
  const std::uint32_t first_contour = from.first_contour;
  const std::uint32_t end_contour = to.first_contour + to.contour_count;
  const std::uint32_t first_corner = mesh_.contours[first_contour].first_corner;
  const PolygonMesh::Contour& last = mesh_.contours[end_contour - 1];
  const std::uint32_t end_corner = last.first_corner + last.corner_count;
  const auto contour_shift = static_cast<std::uint32_t>(result_.contours.size()) - first_contour;
  const auto corner_shift = static_cast<std::uint32_t>(result_.corners.size()) - first_corner;

  const auto append = [](auto& all, const auto& old, std::size_t begin_old, std::size_t end_old) {
    all.insert(all.end(), old.begin() + static_cast<std::ptrdiff_t>(begin_old),
               old.begin() + static_cast<std::ptrdiff_t>(end_old));
    return std::span(all).last(end_old - begin_old);
  };
  for (auto& face : append(result_.faces, mesh_.faces, first, end)) {
    face.first_contour += contour_shift;
  }
  for (auto& contour : append(result_.contours, mesh_.contours, first_contour, end_contour)) {
    contour.first_corner += corner_shift;
  }
  for (auto& corner : append(result_.corners, mesh_.corners, first_corner, end_corner)) {
    corner = scratch_.new_of_old[corner];
  }
  append(result_.corner_normals, mesh_.corner_normals, first_corner, end_corner);
  if (!mesh_.corner_uvs.empty()) {
    append(result_.corner_uvs, mesh_.corner_uvs, first_corner, end_corner);
  }
}

void MeshCut::cut_face(const PolygonMesh::Face& face) {
  PolygonMesh::Face kept = face;
  kept.first_contour = static_cast<std::uint32_t>(result_.contours.size());
  scratch_.runs.clear();
  for (std::uint32_t c = face.first_contour; c < face.first_contour + face.contour_count; ++c) {
    const auto corners = mesh_.contour_corners(c);
    const std::uint8_t side = scratch_.outside[corners[0]];
    std::uint32_t same = 1;
    while (same < corners.size() && scratch_.outside[corners[same]] == side) ++same;
    if (same < corners.size()) {
      find_runs(c, same);
    } else if (!side) {
      keep_contour(c);
    }
  }
  if (!scratch_.runs.empty()) {
    join_runs(face.plane.normal);
    add_joined_contours(face);
  }
  kept.contour_count = static_cast<std::uint32_t>(result_.contours.size()) - kept.first_contour;
  if (kept.contour_count > 0) result_.faces.push_back(kept);
}

void MeshCut::keep_contour(std::uint32_t contour) {
  const auto first = static_cast<std::uint32_t>(result_.corners.size());
  const PolygonMesh::Contour& old = mesh_.contours[contour];
  for (std::uint32_t c = old.first_corner; c < old.first_corner + old.corner_count; ++c) {
    copy_corner(c);
  }
  end_contour(first);
}

void MeshCut::copy_corner(std::uint32_t corner) {
  result_.corners.push_back(scratch_.new_of_old[mesh_.corners[corner]]);
  result_.corner_normals.push_back(mesh_.corner_normals[corner]);
  if (!mesh_.corner_uvs.empty()) result_.corner_uvs.push_back(mesh_.corner_uvs[corner]);
}

std::uint32_t MeshCut::end_contour(std::uint32_t first_corner) {
  const auto count = static_cast<std::uint32_t>(result_.corners.size()) - first_corner;
  result_.contours.push_back({first_corner, count});
  return count;
}

/// Appends the runs of a contour with corners on both sides. `start` is its first corner that is on
/// the other side than corner 0.
void MeshCut::find_runs(std::uint32_t contour, std::uint32_t start) {
  const auto corners = mesh_.contour_corners(contour);
  const auto n = static_cast<std::uint32_t>(corners.size());
  const auto at = [&](std::uint32_t i) { return corners[i % n]; };
  while (scratch_.outside[at(start)]) ++start;
  for (std::uint32_t i = start; i < start + n;) {
    Run run{contour, i % n, 0, crossing(at(i), at(i + n - 1)), kUnset, kUnset};
    while (!scratch_.outside[at(i)]) ++i, ++run.count;
    run.exit = crossing(at(i - 1), at(i));
    scratch_.runs.push_back(run);
    while (i < start + n && scratch_.outside[at(i)]) ++i;
  }
}

/// Sets the run that follows each run of a face along the cut line, and the edges of the cap.
void MeshCut::join_runs(const Vec3& face_normal) {
  auto& runs = scratch_.runs;
  const auto n = static_cast<std::uint32_t>(runs.size());
  if (n == 1) {
    runs[0].next = 0;
  } else {
    // Exits and entries alternate along the cut line.
    const Vec3 line = face_normal.cross(plane_.normal);
    const auto sort_along = [&](std::uint32_t Run::*end) {
      scratch_.along.clear();
      for (std::uint32_t r = 0; r < n; ++r) {
        const std::uint32_t vertex = scratch_.crossings[runs[r].*end].vertex;
        scratch_.along.emplace_back(line.dot(result_.vertices[vertex]), r);
      }
      std::sort(scratch_.along.begin(), scratch_.along.end());
    };
    sort_along(&Run::entry);
    scratch_.entry_order.clear();
    for (const auto& [place, run] : scratch_.along) scratch_.entry_order.push_back(run);
    sort_along(&Run::exit);
    for (std::uint32_t k = 0; k < n; ++k) {
      runs[scratch_.along[k].second].next = scratch_.entry_order[k];
    }
  }
  for (const Run& run : runs) scratch_.cap_next[runs[run.next].entry] = run.exit;
}

void MeshCut::add_joined_contours(const PolygonMesh::Face& face) {
  auto& runs = scratch_.runs;
  for (Run& start : runs) {
    const auto first = static_cast<std::uint32_t>(result_.corners.size());
    for (Run* run = &start; run->count > 0; run = &runs[run->next]) {
      add_run(*run, face);
      run->count = 0;  // marks the run as used
    }
    if (result_.corners.size() > first) end_contour(first);
  }
}

void MeshCut::add_run(const Run& run, const PolygonMesh::Face& face) {
  const PolygonMesh::Contour& contour = mesh_.contours[run.contour];
  const auto corner = [&](std::uint32_t i) {
    return contour.first_corner + (run.first + i) % contour.corner_count;
  };
  add_crossing_corner(face, run.entry, corner(0), corner(contour.corner_count - 1));
  for (std::uint32_t i = 0; i < run.count; ++i) copy_corner(corner(i));
  add_crossing_corner(face, run.exit, corner(run.count - 1), corner(run.count));
}

void MeshCut::add_crossing_corner(const PolygonMesh::Face& face, std::uint32_t crossing,
                                  std::uint32_t inside, std::uint32_t outside) {
  const EdgeCrossing& cut = scratch_.crossings[crossing];
  const std::uint32_t a = cut.inside_first ? inside : outside;
  const std::uint32_t b = cut.inside_first ? outside : inside;
  result_.corners.push_back(cut.vertex);
  result_.corner_normals.push_back(interpolate_normal(
      mesh_.corner_normals[a], mesh_.corner_normals[b], cut.t, face.plane.normal));
  if (mesh_.corner_uvs.empty()) return;
  const Vec2f start = mesh_.corner_uvs[a], end = mesh_.corner_uvs[b];
  result_.corner_uvs.push_back(start + static_cast<float>(cut.t) * (end - start));
}

std::uint32_t MeshCut::crossing(std::uint32_t inside, std::uint32_t outside) {
  const std::uint32_t known = scratch_.crossings.find(inside, outside);
  if (known != EdgeCrossings::kNone) return known;
  const bool inside_first = lexicographically_less(mesh_.vertices[inside], mesh_.vertices[outside]);
  const std::uint32_t a = inside_first ? inside : outside, b = inside_first ? outside : inside;
  const double distance_a = scratch_.distances[a], distance_b = scratch_.distances[b];
  // An end within tolerance of the plane is the point of intersection.
  const double t = std::abs(distance_a) <= tolerance_   ? 0
                   : std::abs(distance_b) <= tolerance_ ? 1
                                                        : distance_a / (distance_a - distance_b);
  const Vec3 start = mesh_.vertices[a], end = mesh_.vertices[b];
  const auto vertex = static_cast<std::uint32_t>(result_.vertices.size());
  result_.vertices.push_back(t == 1 ? end : Vec3(start + t * (end - start)));
  scratch_.cap_next.push_back(kUnset);
  return scratch_.crossings.add(inside, outside, vertex, t, inside_first);
}

void MeshCut::add_cap(PlaneId id) {
  PolygonMesh::Face cap{plane_, id, static_cast<std::uint32_t>(result_.contours.size()), 0,
                        FaceKind::kInterior};
  const Vec3f normal = plane_.normal.cast<float>();
  for (std::uint32_t start = 0; start < scratch_.crossings.size(); ++start) {
    const auto first = static_cast<std::uint32_t>(result_.corners.size());
    for (std::uint32_t c = start, next; (next = scratch_.cap_next[c]) != kUnset; c = next) {
      result_.corners.push_back(scratch_.crossings[c].vertex);
      scratch_.cap_next[c] = kUnset;
    }
    if (result_.corners.size() - first > 2) {
      end_contour(first);
    } else {
      result_.corners.resize(first);  // two edges: the two cut faces share that edge
    }
  }
  cap.contour_count = static_cast<std::uint32_t>(result_.contours.size()) - cap.first_contour;
  result_.corner_normals.resize(result_.corners.size(), normal);
  if (!mesh_.corner_uvs.empty()) {
    for (std::size_t c = result_.corner_uvs.size(); c < result_.corners.size(); ++c) {
      result_.corner_uvs.push_back(planar_uv(result_.vertices[result_.corners[c]], plane_.normal));
    }
  }
  if (cap.contour_count > 0) result_.faces.push_back(cap);
}

}  // namespace

PlaneSide clip(const PolygonMesh& mesh, const Plane& plane, PlaneId id, double tolerance_m,
               PolygonMesh& result, MeshClipScratch& scratch) {
  SUNDER_CHECK(&mesh != &result);
  const double limit = id.value & 1 ? -tolerance_m : tolerance_m;
  const auto is_outside = [&](double distance) {
    return id.value & 1 ? distance >= limit : distance > limit;
  };
  scratch.distances.resize(mesh.vertices.size());
  scratch.outside.resize(mesh.vertices.size());
  std::size_t outside = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double distance = plane.distance(mesh.vertices[v]);
    scratch.distances[v] = distance;
    scratch.outside[v] = is_outside(distance);
    outside += scratch.outside[v];
  }
  if (outside == 0) return PlaneSide::kInside;
  if (outside == mesh.vertices.size()) return PlaneSide::kOutside;
  MeshCut(mesh, plane, tolerance_m, result, scratch).make(id);
  return PlaneSide::kCut;
}

}  // namespace sunder
