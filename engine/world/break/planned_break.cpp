#include "engine/world/break/planned_break.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/base/trace.h"
#include "engine/world/actors/load_case.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/actors/replace.h"
#include "engine/world/break/striker.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

/// Returns the fracture energy of the new crack surface; each crack has two sides.
double crack_energy_J(const WorldState& world, const BreakEdit& edit) {
  double energy = 0;
  for (const ExposedFace& face : edit.loose.exposed) {
    energy += 0.5 * face.area_m2 * world.material(face.material).toughness_J_m2;
  }
  return energy;
}

double crack_energy_J(const WorldState& world, const Structure& structure,
                      std::span<const Bond> cut) {
  const auto material = [&](std::uint32_t slot) -> const Material& {
    return world.material(structure.convex(ConvexSlot(slot))->material);
  };
  double energy = 0;
  for (const Bond& bond : cut)
    energy += bond.area_m2 * crack_energy_J_m2(material(bond.a), material(bond.b));
  return energy;
}

/// Returns true if a plan by stress breaks bonds or makes hinges.
bool breaks_or_bends(const BreakEdit& by_stress) {
  return !by_stress.cut.empty() || !by_stress.hinges.empty();
}

double area_m2(const PlannedBreak& planned) {
  if (!planned.at_bonds) return planned.edit.loose.new_area_m2;
  double area = 0;
  for (const Bond& bond : planned.edit.cut) area += bond.area_m2;
  return area;
}

/// Returns true if the solid breaks at the point of impact before load reaches the rest of it: the
/// energy suffices, and the impact is too fast for waves to carry the load away.
bool breaks_locally(const WorldState& world, const Structure& structure,
                    const PlannedBreak& planned) {
  if (!planned.by_pattern || !planned.edit.changed ||
      planned.along_normal_J() >= planned.impact.energy_J)
    return false;
  const Convex& convex = *structure.convex(planned.impact.convex);
  return planned.command.plug ||
         breaks_before_waves_arrive(world.material(convex.material), planned.speed_m_s);
}

/// Reduces the load of a fast and narrow striker on the rest of the solid to the impulse that is
/// transmitted before the solid is sheared around the striker: J = τ A e / c, the shear strength τ
/// on the sides A of the plug until the shear wave has passed the thickness e. Returns false if
/// that impulse cannot overload a bond.
bool reduce_to_transmitted(const WorldState& world, const Actor& actor, PlannedBreak& planned) {
  if (!planned.command.plug) return true;
  const Plug& plug = *planned.command.plug;
  const Material& material =
      world.material(actor.structure.convex(planned.impact.convex)->material);
  const double through_Ns =
      material.shear_Pa * plug.sides_m2 * plug.solid_m / material.shear_wave_m_s();
  const double share = std::min(1.0, through_Ns / planned.impulse_Ns);
  // The first mode of a bar of rectangular section that moves at v has the stress √3 ρ c v.
  const double speed_m_s = share * planned.impulse_Ns / actor.weight.mass_kg;
  const double most_Pa =
      kStressBoundFactor * std::sqrt(3 * material.youngs_Pa * material.density_kg_m3) * speed_m_s;
  if (most_Pa < material.min_stress_limit_Pa()) return false;
  for (AppliedForce& load : planned.impulses) load.force_N *= share, load.torque_Nm *= share;
  planned.impulse_Ns *= share;
  planned.transmitted_J = share * share * planned.impact.energy_J;
  return true;
}

/// Chooses the mode of break that would come first if the impact grew from zero: by pattern at the
/// share of the energy at which its local part suffices for the cracks, or by stress at the share
/// at which a bond is overloaded. Overload within the reach of the pattern counts for the pattern.
void choose_break_mode(const WorldState& world, const Structure& structure, PlannedBreak& planned) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const ImpulsiveStress& impulsive_stress = planned.stressed.impulsive_stress;
  const double overloads = 1 / (impulsive_stress.worst * impulsive_stress.worst),
               energy_J = planned.impact.energy_J;
  double by_pattern = kNever;
  double by_stress = breaks_or_bends(planned.stressed.edit) ? overloads : kNever;
  if (planned.edit.changed) {
    by_pattern = planned.needed_J / (impulsive_stress.local * energy_J);
    const double distance_m = (impulsive_stress.worst_R - planned.command.X_RP.position).norm();
    if (by_pattern < 1 && distance_m < planned.command.radius_m) by_stress = kNever;
  }
  planned.at_bonds = by_stress < by_pattern;
  planned.breaks = std::min(by_pattern, by_stress) < 1;
  if (!planned.breaks || !planned.at_bonds) return;
  planned.edit = std::move(planned.stressed.edit);
  planned.needed_J = crack_energy_J(world, structure, planned.edit.cut);
  if (std::isfinite(planned.transmitted_J))
    planned.needed_J = std::min(planned.needed_J, kMaxStressBreakShare * energy_J);
  planned.crushing_J = 0;
}

