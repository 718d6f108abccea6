#include "tests/fracture/truths.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>

#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/islands.h"
#include "fracture/adjacency/plane_sweep.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

/// Returns the overlap of two faces by clipping one in space by the edge planes of the other.
double face_overlap(const ConvexPolyhedron& a, std::size_t f, const ConvexPolyhedron& b,
                    std::size_t g) {
  std::vector<Vec3> polygon;
  for (const std::uint32_t corner : a.face_corners(f)) polygon.push_back(a.vertices[corner]);
  const auto corners = b.face_corners(g);
  const Vec3 normal = b.faces[g].plane.normal;
  for (std::size_t e = 0; e < corners.size(); ++e) {
    const Vec3& from = b.vertices[corners[e]];
    const Vec3 out = (b.vertices[corners[(e + 1) % corners.size()]] - from).cross(normal);
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double dp = out.dot(p - from), dq = out.dot(q - from);
      if (dp <= 0) kept.push_back(p);
      if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
    }
    polygon = std::move(kept);
    if (polygon.size() < 3) return 0;
  }
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * twice.norm();
}

std::string find_piece_violation(const BreakPlan& plan) {
  for (const Compound& piece : plan.pieces) {
    if (piece.convexes.empty()) return "an empty piece";
    if (piece.anchored.size() != piece.convexes.size()) return "anchors do not match convexes";
    for (const ConvexPtr& convex : piece.convexes) {
      if (!is_closed(convex->polyhedron)) return "a convex that is not closed";
      if (!(convex->solid.volume_m3 > 0)) return "a convex without volume";
    }
    for (const Ghost& ghost : piece.ghosts) {
      if (!is_closed(ghost.convex->polyhedron)) return "a ghost that is not closed";
      if (ghost.of.empty() || ghost.of.back() >= piece.convexes.size()) return "a ghost of nothing";
      if (!std::is_sorted(ghost.of.begin(), ghost.of.end())) return "a ghost out of order";
    }
    if (!std::ranges::is_sorted(piece.ghosts, {}, &Ghost::of)) return "ghosts out of order";
    if (!(volume(piece) > 0)) return "a piece without volume";
    const auto islands = find_islands(piece);
    if (*std::max_element(islands.begin(), islands.end()) > 0) return "a piece in two parts";
    std::vector<std::vector<double>> covered(piece.convexes.size());
    for (std::size_t c = 0; c < covered.size(); ++c) {
      covered[c].resize(piece.convexes[c]->polyhedron.faces.size());
    }
    for (const Bond& bond : piece.bonds) {
      covered[bond.a][bond.face_a] += bond.area_m2;
      covered[bond.b][bond.face_b] += bond.area_m2;
    }
    for (std::size_t c = 0; c < covered.size(); ++c) {
      for (std::size_t f = 0; f < covered[c].size(); ++f) {
        const double area = face_area(piece.convexes[c]->polyhedron, f);
        const double size = piece.convexes[c]->box.extent().maxCoeff();
        if (piece.ghosts.empty() && covered[c][f] > area * (1 + 1e-9) + 1e-12 * size * size) {
          return "a face covered more than once";
        }
      }
    }
  }
  return {};
}

MassProperties whole(const Compound& compound) {
  MassProperties sum;
  for (const ConvexPtr& convex : compound.convexes) sum = sum + convex->solid;
  for (const Ghost& ghost : compound.ghosts) {
    MassProperties overlap = ghost.convex->solid;
    overlap.volume_m3 *= ghost.sign;
    overlap.second_moment *= ghost.sign;
    if (ghost.sign != 0) sum = sum + overlap;
  }
  return sum;
}

/// Returns the volume that rounding of coordinates may change; it matters only if a solid is tiny
/// or thin compared to its distance from the origin.
double rounding(const Compound& compound) {
  const Box box = bounds(compound);
  const Vec3 e = box.extent();
  const double far = std::max(box.max.cwiseAbs().maxCoeff(), box.min.cwiseAbs().maxCoeff());
  return 1e-16 * far * 2 * (e.x() * e.y() + e.y() * e.z() + e.z() * e.x());
}

}  // namespace

std::string find_violation(const Compound& parent, const BreakPlan& plan) {
  std::ostringstream problem;
  const double before = volume(parent), after = total_volume(plan);
  if (std::abs(after - before) > 1e-12 * before + rounding(parent)) {
    problem << "volume off by " << (after - before) / before << " of it";
    return problem.str();
  }
  if (std::string solid = find_piece_violation(plan); !solid.empty()) return solid;
  if (plan.debris_volume_m3 == 0) {
    const MassProperties old_mass = whole(parent);
    MassProperties new_mass;
    for (const Compound& piece : plan.pieces) new_mass = new_mass + whole(piece);
    const double size = bounds(parent).extent().norm();
    const double offset = bounds(parent).center().norm();
    const double allowed = 1e-12 * (size + offset);
    if ((old_mass.centroid - new_mass.centroid).norm() > allowed) return "the centre moved";
    const double inertia = (old_mass.second_moment - new_mass.second_moment).norm();
    if (inertia > 1e-12 * before * (size + offset) * (size + offset)) return "inertia changed";
  }
  return {};
}

std::vector<Bond> contacts_by_distance(const Compound& compound, double tolerance) {
  struct Entry {
    double distance;
    std::uint32_t convex, face;
  };
  std::vector<Entry> entries;
  for (std::uint32_t c = 0; c < compound.convexes.size(); ++c) {
    const auto& faces = compound.convexes[c]->polyhedron.faces;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      entries.push_back({std::abs(faces[f].plane.d), c, f});
    }
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.distance < b.distance; });
  std::vector<Bond> bonds;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = i + 1; j < entries.size(); ++j) {
      if (entries[j].distance - entries[i].distance > tolerance) break;
      const Entry& a = entries[i].convex < entries[j].convex ? entries[i] : entries[j];
      const Entry& b = entries[i].convex < entries[j].convex ? entries[j] : entries[i];
      if (a.convex == b.convex) continue;
      const ConvexPolyhedron& p = compound.convexes[a.convex]->polyhedron;
      const ConvexPolyhedron& q = compound.convexes[b.convex]->polyhedron;
      const Plane &m = p.faces[a.face].plane, &n = q.faces[b.face].plane;
      if ((m.normal + n.normal).norm() > 1e-7 || std::abs(m.d + n.d) > tolerance) continue;
      const double area = face_overlap(p, a.face, q, b.face);
      const double size =
          std::min(size_of(*compound.convexes[a.convex]), size_of(*compound.convexes[b.convex]));
      if (area > kMinContactArea * size * size)
        bonds.push_back({a.convex, b.convex, a.face, b.face, area});
    }
  }
  sort_bonds(bonds);
  return bonds;
}

}  // namespace sunder::fracture
