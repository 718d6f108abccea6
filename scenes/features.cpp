#include "scenes/features.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace sunder::scenes {
namespace {

constexpr const char* kOn = "on";

std::string on_or(bool on, const char* why) { return on ? kOn : std::string("off: ") + why; }

/// Returns the solids of a scene, and the chain links of its wrecking balls.
std::vector<const Solid*> solids_of(const Scene& scene) {
  std::vector<const Solid*> all;
  for (const Solid& solid : scene.solids) all.push_back(&solid);
  for (const Shot& shot : scene.shots)
    for (const Solid& link : shot.links) all.push_back(&link);
  return all;
}

template <class Predicate>
bool any_solid(const Scene& scene, const Predicate& is) {
  return std::ranges::any_of(solids_of(scene), [&](const Solid* solid) { return is(*solid); });
}

template <class Predicate>
bool any_convex(const Solid& solid, const Predicate& is) {
  return std::ranges::any_of(solid.compound.convexes,
                             [&](const ConvexPtr& convex) { return is(*convex); });
}

/// Returns true if the predicate holds for the material of a convex of the solid.
template <class Predicate>
bool is_made_of(const Scene& scene, const Solid& solid, const Predicate& is) {
  return any_convex(
      solid, [&](const Convex& convex) { return is(scene.materials[convex.material.value]); });
}

/// Returns true if the predicate holds for the material of a solid, a ball or a ground mesh.
template <class Predicate>
bool any_material(const Scene& scene, const Predicate& is) {
  const auto of_ball = [&](const Ball& ball) { return is(scene.materials[ball.material.value]); };
  const auto of_ground = [&](const GroundMesh& mesh) {
    return is(scene.materials[mesh.material.value]);
  };
  return any_solid(scene, [&](const Solid& solid) { return is_made_of(scene, solid, is); }) ||
         std::ranges::any_of(scene.balls, of_ball) ||
         std::ranges::any_of(scene.ground.meshes, of_ground) ||
         std::ranges::any_of(scene.shots, of_ball, &Shot::ball);
}

bool has_pattern(const Material& material) { return material.breakable(); }

/// Returns true if stress may break the solid, or pieces of it that have several convexes.
bool may_break_by_stress(const Scene& scene, const Solid& solid) {
  return (solid.compound.convexes.size() > 1 || is_made_of(scene, solid, has_pattern)) &&
         is_made_of(scene, solid, [](const Material& m) { return m.breaks_by_load(); });
}

bool breaks_by_pattern(const Scene& scene) {
  return any_solid(scene, [&](const Solid& s) { return is_made_of(scene, s, has_pattern); });
}
bool may_break_by_stress(const Scene& scene) {
  return any_solid(scene, [&](const Solid& solid) { return may_break_by_stress(scene, solid); });
}
bool may_break(const Scene& scene, const Solid& solid) {
  return is_made_of(scene, solid, has_pattern) || may_break_by_stress(scene, solid);
}
bool may_break(const Scene& scene) {
  return any_solid(scene, [&](const Solid& solid) { return may_break(scene, solid); });
}

std::string fracture_state(const Scene& scene) {
  return on_or(breaks_by_pattern(scene), "no material of a solid has a fracture pattern");
}
void without_fracture(Scene& scene) {
  for (Material& material : scene.materials) {
    material.pattern = {};
    material.stronger.clear();
  }
}

std::string impact_probe_state(const Scene& scene) {
  return on_or(may_break(scene), "no solid is breakable");
}

std::string stress_state(const Scene& scene) {
  return on_or(may_break_by_stress(scene),
               "no breakable solid has tensile_Pa, shear_Pa or compressive_Pa above 0");
}
/// Turns off all limits of stress: under self-weight, other loads, spin and impacts.
void without_stress(Scene& scene) {
  for (Material& material : scene.materials) {
    material.tensile_Pa = material.shear_Pa = material.compressive_Pa = material.yield_Pa = 0;
  }
}

std::string yielding_state(const Scene& scene) {
  const bool any = any_solid(scene, [&](const Solid& solid) {
    return may_break_by_stress(scene, solid) &&
           is_made_of(scene, solid, [](const Material& m) { return m.yields(); });
  });
  return on_or(any, "yield_Pa = 0 in every material of the solids");
}
void without_yielding(Scene& scene) {
  for (Material& material : scene.materials) material.yield_Pa = 0;
}

/// Returns the state of debris or dust. `limit` is the most particles alive at once,
/// `reason_for_none` the reason if that is 0, and `makes_particles` is true for a material whose
/// crack faces release this kind of particle.
std::string particles_state(const Scene& scene, std::uint32_t limit, const char* reason_for_none,
                            bool (*makes_particles)(const DebrisEmission&)) {
  if (limit == 0) return std::string("off: ") + reason_for_none;
  if (!may_break(scene)) return "off: no solid is breakable";
  const bool any = any_solid(scene, [&](const Solid& solid) {
    return may_break(scene, solid) && is_made_of(scene, solid, [&](const Material& material) {
             return material.crumbling.particles_per_m2 > 0 && makes_particles(material.crumbling);
           });
  });
  return on_or(any,
               "no material of a breakable solid emits these particles ([material.crumbling])");
}
std::string debris_state(const Scene& scene) {
  return particles_state(scene, scene.limits.debris, "debris = 0 in [limits]",
                         [](const DebrisEmission& c) { return c.debris_ratio > 0; });
}
std::string dust_state(const Scene& scene) {
  return particles_state(scene, scene.limits.dust, "dust = 0 in [limits]",
                         [](const DebrisEmission& c) { return c.debris_ratio < 1; });
}
void without_debris(Scene& scene) { scene.limits.debris = 0; }
void without_dust(Scene& scene) { scene.limits.dust = 0; }

std::string ageing_state(const Scene& scene) {
  return on_or(
      scene.limits.ageing > 0,
      "ageing = 0 in [limits], so that fragments become debris only at the limit of bodies");
}
void without_ageing(Scene& scene) { scene.limits.ageing = 0; }

std::string joints_state(const Scene& scene) {
  if (scene.planar) return "off: planar = true, and planar scenes have none";
  const bool hangs = std::ranges::any_of(
      scene.shots, [](const Shot& shot) { return shot.hangs_from_W.has_value(); });
  return on_or(hangs || !scene.joints.empty(), "there is no [[joint]] and no wrecking ball");
}
void without_joints(Scene& scene) {
  scene.joints.clear();
  for (Shot& shot : scene.shots) {
    shot.hangs_from_W.reset();
    shot.links.clear();
  }
}

std::string sleeping_state(const Scene& scene) { return scene.solver.sleeping ? kOn : "off"; }
void without_sleeping(Scene& scene) { scene.solver.sleeping = false; }

std::string continuous_state(const Scene& scene) {
  return on_or(!scene.planar, "planar = true, where steps are short enough to prevent tunnelling");
}

std::string friction_state(const Scene& scene) {
  return on_or(scene.ground.friction > 0 ||
                   any_material(scene, [](const Material& m) { return m.friction > 0; }),
               "friction = 0 everywhere");
}

std::string rolling_state(const Scene& scene) {
  if (scene.planar) return "off: planar = true, and Box2D has no rolling resistance";
  return on_or(any_material(scene, [](const Material& m) { return m.rolling > 0; }),
               "rolling = 0 in every material of the scene's bodies");
}
void without_rolling(Scene& scene) {
  for (Material& material : scene.materials) material.rolling = 0;
}

std::string restitution_state(const Scene& scene) {
  return on_or(scene.ground.restitution > 0 ||
                   any_material(scene, [](const Material& m) { return m.restitution > 0; }),
               "restitution = 0 in [ground] and in every material of the scene's bodies");
}
void without_restitution(Scene& scene) {
  scene.ground.restitution = 0;
  for (Material& material : scene.materials) material.restitution = 0;
}

std::string gradients_state(const Scene& scene) {
  if (scene.planar) return "off: planar = true, so Box2D solves";
  return on_or(scene.solver.sweeps >= 3, "sweeps in [solver] are fewer than 3");
}
void without_gradients(Scene& scene) { scene.solver.sweeps = 1; }

std::string ghosts_state(const Scene& scene) {
  return on_or(any_solid(scene, [](const Solid& s) { return !s.compound.ghosts.empty(); }),
               "no solid has convexes that overlap");
}

std::string visual_state(const Scene& scene) {
  const auto is_mesh = [](const Convex& convex) { return !convex.is_internal(); };
  return on_or(any_solid(scene, [&](const Solid& solid) { return any_convex(solid, is_mesh); }),
               "no solid has a visual mesh");
}

std::string script_state(const Scene& scene) {
  return on_or(!scene.shots.empty() || !scene.blasts.empty() || !scene.removals.empty() ||
                   !scene.drives.empty() || !scene.moves.empty(),
               "[script] is empty or disabled");
}

std::string third_dimension_state(const Scene& scene) {
  return on_or(!scene.planar, "planar = true, so Box2D simulates it");
}

constexpr Feature kFeatures[] = {
    {"fracture", fracture_state, without_fracture},
    {"impact_probe", impact_probe_state, nullptr},
    {"stress", stress_state, without_stress},
    {"yielding", yielding_state, without_yielding},
    {"debris", debris_state, without_debris},
    {"dust", dust_state, without_dust},
    {"ageing", ageing_state, without_ageing},
    {"joints", joints_state, without_joints},
    {"sleeping", sleeping_state, without_sleeping},
    {"continuous_collision", continuous_state, nullptr},
    {"friction", friction_state, nullptr},
    {"rolling_resistance", rolling_state, without_rolling},
    {"restitution", restitution_state, without_restitution},
    {"conjugate_gradients", gradients_state, without_gradients},
    {"ghosts", ghosts_state, nullptr},
    {"visual_meshes", visual_state, nullptr},
    {"script", script_state, nullptr},
    {"third_dimension", third_dimension_state, nullptr},
};

}  // namespace

std::span<const Feature> features() { return kFeatures; }

const Feature* find_feature(const std::string& name) {
  const auto* found = std::ranges::find(kFeatures, name, &Feature::name);
  return found == std::end(kFeatures) ? nullptr : found;
}

}  // namespace sunder::scenes
