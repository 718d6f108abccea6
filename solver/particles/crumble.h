// Emission of debris and dust, uniformly on each face that a break has exposed.
#pragma once

#include "engine/base/random.h"
#include "engine/model/particles.h"
#include "solver/particles/debris.h"
#include "solver/particles/dust.h"

namespace sunder::solver {

/// Shares of the expected debris and dust of some faces that fit within the limits, 0 to 1.
struct CapacityShares {
  double debris = 1;
  double dust = 1;
};
CapacityShares capacity_shares(std::span<const ExposedPolygon> faces, const Debris& debris,
                               const Dust& dust);

/// Adds the debris and dust of one face (paper section 5: "uniformly on those faces with a user
/// specified sampling density and ratio"). The number of particles is the density times the area,
/// rounded up or down at random, so that many small faces give as many as a large one. Each
/// particle is kept with a probability of its share in `shares`; the others are counted as ignored.
/// Puffs of dust that are kept get heavier, so that the total mass stays.
void crumble(const ExposedPolygon& face, const CapacityShares& shares, Random& random,
             Debris& debris, Dust& dust);

/// Adds a chip in place of a body, with its motion and size, and a random shape and rotation.
void add_chip(const DebrisPiece& chip, Random& random, Debris& debris);

}  // namespace sunder::solver
