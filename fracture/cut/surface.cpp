#include "fracture/cut/surface.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/mesh_islands.h"
#include "fracture/cut/cutter.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Returns the internal convex for a part that lies inside the mesh: no old surface shows.
ConvexPtr internal_convex(const Convex& part) {
  ConvexPolyhedron polyhedron = part.polyhedron;
  for (ConvexPolyhedron::Face& face : polyhedron.faces) {
    face.kind = FaceKind::kInterior;
    std::fill_n(polyhedron.corner_normals.begin() + face.first_corner, face.corner_count,
                Vec3f(face.plane.normal.cast<float>()));
  }
  return make_convex(std::move(polyhedron), part.material, nullptr, part.X_RT);
}

/// Returns the volume that a mesh may lose or gain by a cut because corners of faces are off their
/// planes: caps that were joined of faces flush with a neighbour are flat within a tolerance only.
double unevenness_m3(const PolygonMesh& mesh) {
  double sum_m3 = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const PolygonMesh::Face& face = mesh.faces[f];
    double farthest_m = 0;
    for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
      for (const std::uint32_t v : mesh.contour_corners(k)) {
        farthest_m = std::max(farthest_m, std::abs(face.plane.distance(mesh.vertices[v])));
      }
    }
    sum_m3 += farthest_m * face_area(mesh, f);
  }
  return sum_m3;
}

class SurfaceCutter {
 public:
  SurfaceCutter(const AlignedPattern& pattern, const ConvexPtr& parent, const Fit& fit)
      : parent_(parent),
        fit_(fit),
        hull_(make_convex(parent->polyhedron, parent->material, nullptr, parent->X_RT)),
        cutter_(pattern, hull_),
        whole_m3_(parent->solid.volume_m3),
        floor_m3_(cutter_.min_part_m3(whole_m3_)) {}

  Intersection run() {
    if (!cutter_.cut(0)) return whole(true);
    cut_visual([](const Draft&) { return true; });
    merge_slivers();
    if (cutter_.drafts().size() < 2) return whole(false);
    return finish();
  }

 private:
  /// The convexes that one draft becomes.
  struct Parts {
    std::vector<ConvexPtr> convexes;
    double debris_m3 = 0;
  };

  Intersection whole(bool failed) const {
    Intersection result;
    result.parts.push_back({cutter_.largest_cell(), parent_});
    result.failed = failed;
    return result;
  }

