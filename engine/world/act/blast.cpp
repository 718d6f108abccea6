// Read first: push_on().
#include "engine/world/act/blast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "engine/world/act/charge.h"
#include "engine/world/act/cover.h"
#include "engine/world/actors/make_actor.h"

namespace sunder {
namespace {

constexpr double kBreaking_s = 0.05;  // for so long a blast breaks before it pushes
constexpr double kPartOfWay = 0.35;   // longest edge of a triangle of a face, over its distance
constexpr int kMostHalvings = 4;      // of a face's edges
constexpr double kTriedPart = 0.6;    // of the impact radius around a tried place is tried, too

/// What a blast does to a part of an actor.
struct Push {
  Vec3 impulse_W = Vec3::Zero();
  Vec3 weighted_point_W = Vec3::Zero();  ///< Times the impulses' sizes.
  double weight_Ns = 0;

  void add(const Vec3& impulse, const Vec3& point_W) {
    const double size = impulse.norm();
    impulse_W += impulse;
    weighted_point_W += size * point_W;
    weight_Ns += size;
  }
  Vec3 point_W() const { return weighted_point_W / weight_Ns; }
};

/// Adds what the wave of a charge gives to a triangle, counter-clockwise seen from outside: an
/// impulse along its inward normal. Triangles that are large for their distance are divided.
void push_triangle(Push& push, const Blast& blast, const Cover& cover, const Actor& actor,
                   ConvexSlot slot, const std::array<Vec3, 3>& corners_W, int halvings = 0) {
  const auto& [a, b, c] = corners_W;
  const Vec3 middle_W = (a + b + c) / 3;
  const double distance_m = (middle_W - blast.center_W).norm();
  const double edge_m = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  if (edge_m > kPartOfWay * distance_m && halvings < kMostHalvings) {
    const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    for (const std::array<Vec3, 3>& part : {std::array{a, ab, ca}, std::array{ab, b, bc},
                                            std::array{ca, bc, c}, std::array{ab, bc, ca}}) {
      push_triangle(push, blast, cover, actor, slot, part, halvings + 1);
    }
    return;
  }
  const Vec3 double_area = (b - a).cross(c - a);
  const double facing = double_area.dot(blast.center_W - middle_W);
  if (facing <= 0 || cover.covers(middle_W, actor.key, slot)) return;
  const WaveImpulse wave = wave_impulse(*blast.tnt_kg, blast.burst, distance_m);
  const double cosine = std::min(1.0, facing / (double_area.norm() * distance_m));
  push.add(-0.5 * wave.at_incidence(cosine) * double_area, middle_W);
}

/// Adds what the wave of a charge gives to a face.
void push_face(Push& push, const Blast& blast, const Cover& cover, const Actor& actor,
               ConvexSlot slot, std::size_t face, const Pose& X_WR) {
  const ConvexPolyhedron& hull = actor.structure.convex(slot)->polyhedron;
  const auto corners = hull.face_corners(face);
  const auto place_W = [&](std::size_t i) { return Vec3(X_WR * hull.vertices[corners[i]]); };
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    push_triangle(push, blast, cover, actor, slot, {place_W(0), place_W(i), place_W(i + 1)});
  }
}

/// Impulse a square metre that faces the centre from somewhere.
Vec3 impulse_Ns_m2(const Blast& blast, const Vec3& point_W) {
  const Vec3 away = point_W - blast.center_W;
  const double distance = away.norm();
  if (distance >= blast.radius_m || distance <= 0) return Vec3::Zero();
  const double left = 1 - distance / blast.radius_m;
  return blast.impulse_Ns_m2 * left * left / distance * away;
}

/// Impulse on a ball somewhere, for each square metre of its cross-section.
Vec3 impulse_on_ball_Ns_m2(const Blast& blast, const Vec3& point_W) {
  if (!blast.tnt_kg) return impulse_Ns_m2(blast, point_W);
  const Vec3 away = point_W - blast.center_W;
  const double distance_m = away.norm();
  if (distance_m <= 0) return Vec3::Zero();
  return wave_impulse(*blast.tnt_kg, blast.burst, distance_m).on_ball() / distance_m * away;
}

/// On the faces of a convex that nothing covers.
Push push_on(const Blast& blast, const Cover& cover, const Actor& actor, ConvexSlot slot,
             const Pose& X_WR) {
  Push push;
  const ConvexPolyhedron& hull = actor.structure.convex(slot)->polyhedron;
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    if (actor.hidden[slot.value][f] != 0) continue;
    if (blast.tnt_kg) {
      push_face(push, blast, cover, actor, slot, f, X_WR);
      continue;
    }
    Vec3 middle_R = Vec3::Zero();
    const auto corners = hull.face_corners(f);
    for (const std::uint32_t corner : corners) middle_R += hull.vertices[corner];
    const Vec3 middle_W = X_WR * Vec3(middle_R / static_cast<double>(corners.size()));
    const Vec3 impulse = impulse_Ns_m2(blast, middle_W);
    const double size = impulse.norm();
    if (size <= 0 || cover.covers(middle_W, actor.key, slot)) continue;
    const double facing = -impulse.dot(X_WR.rotation * hull.faces[f].plane.normal) / size;
    if (facing > 0) push.add(facing * face_area(hull, f) * impulse, middle_W);
  }
  return push;
}