/// Gives the heaviest piece, which is left around a hole, the step in which its solid came off, so
/// that others can break it in this step.
void keep_born_step(WorldState& world, std::span<const std::uint64_t> pieces,
                    std::uint64_t born_step) {
  Actor* rest = nullptr;
  for (const std::uint64_t key : pieces) {
    Actor* piece = world.actors.find(static_cast<std::uint32_t>(key));
    if (!rest || piece->weight.mass_kg > rest->weight.mass_kg) rest = piece;
  }
  if (rest) rest->born_step = born_step;
}

/// Returns the distance from the point of impact to the farthest corner of the section.
double reach_of(const StructureImpact& hit) {
  double reach_m = 0;
  for (const Vec3& corner : hit.section_R)
    reach_m = std::max(reach_m, (corner - hit.point_R).norm());
  return reach_m;
}

/// Returns the direction of a striker's path through the solid: that of its relative velocity, or
/// the contact normal if the striker glances.
Vec3 path_of(const PlannedBreak& planned) {
  const Vec3& path_m_s_W = planned.path_m_s_W;
  const double along_m_s = path_m_s_W.dot(planned.impact.direction_W);
  return along_m_s > kMinPathCosine * path_m_s_W.norm() ? Vec3(path_m_s_W.normalized())
                                                        : planned.impact.direction_W;
}

/// Adds the striker's section, mass and speed to a hit, and the thickness of the actor along a
/// path.
void add_striker(const WorldState& world, const PlannedBreak& planned, const Actor& actor,
                 const Pose& X_WB, const Vec3& path_W, StructureImpact& hit) {
  const Actor* striker = world.actors.find(planned.striker);
  const ActorImpact& impact = planned.impact;
  const Material& material = world.material(actor.structure.convex(impact.convex)->material);
  if (!striker || !breaks_before_waves_arrive(material, planned.speed_m_s)) return;
  std::vector<const Actor*> strikers = {striker};
  double mass_kg = striker->weight.mass_kg;
  for (const std::uint32_t rider : planned.riders) {
    strikers.push_back(world.actors.find(rider));
    mass_kg += strikers.back()->weight.mass_kg;
  }
  const std::vector<Vec3> section_W =
      cross_section(world, strikers, impact.point_W, path_W, material.impact_radius_m);
  for (const Vec3& corner : section_W)
    hit.section_R.push_back(X_WB.inverse() * corner + actor.weight.com_R);
  if (hit.section_R.empty()) return;
  double widest_m = 0;
  for (const Vec3& a : hit.section_R)
    for (const Vec3& b : hit.section_R) widest_m = std::max(widest_m, (a - b).norm());
  hit.direction_R = X_WB.rotation.conjugate() * path_W;
  hit.narrow = widest_m <= 2 * material.impact_radius_m;
  hit.speed_m_s = planned.speed_m_s;
  // The work of the load includes that of other strikers; that of the striker leaves out riders at
  // a distance.
  hit.energy_J = planned.striker_J;
  hit.striker_kg = 2 * planned.striker_J / (planned.speed_m_s * planned.speed_m_s);
  if (!planned.riders.empty()) {
    hit.striker_kg = mass_kg;
    hit.energy_J = 0.5 * mass_kg * hit.speed_m_s * hit.speed_m_s;
  }
  hit.held = actor.is_static;
  const double most_m = kMaxPerforatedReaches * reach_of(hit);
  hit.thickness_m =
      thickness_behind(actor.structure, hit.section_R, hit.point_R, hit.direction_R, most_m);
  if (!(hit.thickness_m > 0)) {  // the mean of several contacts may lie in a hole
    const Vec3 middle_R = actor.structure.convex(impact.convex)->solid.centroid;
    hit.thickness_m = 2 * thickness_along(actor.structure, middle_R, hit.direction_R, most_m);
  }
  const double depth_m = 0.5 * std::min(hit.thickness_m, reach_of(hit));
  hit.confined =
      confinement(actor.structure, hit.section_R, hit.direction_R, depth_m) >= kMinConfinement;
}

