// Materials of solids: density, strength, fracture pattern and appearance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// Procedural texture of a face, evaluated in the rest frame of the solid.
enum class Texture : std::uint8_t { kPlain, kBrick, kConcrete, kPlaster, kWood, kGlass, kMetal };

/// Appearance of a face.
struct Look {
  Texture texture = Texture::kPlain;
  Vec3f color = Vec3f(0.6f, 0.6f, 0.6f);  ///< Linear RGB albedo.
};

/// Debris and dust that come off new crack area (paper section 5); they do not affect bodies. None
/// by default. 0 < debris_smallest_m <= debris_largest_m.
struct DebrisEmission {
  double particles_per_m2 = 0;      ///< Number per area, debris and dust together.
  double debris_ratio = 0.2;        ///< Fraction of the particles that is debris; the rest is dust.
  double debris_smallest_m = 0.01;  ///< Least radius; radii follow a power law, N(> r) ~ r^-2.
  double debris_largest_m = 0.06;  ///< Largest radius; pieces below this size are not rigid bodies.
  double dust_kg_m2 = 0.02;        ///< Mass of dust per area, which loads the air that carries it.
  double dust_settling_m_s = 0.05;  ///< Settling velocity in still air.
};

/// Parameters of a fracture pattern; fracture/pattern/pattern.h describes each kind.
struct PatternSpec {
  /// Arrangement of the cells; kNone: unbreakable.
  enum class Kind : std::uint8_t { kNone, kVoronoi, kWeb, kRadial, kBrick, kSlabs, kGrid, kFile };
  Kind kind = Kind::kNone;
  /// Voronoi: number of sites; radial: of sectors; slabs: of slabs; grid: of cells per side.
  int cells = 50;
  double falloff = 2;   ///< Voronoi: 1 = uniform; larger values move sites towards the impact.
  int rings = 6;        ///< Web.
  int spokes = 12;      ///< Web.
  double jitter = 0.3;  ///< Web, radial, slabs: irregularity; 0 = regular.
  Vec3 brick_m = Vec3(0.24, 0.08, 0.12);  ///< Brick: length, height and depth.
  std::string file;                       ///< File: an .obj file of convex cells, one per group.
  int colors = 0;  ///< Number of pieces that cells are joined into; 0: each cell is a piece.

  /// Returns the approximate number of cells of the pattern, the unit of fracture budgets.
  int cell_count() const {
    if (kind == Kind::kWeb) return rings * spokes;
    return kind == Kind::kGrid ? cells * cells * cells : cells;
  }
};

/// Pattern and radius for impacts above an energy.
struct ImpactResponse {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  double energy_J = 0;                          ///< Least energy of the impact.
  PatternSpec pattern;
  double impact_radius_m = 1;
};

struct MaterialTag;
using MaterialIndex = Index<MaterialTag>;

/// Mechanical and visual properties of a solid.
struct Material {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  std::string name;
  double density_kg_m3 = 2000;
  double friction = 0.6;
  double restitution = 0;
  /// Coefficient of rolling resistance, torque over normal force and radius: a ball rests on slopes
  /// of up to this tangent.
  double rolling = 0;
  /// Obsolete: least contact impulse that can break the material; overrides its limits of stress.
  std::optional<double> strength_Ns;
  /// Energy per new crack area (the two sides of a crack count once).
  double toughness_J_m2 = 0;
  /// kNone: unbreakable, never cut; a break next to its convexes separates them at their bonds.
  PatternSpec pattern;
  /// Radius of the impact sphere (paper 3.2); infinity breaks the whole solid.
  double impact_radius_m = 1;
  /// Patterns for stronger impacts, ascending by energy, with their own radii.
  std::vector<ImpactResponse> stronger;
  /// Stress that breaks bonds between convexes, under self-weight and slow loads as well; 0:
  /// unlimited. A bond of two materials has the lower limit.
  double tensile_Pa = 0;
  double shear_Pa = 0;
  double compressive_Pa = 0;
  /// Reinforcement against perforation: per cent of the section, in each direction at each face.
  double reinforcement_percent = 0;
  /// Young's modulus; determines the distribution of load over convexes.
  double youngs_Pa = 3e10;
  /// Yield stress: a bond yields instead of breaking if both materials yield; 0: no yielding.
  double yield_Pa = 0;
  double hardening_Pa = 0;  ///< Increase of the yield stress per plastic strain.
  double elongation = 0.2;  ///< Plastic strain at which a yielding section tears.
  /// Rule for fitting new convexes to their visual meshes (paper 3.3).
  Fit fit;
  /// Obsolete: volume below which pieces do not break; see min_breakable_volume_m3().
  std::optional<double> smallest_break_m3;
  /// Volume below which pieces become debris: such bodies would destabilise the solver (paper 5).
  double smallest_piece_m3 = 1e-6;
  Look surface;
  Look interior;
  DebrisEmission crumbling;

  /// Returns true if impacts break the material.
  bool breakable() const { return pattern.kind != PatternSpec::Kind::kNone; }
  /// Returns true if the material bends before it tears.
  bool yields() const { return yield_Pa > 0; }
  /// Returns the speed of shear waves, √(E / 2.4 ρ), for a Poisson's ratio of 0.2.
  double shear_wave_m_s() const { return std::sqrt(youngs_Pa / (2.4 * density_kg_m3)); }
  /// Returns the least of the stress limits; infinite if there is none.
  double min_stress_limit_Pa() const {
    double least = std::numeric_limits<double>::infinity();
    for (const double limit : {tensile_Pa, shear_Pa, compressive_Pa, yield_Pa})
      if (limit > 0 && limit < least) least = limit;
    return least;
  }
  /// Returns the volume below which a piece does not break: eight times the smallest piece.
  double min_breakable_volume_m3() const {
    return smallest_break_m3.value_or(8 * smallest_piece_m3);
  }
  /// Returns the stress at which an impact breaks a convex at the point of impact: the tensile
  /// limit for thin convexes, which bend, else the compressive limit. 0: any stress.
  double impact_limit_Pa(bool is_thin) const {
    return is_thin && tensile_Pa > 0 ? tensile_Pa : compressive_Pa;
  }
  /// Returns the stress of an elastic wave over its particle velocity, √(E ρ).
  double impedance_Pa_s_m() const { return std::sqrt(youngs_Pa * density_kg_m3); }
  /// Returns the strain energy of a solid of this volume at a uniform stress, σ² V / 2E. That is
  /// the kinetic energy of the solid at the speed whose elastic wave has that stress.
  double strain_energy_J(double limit_Pa, double volume_m3) const {
    return limit_Pa * limit_Pa * volume_m3 / (2 * youngs_Pa);
  }
  /// Returns true if a stress limit is set, so that steady loads can break the material.
  bool breaks_by_load() const {
    return min_stress_limit_Pa() < std::numeric_limits<double>::infinity();
  }
};

/// Returns the crack energy per area between two materials: the mean, or the breakable one's.
inline double crack_energy_J_m2(const Material& a, const Material& b) {
  if (a.breakable() != b.breakable()) return (a.breakable() ? a : b).toughness_J_m2;
  return 0.5 * (a.toughness_J_m2 + b.toughness_J_m2);
}

/// Returns the yield stress of a bond of two materials: the lower one, or, if one of them cannot
/// break under stress, the other's. 0: the bond does not yield.
inline double yield_Pa(const Material& a, const Material& b) {
  if (!a.breaks_by_load()) return b.yield_Pa;
  return b.breaks_by_load() ? std::min(a.yield_Pa, b.yield_Pa) : a.yield_Pa;
}

}  // namespace sunder
