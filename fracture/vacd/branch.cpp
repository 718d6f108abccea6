#include "fracture/vacd/branch.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/mesh_islands.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Appends the islands on the inner side of a plane; returns false if there is none, or a sliver.
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
    sides.push_back({side.region, std::move(island), piece.shell});
  }
  return true;
}

/// Returns the parts by a plane, slightly shifted if that avoids slivers; none if all shifts fail.
std::vector<Branch> parts_by(const Branch& branch, const Plane& plane, PlaneId id) {
  const double size = bounds(branch.piece.mesh).extent().maxCoeff();
  const double least_m3 = kMinIslandVolume * branch.solid_m3;
  std::vector<Branch> parts;
  for (const double shift : kCutShifts) {
    const Plane moved{plane.normal, plane.d + shift * size};
    std::vector<VacdPiece> sides;
    if (!add_side(branch.piece, moved, id, least_m3, sides) ||
        !add_side(branch.piece, moved.flipped(), id.opposite(), least_m3, sides)) {
      continue;
    }
    for (VacdPiece& side : sides) parts.push_back(make_branch(std::move(side)));
    break;
  }
  return parts;
}

/// Returns the total hull volume of the parts after each is cut once more.
double volume_one_further(const std::vector<Branch>& parts) {
  if (parts.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const Branch& part : parts) {
    const std::optional<Cut> cut = best_cut(part.piece.mesh, part.outline, Effort::kLittle);
    sum += cut ? std::min(part.hull_m3, cut->hull_volume_m3) : part.hull_m3;
  }
  return sum;
}

/// Returns the parts with the least hull volume after one more cut, among those by `best` and by
/// several cuts through the middle.
std::vector<Branch> search_one_cut_further(const Branch& branch, const Plane& best, PlaneId id) {
  std::vector<Cut> cuts = middle_cuts(branch.piece.mesh, branch.outline);
  cuts.resize(std::min(cuts.size(), kFurtherCuts));
  cuts.push_back({best, 0});
  std::vector<std::vector<Branch>> parts(cuts.size());
  std::vector<double> volume(cuts.size());
  for_chunks(cuts.size(), 1, [&](std::size_t c, std::size_t, std::size_t) {
    parts[c] = parts_by(branch, cuts[c].plane, id);
    volume[c] = volume_one_further(parts[c]);
  });
  const auto least = std::min_element(volume.begin(), volume.end());
  return std::move(parts[static_cast<std::size_t>(least - volume.begin())]);
}

}  // namespace

Branch make_branch(VacdPiece piece) {
  Branch branch;
  branch.outline = outline_of(piece.mesh);
  branch.solid_m3 = mass_properties(piece.mesh).volume_m3;
  branch.hull_m3 = std::max(branch.solid_m3, branch.outline.hull_m3);
  branch.piece = std::move(piece);
  return branch;
}

std::vector<Branch> cut_branch(const Branch& branch, PlaneId id) {
  const std::optional<Cut> cut = best_cut(branch.piece.mesh, branch.outline, Effort::kFull);
  if (!cut) return {};
  const bool stuck = branch.hull_m3 - cut->hull_volume_m3 < kLittleCutGain * branch.slack();
  if (stuck && branch.slack() > kLooseSlack * branch.solid_m3) {
    return search_one_cut_further(branch, cut->plane, id);
  }
  return parts_by(branch, cut->plane, id);
}

}  // namespace sunder::fracture