/// Returns the volume of the convexes that reach into a sphere; of all if the radius is infinite.
double volume_within(const Structure& structure, const Vec3& center_R, double radius_m) {
  double volume_m3 = 0;
  const auto add = [&](ConvexSlot slot) { volume_m3 += structure.convex(slot)->solid.volume_m3; };
  if (std::isinf(radius_m)) {
    structure.for_each([&](ConvexSlot slot, const Convex&) { add(slot); });
  } else {
    for (const ConvexSlot slot : structure.within(center_R, radius_m)) add(slot);
  }
  return volume_m3;
}

/// Returns the impact in the actor's rest frame, with a striker that goes along the contact normal.
StructureImpact hit_of(const WorldState& world, const PlannedBreak& planned, const Actor& actor,
                       const Pose& X_WB) {
  const ActorImpact& impact = planned.impact;
  const Material& material = world.material(actor.structure.convex(impact.convex)->material);
  StructureImpact hit;
  hit.point_R = X_WB.inverse() * impact.point_W + actor.weight.com_R;
  hit.direction_R = X_WB.rotation.conjugate() * impact.direction_W;
  hit.convex = impact.convex;
  hit.energy_J = impact.energy_J;
  hit.volume_m3 = actor.volume_m3;
  hit.reached_m3 = volume_within(actor.structure, hit.point_R, material.impact_radius_m);
  add_striker(world, planned, actor, X_WB, impact.direction_W, hit);
  return hit;
}

/// Returns the volume of a plate that bends at an impact, out to three thicknesses.
double bent_m3(const Convex& convex) {
  const double thickness_m = mean_thickness_m(convex);
  return 28 * thickness_m * thickness_m * thickness_m;
}

/// Returns the particle speed behind the impact wave in the struck solid as a share of the impact's
/// speed: Z₁ / (Z₁ + Z₂), with the impedances of striker and solid; 1 for plates, which bend.
double share_of_speed(const WorldState& world, const Convex& convex, const Actor* striker) {
  if (is_thin(convex)) return 1;
  const double striker_Pa_s_m = striker && !striker->materials.empty()
                                    ? world.material(striker->materials[0]).impedance_Pa_s_m()
                                    : kGroundImpedance_Pa_s_m;
  return striker_Pa_s_m / (striker_Pa_s_m + world.material(convex.material).impedance_Pa_s_m());
}

}  // namespace

bool breaks_where_struck(const WorldState& world, const Actor& actor, const ImpactLoad& load,
                         const Actor* striker) {
  const Convex& convex = *actor.structure.convex(ConvexSlot(load.shape));
  const Material& material = world.material(convex.material);
  if (!material.breakable() || load.work_J <= actor.least_J) return false;
  const double limit_Pa = material.impact_limit_Pa(is_thin(convex));
  if (material.strength_Ns && load.impulse_Ns >= *material.strength_Ns) return true;
  if (limit_Pa == 0) return !material.strength_Ns;  // any stress
  const double share = share_of_speed(world, convex, striker);
  const double reach_m3 = reached_m3(material, actor.volume_m3), size_m = cube_root(reach_m3);
  const double crack_J = material.toughness_J_m2 * size_m * size_m / kGradyShare;
  if (share * share * (load.work_J - crack_J) > material.strain_energy_J(limit_Pa, reach_m3))
    return true;
  if (is_thin(convex) && load.work_J <= material.strain_energy_J(limit_Pa, bent_m3(convex)))
    return false;
  const double speed_m_s = std::min(load.speed_m_s, load.whole_m_s);
  const double squared_m2_s2 =
      speed_m_s * speed_m_s - 2 * crack_J / (material.density_kg_m3 * reach_m3);
  const bool lands_flat = is_thin(convex) && (!striker || striker->is_static);
  const double limit_m_s =
      (lands_flat ? kFlatLanding : 1) * limit_Pa / (share * material.impedance_Pa_s_m());
  return squared_m2_s2 > limit_m_s * limit_m_s;
}

bool breaks_before_waves_arrive(const Material& material, double speed_m_s) {
  if (!(material.shear_Pa > 0)) return false;
  return speed_m_s * material.density_kg_m3 * material.shear_wave_m_s() > material.shear_Pa;
}

