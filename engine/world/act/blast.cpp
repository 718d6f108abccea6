// Read first: impulse_on().
#include "engine/world/act/blast.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/model/work_log.h"
#include "engine/world/act/charge.h"
#include "engine/world/act/cover.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

constexpr const char* kBlastPoints = "points under blast";  // name of the work
constexpr std::size_t kActorsPerChunk = 32;

/// Impulse of a blast on a part of an actor.
struct BlastImpulse {
  Vec3 impulse_W = Vec3::Zero();
  Vec3 weighted_point_W = Vec3::Zero();  ///< Sum of points times impulse sizes.
  double sum_Ns = 0;                     ///< Sum of impulse sizes.
  std::uint64_t points = 0;              ///< Points at which the impulse was computed.

  void add(const Vec3& impulse, const Vec3& point_W) {
    const double size = impulse.norm();
    impulse_W += impulse;
    weighted_point_W += size * point_W;
    sum_Ns += size;
  }
  Vec3 point_W() const { return weighted_point_W / sum_Ns; }
};

/// Adds the impulse of a charge's wave on a triangle (counter-clockwise from outside) along the
/// inward normal. Triangles that are large for their distance are subdivided.
void add_triangle(BlastImpulse& impulse, const Blast& blast, const Cover& cover, const Actor& actor,
                  ConvexSlot slot, const std::array<Vec3, 3>& corners_W, int halvings = 0) {
  const auto& [a, b, c] = corners_W;
  const Vec3 middle_W = (a + b + c) / 3;
  const double distance_m = (middle_W - blast.center_W).norm();
  const double edge_m = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  if (edge_m > kMaxBlastEdge * distance_m && halvings < kMaxBlastHalvings) {
    const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    for (const std::array<Vec3, 3>& part : {std::array{a, ab, ca}, std::array{ab, b, bc},
                                            std::array{ca, bc, c}, std::array{ab, bc, ca}}) {
      add_triangle(impulse, blast, cover, actor, slot, part, halvings + 1);
    }
    return;
  }
  ++impulse.points;
  const Vec3 double_area = (b - a).cross(c - a);
  const double facing = double_area.dot(blast.center_W - middle_W);
  if (facing <= 0 || cover.covers(middle_W, actor.key, slot)) return;
  const WaveImpulse wave = wave_impulse(*blast.tnt_kg, blast.burst, distance_m);
  const double cosine = std::min(1.0, facing / (double_area.norm() * distance_m));
  impulse.add(-0.5 * wave.at_incidence(cosine) * double_area, middle_W);
}

/// Adds the impulse of a charge's wave on a face.
void add_face(BlastImpulse& impulse, const Blast& blast, const Cover& cover, const Actor& actor,
              ConvexSlot slot, std::size_t face, const Pose& X_WR) {
  const ConvexPolyhedron& hull = actor.structure.convex(slot)->polyhedron;
  const auto corners = hull.face_corners(face);
  const auto place_W = [&](std::size_t i) { return Vec3(X_WR * hull.vertices[corners[i]]); };
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    add_triangle(impulse, blast, cover, actor, slot, {place_W(0), place_W(i), place_W(i + 1)});
  }
}

/// Returns the impulse per area at a point on a surface that faces the centre.
Vec3 impulse_Ns_m2(const Blast& blast, const Vec3& point_W) {
  const Vec3 away = point_W - blast.center_W;
  const double distance = away.norm();
  if (distance >= blast.radius_m || distance <= 0) return Vec3::Zero();
  const double left = 1 - distance / blast.radius_m;
  return blast.impulse_Ns_m2 * left * left / distance * away;
}

/// Returns the impulse on a ball at a point, per area of its cross-section.
Vec3 impulse_on_ball_Ns_m2(const Blast& blast, const Vec3& point_W) {
  if (!blast.tnt_kg) return impulse_Ns_m2(blast, point_W);
  const Vec3 away = point_W - blast.center_W;
  const double distance_m = away.norm();
  if (distance_m <= 0) return Vec3::Zero();
  return wave_impulse(*blast.tnt_kg, blast.burst, distance_m).on_ball() / distance_m * away;
}