bool reaches(const Blast& blast, const Actor& actor, const Pose& X_WR) {
  if (actor.structure.empty()) return true;
  const Box box_R = bounds(actor.structure);
  const Vec3 center_R = X_WR.inverse() * blast.center_W;
  const Vec3 nearest_R = center_R.cwiseMax(box_R.min).cwiseMin(box_R.max);
  return (nearest_R - center_R).norm() < reach_m(blast);
}

bool was_tried(const World& world, const Burst& burst, const Convex& convex, const Push& push) {
  if (push.weight_Ns <= 0) return false;
  const double radius = kTriedPart * world.material(convex.material).impact_radius_m;
  return std::ranges::any_of(burst.tried_W, [&](const Vec3& tried_W) {
    return (tried_W - push.point_W()).norm() < radius;
  });
}

/// By slot.
std::vector<Push> pushes_on(const Blast& blast, const Cover& cover, const Actor& actor,
                            const Pose& X_WR) {
  std::vector<Push> pushes(actor.structure.slot_count());
  actor.structure.for_each([&](ConvexSlot slot, const Convex&) {
    pushes[slot.value] = push_on(blast, cover, actor, slot, X_WR);
  });
  return pushes;
}

/// Energy that it gives a convex that is free to move.
double energy_J(const World& world, const Push& push, const Convex& convex) {
  const double mass_kg = world.material(convex.material).density_kg_m3 * convex.solid.volume_m3;
  return 0.5 * push.impulse_W.squaredNorm() / mass_kg;
}

/// All pushes on an actor, if they can bend it.
void add_bending(const World& world, const Actor& actor, const Pose& X_WR,
                 std::span<const Push> pushes, Impact& impact) {
  double all_J = 0;
  actor.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    all_J += energy_J(world, pushes[slot.value], convex);
  });
  if (all_J <= actor.stress.least_J) return;
  const Pose X_RW = X_WR.inverse();
  double most_Ns = 0;
  for (std::uint32_t slot = 0; slot < pushes.size(); ++slot) {
    const Push& push = pushes[slot];
    if (push.weight_Ns <= 0) continue;
    impact.pushes.push_back(
        {ConvexSlot(slot), X_RW.rotation * push.impulse_W, X_RW * push.point_W()});
    if (push.weight_Ns <= most_Ns) continue;
    most_Ns = push.weight_Ns;
    impact.convex = ConvexSlot(slot);
    impact.point_W = push.point_W();
    impact.direction_W = push.impulse_W.normalized();
  }
}