void prepare_command(const WorldState& world, const Breaker& breaker, std::uint64_t event,
                     PlannedBreak& planned) {
  const ActorImpact& impact = planned.impact;
  const Actor& actor = *world.actors.find(impact.key);
  const Pose X_WB = world.physics->state(actor.body).X_WB;
  StructureImpact hit = hit_of(world, planned, actor, X_WB);
  // The seed depends on the actor alone: a repeated impact breaks it the same way, so that an
  // impact over several steps gets no several chances.
  const std::uint64_t seed = combine(world.scene.seed, impact.key);
  const Convex& convex = *actor.structure.convex(impact.convex);
  planned.command = breaker.command(convex, *world.materials, hit, event, seed);
  // A striker that drives a plug out of a face goes along its own path. At an edge, where no plug
  // comes out along the contact normal, the striker pushes along that normal.
  if (const Vec3 path_W = path_of(planned);
      goes_through(planned.command) && path_W != impact.direction_W) {
    StructureImpact oblique = hit;
    oblique.section_R.clear();
    add_striker(world, planned, actor, X_WB, path_W, oblique);
    oblique.confined = hit.confined;
    oblique.cosine = path_W.dot(impact.direction_W);
    oblique.energy_J /= oblique.cosine * oblique.cosine;
    // The plug ends where the last of its sides leaves the solid.
    oblique.thickness_m +=
        reach_of(oblique) * std::sqrt(1 - oblique.cosine * oblique.cosine) / oblique.cosine;
    oblique.path_m =
        path_behind(actor.structure, oblique.section_R, oblique.point_R, oblique.direction_R,
                    reach_of(oblique), kMaxPerforatedReaches * reach_of(oblique));
    BreakCommand command = breaker.command(convex, *world.materials, oblique, event, seed);
    if (goes_through(command)) {
      hit = std::move(oblique), planned.command = std::move(command);
      planned.share_along_normal = hit.cosine * hit.cosine;
    }
  }
  // The impulses of the contacts include those of other strikers, and none of riders at a distance.
  const bool alone = planned.riders.empty() && planned.striker_J > kMinShareAlone * impact.energy_J;
  if (!alone && goes_through(planned.command)) planned.share_along_normal = 0;
  if (impact.pattern) {
    planned.command.pattern = *impact.pattern;
    planned.command.plug.reset();
  }
  planned.path_W = X_WB.rotation * hit.direction_R;
  planned.swept = {std::move(hit.section_R), hit.point_R, hit.direction_R, hit.thickness_m};
}

std::uint32_t parts_to_cut(const WorldState& world, const PlannedBreak& planned) {
  const BreakCommand& command = planned.command;
  const Structure& structure = world.actors.find(planned.impact.key)->structure;
  const std::size_t reached = structure.within(command.X_RP.position, command.radius_m).size();
  const auto cells = static_cast<std::size_t>(command.plug ? command.plug->cell_count()
                                                           : command.pattern.cell_count());
  return static_cast<std::uint32_t>(cells + kPartsPerConvex * reached);
}

void plan_all(const WorldState& world, const Breaker& breaker, std::span<PlannedBreak* const> all) {
  const BodyStates states = world.physics->states();
  for_chunks(all.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      PlannedBreak& planned = *all[i];
      const Stopwatch watch;
      const Actor& actor = *world.actors.find(planned.impact.key);
      if (planned.by_pattern) {
        planned.edit = breaker.plan(actor.structure, planned.command);
        planned.needed_J = crack_energy_J(world, planned.edit);
        if (const auto& plug = planned.command.plug)
          planned.crushing_J = std::max(0.0, plug->energy_J - planned.needed_J);
        planned.needed_J += planned.crushing_J;
      }
      if (breaks_locally(world, actor.structure, planned)) {
        planned.breaks = true;
        planned.plan_ms = watch.ms();
        continue;
      }
      if (planned.by_stress && !reduce_to_transmitted(world, actor, planned))
        planned.by_stress = false;
      if (planned.by_stress) {
        std::vector<AppliedForce> loads;
        LoadCase load = make_load_case(world, actor, states[actor.body].X_WB.rotation, loads);
        const Convex& convex = *actor.structure.convex(planned.impact.convex);
        const bool has_pattern = world.material(convex.material).breakable();
        const std::uint64_t bonds = actor.structure.bond_count() + 1;
        const std::uint64_t most_work = std::min<std::uint64_t>(
            world.scene.limits.impact_evaluations,
            (has_pattern ? kPatternEvaluationsPerBond : kStressOnlyEvaluationsPerBond) * bonds);
        load.impulsive_load = {planned.impulses, planned.transmitted_J,
                               planned.command.X_RP.position,
                               planned.by_pattern ? planned.command.radius_m : 0, most_work};
        load.most_work = std::min(most_work, planned.max_bond_evaluations);
        planned.stressed = breaker.stress(actor.structure, load);
      }
      choose_break_mode(world, actor.structure, planned);
      planned.plan_ms = watch.ms();
    }
  });
}

