#include "fracture/stress/open_overlap.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/roots.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/overlap.h"
#include "fracture/stress/strength.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Minimum thickness of an overlap or part, as a fraction of the cube root of the convex's volume.
/// Thinner ones are rounding errors.
constexpr double kMinRelativeThickness = 1e-9;

bool has_face(const Convex& convex, PlaneId id) {
  return std::ranges::any_of(convex.polyhedron.faces, [&](const auto& f) { return f.id == id; });
}

/// Returns true if a face of `polyhedron` lies in a face of the convex that encloses `polyhedron`.
bool lies_on_surface(const ConvexPolyhedron& polyhedron, std::size_t face,
                     const Convex& enclosing) {
  const double tolerance_m = kMinRelativeThickness * cube_root(enclosing.solid.volume_m3);
  return std::ranges::any_of(enclosing.polyhedron.faces, [&](const auto& other) {
    return std::ranges::all_of(polyhedron.face_corners(face), [&](std::uint32_t v) {
      return other.plane.distance(polyhedron.vertices[v]) > -tolerance_m;
    });
  });
}

/// The part of one convex's surface that lies inside another convex.
struct EmbeddedSurface {
  double area_m2 = 0;
  Vec3 vector_area_m2 = Vec3::Zero();  ///< Sum of area times outward normal.
};

EmbeddedSurface embedded_surface(const Convex& overlap, const Convex& embedded,
                                 const Convex& enclosing) {
  EmbeddedSurface all;
  for (std::uint32_t f = 0; f < overlap.polyhedron.faces.size(); ++f) {
    if (!has_face(embedded, overlap.polyhedron.faces[f].id)) continue;
    if (lies_on_surface(overlap.polyhedron, f, enclosing)) continue;
    const double area_m2 = face_area(overlap.polyhedron, f);
    all.area_m2 += area_m2;
    all.vector_area_m2 += area_m2 * overlap.polyhedron.faces[f].plane.normal;
  }
  return all;
}

/// Returns the surface along which two overlapping convexes separate, with normals out of `a`: the
/// smaller of the two embedded surfaces, or that of `a` if the materials differ, as the material of
/// `a` fills the overlap.
EmbeddedSurface separating_surface(const Convex& overlap, const Convex& a, const Convex& b) {
  const EmbeddedSurface of_a = embedded_surface(overlap, a, b);
  if (a.material != b.material) return of_a;
  const EmbeddedSurface of_b = embedded_surface(overlap, b, a);
  if (!(of_b.area_m2 > 0) || (of_a.area_m2 > 0 && of_a.area_m2 <= of_b.area_m2)) return of_a;
  return {of_b.area_m2, -of_b.vector_area_m2};
}

