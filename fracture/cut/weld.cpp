#include "fracture/cut/weld.h"

#include <algorithm>
#include <cmath>

namespace sunder::fracture {
namespace {

constexpr double kRelativeTolerance = 1e-9;  // Relative tolerance of volumes and areas.

double surface_area(const ConvexPolyhedron& polyhedron) {
  double area = 0;
  for (std::size_t f = 0; f < polyhedron.faces.size(); ++f) area += face_area(polyhedron, f);
  return area;
}

/// Returns the area of a convex's faces that lie in faces of `whole`.
double area_on(const Convex& convex, const ConvexPolyhedron& whole) {
  double area = 0;
  for (std::size_t f = 0; f < convex.polyhedron.faces.size(); ++f) {
    const PlaneId id = convex.polyhedron.faces[f].id;
    const bool is_on = std::any_of(whole.faces.begin(), whole.faces.end(),
                                   [&](const auto& face) { return face.id == id; });
    if (is_on) area += face_area(convex.polyhedron, f);
  }
  return area;
}

}  // namespace

ConvexPtr weld(const AlignedPattern& pattern, const AlignedPattern::Cell& cell,
               std::span<const ConvexPtr> parts, std::span<const Ghost> ghosts) {
  double volume = 0;
  for (const ConvexPtr& part : parts) {
    if (!part->is_internal() || part->material != parts[0]->material ||
        !(part->X_RT == parts[0]->X_RT))
      return nullptr;
    volume += part->solid.volume_m3;
  }
  for (const Ghost& ghost : ghosts) volume += ghost.sign * ghost.convex->solid.volume_m3;
  if (!(std::abs(volume - cell.volume) <= kRelativeTolerance * cell.volume)) return nullptr;

  ConvexPolyhedron whole = pattern.polyhedron(cell);
  double boundary = 0;
  for (const ConvexPtr& part : parts) boundary += area_on(*part, whole);
  for (const Ghost& ghost : ghosts) boundary += ghost.sign * area_on(*ghost.convex, whole);
  const double area = surface_area(whole);
  if (std::abs(boundary - area) > kRelativeTolerance * area) return nullptr;
  return make_convex(std::move(whole), parts[0]->material, nullptr, parts[0]->X_RT);
}

}  // namespace sunder::fracture
