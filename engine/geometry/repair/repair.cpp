#include "engine/geometry/repair/repair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/check.h"
#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/holes.h"
#include "engine/geometry/repair/shell.h"
#include "engine/geometry/repair/solids.h"
#include "engine/geometry/repair/surface.h"

namespace sunder {
namespace {

/// Open vertices and edges this close, relative to the mesh's size, were meant to be one.
constexpr double kClose = 1e-6;
/// A shell has no thickness whose volume is less than this part of its area to the power 3/2.
constexpr double kThin = 1e-6;
/// What is open is enclosed anew if it is more than this part of the whole area.
constexpr double kWorthEnclosing = 0.02;
/// Enclosed parts smaller than this beside the largest come from the grid, not from the mesh.
constexpr double kCrumb = 1e-3;

class Repairs {
 public:
  void note(const char* name, std::size_t count, bool harmless = false) {
    if (count > 0) list.push_back({name, count, harmless});
  }
  std::vector<Repair> list;
};

std::size_t drop_worthless(RawMesh& mesh, Repairs& repairs) {
  const std::size_t degenerate = drop_degenerate(mesh), duplicate = drop_duplicates(mesh);
  repairs.note("degenerate faces dropped", degenerate);
  repairs.note("duplicate faces dropped", duplicate);
  return degenerate + duplicate;
}

/// Tier 1: vertices that are one, faces that are none, edges that meet but do not match.
void clean(RawMesh& mesh, double size, Repairs& repairs) {
  repairs.note("identical vertices joined", join_identical(mesh), true);
  drop_worthless(mesh, repairs);
  const auto open_vertices = [](const Surface& surface) {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t c : surface.open_half_edges()) {
      vertices.push_back(surface.mesh.corners[c]);
      vertices.push_back(surface.mesh.corners[surface.next(c)]);
    }
    return vertices;
  };
  if (edge_faults(mesh).open == 0) return;
  const std::size_t joined = join_close(mesh, open_vertices(pair_edges(mesh)), kClose * size);
  repairs.note("close vertices joined", joined);
  if (joined > 0) drop_worthless(mesh, repairs);
  const std::vector<std::uint32_t> open = pair_edges(mesh).open_half_edges();
  const std::size_t inserted = join_t_junctions(mesh, open, kClose * size);
  repairs.note("vertices put into the edges they lie on", inserted);
  if (inserted > 0) drop_worthless(mesh, repairs);
}

/// Tier 2: neighbours agree, solids that touch come apart.
Surface part(RawMesh mesh, Repairs& repairs) {
  repairs.note("faces turned to agree with their neighbours", orient(mesh));
  repairs.note("edges of more than two faces parted", edge_faults(mesh).crowded);
  Surface surface = pair_edges(std::move(mesh));
  repairs.note("vertices parted where surfaces only touch", split_vertices(surface), true);
  return surface;
}

/// Tier 3: holes.
Surface close(Surface surface, Repairs& repairs) {
  const ClosedHoles holes = close_holes(surface);
  repairs.note("planar holes closed", holes.planar);
  repairs.note("curved holes closed", holes.curved);
  if (holes.planar + holes.curved == 0) return surface;
  return pair_edges(std::move(surface.mesh));
}

/// Of each polygon, whether it is part of a closed shell with some thickness.
std::vector<std::uint8_t> solid_polygons(const Surface& surface) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> shell = shells_of(surface, count);
  const std::vector<double> volume = volumes(surface.mesh, shell, count);
  std::vector<double> area(count, 0);
  std::vector<std::uint8_t> good(count, 1);
  for (std::size_t p = 0; p < shell.size(); ++p) {
    area[shell[p]] += 0.5 * double_area(surface.mesh, p).norm();
  }
  for (const std::uint32_t c : surface.open_half_edges()) good[shell[surface.polygon[c]]] = 0;
  for (std::uint32_t s = 0; s < count; ++s) {
    if (!(std::abs(volume[s]) > kThin * area[s] * std::sqrt(area[s]))) good[s] = 0;
  }
  std::vector<std::uint8_t> solid;
  for (const std::uint32_t s : shell) solid.push_back(good[s]);
  return solid;
}