/// Returns the impulse on the uncovered faces of a convex.
BlastImpulse impulse_on(const Blast& blast, const Cover& cover, const Actor& actor, ConvexSlot slot,
                        const Pose& X_WR) {
  BlastImpulse impulse;
  const ConvexPolyhedron& hull = actor.structure.convex(slot)->polyhedron;
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    if (actor.hidden[slot.value][f] != 0) continue;
    if (blast.tnt_kg) {
      add_face(impulse, blast, cover, actor, slot, f, X_WR);
      continue;
    }
    ++impulse.points;
    Vec3 middle_R = Vec3::Zero();
    const auto corners = hull.face_corners(f);
    for (const std::uint32_t corner : corners) middle_R += hull.vertices[corner];
    const Vec3 middle_W = X_WR * Vec3(middle_R / static_cast<double>(corners.size()));
    const Vec3 per_area = impulse_Ns_m2(blast, middle_W);
    const double size = per_area.norm();
    if (size <= 0 || cover.covers(middle_W, actor.key, slot)) continue;
    const double facing = -per_area.dot(X_WR.rotation * hull.faces[f].plane.normal) / size;
    if (facing > 0) impulse.add(facing * face_area(hull, f) * per_area, middle_W);
  }
  return impulse;
}

bool reaches(const Blast& blast, const Actor& actor, const Pose& X_WR) {
  if (actor.structure.empty()) return true;
  const Box box_R = bounds(actor.structure);
  const Vec3 center_R = X_WR.inverse() * blast.center_W;
  const Vec3 nearest_R = center_R.cwiseMax(box_R.min).cwiseMin(box_R.max);
  return (nearest_R - center_R).norm() < reach_m(blast);
}

bool was_tried(const WorldState& world, const ActiveBlast& active, const Convex& convex,
               const BlastImpulse& impulse) {
  if (impulse.sum_Ns <= 0) return false;
  const double radius = kTriedBlastRadius * world.material(convex.material).impact_radius_m;
  return std::ranges::any_of(active.tried_points_W, [&](const Vec3& tried_W) {
    return (tried_W - impulse.point_W()).norm() < radius;
  });
}

/// Returns the impulses on an actor by slot.
std::vector<BlastImpulse> impulses_on(const Blast& blast, const Cover& cover, const Actor& actor,
                                      const Pose& X_WR) {
  std::vector<BlastImpulse> impulses(actor.structure.slot_count());
  actor.structure.for_each([&](ConvexSlot slot, const Convex&) {
    impulses[slot.value] = impulse_on(blast, cover, actor, slot, X_WR);
  });
  return impulses;
}

/// Returns the energy that an impulse gives to a free convex.
double energy_J(const WorldState& world, const BlastImpulse& impulse, const Convex& convex) {
  const double mass_kg = world.material(convex.material).density_kg_m3 * convex.solid.volume_m3;
  return 0.5 * impulse.impulse_W.squaredNorm() / mass_kg;
}

/// Adds all impulses on an actor to the impact, if they can break it by bending.
void add_bending(const WorldState& world, const Actor& actor, const Pose& X_WR,
                 std::span<const BlastImpulse> impulses, ActorImpact& impact) {
  double all_J = 0;
  actor.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    all_J += energy_J(world, impulses[slot.value], convex);
  });
  if (all_J <= actor.stress.least_J) return;
  const Pose X_RW = X_WR.inverse();
  double most_Ns = 0;
  for (std::uint32_t slot = 0; slot < impulses.size(); ++slot) {
    const BlastImpulse& impulse = impulses[slot];
    if (impulse.sum_Ns <= 0) continue;
    impact.impulses.push_back(
        {ConvexSlot(slot), X_RW.rotation * impulse.impulse_W, X_RW * impulse.point_W()});
    if (impulse.sum_Ns <= most_Ns) continue;
    most_Ns = impulse.sum_Ns;
    impact.convex = ConvexSlot(slot);
    impact.point_W = impulse.point_W();
    impact.direction_W = impulse.impulse_W.normalized();
  }
}

