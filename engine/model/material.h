// What solids are made of: how heavy, how strong, how they break and what they look like.
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

/// The procedural texture of a face, evaluated in the rest frame of the solid.
enum class Texture : std::uint8_t { kPlain, kBrick, kConcrete, kPlaster, kWood, kGlass, kMetal };

struct Look {
  Texture texture = Texture::kPlain;
  Vec3f color = Vec3f(0.6f, 0.6f, 0.6f);  ///< Linear RGB albedo.
};

/// What comes off a square metre of new crack surface, for the eye (paper section 5). None by
/// default. 0 < debris_smallest_m <= debris_largest_m.
struct Crumbling {
  double particles_per_m2 = 0;      ///< Debris and dust together.
  double debris_ratio = 0.2;        ///< Part of them that is debris; the rest is dust.
  double debris_smallest_m = 0.01;  ///< Radii follow a power law, N(> r) ~ r^-2, between these.
  double debris_largest_m = 0.06;   ///< The size below which pieces are no rigid bodies.
  double dust_kg_m2 = 0.02;         ///< Weighs on the air that carries it.
  double dust_settling_m_s = 0.05;  ///< Speed of fall in still air.
};

/// How a material's cells are laid out; see fracture/pattern/pattern.h for what each does.
struct PatternSpec {
  enum class Kind : std::uint8_t { kNone, kVoronoi, kWeb, kRadial, kBrick, kSlabs, kGrid, kFile };
  Kind kind = Kind::kNone;
  int cells = 50;       ///< Voronoi: sites; radial: sectors; slabs: how many; grid: a side.
  double falloff = 2;   ///< Voronoi: 1 = uniform; larger packs sites towards the impact.
  int rings = 6;        ///< Web.
  int spokes = 12;      ///< Web.
  double jitter = 0.3;  ///< Web, radial, slabs: 0 = regular.
  Vec3 brick_m = Vec3(0.24, 0.08, 0.12);  ///< Brick: its length, height and depth.
  std::string file;                       ///< File: an .obj of convex cells, one a group.
  int colors = 0;  ///< Cells are joined into this many pieces, 0: each its own.

  /// How many cells a pattern of this kind has, about: the unit that fracture budgets count.
  int cell_count() const {
    if (kind == Kind::kWeb) return rings * spokes;
    return kind == Kind::kGrid ? cells * cells * cells : cells;
  }
};

/// How a harder impact breaks a material.
struct StrongerImpact {
  double energy_J = 0;  ///< From this on.
  PatternSpec pattern;
  double impact_radius_m = 1;
};

struct MaterialTag;
using MaterialIndex = Index<MaterialTag>;

struct Material {
  std::string name;
  double density_kg_m3 = 2000;
  double friction = 0.6;
  double restitution = 0;
  /// Torque that resists rolling, over load and radius: a ball holds on slopes up to this.
  double rolling = 0;
  /// Obsolete: least impulse of a contact that can break it, in place of its limits of stress.
  std::optional<double> strength_Ns;
  /// Energy taken by each square metre of new crack (both sides counted once).
  double toughness_J_m2 = 0;
  /// kNone never breaks: nothing cuts its convexes, but what breaks beside them parts from them.
  PatternSpec pattern;
  /// Radius of the impact sphere (paper 3.2); infinity breaks the whole solid.
  double impact_radius_m = 1;
  /// In place of `pattern` and `impact_radius_m` for harder impacts, ascending by energy.
  std::vector<StrongerImpact> stronger;
  /// Stress that breaks the bonds between its convexes, own weight and slow load included; 0:
  /// never. Where two materials meet, the weaker decides.
  double tensile_Pa = 0;
  double shear_Pa = 0;
  double compressive_Pa = 0;
  /// Reinforcement against being driven through, per cent of the section each way in each face.
  double reinforcement_percent = 0;
  /// Stiffness: how convexes share a load between them.
  double youngs_Pa = 3e10;
  /// Stress at which it flows in place of breaking, where both sides of a bond do; 0: it does not.
  double yield_Pa = 0;
  double hardening_Pa = 0;  ///< By which that grows for each part of its length it was drawn out.
  double elongation = 0.2;  ///< The part of its length by which it is drawn out when it tears.
  /// How the convexes of a break are fitted to the visual meshes in them (paper 3.3).
  Fit fit;
  /// Obsolete: pieces below this volume no longer break. See smallest_broken_m3().
  std::optional<double> smallest_break_m3;
  /// Pieces below this volume are debris, no bodies: they would unsettle the solver (paper 5).
  double smallest_piece_m3 = 1e-6;
  Look surface;
  Look interior;
  Crumbling crumbling;

  bool breakable() const { return pattern.kind != PatternSpec::Kind::kNone; }
  bool yields() const { return yield_Pa > 0; }
  /// Speed of shear waves, √(E / 2.4 ρ): that of a Poisson's ratio of 0.2.
  double shear_wave_m_s() const { return std::sqrt(youngs_Pa / (2.4 * density_kg_m3)); }
  /// Infinite if no stress breaks it, or makes it flow.
  double weakest_Pa() const {
    double least = std::numeric_limits<double>::infinity();
    for (const double limit : {tensile_Pa, shear_Pa, compressive_Pa, yield_Pa})
      if (limit > 0 && limit < least) least = limit;
    return least;
  }
  /// The volume below which a piece does not break: halved three times, it would be debris.
  double smallest_broken_m3() const { return smallest_break_m3.value_or(8 * smallest_piece_m3); }
  /// Stress at which an impact breaks a convex where it strikes: thin ones bend. 0: any does.
  double impact_limit_Pa(bool is_thin) const {
    return is_thin && tensile_Pa > 0 ? tensile_Pa : compressive_Pa;
  }
  /// Stress of an elastic wave over the speed that it pushes at, √(E ρ).
  double impedance_Pa_s_m() const { return std::sqrt(youngs_Pa * density_kg_m3); }
  /// Strain energy that a solid of this volume holds at a limit of stress, σ² V / 2E. What flies
  /// against something rigid has it at the speed whose wave has that stress.
  double strain_energy_J(double limit_Pa, double volume_m3) const {
    return limit_Pa * limit_Pa * volume_m3 / (2 * youngs_Pa);
  }
  bool breaks_by_load() const { return weakest_Pa() < std::numeric_limits<double>::infinity(); }
};

/// Energy that a crack takes where two materials meet: each side pays for itself, unless only one
/// of them breaks.
inline double crack_J_m2(const Material& a, const Material& b) {
  if (a.breakable() != b.breakable()) return (a.breakable() ? a : b).toughness_J_m2;
  return 0.5 * (a.toughness_J_m2 + b.toughness_J_m2);
}

/// Stress at which a bond of two materials flows: the weaker's, or, on what no stress breaks, the
/// other's; 0: it breaks instead.
inline double yield_Pa(const Material& a, const Material& b) {
  if (!a.breaks_by_load()) return b.yield_Pa;
  return b.breaks_by_load() ? std::min(a.yield_Pa, b.yield_Pa) : a.yield_Pa;
}

}  // namespace sunder
