#include "engine/world/break/planned_break.h"

#include <algorithm>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/base/trace.h"
#include "engine/world/actors/replace.h"

namespace sunder {
namespace {

// An impact with less than this part of what the last fruitless plan asked for is not planned.
constexpr double kWorthPlanning = 0.7;

/// Energy that the new crack surface takes; each crack has two sides.
double crack_energy_J(const World& world, const BreakEdit& edit) {
  double energy = 0;
  for (const ExposedFace& face : edit.loose.exposed) {
    energy += 0.5 * face.area_m2 * world.material(face.material).toughness_J_m2;
  }
  return energy;
}

/// The impact as the actor's rest frame sees it.
Hit hit_of(const Impact& impact, const Actor& actor, const Pose& X_WB) {
  Hit hit;
  hit.point_R = X_WB.inverse() * impact.point_W + actor.weight.com_R;
  hit.direction_R = X_WB.rotation.conjugate() * impact.direction_W;
  hit.convex = impact.convex;
  hit.energy_J = impact.energy_J;
  return hit;
}

}  // namespace

void prepare(const World& world, const Breaker& breaker, std::uint64_t event,
             PlannedBreak& planned) {
  const Impact& impact = planned.impact;
  const Actor& actor = *world.actors.find(impact.key);
  const Hit hit = hit_of(impact, actor, world.physics->state(actor.body).X_WB);
  // Of the actor: hit once more, it would break the same way, or an impact that comes in several
  // steps would be given several chances.
  const std::uint64_t seed = combine(world.scene.seed, impact.key);
  const Convex& convex = *actor.structure.convex(impact.convex);
  planned.command = breaker.command(convex, *world.materials, hit, event, seed);
}

std::uint32_t parts_to_cut(const World& world, const PlannedBreak& planned) {
  constexpr std::size_t kPartsOfConvex = 8;
  const BreakCommand& command = planned.command;
  const Structure& structure = world.actors.find(planned.impact.key)->structure;
  const std::size_t reached = structure.within(command.X_RP.position, command.radius_m).size();
  const auto cells = static_cast<std::size_t>(command.pattern.cell_count());
  return static_cast<std::uint32_t>(cells + kPartsOfConvex * reached);
}

void plan_all(const World& world, const Breaker& breaker, std::span<PlannedBreak* const> all) {
  for_chunks(all.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      PlannedBreak& planned = *all[i];
      const Stopwatch watch;
      const Structure& structure = world.actors.find(planned.impact.key)->structure;
      planned.edit = breaker.plan(structure, planned.command);
      planned.plan_ms = watch.ms();
      planned.needed_J = crack_energy_J(world, planned.edit);
    }
  });
}

Verdict verdict_on(const World& world, const PlannedBreak& planned) {
  const bool pays = planned.edit.changed && planned.impact.energy_J > planned.needed_J;
  if (!pays) return Verdict::kHolds;
  return has_room(world, planned.edit) ? Verdict::kBreaks : Verdict::kNoRoom;
}

void note_verdict(World& world, const PlannedBreak& planned, Verdict verdict) {
  if (verdict == Verdict::kNoRoom) ++world.ledger.report.limits_hit;
  if (verdict != Verdict::kHolds) return;
  Actor& actor = *world.actors.find(planned.impact.key);
  actor.least_J = std::max(actor.least_J, planned.edit.changed ? kWorthPlanning * planned.needed_J
                                                               : 1.4 * planned.impact.energy_J);
}

void break_actor(World& world, PlannedBreak& planned) {
  const Impact& impact = planned.impact;
  const std::uint32_t pieces = pieces_after(world.actors.find(impact.key)->structure, planned.edit);
  world.ledger.breaks.push_back({world.clock.time_s(), impact.key, impact.point_W, planned.needed_J,
                                 planned.edit.loose.new_area_m2, planned.plan_ms, pieces});
  world.ledger.report.failed += planned.edit.loose.failed;
  carry_out(world, impact.key, planned.edit);
}

}  // namespace sunder
