// Repair of mesh files: makes watertight solids of arbitrary meshes and reports each repair by name
// (docs/decisions/007-mesh-input.md).
//
// Begin with repair_mesh() in repair.cpp, which calls the tiers in order. Vertices and faces are
// cleaned (clean.h), faces oriented and edges paired (surface.h), and holes closed (holes.h). Parts
// still open are replaced by an isosurface of their winding number (shell.h), and the whole mesh if
// it passes through itself too much (inside_out.h). solids.h makes polygon meshes of closed shells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// Options of repair_mesh().
struct RepairOptions {
  bool repair = true;  ///< False to throw InputError for a mesh that needs repairs.
  /// Least cosine between face normals at a smooth edge, where the file has no normals.
  double crease_cosine = 0.766;    // 40 degrees
  std::uint32_t shell_cells = 32;  ///< Grid cells of the last tier along the longest side.
};

/// A kind of repair, and the number of elements of the mesh that it was applied to.
struct Repair {
  std::string name;
  std::size_t count = 0;
  bool harmless = false;  ///< True if the surface stays the same; allowed even with `repair` off.
};

/// The watertight solids of a mesh, and the repairs that were made.
struct RepairedMesh {
  std::vector<PolygonMesh> shells;  ///< Watertight, with positive volume; may overlap.
  std::vector<Repair> repairs;      ///< In the order made; empty if the mesh needed none.
  bool closed = false;              ///< True if the mesh was watertight as given.
};

/// Returns the watertight solids of a mesh: one for each outer shell, with the cavities in it.
/// Planar polygons are not triangulated. Throws InputError, with `name`, fault and remedy, if the
/// mesh encloses no volume, or needs repairs and `options.repair` is false. Work is bounded.
RepairedMesh repair_mesh(RawMesh mesh, const std::string& name, const RepairOptions& options = {});

}  // namespace sunder