/// Sets the point and energy of an impact by pattern, at the largest untried impulse; the energy
/// stays 0 if it cannot break the actor.
void add_breaking(const WorldState& world, const ActiveBlast& active, const Actor& actor,
                  std::vector<BlastImpulse> impulses, ActorImpact& impact) {
  const Structure& structure = actor.structure;
  ConvexSlot hardest(0);
  structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    BlastImpulse& impulse = impulses[slot.value];
    const bool breaks = world.material(convex.material).breakable();
    if (!breaks || was_tried(world, active, convex, impulse)) impulse = {};
    if (impulse.sum_Ns > impulses[hardest.value].sum_Ns) hardest = slot;
  });
  if (impulses.empty() || impulses[hardest.value].sum_Ns <= 0) return;
  const Material& material = world.material(structure.convex(hardest)->material);
  if (actor.volume_m3 < material.min_breakable_volume_m3()) return;
  const Vec3 point_W = impulses[hardest.value].point_W();
  Vec3 impulse_W = Vec3::Zero();
  double near_J = 0, near_m3 = 0;
  structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    const BlastImpulse& impulse = impulses[slot.value];
    const bool near =
        impulse.sum_Ns > 0 && (impulse.point_W() - point_W).norm() <= material.impact_radius_m;
    if (!near) return;
    impulse_W += impulse.impulse_W;
    near_J += energy_J(world, impulse, convex);
    near_m3 += convex.solid.volume_m3;
  });
  const double impulse_Ns = impulse_W.norm();
  if (impulse_Ns < material.strength_Ns.value_or(0) || impulse_Ns <= 0) return;
  const double limit_Pa = material.impact_limit_Pa(is_thin(*structure.convex(hardest)));
  const double speed_m_s = impulse_Ns / (material.density_kg_m3 * near_m3);
  if (!material.strength_Ns && speed_m_s * material.impedance_Pa_s_m() <= limit_Pa &&
      near_J <= material.strain_energy_J(limit_Pa, near_m3))
    return;
  impact.convex = hardest;
  impact.point_W = point_W;
  impact.direction_W = impulse_W.normalized();
  impact.energy_J = near_J;
}

/// Returns the impulse on an actor.
BlastImpulse impulse_on(const Blast& blast, const Cover& cover, const Actor& actor,
                        const Pose& X_WB) {
  BlastImpulse impulse;
  const Pose X_WR = rest_pose(actor, X_WB);
  if (actor.is_static || !reaches(blast, actor, X_WR)) return impulse;
  actor.structure.for_each([&](ConvexSlot slot, const Convex&) {
    const BlastImpulse part = impulse_on(blast, cover, actor, slot, X_WR);
    impulse.impulse_W += part.impulse_W;
    impulse.weighted_point_W += part.weighted_point_W;
    impulse.sum_Ns += part.sum_Ns;
    impulse.points += part.points;
  });
  if (actor.structure.empty() && !cover.covers(X_WR.position)) {
    const double radius = ball_radius_m(actor.volume_m3);
    impulse.add(std::numbers::pi * radius * radius * impulse_on_ball_Ns_m2(blast, X_WR.position),
                X_WR.position);
  }
  return impulse;
}

/// Returns false if no impulse breaks an actor: add_bending() and add_breaking() add nothing.
bool may_break(const WorldState& world, const Actor& actor) {
  if (actor.stress.least_J < std::numeric_limits<double>::infinity()) return true;
  return std::ranges::any_of(actor.materials, [&](MaterialIndex index) {
    const Material& material = world.material(index);
    return material.breakable() && actor.volume_m3 >= material.min_breakable_volume_m3();
  });
}

