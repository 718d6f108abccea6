#include "engine/world/actors/make_actor.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/base/roots.h"
#include "engine/model/piece_mesh.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

/// Returns true if stress in its bonds may break an actor.
bool breaks_by_load(const WorldState& world, const Actor& actor) {
  if (actor.structure.size() < 2) return false;
  return std::ranges::any_of(actor.materials, [&](MaterialIndex material) {
    return world.material(material).breaks_by_load();
  });
}

/// Returns true if contact forces and impacts load the bonds of an actor. Small fragments of
/// brittle materials are checked for stress by spin only.
bool reports_contact_loads(const WorldState& world, const Actor& actor) {
  if (!actor.stress.breakable) return false;
  const bool is_fragment = actor.key != actor.root_key && !actor.is_static;
  return !is_fragment || actor.structure.size() >= world.scene.limits.loaded_convexes ||
         std::ranges::any_of(actor.materials, [&](MaterialIndex material) {
           return world.material(material).yields();
         });
}

/// Returns the squared angular speed at which ρω²r² at the farthest point equals the lowest stress
/// limit.
double burst_omega2_s2_of(const WorldState& world, const Actor& actor) {
  double min_stress_limit_Pa = std::numeric_limits<double>::infinity(), density_kg_m3 = 0,
         reach_m = 0;
  for (const MaterialIndex index : actor.materials) {
    const Material& material = world.material(index);
    density_kg_m3 = std::max(density_kg_m3, material.density_kg_m3);
    min_stress_limit_Pa = std::min(min_stress_limit_Pa, material.min_stress_limit_Pa());
  }
  actor.structure.for_each([&](ConvexSlot, const Convex& convex) {
    const Vec3 low = actor.weight.com_R - convex.box.min,
               high = convex.box.max - actor.weight.com_R;
    reach_m = std::max(reach_m, low.cwiseMax(high).norm());
  });
  return min_stress_limit_Pa / (density_kg_m3 * reach_m * reach_m);
}

/// Returns true if impacts do not break a material by stress, as the actor has too many bonds.
bool exceeds_impact_bonds(const WorldState& world, const Actor& actor, const Material& material) {
  return material.breakable() && actor.structure.bond_count() > world.scene.limits.impact_bonds;
}

std::vector<MaterialIndex> materials_of(const Compound& compound) {
  std::vector<MaterialIndex> all;
  for (const ConvexPtr& convex : compound.convexes) {
    const auto is_it = [&](MaterialIndex known) { return known.value == convex->material.value; };
    if (std::ranges::none_of(all, is_it)) all.push_back(convex->material);
  }
  return all;
}

/// Returns true if one of a structure's convexes is a plate or shell, or is assumed to be.
bool has_thin_convex(const Structure& structure) {
  bool found = structure.size() > kMaxThinChecks;
  if (!found)
    structure.for_each([&](ConvexSlot, const Convex& convex) { found = found || is_thin(convex); });
  return found;
}

/// Returns the shape of an actor that is a ball.
ShapeDesc ball_shape(const WorldState& world, const Actor& actor) {
  const Material& material = world.material(actor.materials[0]);
  ShapeDesc shape;
  shape.kind = ShapeDesc::Kind::kSphere;
  shape.radius_m = ball_radius_m(actor.volume_m3);
  shape.friction = material.friction;
  shape.restitution = material.restitution;
  shape.rolling = material.rolling;
  return shape;
}

}  // namespace

double reached_m3(const Material& material, double volume_m3) {
  const double radius_m = material.impact_radius_m;
  return std::min(volume_m3, 4.2 * radius_m * radius_m * radius_m);
}

