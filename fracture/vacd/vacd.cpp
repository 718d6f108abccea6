#include "fracture/vacd/vacd.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/base/trace.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/tuning.h"
#include "fracture/vacd/nodes.h"
#include "fracture/vacd/regions.h"
#include "fracture/vacd/tree.h"

namespace sunder::fracture {
namespace {

void check_options(const VacdOptions& options) {
  if (options.nodes.size() > kMostNodes || options.node_count.value_or(0) > kMostNodes ||
      options.convexes > kMostNodes) {
    throw InputError("a decomposition may have at most " + std::to_string(kMostNodes) +
                     " nodes and as many convexes; reduce their number");
  }
  for (const Vec3& node : options.nodes) {
    if (!node.allFinite()) throw InputError("a node has a coordinate that is not finite");
  }
}

/// Returns the pieces of all shells, with `count` automatic nodes unless there are nodes by hand.
std::vector<VacdPiece> all_pieces(const RepairedMesh& mesh, const VacdOptions& options,
                                  std::uint32_t count, PlaneIdAllocator& ids) {
  std::vector<VacdPiece> pieces;
  const std::vector<std::uint32_t> share = share_nodes(mesh.shells, count);
  for (std::size_t s = 0; s < mesh.shells.size(); ++s) {
    const PolygonMesh& shell = mesh.shells[s];
    const std::vector<Vec3> nodes =
        options.nodes.empty() ? automatic_nodes(shell, share[s]) : options.nodes;
    std::vector<VacdPiece> part = voronoi_pieces(shell, nodes, ids);
    for (VacdPiece& piece : part) piece.shell = static_cast<std::uint32_t>(s);
    std::move(part.begin(), part.end(), std::back_inserter(pieces));
  }
  return pieces;
}

/// Returns the least number of nodes that is tried: enough for pieces with few enough polygons, as
/// placing nodes is faster than cutting pieces one by one.
std::uint32_t nodes_by_default(const RepairedMesh& mesh, const VacdOptions& options) {
  std::size_t polygons = 0;
  for (const PolygonMesh& shell : mesh.shells) polygons += shell.faces.size();
  const double needed = kNodesPerFullPiece * static_cast<double>(polygons) / options.polygons;
  return std::clamp(static_cast<std::uint32_t>(std::min<double>(needed, kMostNodes)), kFewestNodes,
                    kMostNodes);
}

/// Returns pieces cut by nodes, if any, and refined by `convexes` and `polygons`.
std::vector<VacdPiece> cut_pieces(const RepairedMesh& mesh, const VacdOptions& options,
                                  PlaneIdAllocator& ids) {
  const auto shells = static_cast<std::uint32_t>(mesh.shells.size());
  const std::uint32_t limit = options.convexes;
  std::uint32_t count = options.node_count.value_or(shells);
  for (;;) {
    ids = {};
    std::vector<VacdPiece> pieces = all_pieces(mesh, options, count, ids);
    const auto made = static_cast<std::uint32_t>(pieces.size());
    const bool fewest = options.nodes.empty() && count <= shells;
    if (limit == 0 || made <= limit || fewest) {
      return refine(std::move(pieces), {limit, options.polygons, options.progress}, ids);
    }
    if (!options.nodes.empty()) {
      throw InputError("the nodes give " + std::to_string(made) + " convexes, more than the " +
                       std::to_string(limit) + " allowed; use fewer nodes, or allow more convexes");
    }
    count -= std::min(count - shells, made - limit);
  }
}

/// Removes pieces that are inside out or have no volume but rounding errors; returns the volume of
/// those that are inside out.
double drop_inside_out(const RepairedMesh& mesh, std::vector<VacdPiece>& pieces) {
  constexpr double kRounding = 1e-15;  // Least volume, over the cube of the mesh's diagonal.
  Box box;
  for (const PolygonMesh& shell : mesh.shells) box.extend(bounds(shell));
  const double size_m = box.extent().norm();
  const double least_m3 = kRounding * size_m * size_m * size_m;
  std::vector<double> volume(pieces.size());
  for_chunks(pieces.size(), 1, [&](std::size_t p, std::size_t, std::size_t) {
    volume[p] = mass_properties(pieces[p].mesh).volume_m3;
  });
  double dropped = 0;
  std::size_t kept = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (volume[p] > least_m3) {
      if (kept != p) pieces[kept] = std::move(pieces[p]);
      ++kept;
    } else {
      dropped += std::max(0.0, -volume[p]);
    }
  }
  pieces.resize(kept);
  return dropped;
}

/// Returns the material of most of a mesh's original surface; `otherwise` if it has none.
MaterialIndex material_of(const PolygonMesh& mesh, const VacdOptions& options,
                          MaterialIndex otherwise) {
  std::map<MaterialIndex, double> area_m2;
  const std::vector<MaterialIndex>& materials = options.materials_by_appearance;
  const std::size_t caps = materials.empty() ? 0 : first_cap(mesh);
  for (std::size_t f = 0; f < caps; ++f) {
    const std::size_t appearance = mesh.faces[f].appearance;
    const bool has_material = appearance > 0 && appearance <= materials.size();
    area_m2[has_material ? materials[appearance - 1] : options.material] += face_area(mesh, f);
  }
  const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto most = std::max_element(area_m2.begin(), area_m2.end(), less);
  return most == area_m2.end() ? otherwise : most->first;
}

bool is_textured(const PolygonMesh& mesh, const VacdOptions& options) {
  const std::vector<std::uint8_t>& textured = options.textured_by_appearance;
  return std::ranges::any_of(mesh.faces, [&](const PolygonMesh::Face& face) {
    return face.appearance > 0 && face.appearance <= textured.size() &&
           textured[face.appearance - 1];
  });
}

/// Returns a part per piece, fitted to its mesh, with the mesh unless the part renders alike.
std::vector<Part> fitted_parts(const RepairedMesh& mesh, std::vector<VacdPiece> pieces,
                               const VacdOptions& options) {
  std::vector<MaterialIndex> of_shells;
  for (const PolygonMesh& shell : mesh.shells) {
    of_shells.push_back(material_of(shell, options, options.material));
  }
  std::vector<Part> parts(pieces.size());
  for_chunks(pieces.size(), 1, [&](std::size_t p, std::size_t, std::size_t) {
    VacdPiece& piece = pieces[p];
    parts[p].polyhedron = fitted_region(piece, options.fit);
    parts[p].material = material_of(piece.mesh, options, of_shells[piece.shell]);
    if (piece.is_inside_mesh()) return;
    if (is_textured(piece.mesh, options) || !renders_like(parts[p].polyhedron, piece.mesh)) {
      parts[p].visual = std::make_shared<PolygonMesh>(std::move(piece.mesh));
    }
  });
  return parts;
}

/// Returns the distance from one plane up to which faces of different shells touch.
double touching_tolerance(const RepairedMesh& mesh) {
  constexpr double kTouching = 1e-7;
  Box box;
  for (const PolygonMesh& shell : mesh.shells) box.extend(bounds(shell));
  return kTouching * box.extent().maxCoeff();
}

VacdFigures measure(const Compound& compound, const RepairedMesh& mesh) {
  VacdFigures figures;
  figures.ghosts = compound.ghosts.size();
  for (const PolygonMesh& shell : mesh.shells) {
    figures.shell_volume_m3 += mass_properties(shell).volume_m3;
  }
  for (const ConvexPtr& convex : compound.convexes) {
    figures.hull_volume_m3 += mass_properties(convex->polyhedron).volume_m3;
    figures.max_faces_per_convex =
        std::max(figures.max_faces_per_convex,
                 convex->visual ? convex->visual->faces.size() : convex->polyhedron.faces.size());
  }
  return figures;
}

Vacd decompose_as_told(const RepairedMesh& mesh, const VacdOptions& options) {
  const Stopwatch watch;
  PlaneIdAllocator ids;
  std::vector<VacdPiece> pieces = cut_pieces(mesh, options, ids);
  const double inside_out_m3 = drop_inside_out(mesh, pieces);
  const double split_ms = watch.ms();
  std::vector<Part> parts = fitted_parts(mesh, std::move(pieces), options);
  Vacd result{make_compound(std::move(parts), touching_tolerance(mesh)), {}};
  const double total_ms = watch.ms();
  result.figures = measure(result.compound, mesh);
  result.figures.inside_out_m3 = inside_out_m3;
  result.figures.split_ms = split_ms;
  result.figures.total_ms = total_ms;
  return result;
}

}  // namespace

bool VacdFigures::has_tight_hulls() const { return hull_volume_ratio() <= kTightHulls; }

Vacd decompose(const RepairedMesh& mesh, const VacdOptions& options) {
  check_options(options);
  if (!options.chooses_nodes()) return decompose_as_told(mesh, options);
  VacdOptions chosen = options;
  chosen.node_count = nodes_by_default(mesh, options);
  Vacd best = decompose_as_told(mesh, chosen);
  double split_ms = best.figures.split_ms, total_ms = best.figures.total_ms;
  const auto slack = [](const Vacd& vacd) { return vacd.figures.hull_volume_ratio() - 1; };
  while (!best.figures.has_tight_hulls() && *chosen.node_count <= kMostChosenNodes / 2) {
    *chosen.node_count *= 2;
    Vacd next = decompose_as_told(mesh, chosen);
    split_ms += next.figures.split_ms, total_ms += next.figures.total_ms;
    if (!(slack(next) < kLeastTighter * slack(best))) break;
    best = std::move(next);
  }
  best.figures.split_ms = split_ms, best.figures.total_ms = total_ms;
  return best;
}

}  // namespace sunder::fracture
