// A fracture event, whole or partial (paper 3.1 and 3.2), as five steps:
//
//   align      (align.h)         the pattern is moved onto the impact
//   intersect  (intersect.h)     convexes within reach are cut by its cells
//   weld       (weld.h)          covered cells become one convex
//   group      (fragments.h)     what lies in one cell, or colour, goes together; the rest stays
//   islands    (reassembly.h)    what no longer touches parts company
//
// Read first: break_structure(). Its cost depends on what the sphere touches alone.
#pragma once

#include "engine/model/breaker.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// What a pattern at its place does to a structure, which is left as it is.
BreakEdit break_structure(const Structure& structure, const Pattern& pattern,
                          const Placement& placement, const ImpactSphere& sphere,
                          std::uint64_t event, const Fit& fit = {});

/// Carries an edit out, and gives all there is then as pieces: what is left of the structure first.
BreakPlan as_pieces(Structure& structure, BreakEdit edit);

/// A break of a compound, as pieces: what is left of it first. Gives it back as it was, if
/// nothing came off. Islands that do not hang together (a compound given in may have several) break
/// each on its own, and are pieces in any case.
BreakPlan fracture(const Compound& compound, const Pattern& pattern, const Placement& placement,
                   const ImpactSphere& sphere, std::uint64_t event, const Fit& fit = {});

}  // namespace sunder::fracture