void set_least(const WorldState& world, Actor& actor) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  actor.least_J = actor.least_Ns = actor.least_m_s = actor.least_slow_J = kNever;
  actor.stress.least_J = std::numeric_limits<double>::infinity();
  actor.stress.least_Ns = 0;
  if (actor.is_kinematic || actor.structure.empty()) return;  // balls do not break
  const bool may_bend = has_thin_convex(actor.structure);
  for (const MaterialIndex index : actor.materials) {
    const Material& material = world.material(index);
    const double least_m3 = world.smallest_piece_factor * material.min_breakable_volume_m3();
    if (!material.breakable() || actor.volume_m3 < least_m3) continue;
    const double reach_m3 = reached_m3(material, actor.volume_m3);
    const double crack_m2 = kMinCrackArea * cube_root(reach_m3 * reach_m3);
    actor.least_J = std::min(actor.least_J, material.toughness_J_m2 * crack_m2);
    double limit_Pa = material.impact_limit_Pa(false);
    if (may_bend) limit_Pa = std::min(limit_Pa, material.impact_limit_Pa(true));
    actor.least_Ns = std::min(actor.least_Ns, limit_Pa > 0 ? 0 : material.strength_Ns.value_or(0));
    const double limit_m_s = (may_bend ? kFlatLanding : 1) * limit_Pa / material.impedance_Pa_s_m();
    actor.least_m_s = std::min(actor.least_m_s, material.strength_Ns ? 0 : limit_m_s);
    actor.least_slow_J = std::min(actor.least_slow_J, material.strain_energy_J(limit_Pa, reach_m3));
  }
  if (!reports_contact_loads(world, actor)) return;
  const double convex_m3 = actor.volume_m3 / static_cast<double>(actor.structure.size());
  for (const MaterialIndex index : actor.materials) {
    const Material& material = world.material(index);
    if (!material.breaks_by_load()) continue;
    if (exceeds_impact_bonds(world, actor, material)) continue;
    // The least strain energy of a block with stress σ at a corner is σ²V / (14 E): the stress is
    // shared between tension and bending about both axes.
    const double limit_Pa = material.min_stress_limit_Pa();
    actor.stress.least_J =
        std::min(actor.stress.least_J, limit_Pa * limit_Pa / (14 * material.youngs_Pa) * convex_m3);
  }
}

void count_limits(WorldState& world, const Actor& actor) {
  if (!actor.stress.breakable) return;
  LimitsHit& limits = world.log.report.limits;
  if (!reports_contact_loads(world, actor)) {
    ++limits[Limit::kLoadedConvexes];
  } else if (std::ranges::any_of(actor.materials, [&](MaterialIndex index) {
               const Material& material = world.material(index);
               return material.breaks_by_load() && exceeds_impact_bonds(world, actor, material);
             })) {
    ++limits[Limit::kImpactBonds];
  }
}

Actor make_actor(WorldState& world, const Compound& compound) {
  return make_actor(world, compound, Structure(compound));
}

Actor make_actor(WorldState& world, const Compound& compound, Structure structure) {
  Actor actor;
  actor.key = actor.root_key = actor.last_frame_key = world.actors.new_key();
  actor.structure = std::move(structure);
  actor.is_static = actor.structure.is_anchored();
  actor.weight = mass_of(compound, *world.materials);
  actor.volume_m3 = volume(compound);
  actor.materials = materials_of(compound);
  actor.born_step = world.clock.step;
  set_strength(world, actor);
  return actor;
}

void set_strength(const WorldState& world, Actor& actor) {
  actor.stress = {};
  actor.stress.breakable = !actor.is_kinematic && breaks_by_load(world, actor);
  actor.stress.since_step = world.clock.step;
  if (actor.stress.breakable && !actor.is_static)
    actor.stress.burst_omega2_s2 = burst_omega2_s2_of(world, actor);
  set_least(world, actor);
}

ShapeDesc shape_of(const WorldState& world, const Actor& actor, ConvexSlot slot) {
  const Convex& convex = *actor.structure.convex(slot);
  const Material& material = world.material(convex.material);
  ShapeDesc shape;
  shape.hull = &convex.polyhedron;
  shape.friction = material.friction;
  shape.restitution = material.restitution;
  shape.rolling = material.rolling;
  shape.tag = slot.value;
  return shape;
}