  /// Cuts the visual mesh to the regions of those drafts for which `is_due` is true.
  template <class IsDue>
  void cut_visual(const IsDue& is_due) {
    std::vector<Draft*> due;
    std::vector<std::vector<NamedPlane>> planes;
    for (Draft& draft : cutter_.drafts()) {
      if (!is_due(draft)) continue;
      due.push_back(&draft);
      planes.push_back(cutter_.cutting_planes(draft.region));
    }
    std::vector<MeshRegion> regions;
    for (std::size_t i = 0; i < due.size(); ++i) {
      regions.push_back({due[i]->convex->box, planes[i]});
    }
    std::vector<PolygonMesh> parts = split(*parent_->visual, regions, cutter_.tolerance_m());
    for_chunks(due.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      due[i]->visual = std::move(parts[i]);
      due[i]->visual_solid = mass_properties(due[i]->visual);
      due[i]->volume_m3 = due[i]->visual_solid.volume_m3;
      due[i]->has_grown = false;
    });
  }

  /// Merges drafts with little volume into their neighbours, as in Cutter.
  void merge_slivers() {
    std::erase_if(cutter_.drafts(), [](const Draft& draft) { return draft.visual.empty(); });
    cutter_.merge_slivers(floor_m3_);
    const auto has_grown = [](const Draft& draft) { return draft.has_grown; };
    if (std::any_of(cutter_.drafts().begin(), cutter_.drafts().end(), has_grown)) {
      cut_visual(has_grown);
    }
  }

  Intersection finish() {
    std::vector<Draft>& drafts = cutter_.drafts();
    std::vector<Parts> parts(drafts.size());
    for_chunks(drafts.size(), 1,
               [&](std::size_t i, std::size_t, std::size_t) { parts[i] = parts_of(drafts[i]); });
    Intersection result;
    result.debris_volume_m3 = cutter_.debris_m3();
    double sum = result.debris_volume_m3;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
      for (ConvexPtr& convex : parts[i].convexes) {
        // Parts of a mesh that intersects itself may be inside out.
        if (!(convex->solid.volume_m3 > 0)) return whole(true);
        sum += convex->solid.volume_m3;
        result.parts.push_back({drafts[i].cell, std::move(convex)});
      }
      sum += parts[i].debris_m3;
      result.debris_volume_m3 += parts[i].debris_m3;
    }
    return adds_up(sum) && !result.parts.empty() ? result : whole(true);
  }

  bool adds_up(double sum_m3) const {
    const double error_m3 = std::abs(sum_m3 - whole_m3_);
    const double allowed_m3 = cutter_.allowed_error_m3(whole_m3_);
    return error_m3 <= allowed_m3 || error_m3 <= allowed_m3 + unevenness_m3(*parent_->visual);
  }

  Parts parts_of(Draft& draft) const {
    Parts parts;
    if (is_inside(draft)) {
      parts.convexes.push_back(internal_convex(*draft.convex));
      return parts;
    }
    std::vector<PolygonMesh> meshes = islands(std::move(draft.visual));
    for (PolygonMesh& mesh : meshes) {
      const bool alone = meshes.size() == 1;
      const MassProperties solid = alone ? draft.visual_solid : mass_properties(mesh);
      if (solid.volume_m3 < floor_m3_) {
        // An island that is inside out is no debris: without it the volumes do not add up.
        parts.debris_m3 += std::max(0.0, solid.volume_m3);
        continue;
      }
      parts.convexes.push_back(surface_convex(draft, std::move(mesh), solid));
    }
    return parts;
  }

  /// Returns the convex of an island; make_convex() would compute the mass properties again.
  ConvexPtr surface_convex(const Draft& draft, PolygonMesh mesh,
                           const MassProperties& solid) const {
    auto convex = std::make_shared<Convex>();
    convex->polyhedron = fit_to_points(draft.convex->polyhedron, mesh.vertices, fit_);
    convex->visual = std::make_shared<PolygonMesh>(std::move(mesh));
    convex->material = parent_->material;
    convex->solid = solid;
    convex->X_RT = parent_->X_RT;
    convex->box = bounds(convex->polyhedron);
    return convex;
  }

  /// Returns true if the draft is completely solid: its part of the mesh has no old surface.
  bool is_inside(const Draft& draft) const {
    for (const PolygonMesh::Face& face : draft.visual.faces) {
      if (face.kind == FaceKind::kSurface) return false;
    }
    const double missing = draft.convex->solid.volume_m3 - draft.volume_m3;
    return std::abs(missing) <= 0.1 * cutter_.allowed_error_m3(whole_m3_);
  }

  const ConvexPtr& parent_;
  const Fit& fit_;
  const ConvexPtr hull_;  ///< The parent's polyhedron as an internal convex.
  Cutter cutter_;
  const double whole_m3_;
  const double floor_m3_;
};

}  // namespace

Intersection intersect_surface(const AlignedPattern& pattern, const ConvexPtr& convex,
                               const Fit& fit) {
  return SurfaceCutter(pattern, convex, fit).run();
}

ConvexPolyhedron fit_to_points(const ConvexPolyhedron& region, std::span<const Vec3> points,
                               const Fit& fit) {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  const double size = box.extent().maxCoeff();
  const double reach = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  const double tolerance = 1e-13 * size + 4e-15 * reach;
  ConvexPolyhedron kept = region, next;
  ClipScratch scratch;
  for (const Plane& plane : touching_planes(points, fit_directions(points, fit))) {
    double most = 0;
    for (const Vec3& vertex : kept.vertices) most = std::max(most, plane.distance(vertex));
    if (most <= kMinFitCutDepth * size) continue;
    if (clip(kept, plane, {}, tolerance, next, scratch) == PlaneSide::kCut) std::swap(kept, next);
  }
  return ConvexPolyhedron(kept);  // a copy, without the memory that clip() reserves
}

}  // namespace sunder::fracture
