// Mitres: the two sides of a section that has bent end in the plane midway between them, as the
// sides of a picture frame do. No gap and no overlap is left, and a plane through the section's
// centroid takes from each side of constant cross-section what it gives to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/geometry/clip.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// cos 75°: of half the largest bend that a mitre is made of.
inline constexpr double kLeastCosine = 0.25881904510252074;

/// Where one side of a section ends, in that side's rest frame.
struct SectionEnd {
  Vec3 centroid;
  /// Unit, out of the side: the way its side edges run. Where neither side has twisted, normals of
  /// the section's faces give the same plane.
  Vec3 along;
};

/// A plane as two sides see it, each in its rest frame; each lies within its own. Once B has been
/// carried into A's frame, a.flipped() is its plane, bit for bit.
struct Midplane {
  Plane a, b;
};

/// The plane midway between two ends; B's rest frame has the pose X_AB in A's. Nothing where they
/// are bent by more than 150°: mitres would run to a point.
std::optional<Midplane> midplane(const SectionEnd& a, const SectionEnd& b, const Pose& X_AB);

/// A convex of a column and its face towards the section.
struct ColumnCell {
  const ConvexPolyhedron* convex = nullptr;
  std::uint32_t front = 0;
};

/// Reused memory of mitre(); one per thread.
struct MitreScratch {
  ConvexPolyhedron drawn, cut;
  ClipScratch clip;
};

/// Ends a column, convexes one behind the other from the section on, in its side's midplane. The
/// answer is the rearmost cell that the plane reaches: in its place comes `result`, which loses its
/// front and is drawn out, or clipped, to the plane; cells before it are gone and those behind it
/// stay as they are. So a column ends in one convex that has all its sides, ready to be bent again.
/// Nothing where the plane leaves nothing of the column.
///
/// Faces keep planes, names and kinds bit for bit, and the shading of their nearest corners; the
/// new one, the last, gets `id` as in clip(), whose tolerance this is. Corners follow from planes,
/// so bends do not add up rounding. Where sides flare by so much that they meet the plane only far
/// off, or never, the cell is clipped alone and keeps what is left of its front.
std::optional<std::size_t> mitre(std::span<const ColumnCell> column, const Plane& midplane,
                                 PlaneId id, double tolerance_m, ConvexPolyhedron& result,
                                 MitreScratch& scratch);

/// Ends the visual mesh of a column's last convex in the midplane. Its caps named `front` move
/// `along` (unit, as given to midplane()) to beyond that plane, with flat walls of the original
/// surface's kind where they passed, and clip() does the rest; its answers, `id` and tolerance
/// these are. Watertight if the mesh is.
PlaneSide mitre(const PolygonMesh& mesh, PlaneId front, const Vec3& along, const Plane& midplane,
                PlaneId id, double tolerance_m, PolygonMesh& result, MeshClipScratch& scratch);

}  // namespace sunder
