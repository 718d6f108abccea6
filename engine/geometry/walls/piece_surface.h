// The faces of several closed meshes on common points: the working form of outer_surface().
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/walls/outer_surface.h"

namespace sunder {

/// Two points, the smaller number first.
using PointPair = std::array<std::uint32_t, 2>;

inline PointPair point_pair(std::uint32_t a, std::uint32_t b) {
  return a < b ? PointPair{a, b} : PointPair{b, a};
}

/// Faces whose corners are numbers of points that all meshes share.
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
    std::uint32_t mark = 0;
    std::uint32_t mesh = 0;  ///< Number of the mesh that the face is of.
    std::vector<Contour> contours;
  };

  std::vector<Vec3> points;
  std::vector<Face> faces;
  bool has_uvs = false;  ///< True if any of the meshes has texture coordinates.
};

/// Faces of different meshes in one plane, some of which face each other.
struct WallPlane {
  Vec3 normal = Vec3::UnitZ();       ///< Of the faces with an even name.
  std::vector<std::uint32_t> faces;  ///< Numbers of PieceSurface::faces, ascending.
};

/// Joins the vertices of all meshes that are within `tolerance_m` of each other.
PieceSurface join_meshes(std::span<const PolygonMesh* const> meshes, double tolerance_m);

/// The planes in which faces of two meshes may cover each other: their names are opposite and their
/// bounding boxes overlap.
std::vector<WallPlane> find_wall_planes(const PieceSurface& surface, double tolerance_m);

/// Splits edges of faces in wall planes where points of the same plane lie on them and where they
/// cross, in all faces that have these edges. Returns false if the rounds of splitting find no end.
bool split_edges(PieceSurface& surface, std::span<const WallPlane> planes, double tolerance_m);

/// Removes what faces of a plane with opposite names have in common. Edges must have been split.
/// Returns false if the outlines of what is left do not close.
bool remove_common(PieceSurface& surface, const WallPlane& plane);

/// Divides edges that more than two faces share: each pair of faces with solid between them has a
/// point of its own there, in a place of its own, so that no two pairs have an edge in common.
/// Returns false if an edge is not passed as often one way as the other.
bool divide_touching_edges(PieceSurface& surface);

/// A mesh of the faces. Corners at one point that no chain of faces connects become different
/// vertices. Returns none if an edge is not passed as often one way as the other.
std::optional<OuterSurface> assemble(const PieceSurface& surface);

/// Removes repeated corners and parts of a contour that go to a point and straight back.
void clean_contour(PieceSurface::Contour& contour);

}  // namespace sunder
