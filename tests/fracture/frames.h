// Test fixture: beams, portals and arches of convexes, with their stresses.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/base/trigonometry.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/stress/stress_breaks.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {

inline constexpr double kDensity = 2400, kGravity = 9.81;
inline const Vec3 kDown(0, -kGravity, 0);

/// Returns concrete as material 0, and a foundation that never breaks as material 1.
inline std::vector<Material> stone(double tensile_Pa = 0) {
  Material material;
  material.density_kg_m3 = kDensity;
  material.tensile_Pa = tensile_Pa;
  Material foundation = material;
  foundation.tensile_Pa = 0;
  return {material, foundation};
}

/// Appends the box [low, high] as nx × ny × nz convexes.
inline void add_grid(const Vec3& low, const Vec3& high, int nx, int ny, int nz, bool anchored,
                     std::vector<Part>& parts) {
  const Vec3 step = (high - low).cwiseQuotient(Vec3(nx, ny, nz));
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        const Vec3 from = low + step.cwiseProduct(Vec3(i, j, k));
        const Vec3 to = low + step.cwiseProduct(Vec3(i + 1, j + 1, k + 1));
        parts.push_back({make_box(from, to), MaterialIndex(anchored ? 1 : 0), anchored});
      }
    }
  }
}

/// Returns a bar along x from 0 to `length`, of square section `width`, in `along`·`across`² boxes.
/// The bar is anchored by one more layer before x = 0, and by one after its end if `held_twice`.
inline Compound bar(double length, double width, int along, int across, bool held_twice = false) {
  std::vector<Part> parts;
  const double dx = length / along;
  add_grid(Vec3(-dx, 0, 0), Vec3(0, width, width), 1, across, across, true, parts);
  add_grid(Vec3::Zero(), Vec3(length, width, width), along, across, across, false, parts);
  if (held_twice) {
    add_grid(Vec3(length, 0, 0), Vec3(length + dx, width, width), 1, across, across, true, parts);
  }
  return make_compound(std::move(parts));
}

inline BondStress worst_stress(const Compound& compound, const StressSystem& system,
                               const std::vector<Displacement>& displacements) {
  BondStress worst;
  for (std::uint32_t i = 0; i < compound.bonds.size(); ++i) {
    const BondStress stress = system.stress(compound, i, displacements);
    worst.tension_Pa = std::max(worst.tension_Pa, stress.tension_Pa);
    worst.compression_Pa = std::max(worst.compression_Pa, stress.compression_Pa);
    worst.shear_Pa = std::max(worst.shear_Pa, stress.shear_Pa);
  }
  return worst;
}

inline StressSystem system_of(const Compound& compound, const std::vector<Material>& materials) {
  std::vector<BondGeometry> geometry;
  for (const Bond& bond : compound.bonds) geometry.push_back(bond_geometry(compound, bond));
  return StressSystem(compound, std::move(geometry), materials);
}

/// Returns the maximum stresses under self-weight and loads, solved as in the simulation.
inline BondStress worst_stress(const Compound& compound, std::vector<ConvexLoad> loads = {},
                               const Vec3& gravity = kDown, double tolerance = 1e-3) {
  const StressSystem system = system_of(compound, stone());
  std::vector<Displacement> displacements;
  system.solve(loads, gravity, tolerance, 500, displacements);
  return worst_stress(compound, system, displacements);
}

}  // namespace sunder::fracture
