// Test fixture: bars of materials that yield, and their loads.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/random.h"
#include "fracture/pattern/voronoi.h"
#include "tests/fracture/frames.h"

namespace sunder::fracture {

inline constexpr double kYield_Pa = 2.5e8;

/// Returns steel twice: material 0 of the structure and material 1 of its foundation.
inline std::vector<Material> steel() {
  Material material;
  material.density_kg_m3 = 1e-3;
  material.youngs_Pa = 2e11;
  material.yield_Pa = kYield_Pa;
  return {material, material};
}

/// Returns a bar along x from 0 to `length_m`, of section `width_m`², in Voronoi cells; cells that
/// reach x = 0 are anchored.
inline Compound voronoi_bar_of(int cells, double length_m, double width_m, std::uint64_t seed) {
  Random random(seed, 5);
  const Vec3 high(length_m, width_m, width_m);
  std::vector<Vec3> sites;
  for (int i = 0; i < cells; ++i) {
    const double x = random.uniform(0, 1), y = random.uniform(0, 1);
    sites.push_back(high.cwiseProduct(Vec3(x, y, random.uniform(0, 1))));
  }
  std::vector<Plane> planes;
  for (int k = 0; k < 3; ++k) {
    planes.push_back(Plane::through(Vec3::Zero(), -Vec3::Unit(k)));
    planes.push_back(Plane::through(high, Vec3::Unit(k)));
  }
  std::vector<Part> parts;
  for (ConvexPolyhedron& cell : voronoi_cells(sites, make_box(Vec3::Zero(), high), planes)) {
    if (cell.empty()) continue;
    const bool fixed = bounds(cell).min.x() < 1e-9;
    parts.push_back({std::move(cell), MaterialIndex(fixed ? 1 : 0), fixed});
  }
  return make_compound(std::move(parts), 1e-9);
}

/// Returns equal forces on the convexes at the far end of a bar along x, at the end's middle.
inline std::vector<ConvexLoad> pull_at_end(const Compound& compound, const Vec3& force_N) {
  const Box box = bounds(compound);
  const Vec3 middle(box.max.x(), box.center().y(), box.center().z());
  std::vector<ConvexLoad> loads;
  for (std::uint32_t c = 0; c < compound.convexes.size(); ++c)
    if (compound.convexes[c]->box.max.x() > box.max.x() - 1e-9)
      loads.push_back({c, force_N, middle});
  for (ConvexLoad& load : loads) load.force_N /= static_cast<double>(loads.size());
  return loads;
}

/// Returns the index of the bond nearest to a point, among bonds of at least this |x| of normal.
inline std::uint32_t bond_at(const StressSystem& system, const Vec3& point_R, double facing_x = 0) {
  std::uint32_t best = 0;
  const auto distance = [&](std::uint32_t i) {
    const BondGeometry& g = system.geometry()[i];
    return (std::abs(g.normal_R.x()) < facing_x ? 1e9 : 0) + (g.centroid_R - point_R).norm();
  };
  for (std::uint32_t i = 0; i < system.geometry().size(); ++i)
    if (distance(i) < distance(best)) best = i;
  return best;
}

}  // namespace sunder::fracture