/// Applies a blast's impulse to a chip at its current position.
void apply_impulse(const WorldState& world, const Blast& blast, const Cover& cover,
                   DebrisPiece& chip) {
  const double elapsed_s = world.clock.elapsed_s();
  const Vec3 place_W = chip.center_W + elapsed_s * chip.velocity_W;
  if (cover.covers(place_W)) return;
  const Vec3 impulse_Ns = impulse_on_ball_Ns_m2(blast, place_W);
  const double density_kg_m3 = world.material(chip.material).density_kg_m3;
  const Vec3 gain_W =
      0.75 / (chip.radius_m * density_kg_m3) * impulse_Ns;  // of a ball's cross-section
  chip.velocity_W += gain_W;
  chip.center_W -= elapsed_s * gain_W;
}

}  // namespace

ActiveBlast start_blast(const WorldState& world, Blast blast, std::uint32_t number) {
  return {std::move(blast), world.clock.time_s() + kBlastBreakTime_s, {}, number};
}

std::vector<ActorImpact> find_blast_impacts(WorldState& world, ActiveBlast& active) {
  struct Found {
    std::uint32_t place = 0;  ///< Of the actor.
    std::uint64_t points = 0;
    ActorImpact impact;
  };
  const BodyStates states = world.physics->states();
  std::vector<Found> all = collect_chunks<Found>(
      world.actors.size(), kActorsPerChunk,
      [&](std::size_t begin, std::size_t end, std::vector<Found>& found) {
        for (std::size_t i = begin; i < end; ++i) {
          const Actor& actor = world.actors[i];
          if (actor.is_kinematic || !may_break(world, actor)) continue;
          if (reaches(active.blast, actor, rest_pose(actor, states[actor.body].X_WB)))
            found.push_back({static_cast<std::uint32_t>(i), 0, {}});
        }
      });
  if (all.empty()) return {};
  const Cover cover(world, active.blast);
  WorkSpan span(world.log.work_counts, Stage::kAct, kBlastPoints);
  for_chunks(all.size(), kActorsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Actor& actor = world.actors[all[i].place];
      const Pose X_WR = rest_pose(actor, states[actor.body].X_WB);
      ActorImpact& impact = all[i].impact;
      impact.key = actor.key;
      impact.blast = active.number;
      std::vector<BlastImpulse> impulses = impulses_on(active.blast, cover, actor, X_WR);
      for (const BlastImpulse& impulse : impulses) all[i].points += impulse.points;
      const auto bent = active.bent.find(actor.key);
      if (bent == active.bent.end() || bent->second != actor.edits)
        add_bending(world, actor, X_WR, impulses, impact);
      add_breaking(world, active, actor, std::move(impulses), impact);
    }
  });
  std::vector<ActorImpact> impacts;
  for (Found& found : all) {
    span.count(found.points);
    const Actor& actor = world.actors[found.place];
    active.bent[actor.key] = actor.edits;
    ActorImpact& impact = found.impact;
    if (impact.energy_J > 0 || !impact.impulses.empty()) impacts.push_back(std::move(impact));
  }
  for (const ActorImpact& impact : impacts)
    if (impact.energy_J > 0) active.tried_points_W.push_back(impact.point_W);
  return impacts;
}

void apply_blast_impulses(WorldState& world, const Blast& blast) {
  const Cover cover(world, blast);
  WorkSpan span(world.log.work_counts, Stage::kAct, kBlastPoints);
  if (world.exposed) {
    std::vector<DebrisPiece>& chips = world.exposed->chips;
    for_chunks(chips.size(), kActorsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) apply_impulse(world, blast, cover, chips[i]);
    });
    span.count(chips.size());
  }
  const BodyStates states = world.physics->states();
  std::vector<BlastImpulse> impulses(world.actors.size());
  for_chunks(impulses.size(), kActorsPerChunk,
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (std::size_t i = begin; i < end; ++i) {
                 const Actor& actor = world.actors[i];
                 impulses[i] = impulse_on(blast, cover, actor, states[actor.body].X_WB);
               }
             });
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    span.count(impulses[i].points);
    if (impulses[i].sum_Ns <= 0) continue;
    world.log.report.energy.drives +=
        push_actor(world, world.actors[i], impulses[i].impulse_W, impulses[i].point_W());
  }
}

}  // namespace sunder
