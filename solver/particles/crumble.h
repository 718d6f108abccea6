// Fresh cracks crumble: debris and dust, uniformly on each face that a break laid bare.
#pragma once

#include <vector>

#include "engine/base/random.h"
#include "engine/model/particles.h"
#include "solver/particles/debris.h"
#include "solver/particles/dust.h"

namespace sunder::solver {

/// What debris and dust there is room for, of what faces would give: 0 to 1.
struct Shares {
  double debris = 1;
  double dust = 1;
};
Shares shares(std::span<const Emission> faces, const Debris& debris, const Dust& dust);

/// Adds what comes off a face (paper section 5: "uniformly on those faces with a user specified
/// sampling density and ratio"). The count is the density times the area, rounded up or down at
/// random, so that many small faces give as much as a large one. Where room is short each face
/// gives its share; the rest is ignored and counted so, and the dust that remains is heavier.
void crumble(const Emission& face, const Shares& shares, Random& random, Debris& debris,
             Dust& dust);

/// A chip that was a body turns up as it was, in a random shape.
void add_chip(const Chip& chip, Random& random, Debris& debris);

}  // namespace sunder::solver