Outcome outcome_of(const WorldState& world, const PlannedBreak& planned,
                   std::size_t pieces_planned) {
  if (!planned.breaks) return Outcome::kHolds;
  return fits_body_limit(world, planned.edit, pieces_planned) ? Outcome::kBreaks
                                                              : Outcome::kBodyLimit;
}

void record_outcome(WorldState& world, const PlannedBreak& planned, Outcome outcome) {
  LimitsHit& limits = world.log.report.limits;
  if (outcome == Outcome::kBodyLimit) ++limits[Limit::kBodies];
  if (outcome != Outcome::kHolds) return;
  Actor& actor = *world.actors.find(planned.impact.key);
  const double energy_J = planned.impact.energy_J;
  if (planned.by_pattern && !planned.command.plug)
    actor.least_J =
        std::max(actor.least_J, planned.edit.changed ? kReplanEnergyShare * planned.needed_J
                                                     : kReplanEnergyGrowth * energy_J);
  if (!planned.by_stress) return;
  if (planned.stressed.gave_up) ++limits[Limit::kImpactEvaluations];
  if (planned.stressed.undecided) {
    ++limits[Limit::kPartsAFrame];
    actor.stress.memory = planned.stressed.memory;
    return;
  }
  if (!breaks_or_bends(planned.stressed.edit)) actor.stress.memory = planned.stressed.memory;
  if (!std::isfinite(planned.transmitted_J)) return;
  const ImpulsiveStress& impulsive_stress = planned.stressed.impulsive_stress;
  // The bending energy of a solid of mass M is at most J² / 2M: stress grows with the impulse.
  if (impulsive_stress.worst > 0)
    actor.stress.least_Ns = std::max(
        actor.stress.least_Ns, kRetryImpulseShare * planned.impulse_Ns / impulsive_stress.worst);
  const double bends_J = (1 - impulsive_stress.local) * energy_J;
  actor.stress.least_J =
      std::max(actor.stress.least_J,
               impulsive_stress.worst > 0
                   ? kRetryEnergyShare * bends_J / (impulsive_stress.worst * impulsive_stress.worst)
                   : energy_J);
}

void break_actor(WorldState& world, const Breaker& breaker, PlannedBreak& planned) {
  const ActorImpact& impact = planned.impact;
  Actor& actor = *world.actors.find(impact.key);
  const std::vector<ExposedFace>& bare = planned.edit.loose.exposed;
  const Convex& broken = planned.at_bonds && !bare.empty()
                             ? planned.edit.exposed_convex(actor.structure, bare[0])
                             : *actor.structure.convex(impact.convex);
  BreakEvent event = make_break_event(world, actor, broken.material);
  event.point_W = impact.point_W;
  event.energy_J = planned.needed_J;
  event.new_area_m2 = area_m2(planned);
  event.plan_ms = planned.plan_ms;
  if (planned.at_bonds) {
    const Pose X_WB = world.physics->state(actor.body).X_WB;
    event.point_W = X_WB * Vec3(planned.stressed.impulsive_stress.worst_R - actor.weight.com_R);
    actor.stress.memory = planned.stressed.memory;
  }
  const bool only_bends = planned.only_bends();
  const std::uint64_t born_step = actor.born_step;
  if (planned.edit.changed) event.pieces = pieces_after(actor.structure, planned.edit);
  world.log.report.failed += planned.edit.loose.failed;
  world.log.report.failed_m3 += planned.edit.loose.failed_m3;
  breaker.on_applied(planned.edit.loose);
  if (planned.edit.changed) {
    const std::uint32_t first_key = world.actors.next_key();
    event.child_keys = apply_break(world, impact.key, planned.edit);
    if (!planned.at_bonds) apply_plastic_collision(world, planned, first_key);
    if (!planned.at_bonds && goes_through(planned.command))
      keep_born_step(world, event.child_keys, born_step);
  } else {  // cracked, but still in one piece
    actor.structure.apply(planned.edit);
  }
  if (!only_bends) world.log.breaks.push_back(std::move(event));
}

}  // namespace sunder
