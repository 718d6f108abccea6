// Clipping (Sutherland and Hodgman 1974) of the incident face against the reference face's sides.
#include "solver/rigid/collide/patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// Returns the face of `hull` whose normal is most opposed to `direction` (in the hull's frame).
std::uint32_t incident_face(const Hull& hull, const Vec3f& direction) {
  const auto along = [&](const Hull::PlaneChunk& planes) {
    const Wide3& n = planes.normal;
    return n.x * direction.x() + (n.y * direction.y() + n.z * direction.z());
  };
  Wide least = splat(1e30f);
  for (const Hull::PlaneChunk& planes : hull.planes()) least = min(least, along(planes));
  const Wide best = splat(min_lane(least));
  for (std::uint32_t c = 0; c < hull.planes().size(); ++c)
    if (const std::uint32_t set = bits(along(hull.planes()[c]) == best))
      return c * kLanes + static_cast<std::uint32_t>(__builtin_ctz(set));
  return 0;  // if `direction` is not finite
}

/// Keeps the part of the polygon with side·(x − origin) <= 0.
void clip_side(const Vec3f& origin, const Vec3f& side, std::uint32_t side_index,
               PatchScratch& scratch) {
  auto& in = scratch.polygon;
  auto& out = scratch.clipped;
  auto& ahead = scratch.ahead;
  ahead.resize(in.size());
  float most = 0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    ahead[i] = side.dot(in[i].position - origin);
    most = std::max(most, ahead[i]);
  }
  if (most <= 0) return;
  out.clear();
  for (std::size_t i = 0; i < in.size(); ++i) {
    const auto& from = in[i];
    const std::size_t next = i + 1 < in.size() ? i + 1 : 0;
    const auto& to = in[next];
    const float d0 = ahead[i], d1 = ahead[next];
    if (d0 <= 0) out.push_back(from);
    if ((d0 < 0 && d1 > 0) || (d0 > 0 && d1 < 0)) {
      const Vec3f cut = from.position + (d0 / (d0 - d1)) * (to.position - from.position);
      out.push_back({cut, (side_index + 1) << 20 | ((from.feature ^ to.feature << 10) & 0xfffff)});
    }
  }
  in.swap(out);
}

void face_patch(const Hull& a, const Hull& b, const RelativePose& pose, const SeparatingAxis& axis,
                float reach_m, const HullScratch& hulls, PatchScratch& scratch,
                std::vector<PatchPoint>& points) {
  const bool on_a = axis.kind == SeparatingAxis::Kind::kFaceA;
  const Hull &reference = on_a ? a : b, &incident = on_a ? b : a;
  const std::uint32_t face = on_a ? axis.index_a : axis.index_b;
  const Vec3f normal = on_a ? axis.normal_A : Vec3f(-axis.normal_A);  // away from the reference
  const Vec3f plane = on_a ? a.normal(face) : Vec3f(pose.R * b.normal(face));
  const float slope = 1 / plane.dot(normal);  // 1 unless an edge gave the axis
  const std::uint32_t other =
      incident_face(incident, on_a ? Vec3f(pose.R.transpose() * normal) : normal);
  auto position = [&](bool of_a, std::uint32_t v) {
    return of_a ? a.vertex(v) : hulls.vertex_b(v);
  };
  scratch.polygon.clear();
  for (const std::uint16_t v : incident.face_corners(other))
    scratch.polygon.push_back({position(!on_a, v), v});
  scratch.reference.clear();
  for (const std::uint16_t v : reference.face_corners(face))
    scratch.reference.push_back(position(on_a, v));

  const std::size_t sides = scratch.reference.size();
  for (std::size_t i = 0; i < sides && !scratch.polygon.empty(); ++i) {
    const Vec3f& from = scratch.reference[i];
    const Vec3f& to = scratch.reference[i + 1 < sides ? i + 1 : 0];
    clip_side(from, (to - from).cross(normal), static_cast<std::uint32_t>(i), scratch);
  }
  const std::uint32_t owner = on_a ? 0 : 1u << 31;
  for (const auto& corner : scratch.polygon) {
    const float separation = slope * plane.dot(corner.position - scratch.reference[0]);
    if (separation > reach_m) continue;
    const Vec3f opposite = corner.position - separation * normal;
    points.push_back({on_a ? opposite : corner.position, on_a ? corner.position : opposite,
                      separation, corner.feature | owner});
  }
}

/// Returns the closest points of the lines of two edges.
PatchPoint edge_point(const Hull& a, const Hull& b, const SeparatingAxis& axis,
                      const HullScratch& hulls) {
  const auto [a0, a1] = a.edge_vertices(axis.index_a);
  const auto [b0, b1] = b.edge_vertices(axis.index_b);
  const Vec3f pa = a.vertex(a0), da = a.vertex(a1) - pa;
  const Vec3f pb = hulls.vertex_b(b0), db = hulls.vertex_b(b1) - pb;
  const Vec3f gap = pb - pa;
  const float aa = da.squaredNorm(), bb = db.squaredNorm(), ab = da.dot(db);
  const float det = aa * bb - ab * ab;
  const float s = det > 0 ? (gap.dot(da) * bb - gap.dot(db) * ab) / det : 0.5f;
  const Vec3f on_a = pa + std::clamp(s, 0.f, 1.f) * da;
  // degenerate hulls have edges of no length
  const float t = bb > 0 ? (on_a - pb).dot(db) / bb : 0.f;
  const Vec3f on_b = pb + std::clamp(t, 0.f, 1.f) * db;
  return {on_a, on_b, axis.separation_m, 1u << 30 | axis.index_a << 15 | axis.index_b};
}

