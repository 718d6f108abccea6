// sunder hull: an approximate convex hull of a mesh (paper 4.2, figure 13).
#include "engine/geometry/hull.h"

#include <cstdio>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "engine/geometry/approximate_hull.h"
#include "fracture/solids.h"
#include "scenes/app/commands.h"
#include "scenes/app/mesh_report.h"

namespace sunder::app {
namespace {

/// Tolerance of encloses(): largest distance of a point outside the hull, relative to its size.
constexpr double kOutsideTolerance = 1e-9;

/// Returns the vertices that faces of a mesh use, or all vertices of a built-in solid; sets the
/// name and the counts of `solid`.
std::vector<Vec3> points_of(const std::string& mesh, double scale, scenes::MeshSolid& solid) {
  std::vector<Vec3> points;
  if (scenes::is_built_in_solid(mesh)) {
    scenes::need_no_scale(mesh, scale);
    solid = scenes::as_mesh_solid(mesh, fracture::make_solid(mesh));
    for (const ConvexPtr& convex : solid.compound.convexes) {
      const auto& vertices = convex->polyhedron.vertices;
      points.insert(points.end(), vertices.begin(), vertices.end());
    }
    return points;
  }
  const RawMesh raw = scenes::make_raw_mesh(mesh);
  solid.name = mesh;
  solid.vertices = raw.vertices.size();
  solid.faces = raw.polygons.size();
  std::vector<std::uint8_t> used(raw.vertices.size(), 0);
  for (const std::uint32_t vertex : raw.corners) used[vertex] = 1;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) points.push_back(scale * raw.vertices[v]);
  }
  return points;
}

bool encloses(const ConvexPolyhedron& hull, const std::vector<Vec3>& points) {
  const double allowed = kOutsideTolerance * bounds(hull).extent().norm();
  for (const ConvexPolyhedron::Face& face : hull.faces) {
    for (const Vec3& point : points) {
      if (face.plane.distance(point) > allowed) return false;
    }
  }
  return true;
}

}  // namespace

int hull(const HullOptions& options) {
  options.apply();
  scenes::MeshSolid solid;
  const std::vector<Vec3> points = points_of(options.mesh, options.scale, solid);
  Box box;
  for (const Vec3& point : points) box.extend(point);
  const double exact_m3 = mass_properties(make_hull(points)).volume_m3;
  if (!(exact_m3 > 0)) throw InputError(options.mesh + ": its vertices span no volume");

  const Stopwatch watch;
  const Fit fit{Fit::Kind::kHull, options.vertices};
  const ConvexPolyhedron fitted = fitted_hull(points, fit);
  const double total_ms = watch.ms();
  const std::size_t used = approximate_hull(points, options.vertices).vertices.size();
  const double ratio = mass_properties(fitted).volume_m3 / exact_m3;
  const bool all = encloses(fitted, points);

  char text[200];
  std::snprintf(
      text, sizeof text,
      "hull     of %zu vertices chosen: %zu faces, %.4f of the true hull's volume, %s all "
      "vertices; %.2f ms\n",
      used, fitted.faces.size(), ratio, all ? "encloses" : "does NOT enclose", total_ms);
  const InputSize size{box.extent(), exact_m3};
  options.print(solid.name + ": " + std::to_string(points.size()) + " vertices\n" +
                app::text(size, options.scale) + text);
  Figures figures = {{"/input/vertices", std::int64_t(solid.vertices)},
                     {"/input/faces", std::int64_t(solid.faces)},
                     {"/vertices_used", std::int64_t(used)},
                     {"/faces", std::int64_t(fitted.faces.size())},
                     {"/volume_ratio", ratio},
                     {"/encloses_all", all},
                     {"/total_ms", total_ms}};
  add_size(size, options.scale, figures);
  options.write_json(format_figures(figures));
  return all ? 0 : 1;
}

}  // namespace sunder::app
