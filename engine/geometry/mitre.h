// Mitre joints at bent sections: the two sides of the section are extended or clipped to the plane
// midway between them, without gap or overlap. Where the cross-section is constant and the plane
// goes through the section's centroid, the volume of each side stays the same.
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

/// cos 75°, the least cosine of half the angle of a bend. Larger bends get no mitre.
inline constexpr double kMinMitreCosine = 0.25881904510252074;

/// The end of one side of a section, in that side's rest frame.
struct SectionEnd {
  Vec3 centroid;
  /// Unit direction of the side edges, outward; without twist, face normals give the same plane.
  Vec3 along;
};

/// The plane midway between two sides, in the rest frame of each; each side lies inside its own
/// half-space. In A's frame the half-space of B is a.flipped(), bit for bit.
struct Midplane {
  Plane a, b;
};

/// Returns the plane midway between two ends; X_AB is the pose of B's rest frame in A's. None if
/// the bend is more than 150°, for which a mitre would be a spike.
std::optional<Midplane> midplane(const SectionEnd& a, const SectionEnd& b, const Pose& X_AB);

/// A convex of a column and the index of its face towards the section.
struct ColumnCell {
  const ConvexPolyhedron* convex = nullptr;
  std::uint32_t front = 0;
};

/// Scratch memory of mitre(), for reuse by one thread.
struct MitreScratch {
  ConvexPolyhedron extended, cut;
  ClipScratch clip;
};

/// Makes a column (convexes one behind the other, from the section on) end in its side's midplane.
/// Returns the index of the rearmost cell that the plane reaches: the caller replaces this cell by
/// `result` (the cell without its front face, extended or clipped to the plane), removes the cells
/// before it and keeps those behind it. So the column ends in one convex with all of its side
/// faces, and can be bent again. Returns none if the plane leaves nothing of the column.
///
/// Faces keep plane, id and kind bit for bit, and the shading normals of the nearest old corners.
/// The new face is the last and gets `id`; id and tolerance are those of clip(). Corners are
/// computed from planes, so rounding errors do not accumulate over bends. If the side faces diverge
/// too far to meet the plane nearby, the cell is only clipped and keeps the rest of its front.
std::optional<std::size_t> mitre(std::span<const ColumnCell> column, const Plane& midplane,
                                 PlaneId id, double tolerance_m, ConvexPolyhedron& result,
                                 MitreScratch& scratch);

/// Makes the visual mesh of a column's last convex end in the midplane: extrudes its caps with the
/// id `front` by `along` (unit, as given to midplane()) to beyond the plane, with flat kSurface
/// walls, and clips. Result, `id` and tolerance are those of clip(). Watertight if the mesh is.
PlaneSide mitre(const PolygonMesh& mesh, PlaneId front, const Vec3& along, const Plane& midplane,
                PlaneId id, double tolerance_m, PolygonMesh& result, MeshClipScratch& scratch);

}  // namespace sunder
