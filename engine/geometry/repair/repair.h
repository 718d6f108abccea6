// From meshes as they come to solids that can be broken: repaired in tiers, each repair named.
//
// Read first: repair_mesh() in repair.cpp, which is the list of tiers. Vertices and faces are
// cleaned (clean.h), edges paired and faces oriented (surface.h), holes closed (holes.h); what
// still encloses nothing is enclosed by a winding-number shell (shell.h). solids.h makes polygon
// meshes of what is closed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// What may be done to a mesh.
struct RepairOptions {
  bool repair = true;  ///< If not, a mesh that needs it is refused.
  /// Where the file gives no normals, edges are smooth whose faces' normals meet at this or more.
  double crease_cosine = 0.766;    // 40 degrees
  std::uint32_t shell_cells = 32;  ///< Along the longest side of what the last tier encloses.
  bool enclose_all = false;        ///< Whether the last tier encloses what is closed, too.
};

/// Something that was done to a mesh, and to how many of its parts.
struct Repair {
  std::string name;
  std::size_t count = 0;
  bool harmless = false;  ///< The same surface, written otherwise: done even where repair is off.
};

/// Solids that can be broken, and what was done to get them.
struct RepairedMesh {
  std::vector<PolygonMesh> shells;  ///< Watertight, of positive volume; they may overlap.
  std::vector<Repair> repairs;      ///< In the order done; empty if the mesh was sound.
  bool closed = false;              ///< Whether the mesh was watertight as given.
};

/// Watertight solids of a mesh: one per shell, cavities with the shell around them. Polygons stay
/// polygons unless they are not planar. Throws InputError naming `name`, what is wrong and what to
/// do, if the mesh encloses nothing, or needs repairs and may not have them. Work is bounded.
RepairedMesh repair_mesh(RawMesh mesh, const std::string& name, const RepairOptions& options = {});

}  // namespace sunder
