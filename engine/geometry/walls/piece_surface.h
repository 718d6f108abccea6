// The faces of several closed meshes on common points, and the steps of outer_surface().
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/walls/outer_surface.h"

namespace sunder {

/// An undirected edge: two point numbers, the smaller first.
using PointPair = std::array<std::uint32_t, 2>;

/// Returns the undirected edge of two points.
inline PointPair point_pair(std::uint32_t a, std::uint32_t b) {
  return a < b ? PointPair{a, b} : PointPair{b, a};
}

/// Faces whose corners refer to points that all meshes share.
struct PieceSurface {
  struct Corner {
    std::uint32_t point = 0;
    Vec3f normal = Vec3f::Zero();
    Vec2f uv = Vec2f::Zero();
  };
  using Contour = std::vector<Corner>;
  struct Face {
    Plane plane;
    PlaneId id;
    FaceKind kind = FaceKind::kSurface;
    std::uint32_t appearance = 0;
    std::uint32_t mesh = 0;  ///< Index of the face's mesh.
    std::vector<Contour> contours;
  };

  std::vector<Vec3> points;
  std::vector<Face> faces;
  bool has_uvs = false;  ///< True if any of the meshes has texture coordinates.
};

/// A plane with faces of different meshes on both of its sides.
struct WallPlane {
  Vec3 normal = Vec3::UnitZ();       ///< Normal of the faces with an even id.
  std::vector<std::uint32_t> faces;  ///< Indices into PieceSurface::faces, ascending.
};

/// Returns the faces of all meshes, with vertices within `tolerance_m` of each other joined.
PieceSurface join_meshes(std::span<const PolygonMesh* const> meshes, double tolerance_m);

/// Returns the planes in which faces of two meshes have opposite ids and overlapping boxes.
std::vector<WallPlane> find_wall_planes(const PieceSurface& surface, double tolerance_m);

/// Splits edges of faces in wall planes where points of the plane lie on them and where they cross,
/// in all faces that have these edges. Returns false if too many rounds are needed.
bool split_edges(PieceSurface& surface, std::span<const WallPlane> planes, double tolerance_m);

/// Removes the common parts of faces of a plane with opposite ids. Edges must have been split. A
/// face whose outline crosses itself is right with `cover_repeatedly` only, which takes longer.
/// Returns false if the outline of a remaining part is not closed.
bool remove_common(PieceSurface& surface, const WallPlane& plane, bool cover_repeatedly);

/// Divides edges of more than two faces: for each pair of faces with solid between them at a
/// different point, so that no two pairs have an edge in common. Returns false if an edge has
/// unequal numbers of faces in its two directions.
bool divide_touching_edges(PieceSurface& surface);

/// Returns a mesh of the faces. Corners at one point that no chain of faces connects become
/// different vertices. Returns none if an edge has unequal numbers of faces in its two directions.
std::optional<OuterSurface> assemble(const PieceSurface& surface);

/// Removes repeated corners and spikes; a contour of fewer than three corners becomes empty.
void clean_contour(PieceSurface::Contour& contour);

}  // namespace sunder
