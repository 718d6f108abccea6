#include "tests/fracture/visual_truths.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/base/random.h"
#include "engine/geometry/approximate_hull.h"
#include "fracture/adjacency/compound_builder.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture {
namespace {

int passes(double from_u, double from_v, double to_u, double to_v) {
  if ((from_v <= 0) == (to_v <= 0)) return 0;
  const double side = from_u * to_v - to_u * from_v;
  return from_v <= 0 ? (side > 0 ? 1 : 0) : (side < 0 ? -1 : 0);
}

/// Returns the number of exits of a ray along x from the mesh, minus the number of its entries.
int winding_of(const PolygonMesh& mesh, const Vec3& point) {
  int sum = 0;
  for (std::size_t k = 0; k < mesh.contours.size(); ++k) {
    const auto corners = mesh.contour_corners(k);
    const Vec3 a = mesh.vertices[corners[0]] - point;
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 b = mesh.vertices[corners[i - 1]] - point, c = mesh.vertices[corners[i]] - point;
      const int turns = passes(a.y(), a.z(), b.y(), b.z()) + passes(b.y(), b.z(), c.y(), c.z()) +
                        passes(c.y(), c.z(), a.y(), a.z());
      if (turns != 0 && turns * a.dot(b.cross(c)) > 0) sum += turns;
    }
  }
  return sum;
}

std::string find_mesh_violation(const Convex& convex) {
  const PolygonMesh& mesh = *convex.visual;
  if (open_edges(mesh) > 0) return "a mesh that is not watertight";
  std::size_t rings = 0;
  for (const PolygonMesh::Face& face : mesh.faces) rings += face.contour_count - 1;
  const auto euler = static_cast<std::ptrdiff_t>(mesh.vertices.size() + mesh.faces.size()) -
                     static_cast<std::ptrdiff_t>(mesh.corners.size() / 2 + rings);
  if (euler % 2 != 0) return "a mesh of odd Euler number";
  const Box box = bounds(mesh);
  const double reach = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  const double near = 1e-12 * box.extent().maxCoeff() + 1e-14 * reach;
  for (const ConvexPolyhedron::Face& face : convex.polyhedron.faces) {
    for (const Vec3& vertex : mesh.vertices) {
      if (face.plane.distance(vertex) > near) return "a mesh that sticks out of its convex";
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const bool is_cap = !mesh.faces[f].id.none();
    if (is_cap != (f >= first_cap(mesh))) return "a cap among the other faces";
    if (is_cap != (mesh.faces[f].kind == FaceKind::kInterior)) return "a cap that looks old";
    const auto& faces = convex.polyhedron.faces;
    const bool is_shared = std::any_of(
        faces.begin(), faces.end(), [&](const auto& face) { return face.id == mesh.faces[f].id; });
    // A cap as thin as rounding touches no other convex.
    if (is_cap && !is_shared && face_area(mesh, f) > 1e-9 * box.extent().squaredNorm()) {
      return "a cap in no face of its convex";
    }
  }
  return {};
}

std::string find_coverage_violation(const Compound& parent, const BreakPlan& plan) {
  Random random(17);
  const Box box = bounds(parent);
  for (int i = 0; i < 40; ++i) {
    const Vec3 place(random.uniform(), random.uniform(), random.uniform());
    const Vec3 point = box.min + place.cwiseProduct(box.extent());
    const int before = winding(std::span(&parent, 1), point), after = winding(plan.pieces, point);
    if (before != after) {
      return "a point covered " + std::to_string(after) + " times, not " + std::to_string(before);
    }
  }
  return {};
}

}  // namespace

int winding(std::span<const Compound> compounds, const Vec3& point) {
  int sum = 0;
  for (const Compound& compound : compounds) {
    for (const ConvexPtr& convex : compound.convexes) {
      const Box& box = convex->box;
      if ((point.array() < box.min.array()).any() || (point.array() > box.max.array()).any()) {
        continue;
      }
      sum += convex->is_internal() ? contains(convex->polyhedron, point)
                                   : winding_of(*convex->visual, point);
    }
  }
  return sum;
}

std::string find_visual_violation(const Compound& parent, const BreakPlan& plan) {
  if (std::string violation = find_violation(parent, plan); !violation.empty()) return violation;
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) {
      if (convex->is_internal()) continue;
      if (std::string violation = find_mesh_violation(*convex); !violation.empty())
        return violation;
    }
  }
  // Large debris has no geometry in the pieces, so coverage cannot be compared.
  return plan.debris_volume_m3 > 1e-6 * volume(parent) ? "" : find_coverage_violation(parent, plan);
}

Compound solid_of(PolygonMesh mesh, std::uint8_t anchored) {
  ConvexPolyhedron hull = fitted_hull(mesh.vertices, {});
  auto visual = std::make_shared<const PolygonMesh>(std::move(mesh));
  return make_compound({{std::move(hull), MaterialIndex(0u), anchored, std::move(visual)}});
}

}  // namespace sunder::fracture
