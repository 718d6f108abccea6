// Fracture of a structure by a pattern, whole or partial (paper 3.1 and 3.2), in five steps:
//
//   align      (align.h)         moves the pattern to the impact
//   intersect  (intersect.h)     cuts the convexes within reach by the cells of the pattern
//   weld       (weld.h)          replaces the parts that fill a cell by one convex
//   group      (fragments.h)     groups fragments by cell or colour; the rest keeps its group
//   islands    (reassembly.h)    makes each connected component of a group a piece
//
// Read first: break_structure(). Its cost depends only on the convexes that the sphere touches.
#pragma once

#include "engine/model/breaker.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// Returns the edit by which the placed pattern breaks a structure; the structure is not changed.
/// `event` is unique in a run and at least 1; the ids of new planes follow from it.
BreakEdit break_structure(const Structure& structure, const Pattern& pattern,
                          const Placement& placement, const ImpactSphere& sphere,
                          std::uint64_t event, const Fit& fit = {});

/// Applies an edit and returns all that is there then as pieces: the remaining structure first.
BreakPlan apply_edit(Structure& structure, BreakEdit edit);

/// Breaks a compound and returns its pieces, the remaining compound first; returns the compound
/// unchanged if nothing came off. A compound given in may have several islands: each of them breaks
/// separately and is a piece in any case.
BreakPlan fracture(const Compound& compound, const Pattern& pattern, const Placement& placement,
                   const ImpactSphere& sphere, std::uint64_t event, const Fit& fit = {});

}  // namespace sunder::fracture
