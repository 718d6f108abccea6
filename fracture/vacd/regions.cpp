#include "fracture/vacd/regions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/geometry/mesh_islands.h"
#include "engine/geometry/split_mesh.h"
#include "fracture/pattern/voronoi.h"

namespace sunder::fracture {
namespace {

/// Margin around a mesh, over its size, so that it does not touch the outermost faces of regions.
constexpr double kMargin = 1e-2;
/// Distance of two equal unit normals.
constexpr double kParallel = 1e-6;

ConvexPolyhedron box_with_margin(const Box& box) {
  const Vec3 room = Vec3::Constant(kMargin * box.extent().maxCoeff());
  return make_box(box.min - room, box.max + room);
}

/// Returns the inner planes of a cell, nearest first.
std::vector<NamedPlane> inner_planes(const ConvexPolyhedron& cell) {
  std::vector<NamedPlane> planes;
  const Vec3 center = bounds(cell).center();
  for (const ConvexPolyhedron::Face& face : cell.faces) {
    if (!face.id.none()) planes.push_back({face.plane, face.id});
  }
  std::sort(planes.begin(), planes.end(), [&](const NamedPlane& a, const NamedPlane& b) {
    const double at_a = -a.plane.distance(center), at_b = -b.plane.distance(center);
    return at_a != at_b ? at_a < at_b : a.id < b.id;
  });
  return planes;
}

/// Returns Voronoi cells whose inner faces have unique ids.
std::vector<ConvexPolyhedron> cells_with_ids(std::span<const Vec3> nodes, const Box& box,
                                             PlaneIdAllocator& ids) {
  std::vector<ConvexPolyhedron> cells;
  if (nodes.size() < 2) {
    cells.push_back(box_with_margin(box));
    return cells;
  }
  std::vector<Plane> planes(1);  // Reserves index 0, whose id would be zero.
  cells = voronoi_cells(nodes, box_with_margin(box), planes);
  for (ConvexPolyhedron& cell : cells) {
    for (ConvexPolyhedron::Face& face : cell.faces) {
      if (!face.id.none()) face.id.value += 2 * ids.used();
    }
  }
  ids.reserve(planes.size() - 1);
  return cells;
}

/// Removes directions of the region's shared faces: clipping in them again would leave slivers.
void drop_own_directions(const ConvexPolyhedron& region, std::vector<Vec3>& directions) {
  std::erase_if(directions, [&](const Vec3& direction) {
    return std::any_of(
        region.faces.begin(), region.faces.end(), [&](const ConvexPolyhedron::Face& face) {
          return !face.id.none() &&
                 (face.plane.normal - direction).squaredNorm() < kParallel * kParallel;
        });
  });
}

}  // namespace

bool VacdPiece::is_inside_mesh() const {
  return std::none_of(mesh.faces.begin(), mesh.faces.end(),
                      [](const PolygonMesh::Face& face) { return face.id.none(); });
}

double region_tolerance(const Box& box) {
  const double reach = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  return 1e-13 * box.extent().maxCoeff() + 1e-15 * reach;
}

std::vector<VacdPiece> voronoi_pieces(const PolygonMesh& mesh, std::span<const Vec3> nodes,
                                      PlaneIdAllocator& ids) {
  const Box box = bounds(mesh);
  std::vector<ConvexPolyhedron> cells = cells_with_ids(nodes, box, ids);
  std::erase_if(cells, [](const ConvexPolyhedron& cell) { return cell.empty(); });
  std::vector<std::vector<NamedPlane>> planes;
  for (const ConvexPolyhedron& cell : cells) planes.push_back(inner_planes(cell));
  std::vector<MeshRegion> regions;
  for (std::size_t c = 0; c < cells.size(); ++c) regions.push_back({bounds(cells[c]), planes[c]});
  std::vector<PolygonMesh> parts = split(mesh, regions, region_tolerance(box));
  std::vector<std::vector<PolygonMesh>> separate(cells.size());
  for_chunks(cells.size(), 1, [&](std::size_t c, std::size_t, std::size_t) {
    separate[c] = islands(std::move(parts[c]));
  });
  std::vector<VacdPiece> pieces;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (PolygonMesh& island : separate[c]) pieces.push_back({cells[c], std::move(island)});
  }
  return pieces;
}

ConvexPolyhedron fitted_region(const VacdPiece& piece, const Fit& fit) {
  if (piece.is_inside_mesh()) return piece.region;
  const std::span<const Vec3> points = piece.mesh.vertices;
  std::vector<Vec3> directions = fit_directions(points, fit);
  drop_own_directions(piece.region, directions);
  const std::vector<Plane> planes = touching_planes(points, directions);
  const std::vector<PlaneId> none(planes.size());
  ConvexPolyhedron fitted =
      clip_all(piece.region, planes, none, region_tolerance(bounds(piece.region)));
  for (ConvexPolyhedron::Face& face : fitted.faces) {
    face.kind = face.id.none() ? FaceKind::kSurface : FaceKind::kInterior;
  }
  return fitted;
}

bool renders_like(const ConvexPolyhedron& polyhedron, const PolygonMesh& mesh) {
  constexpr double kSameVolume = 1e-13;
  constexpr float kFlat = 0.9999f;
  const double volume = mass_properties(mesh).volume_m3;
  if (!mesh.corner_uvs.empty()) return false;
  if (std::abs(mass_properties(polyhedron).volume_m3 - volume) > kSameVolume * volume) return false;
  for (const PolygonMesh::Face& face : mesh.faces) {
    const Vec3f normal = face.plane.normal.cast<float>();
    for (std::uint32_t k = 0; k < face.contour_count; ++k) {
      const PolygonMesh::Contour& contour = mesh.contours[face.first_contour + k];
      for (std::uint32_t c = 0; c < contour.corner_count; ++c) {
        if (mesh.corner_normals[contour.first_corner + c].dot(normal) < kFlat) return false;
      }
    }
  }
  return true;
}

}  // namespace sunder::fracture
