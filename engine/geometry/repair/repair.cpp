#include "engine/geometry/repair/repair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/check.h"
#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/holes.h"
#include "engine/geometry/repair/inside_out.h"
#include "engine/geometry/repair/shell.h"
#include "engine/geometry/repair/solids.h"
#include "engine/geometry/repair/surface.h"
#include "engine/geometry/repair/surface_audit.h"

namespace sunder {
namespace {

/// Distance over the mesh's diagonal up to which open vertices and edges are joined.
constexpr double kJoinTolerance = 1e-6;
/// Distance up to which vertices that no edge joins are one: solids on a grid of kTwinDistance_m
/// that are a step apart along each axis touch.
constexpr double kMaxTwinDistance_m = 2 * kTwinDistance_m;
/// Least volume of a shell that counts as solid, over its area to the power 3/2.
constexpr double kMinThicknessRatio = 1e-6;
/// Least area of the open part, over the area of the mesh, that gets a winding-number shell.
constexpr double kMinOpenAreaRatio = 0.02;
/// Greatest part of the volume that may be inside out, where a surface passes through itself. On
/// balls with vertices moved at random, the convexes then have up to 2e-3 of it in net volume.
constexpr double kMaxInsideOutRatio = 0.05;
/// Least volume of a component of that shell over the largest; smaller ones are grid artefacts.
constexpr double kMinShellVolumeRatio = 1e-3;

/// The list of repairs made so far.
class Repairs {
 public:
  void record(const char* name, std::size_t count, bool harmless = false) {
    if (count > 0) list.push_back({name, count, harmless});
  }
  std::vector<Repair> list;
};

std::size_t drop_degenerate_and_duplicate(RawMesh& mesh, Repairs& repairs) {
  const std::size_t degenerate = drop_degenerate(mesh), duplicate = drop_duplicates(mesh);
  repairs.record("degenerate faces removed", degenerate);
  repairs.record("duplicate faces removed", duplicate);
  return degenerate + duplicate;
}

/// Joins vertices of open edges that are close to others, or to open edges.
void join_open(RawMesh& mesh, double size, Repairs& repairs) {
  const auto open_vertices = [](const Surface& surface) {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t c : surface.open_half_edges()) {
      vertices.push_back(surface.mesh.corners[c]);
      vertices.push_back(surface.mesh.corners[surface.next(c)]);
    }
    return vertices;
  };
  const std::size_t joined =
      join_close(mesh, open_vertices(pair_edges(mesh)), kJoinTolerance * size);
  repairs.record("close vertices joined", joined);
  if (joined > 0) drop_degenerate_and_duplicate(mesh, repairs);
  const std::vector<std::uint32_t> open = pair_edges(mesh).open_half_edges();
  const std::size_t inserted = join_t_junctions(mesh, open, kJoinTolerance * size);
  repairs.record("T-junctions fixed (vertices inserted into edges)", inserted);
  if (inserted > 0) drop_degenerate_and_duplicate(mesh, repairs);
}

/// Tier 1: joins vertices, removes degenerate and duplicate faces, and resolves T-junctions.
void clean(RawMesh& mesh, double size, Repairs& repairs) {
  repairs.record("identical vertices joined", join_identical(mesh), true);
  drop_degenerate_and_duplicate(mesh, repairs);
  if (edge_faults(mesh).open > 0) join_open(mesh, size, repairs);
  const std::size_t twins = join_twins(mesh, std::min(kMaxTwinDistance_m, kJoinTolerance * size));
  repairs.record("twin vertices joined", twins);
  if (twins > 0) drop_degenerate_and_duplicate(mesh, repairs);
}

/// Tier 2: orients neighbours consistently and separates solids that touch.
Surface orient_and_split(RawMesh mesh, Repairs& repairs) {
  repairs.record("faces flipped to match their neighbours", orient(mesh));
  repairs.record("non-manifold edges (of more than two faces) split",
                 edge_faults(mesh).non_manifold);
  Surface surface = pair_edges(std::move(mesh));
  repairs.record("non-manifold vertices split", split_vertices(surface), true);
  return surface;
}

/// Tier 3: closes holes.
Surface close(Surface surface, Repairs& repairs) {
  const ClosedHoles holes = close_holes(surface);
  repairs.record("planar holes closed", holes.planar);
  repairs.record("curved holes closed", holes.curved);
  if (holes.planar + holes.curved == 0) return surface;
  return pair_edges(std::move(surface.mesh));
}

/// Returns for each polygon 1 if its shell is closed and has enough volume, else 0.
std::vector<std::uint8_t> solid_polygons(const Surface& surface) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> shell = shells_of(surface, count);
  const std::vector<double> volume = volumes(surface.mesh, shell, count);
  std::vector<double> area(count, 0);
  std::vector<std::uint8_t> is_solid(count, 1);
  for (std::size_t p = 0; p < shell.size(); ++p) {
    area[shell[p]] += 0.5 * double_area(surface.mesh, p).norm();
  }
  for (const std::uint32_t c : surface.open_half_edges()) is_solid[shell[surface.polygon[c]]] = 0;
  for (std::uint32_t s = 0; s < count; ++s) {
    if (!(std::abs(volume[s]) > kMinThicknessRatio * area[s] * std::sqrt(area[s]))) is_solid[s] = 0;
  }
  std::vector<std::uint8_t> solid;
  for (const std::uint32_t s : shell) solid.push_back(is_solid[s]);
  return solid;
}

