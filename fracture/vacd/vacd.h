// Volumetric approximate convex decomposition: converts a visual mesh to a compound (paper 4.1).
//
// Read first: decompose() in vacd.cpp, which lists the steps. Space is divided into convex regions,
// by Voronoi nodes (nodes.h) and then by planes where these make hulls tighter; each region owns
// the islands of the mesh in it and is fitted to each of them.
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

inline constexpr std::uint32_t kFewestNodes = 12;   ///< Least number of nodes by default.
inline constexpr std::uint32_t kMostNodes = 10000;  ///< Maximum number of nodes and of convexes.
inline constexpr std::uint32_t kDefaultPolygons = 10000;  ///< Default limit of polygons per piece.

/// Options of a decomposition.
struct VacdOptions {
  std::vector<Vec3>
      /// Sites of Voronoi cells in the mesh's coordinates, placed by hand; empty: automatic.
      nodes;
  /// Number of automatic nodes of all shells together. By default none if `convexes` is given, and
  /// else as many as make tight hulls: the number is doubled until they are, or until that makes
  /// them hardly tighter.
  std::optional<std::uint32_t> node_count;
  /// Maximum number of convexes, which is reached if more convexes make tighter hulls; 0: as many
  /// as the nodes make. There are never fewer convexes than shells, as a convex owns one connected
  /// mesh.
  std::uint32_t convexes = 0;
  /// A piece with more polygons is cut again if allowed: the cost of an impact grows with them.
  std::uint32_t polygons = kDefaultPolygons;
  Fit fit{Fit::Kind::kHull, 24};
  MaterialIndex material;
  /// Materials by the appearances of faces (PolygonMesh::Face::appearance), from 1 on; `material`
  /// stands for all others. A convex has the material with most area on its surface, or on its
  /// shell's surface if it has none itself.
  std::vector<MaterialIndex> materials_by_appearance{};
  /// By the appearances of faces, from 1 on: true if the file defines the appearance, so that the
  /// visual mesh must be kept.
  std::vector<std::uint8_t> textured_by_appearance{};
  /// Called with the fraction of the work done; may be empty.
  std::function<void(double)> progress{};

  /// True if the number of nodes follows from the mesh.
  bool chooses_nodes() const { return nodes.empty() && !node_count && convexes == 0; }
};

/// Measurements of a decomposition.
struct VacdFigures {
  double shell_volume_m3 = 0;  ///< Sum over the shells; overlaps count once per shell.
  /// Volume of parts left out because they are inside out: the mesh intersects itself there.
  double inside_out_m3 = 0;
  double hull_volume_m3 = 0;  ///< Volume of all convexes' polyhedra.
  /// Largest number of polygons of one convex's visual mesh.
  std::size_t max_faces_per_convex = 0;
  std::size_t ghosts = 0;  ///< Number of overlaps of shells, or of the hulls of islands.
  double split_ms = 0;     ///< Time for nodes, regions and cutting the mesh.
  double total_ms = 0;

  double hull_volume_ratio() const { return hull_volume_m3 / shell_volume_m3; }
  /// True if the hulls have at most 1.15 times the volume of the mesh.
  bool has_tight_hulls() const;
};

/// Result of a decomposition.
struct Vacd {
  Compound compound;
  VacdFigures figures;
};

/// Decomposes a mesh into convexes, each of which owns one connected, watertight piece of a shell
/// in one of disjoint convex regions. The pieces add up to the mesh without the parts that are
/// inside out. Regions inside the mesh have no visual mesh, and neither have pieces that are
/// flat-shaded convexes without texture, as their polyhedra render alike. Regions that touch share
/// plane ids and bonds; hulls that overlap (of different shells, or of islands in one region) get
/// ghosts. Throws InputError if the options ask for more than kMostNodes, or have nodes that make
/// more convexes than allowed or coordinates that are not finite.
Vacd decompose(const RepairedMesh& mesh, const VacdOptions& options = {});

/// Reads Voronoi nodes from a file: `x y z` per line; text after a # is ignored. Throws InputError
/// with `name` and the line.
std::vector<Vec3> read_nodes(std::istream& in, const std::string& name);

}  // namespace sunder::fracture