/// Returns the vertex deepest behind the reference face; for overlaps whose clipped patch is empty.
PatchPoint deepest_point(const Hull& a, const Hull& b, const SeparatingAxis& axis,
                         const HullScratch& hulls) {
  const bool on_a = axis.kind == SeparatingAxis::Kind::kFaceA;
  const std::uint32_t count = on_a ? b.vertex_count() : a.vertex_count();
  const Vec3f down = on_a ? axis.normal_A : Vec3f(-axis.normal_A);
  std::uint32_t best = 0;
  float least = 1e30f;
  for (std::uint32_t v = 0; v < count; ++v) {
    const float along = down.dot(on_a ? hulls.vertex_b(v) : a.vertex(v));
    if (along < least) least = along, best = v;
  }
  const Vec3f tip = on_a ? hulls.vertex_b(best) : a.vertex(best);
  const Vec3f opposite = tip - axis.separation_m * down;
  return {on_a ? opposite : tip, on_a ? tip : opposite, axis.separation_m, 3u << 29 | best};
}

void drop_high(float layer_m, std::vector<PatchPoint>& points) {
  std::array<float, 4> low;  // the four least separations, ascending
  low.fill(1e30f);
  for (const PatchPoint& p : points) {
    if (p.separation_m >= low[3]) continue;
    low[3] = p.separation_m;
    for (std::size_t i = 3; i > 0 && low[i] < low[i - 1]; --i) std::swap(low[i], low[i - 1]);
  }
  float limit = std::max(low[0] + layer_m, low[3]);
  if (low[0] < -2 * layer_m) limit = std::max(limit, 0.f);
  std::erase_if(points, [&](const PatchPoint& p) { return p.separation_m > limit; });
}

}  // namespace

void make_patch(const Hull& a, const Hull& b, const RelativePose& pose, const SeparatingAxis& axis,
                float reach_m, const HullScratch& hulls, PatchScratch& scratch,
                std::vector<PatchPoint>& points) {
  if (axis.kind == SeparatingAxis::Kind::kEdges) {
    points.push_back(edge_point(a, b, axis, hulls));
    return;
  }
  face_patch(a, b, pose, axis, reach_m, hulls, scratch, points);
  if (points.empty() && axis.separation_m < 0) points.push_back(deepest_point(a, b, axis, hulls));
}

void add_faces_at_edges(const Hull& a, const Hull& b, const RelativePose& pose,
                        const SeparatingAxis& edges, float reach_m, const HullScratch& hulls,
                        PatchScratch& scratch, std::vector<PatchPoint>& points) {
  SeparatingAxis faces = edges;
  const Vec3f normal_B = pose.R.transpose() * edges.normal_A;
  faces.index_a = incident_face(a, -edges.normal_A), faces.index_b = incident_face(b, normal_B);
  const float cosine_a = a.normal(faces.index_a).dot(edges.normal_A),
              cosine_b = -b.normal(faces.index_b).dot(normal_B);
  if (std::max(cosine_a, cosine_b) < kSwingCosine) return;
  faces.kind = cosine_a >= cosine_b ? SeparatingAxis::Kind::kFaceA : SeparatingAxis::Kind::kFaceB;
  face_patch(a, b, pose, faces, reach_m, hulls, scratch, points);
}

void reduce_patch(const Vec3f& normal_A, float layer_m, std::vector<PatchPoint>& points) {
  if (points.size() <= 4) return;
  drop_high(layer_m, points);
  if (points.size() <= 4) return;
  auto best_by = [&](auto score) {
    std::size_t best = 0;
    float most = -1e30f;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (const float s = score(points[i]); s > most) most = s, best = i;
    return best;
  };
  std::array<std::size_t, 4> keep{};
  keep[0] = best_by([](const PatchPoint& p) { return -p.separation_m; });
  const Vec3f p0 = points[keep[0]].on_a;
  keep[1] = best_by([&](const PatchPoint& p) { return (p.on_a - p0).squaredNorm(); });
  const Vec3f p1 = points[keep[1]].on_a;
  auto area = [&](const Vec3f& x, const Vec3f& y, const Vec3f& z) {
    return normal_A.dot((y - x).cross(z - x));
  };
  keep[2] = best_by([&](const PatchPoint& p) { return std::abs(area(p0, p1, p.on_a)); });
  const Vec3f p2 = points[keep[2]].on_a;
  // The fourth point adds the most area outside the triangle: against the winding of one of its
  // sides.
  const float winding = area(p0, p1, p2) < 0 ? -1.f : 1.f;
  auto outside = [&](const PatchPoint& p) {
    return -std::min({winding * area(p0, p1, p.on_a), winding * area(p1, p2, p.on_a),
                      winding * area(p2, p0, p.on_a)});
  };
  keep[3] = best_by(outside);
  std::sort(keep.begin(), keep.end());
  const auto last = std::unique(keep.begin(), keep.end());
  std::size_t count = 0;
  for (auto it = keep.begin(); it != last; ++it) points[count++] = points[*it];
  points.resize(count);
}

}  // namespace sunder::solver