/// Returns the convexes that overlap a convex, ascending, each with true if their ghost counts in
/// sums of volume and mass.
std::vector<std::pair<ConvexSlot, bool>> partners(const Structure& structure, ConvexSlot slot) {
  std::vector<std::pair<ConvexSlot, bool>> found;
  for (const std::uint32_t ghost_index : structure.ghost_indices(slot)) {
    const Ghost& ghost = structure.ghost(ghost_index);
    if (ghost.of.size() != 2) continue;
    const std::uint32_t other = ghost.of[0] == slot.value ? ghost.of[1] : ghost.of[0];
    found.emplace_back(other, ghost.sign != 0);
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Returns the first convex after `slot` that overlaps `slot` and has another material; none() if
/// there is none. An overlap has the material of the convex in the lower slot, so that only the one
/// in the higher slot may be cut.
ConvexSlot next_of_other_material(const Structure& structure, ConvexSlot slot) {
  for (const auto& [other, counts_in_mass] : partners(structure, slot)) {
    if (counts_in_mass && other > slot &&
        structure.convex(other)->material != structure.convex(slot)->material)
      return other;
  }
  return {};
}

/// Returns the convex that is cut to open an overlap.
ConvexSlot choose_cut(const Structure& structure, ConvexSlot a, ConvexSlot b) {
  const auto volume = [&](ConvexSlot slot) { return structure.convex(slot)->solid.volume_m3; };
  if (volume(a) < volume(b) && next_of_other_material(structure, a).none()) return a;
  ConvexSlot last = b;
  for (ConvexSlot next = last; !next.none(); next = next_of_other_material(structure, last))
    last = next;
  return last;
}

}  // namespace

double overlap_utilisation(const Compound& compound, const Ghost& ghost, const Wrench& wrench,
                           std::span<const Material> materials) {
  const Convex &a = *compound.convexes[ghost.of[0]], &b = *compound.convexes[ghost.of[1]];
  const EmbeddedSurface surface = separating_surface(*ghost.convex, a, b);
  if (!(surface.area_m2 > 0)) return 0;
  const Strength strength = weaker_of(materials[a.material.value], materials[b.material.value]);
  const double section_m2 = surface.vector_area_m2.norm();
  // A square section of this area has the section modulus A^(3/2) / 6.
  const auto bending_Pa = [&](double area_m2) {
    return 6 * wrench.moment_Nm.norm() / (area_m2 * std::sqrt(area_m2));
  };
  if (section_m2 < kMaxThroughRatio * surface.area_m2) {
    return std::max(bending_Pa(surface.area_m2) / strength.compressive_Pa,
                    wrench.force_N.norm() / surface.area_m2 / strength.shear_Pa);
  }
  const Vec3 normal = surface.vector_area_m2 / section_m2;
  const double tension_N = normal.dot(wrench.force_N);
  const double shear_N = (wrench.force_N - tension_N * normal).norm();
  return std::max({(tension_N / section_m2 + bending_Pa(section_m2)) / strength.tensile_Pa,
                   (bending_Pa(section_m2) - tension_N / section_m2) / strength.compressive_Pa,
                   shear_N / surface.area_m2 / strength.shear_Pa});
}

BreakEdit open_overlap(const Structure& structure, ConvexSlot a, ConvexSlot b) {
  const ConvexSlot cut = choose_cut(structure, a, b);
  const Convex& old = *structure.convex(cut);
  const double thinnest_m = kMinRelativeThickness * cube_root(old.solid.volume_m3);
  // The other convex of the overlap; none() if a third convex is cut.
  const ConvexSlot other_of_overlap = cut == a ? b : cut == b ? a : ConvexSlot();

  // `uncounted`: convexes that stay connected to the parts by ghosts of sign 0, because one of the
  // two is a surface convex.
  std::vector<ConvexSlot> around, uncounted;
  std::vector<const ConvexPolyhedron*> others;
  for (const auto& [other, counts_in_mass] : partners(structure, cut)) {
    around.push_back(other);
    if (counts_in_mass) others.push_back(&structure.convex(other)->polyhedron);
    if (!counts_in_mass && other != other_of_overlap) uncounted.push_back(other);
  }
  for (const Link& link : structure.links(cut)) around.push_back(link.other);
  std::ranges::sort(around);
  around.erase(std::unique(around.begin(), around.end()), around.end());

  BreakEdit edit;
  edit.changed = true;
  edit.removed = {cut};
  if (others.empty()) {
    edit.added = {structure.convex(cut)};  // nothing to cut off: a new slot without the ghost
  } else {
    try {
      for (ConvexPolyhedron& part : subtract(old.polyhedron, others, thinnest_m))
        edit.added.push_back(make_convex(std::move(part), old.material, nullptr, old.X_RT));
    } catch (const InputError&) {  // too many parts
      return {};
    }
  }
  std::vector<ConvexPtr> convexes;
  for (const ConvexSlot slot : around) convexes.push_back(structure.convex(slot));
  const auto first_part = static_cast<std::uint32_t>(convexes.size());
  const auto slot_of = [&](std::uint32_t index) {
    return index < first_part ? around[index].value : structure.slot_count() + index - first_part;
  };
  for (const ConvexPtr& part : edit.added) {
    edit.added_anchors.push_back(inherited_anchors(structure.anchored(cut), old.box, part->box));
    convexes.push_back(part);
  }
  for (Bond bond : find_contacts(convexes)) {
    if (bond.b < first_part) continue;
    bond.a = slot_of(bond.a);
    bond.b = slot_of(bond.b);
    edit.bonds.push_back(bond);
  }
  for (std::uint32_t i = first_part; i < convexes.size(); ++i) {
    for (const ConvexSlot slot : uncounted) {
      ConvexPolyhedron common =
          overlap(convexes[i]->polyhedron, structure.convex(slot)->polyhedron, thinnest_m);
      if (common.empty()) continue;
      edit.ghosts.push_back(
          {make_convex(std::move(common), old.material), {slot.value, slot_of(i)}, 0});
    }
  }
  return edit;
}

}  // namespace sunder::fracture
