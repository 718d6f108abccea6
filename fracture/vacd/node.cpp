#include "fracture/vacd/node.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/mesh_islands.h"

namespace sunder::fracture {
namespace {

constexpr double kLeastShare = 1e-6;  // of a piece: smaller islands are not cut off
/// A cut that takes less of the slack than this is not worth much by itself; where the hull is also
/// looser than that, it is worth looking one cut further.
constexpr double kLittleGain = 0.25, kLoose = 0.1;
constexpr std::size_t kLookedAt = 6;  // cuts, one cut further

/// Appends the islands on the inner side of a plane; false if there is nothing, or a sliver.
bool add_side(const VacdPiece& piece, const Plane& plane, PlaneId id, double least_m3,
              std::vector<VacdPiece>& sides) {
  const double tolerance = region_tolerance(bounds(piece.region));
  VacdPiece side;
  ClipScratch clip_scratch;
  MeshClipScratch mesh_scratch;
  if (clip(piece.region, plane, id, tolerance, side.region, clip_scratch) != PlaneSide::kCut ||
      clip(piece.mesh, plane, id, tolerance, side.mesh, mesh_scratch) != PlaneSide::kCut) {
    return false;
  }
  for (PolygonMesh& island : islands(std::move(side.mesh))) {
    if (!(mass_properties(island).volume_m3 > least_m3)) return false;
    sides.push_back({side.region, std::move(island)});
  }
  return true;
}

/// The parts by a plane, or one a little aside if that leaves slivers; empty if all do.
std::vector<VacdNode> parts_by(const VacdNode& node, const Plane& plane, PlaneId id) {
  const double size = bounds(node.piece.mesh).extent().maxCoeff();
  const double least_m3 = kLeastShare * node.solid_m3;
  std::vector<VacdNode> parts;
  for (const double shift : {0.0, 1e-3, -1e-3, 5e-3, -5e-3}) {
    const Plane moved{plane.normal, plane.d + shift * size};
    std::vector<VacdPiece> sides;
    if (!add_side(node.piece, moved, id, least_m3, sides) ||
        !add_side(node.piece, moved.flipped(), id.opposite(), least_m3, sides)) {
      continue;
    }
    for (VacdPiece& side : sides) parts.push_back(make_node(std::move(side)));
    break;
  }
  return parts;
}

/// The volume of the parts' hulls once each is cut again.
double volume_one_further(const std::vector<VacdNode>& parts) {
  if (parts.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const VacdNode& part : parts) {
    const std::optional<Cut> cut = best_cut(part.piece.mesh, part.outline, Effort::kLittle);
    sum += cut ? std::min(part.hull_m3, cut->hull_volume_m3) : part.hull_m3;
  }
  return sum;
}

/// The parts that are smallest one cut further, of those by `best` and by some cuts through the
/// middle.
std::vector<VacdNode> look_further(const VacdNode& node, const Plane& best, PlaneId id) {
  std::vector<Cut> cuts = middle_cuts(node.piece.mesh, node.outline);
  cuts.resize(std::min(cuts.size(), kLookedAt));
  cuts.push_back({best, 0});
  std::vector<std::vector<VacdNode>> parts(cuts.size());
  std::vector<double> volume(cuts.size());
  for_chunks(cuts.size(), 1, [&](std::size_t c, std::size_t, std::size_t) {
    parts[c] = parts_by(node, cuts[c].plane, id);
    volume[c] = volume_one_further(parts[c]);
  });
  const auto least = std::min_element(volume.begin(), volume.end());
  return std::move(parts[static_cast<std::size_t>(least - volume.begin())]);
}

}  // namespace

VacdNode make_node(VacdPiece piece) {
  VacdNode node;
  node.outline = outline_of(piece.mesh);
  node.solid_m3 = mass_properties(piece.mesh).volume_m3;
  node.hull_m3 = std::max(node.solid_m3, node.outline.hull_m3);
  node.piece = std::move(piece);
  return node;
}

std::vector<VacdNode> cut_node(const VacdNode& node, PlaneId id) {
  const std::optional<Cut> cut = best_cut(node.piece.mesh, node.outline, Effort::kFull);
  if (!cut) return {};
  const bool stuck = node.hull_m3 - cut->hull_volume_m3 < kLittleGain * node.slack();
  if (stuck && node.slack() > kLoose * node.solid_m3) {
    return look_further(node, cut->plane, id);
  }
  return parts_by(node, cut->plane, id);
}

}  // namespace sunder::fracture