/// Returns for each polygon 1 if its shell is not small beside the largest, else 0.
std::vector<std::uint8_t> polygons_of_large_shells(const Surface& surface) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> shell = shells_of(surface, count);
  const std::vector<double> volume = volumes(surface.mesh, shell, count);
  const double largest = *std::max_element(volume.begin(), volume.end());
  std::vector<std::uint8_t> keep;
  for (const std::uint32_t s : shell)
    keep.push_back(volume[s] > kMinShellVolumeRatio * largest ? 1 : 0);
  return keep;
}

/// Tier 4: keeps the polygons for which `solid` is 1 and replaces the others, without those from
/// `given_count` on, which tier 3 added, by a winding-number shell, or drops them if they are few.
RawMesh enclose(const Surface& surface, const std::vector<std::uint8_t>& solid,
                std::size_t given_count, std::uint32_t shell_cells, Repairs& repairs) {
  std::vector<std::uint8_t> open_part(solid.size(), 0);
  double whole_area = 0, open_area = 0;
  for (std::size_t p = 0; p < std::min(given_count, solid.size()); ++p) {
    const double area = double_area(surface.mesh, p).norm();
    open_part[p] = 1 - solid[p];
    whole_area += area;
    open_area += open_part[p] ? area : 0;
  }
  RawMesh result = extract(surface.mesh, solid);
  const auto count = static_cast<std::size_t>(std::count(open_part.begin(), open_part.end(), 1));
  if (count == 0) return result;
  if (open_area > kMinOpenAreaRatio * whole_area) {
    const Surface shell = pair_edges(winding_shell(extract(surface.mesh, open_part), shell_cells));
    if (!shell.mesh.polygons.empty()) {
      append(result, extract(shell.mesh, polygons_of_large_shells(shell)));
      repairs.record("faces enclosed in a winding-number shell", count);
      return result;
    }
  }
  repairs.record("open faces removed (too few to enclose a volume)", count);
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
  throw InputError(name + ": the mesh needs repairs, but repair is off: " + needed +
                   "; fix the mesh, or set repair to auto");
}

/// Returns the watertight solids of what tier 4 makes of a surface.
std::vector<PolygonMesh> make_solids(RawMesh mesh, double crease_cosine, Repairs& repairs) {
  repairs.record("faces triangulated because they are not planar", triangulate_curved(mesh), true);
  Surface surface = pair_edges(std::move(mesh));
  split_vertices(surface);
  repairs.record("vertices inserted into edges that a surface has twice",
                 divide_repeated_edges(surface));
  std::vector<std::uint32_t> solid;
  std::uint32_t count = 0;
  repairs.record("inverted shells flipped outward", orient_outward(surface, solid, count));
  return polygon_meshes(surface, solid, count, crease_cosine);
}

/// Returns true if solids pass through themselves so often that their inside is undefined.
bool is_tangled(const std::vector<PolygonMesh>& solids) {
  double volume_m3 = 0, inside_out_m3 = 0;
  for (const PolygonMesh& solid : solids) {
    volume_m3 += mass_properties(solid).volume_m3;
    inside_out_m3 += inside_out_volume(solid);
  }
  return inside_out_m3 > kMaxInsideOutRatio * volume_m3;
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
  Surface surface = orient_and_split(std::move(mesh), repairs);
  const std::size_t given_count = surface.mesh.polygons.size();
  surface = close(std::move(surface), repairs);
  const Repairs so_far = repairs;
  const auto solids = [&](const std::vector<std::uint8_t>& solid, std::uint32_t shell_cells) {
    RawMesh enclosed = enclose(surface, solid, given_count, shell_cells, repairs);
    if (enclosed.polygons.empty()) {
      throw InputError(name +
                       ": the mesh encloses no volume; close its holes, or give it thickness");
    }
    return make_solids(std::move(enclosed), options.crease_cosine, repairs);
  };
  result.shells = solids(solid_polygons(surface), options.shell_cells);
  if (!options.repair) refuse_repairs(repairs, name);
  if (is_tangled(result.shells)) {
    if (!options.repair) {
      throw InputError(name + ": the mesh intersects itself, but repair is off; fix the mesh, or " +
                       "set repair to auto");
    }
    repairs = so_far;
    result.shells =
        solids(std::vector<std::uint8_t>(surface.mesh.polygons.size(), 0), 2 * options.shell_cells);
  }
  result.repairs = std::move(repairs.list);
  return result;
}

}  // namespace sunder