/// The impact that a blast amounts to where it presses hardest; of no energy if it cannot break it.
void add_breaking(const World& world, const Burst& burst, const Actor& actor,
                  std::vector<Push> pushes, Impact& impact) {
  const Structure& structure = actor.structure;
  ConvexSlot hardest(0);
  structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    Push& push = pushes[slot.value];
    const bool breaks = world.material(convex.material).breakable();
    if (!breaks || was_tried(world, burst, convex, push)) push = {};
    if (push.weight_Ns > pushes[hardest.value].weight_Ns) hardest = slot;
  });
  if (pushes.empty() || pushes[hardest.value].weight_Ns <= 0) return;
  const Material& material = world.material(structure.convex(hardest)->material);
  if (actor.volume_m3 < material.smallest_broken_m3()) return;
  const Vec3 point_W = pushes[hardest.value].point_W();
  Vec3 impulse_W = Vec3::Zero();
  double near_J = 0, near_m3 = 0;
  structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    const Push& push = pushes[slot.value];
    const bool near =
        push.weight_Ns > 0 && (push.point_W() - point_W).norm() <= material.impact_radius_m;
    if (!near) return;
    impulse_W += push.impulse_W;
    near_J += energy_J(world, push, convex);
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

void push_away(World& world, const Blast& blast, const Cover& cover, const Actor& actor) {
  const Pose X_WR = rest_pose(actor, world.physics->state(actor.body).X_WB);
  if (!reaches(blast, actor, X_WR)) return;
  Push push;
  actor.structure.for_each([&](ConvexSlot slot, const Convex&) {
    const Push part = push_on(blast, cover, actor, slot, X_WR);
    push.impulse_W += part.impulse_W;
    push.weighted_point_W += part.weighted_point_W;
    push.weight_Ns += part.weight_Ns;
  });
  if (actor.structure.empty() && !cover.covers(X_WR.position)) {
    const double radius = ball_radius_m(actor.volume_m3);
    push.add(std::numbers::pi * radius * radius * impulse_on_ball_Ns_m2(blast, X_WR.position),
             X_WR.position);
  }
  if (push.weight_Ns <= 0) return;
  world.ledger.report.energy.drives += push_actor(world, actor, push.impulse_W, push.point_W());
}

/// From where it is by now.
void push_away(const World& world, const Blast& blast, const Cover& cover, Chip& chip) {
  const double elapsed_s = world.clock.elapsed_s();
  const Vec3 place_W = chip.center_W + elapsed_s * chip.velocity_W;
  if (cover.covers(place_W)) return;
  const Vec3 impulse_Ns = impulse_on_ball_Ns_m2(blast, place_W);
  const double density_kg_m3 = world.material(chip.material).density_kg_m3;
  const Vec3 gain_W = 0.75 / (chip.radius_m * density_kg_m3) * impulse_Ns;  // of a ball's section
  chip.velocity_W += gain_W;
  chip.center_W -= elapsed_s * gain_W;
}

}  // namespace

Burst light(const World& world, const Blast& blast) {
  const auto number = static_cast<std::uint32_t>(&blast - world.scene.blasts.data());
  return {blast, world.clock.time_s() + kBreaking_s, {}, number};
}

std::vector<Impact> blows_of(const World& world, Burst& burst) {
  const BodyStates states = world.physics->states();
  const Cover cover(world, burst.blast);
  std::vector<Impact> impacts;
  for (const Actor& actor : world.actors) {
    const Pose X_WR = rest_pose(actor, states[actor.body].X_WB);
    if (actor.is_kinematic || !reaches(burst.blast, actor, X_WR)) continue;
    Impact impact;
    impact.key = actor.key;
    impact.blast = burst.number;
    std::vector<Push> pushes = pushes_on(burst.blast, cover, actor, X_WR);
    const auto bent = burst.bent.find(actor.key);
    if (bent == burst.bent.end() || bent->second != actor.edits) {
      burst.bent[actor.key] = actor.edits;
      add_bending(world, actor, X_WR, pushes, impact);
    }
    add_breaking(world, burst, actor, std::move(pushes), impact);
    if (impact.energy_J > 0 || !impact.pushes.empty()) impacts.push_back(std::move(impact));
  }
  for (const Impact& impact : impacts)
    if (impact.energy_J > 0) burst.tried_W.push_back(impact.point_W);
  return impacts;
}

void push_by(World& world, const Blast& blast) {
  const Cover cover(world, blast);
  if (world.exposed) {
    for (Chip& chip : world.exposed->chips) push_away(world, blast, cover, chip);
  }
  for (const Actor& actor : world.actors) {
    if (!actor.is_static) push_away(world, blast, cover, actor);
  }
}

}  // namespace sunder