BodyDesc make_body_desc(const WorldState& world, const Actor& actor, const Motion& motion) {
  BodyDesc body;
  body.com_R = actor.weight.com_R;
  body.X_WB = {motion.X_WR * actor.weight.com_R, motion.X_WR.rotation};
  body.is_static = actor.is_static && !actor.is_kinematic;
  body.is_kinematic = actor.is_kinematic;
  body.mass_kg = actor.weight.mass_kg;
  body.inertia_B = actor.weight.inertia_R;
  if (!body.is_static) {
    body.angular_velocity_W = motion.field.angular_velocity_W;
    body.velocity_W = motion.field(body.X_WB.position);
  }
  actor.structure.for_each(
      [&](ConvexSlot slot, const Convex&) { body.shapes.push_back(shape_of(world, actor, slot)); });
  if (actor.structure.empty()) body.shapes = {ball_shape(world, actor)};
  body.tag = actor.key;
  body.filter = actor.filter;
  body.reports_load = reports_contact_loads(world, actor);
  return body;
}

double move_actor(WorldState& world, const Actor& actor, const BodyState& state) {
  const double before_J = kinetic_J(actor, world.physics->state(actor.body));
  world.physics->set_state(actor.body, state);
  return kinetic_J(actor, world.physics->state(actor.body)) - before_J;
}

double push_actor(WorldState& world, const Actor& actor, const Vec3& impulse_W,
                  const Vec3& point_W) {
  const double before_J = kinetic_J(actor, world.physics->state(actor.body));
  world.physics->apply_impulse(actor.body, impulse_W, point_W);
  return kinetic_J(actor, world.physics->state(actor.body)) - before_J;
}

void remake_body(WorldState& world, Actor& actor) {
  const Motion motion = motion_of(actor, world.physics->state(actor.body));
  const BodyDesc body = make_body_desc(world, actor, motion);
  actor.body = world.physics->replace(std::span(&actor.body, 1), std::span(&body, 1))[0];
  world.joints.reattach(*world.physics, actor);
}

void add_compounds(WorldState& world, std::span<const Solid> solids) {
  std::vector<Structure> structures;
  for (const Solid& solid : solids) structures.emplace_back(solid.compound);
  add_compounds(world, solids, std::move(structures));
}

void add_compounds(WorldState& world, std::span<const Solid> solids,
                   std::vector<Structure> structures) {
  std::vector<Actor> actors;
  std::vector<BodyDesc> bodies;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Solid& solid = solids[i];
    Actor& actor = actors.emplace_back(make_actor(world, solid.compound, std::move(structures[i])));
    actor.filter = solid.filter;
    actor.user_data = solid.user_data;
    count_limits(world, actor);
    const Vec3 com_W = solid.X_WR * actor.weight.com_R;
    bodies.push_back(make_body_desc(
        world, actor, {solid.X_WR, {com_W, solid.velocity_W, solid.angular_velocity_W}}));
  }
  world.meshes.add_to(actors, {});
  const std::vector<BodyId> ids = world.physics->replace({}, bodies);
  for (std::size_t i = 0; i < actors.size(); ++i) {
    actors[i].body = ids[i];
    world.actors.add(std::move(actors[i]));
  }
}

void add_ball(WorldState& world, const Ball& ball) {
  const double radius = ball.radius_m;
  Actor actor;
  actor.key = actor.root_key = actor.last_frame_key = world.actors.new_key();
  actor.volume_m3 = ball_volume_m3(radius);
  actor.weight.mass_kg = ball_mass_kg(ball, *world.materials);
  actor.weight.inertia_R = 0.4 * actor.weight.mass_kg * radius * radius * Mat3::Identity();
  actor.materials = {ball.material};
  actor.filter = ball.filter;
  actor.user_data = ball.user_data;
  actor.born_step = world.clock.step;
  actor.meshes = {world.meshes.add(make_ball_mesh(radius, ball.material))};

  const BodyDesc body = make_body_desc(
      world, actor,
      {{ball.center_W, Quat::Identity()}, {ball.center_W, ball.velocity_W, Vec3::Zero()}});
  actor.body = world.physics->replace({}, std::span(&body, 1))[0];
  world.actors.add(std::move(actor));
}

}  // namespace sunder
