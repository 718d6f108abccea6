// Volumetric approximate convex decomposition: a visual mesh becomes a compound (paper 4.1).
//
// Read first: decompose() in vacd.cpp, the list of steps. Space is cut into convex regions, by
// Voronoi nodes (vacd/nodes.h) and then by planes where that makes hulls tighter; each region
// owns the islands of the mesh in it, and is fitted to each of them.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/repair/repair.h"
#include "engine/model/compound.h"

namespace sunder::fracture {

/// Voronoi nodes where nothing else is asked for.
inline constexpr std::uint32_t kDefaultNodes = 12;
inline constexpr std::uint32_t kMostNodes = 10000;        ///< Also of convexes.
inline constexpr std::uint32_t kDefaultPolygons = 10000;  ///< Of a piece.

/// How a mesh is decomposed.
struct VacdOptions {
  std::vector<Vec3>
      nodes;  ///< Sites of Voronoi cells, by hand, in the mesh's coordinates; empty: automatic.
  /// Automatic nodes, shared among the shells; none by default where `convexes` is given.
  std::optional<std::uint32_t> node_count;
  /// At most so many convexes, and no fewer where more make tighter hulls; 0: what the nodes make.
  /// A convex owns one connected mesh, so there are never fewer than shells.
  std::uint32_t convexes = 0;
  /// A piece with more is cut again, if `convexes` allows: what an impact costs grows with it.
  std::uint32_t polygons = kDefaultPolygons;
  Fit fit{Fit::Kind::kHull, 24};
  MaterialIndex material;
  /// By marks of faces (PolygonMesh::Face), from 1 on: what a convex is made of most of whose
  /// surface has that mark, or, if it has none, most of whose shell's has. Other marks: `material`.
  std::vector<MaterialIndex> marked{};
  /// Likewise: whether such faces look other than their material does, and so must stay as they
  /// are.
  std::vector<std::uint8_t> painted{};
  std::function<void(double)> progress{};  ///< Told of the share of the work done; may be empty.
};

/// What came of it.
struct VacdFigures {
  double mesh_volume_m3 = 0;
  /// Of parts left out because they are inside out: the mesh passes through itself there.
  double inside_out_m3 = 0;
  double hull_volume_m3 = 0;             ///< Of all convexes' polyhedra.
  std::size_t max_faces_per_convex = 0;  ///< Polygons of one convex's visual mesh.
  std::size_t ghosts = 0;                ///< Overlaps of shells, or of islands' hulls.
  double split_ms = 0;                   ///< Nodes, regions and the cutting of the mesh.
  double total_ms = 0;

  double hull_volume_ratio() const { return hull_volume_m3 / mesh_volume_m3; }
};

/// A decomposition.
struct Vacd {
  Compound compound;
  VacdFigures figures;
};

/// Convexes that each own one connected watertight piece of a shell, within disjoint convex
/// regions; pieces sum to the mesh, less what of it is inside out. Without visual mesh are regions
/// wholly inside the mesh, and pieces that are flat-shaded convexes without texture or paint:
/// seen alone, they look the same. Regions that touch share plane ids and bonds, and hulls that
/// overlap (of different shells, or of islands in one region) ghosts. Throws InputError if the
/// options ask for more than kMostNodes, for nodes by hand that make more convexes than allowed, or
/// for coordinates that are not finite.
Vacd decompose(const RepairedMesh& mesh, const VacdOptions& options = {});

/// Voronoi nodes from a file: `x y z` a line, what follows a # is left out. Throws InputError
/// naming `name` and the line.
std::vector<Vec3> read_nodes(std::istream& in, const std::string& name);

}  // namespace sunder::fracture