/// Of each polygon, whether its shell is more than a crumb beside the largest.
std::vector<std::uint8_t> polygons_of_worth(const Surface& surface) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> shell = shells_of(surface, count);
  const std::vector<double> volume = volumes(surface.mesh, shell, count);
  const double largest = *std::max_element(volume.begin(), volume.end());
  std::vector<std::uint8_t> worth;
  for (const std::uint32_t s : shell) worth.push_back(volume[s] > kCrumb * largest ? 1 : 0);
  return worth;
}

/// Tier 4: keeps the solids, and encloses what is left if that is much. Polygons from
/// `given_count` on closed holes in vain.
RawMesh enclose(const Surface& surface, std::size_t given_count, const RepairOptions& options,
                Repairs& repairs) {
  const std::vector<std::uint8_t> solid =
      options.enclose_all ? std::vector<std::uint8_t>(surface.mesh.polygons.size(), 0)
                          : solid_polygons(surface);
  std::vector<std::uint8_t> rest(solid.size(), 0);
  double whole_area = 0, rest_area = 0;
  for (std::size_t p = 0; p < std::min(given_count, solid.size()); ++p) {
    const double area = double_area(surface.mesh, p).norm();
    rest[p] = 1 - solid[p];
    whole_area += area;
    rest_area += rest[p] ? area : 0;
  }
  RawMesh result = extract(surface.mesh, solid);
  const auto count = static_cast<std::size_t>(std::count(rest.begin(), rest.end(), 1));
  if (count == 0) return result;
  if (rest_area > kWorthEnclosing * whole_area) {
    const Surface shell =
        pair_edges(winding_shell(extract(surface.mesh, rest), options.shell_cells));
    if (!shell.mesh.polygons.empty()) {
      append(result, extract(shell.mesh, polygons_of_worth(shell)));
      repairs.note("faces enclosed in a winding-number shell", count);
      return result;
    }
  }
  repairs.note("faces that enclose nothing dropped", count);
  return result;
}

void refuse_repairs(const Repairs& repairs, const std::string& name) {
  std::string needed;
  for (const Repair& repair : repairs.list) {
    if (repair.harmless) continue;
    needed +=
        (needed.empty() ? "" : ", ") + repair.name + " (" + std::to_string(repair.count) + ")";
  }
  if (needed.empty()) return;
  throw InputError(name + ": repairs are off, and the mesh needs them: " + needed +
                   "; mend it, or allow repairs");
}

}  // namespace

RepairedMesh repair_mesh(RawMesh mesh, const std::string& name, const RepairOptions& options) {
  Box box;
  for (const std::uint32_t v : mesh.corners) box.extend(mesh.vertices[v]);
  const double size = box.empty() ? 0 : box.extent().norm();

  Repairs repairs;
  RepairedMesh result;
  clean(mesh, size, repairs);
  result.closed = repairs.list.empty() || repairs.list.back().harmless;
  result.closed = result.closed && !edge_faults(mesh).any();
  Surface surface = part(std::move(mesh), repairs);
  const std::size_t given_count = surface.mesh.polygons.size();
  surface = close(std::move(surface), repairs);
  mesh = enclose(surface, given_count, options, repairs);
  if (mesh.polygons.empty()) {
    throw InputError(name + ": the mesh encloses no volume: give it thickness, or close it");
  }

  repairs.note("faces triangulated because they are not planar", triangulate_curved(mesh), true);
  surface = pair_edges(std::move(mesh));
  split_vertices(surface);
  repairs.note("vertices put into edges that a surface passes twice", part_edges(surface));
  std::vector<std::uint32_t> solid;
  std::uint32_t count = 0;
  repairs.note("shells turned outward", face_outward(surface, solid, count));
  if (!options.repair) refuse_repairs(repairs, name);
  result.shells = polygon_meshes(surface, solid, count, options.crease_cosine);
  result.repairs = std::move(repairs.list);
  return result;
}

}  // namespace sunder
