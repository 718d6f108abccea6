// What solids are made of: how heavy, how strong, how they break and what they look like.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/index.h"
#include "engine/base/types.h"

namespace sunder {

/// The procedural texture of a face, evaluated in the rest frame of the solid.
enum class Texture : std::uint8_t { kPlain, kBrick, kConcrete, kPlaster, kWood, kGlass, kMetal };

struct Look {
  Texture texture = Texture::kPlain;
  Vec3f color = Vec3f(0.6f, 0.6f, 0.6f);  ///< Linear RGB albedo.
};

/// How a material's cells are laid out; see fracture/pattern.h for what each does.
struct PatternSpec {
  enum class Kind : std::uint8_t { kNone, kVoronoi, kWeb };
  Kind kind = Kind::kNone;
  int cells = 50;       ///< Voronoi: sites.
  double falloff = 2;   ///< Voronoi: 1 = uniform; larger packs sites towards the impact.
  int rings = 6;        ///< Web.
  int spokes = 12;      ///< Web.
  double jitter = 0.3;  ///< Web: 0 = regular.

  /// How many cells a pattern of this kind has, about: the unit that fracture budgets count.
  int cell_count() const { return kind == Kind::kWeb ? rings * spokes : cells; }
};

struct MaterialTag;
using MaterialIndex = Index<MaterialTag>;

struct Material {
  std::string name;
  double density_kg_m3 = 2000;
  double friction = 0.6;
  double restitution = 0;
  /// Least impulse of a contact that can break it.
  double strength_Ns = 0;
  /// Energy taken by each square metre of new crack (both sides counted once).
  double toughness_J_m2 = 0;
  /// kNone never breaks.
  PatternSpec pattern;
  /// Radius of the impact sphere (paper 3.2); infinity breaks the whole solid.
  double impact_radius_m = 1;
  /// Pieces below this volume no longer break.
  double smallest_break_m3 = 1e-3;
  Look surface;
  Look interior;

  bool breakable() const { return pattern.kind != PatternSpec::Kind::kNone; }
};

}  // namespace sunder
