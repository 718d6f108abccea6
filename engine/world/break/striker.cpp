#include "engine/world/break/striker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/base/roots.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/prism.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Removes corners, those that cut off the least area first, until kMaxSectionCorners are left.
void simplify(std::vector<Vec2>& hull) {
  while (hull.size() > kMaxSectionCorners) {
    std::size_t least = 0;
    double least_m2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec2& before = hull[(i + hull.size() - 1) % hull.size()];
      const Vec2& after = hull[(i + 1) % hull.size()];
      const double cut_m2 = cross(hull[i] - before, after - hull[i]);
      if (cut_m2 < least_m2) least_m2 = cut_m2, least = i;
    }
    hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

/// Returns two unit vectors perpendicular to a direction; with it as the third, right-handed.
std::pair<Vec3, Vec3> axes_across(const Vec3& direction) {
  const Vec3 any = std::abs(direction.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitZ();
  const Vec3 first = any.cross(direction).normalized();
  return {first, direction.cross(first)};
}

/// Adds points of the outline of an actor that is projected along u × v onto the plane through a
/// point; of a ball in order.
void add_outline(const WorldState& world, const Actor& actor, const Vec3& point_W, const Vec3& u,
                 const Vec3& v, double reach_m, std::vector<Vec2>& points) {
  const Pose X_WB = world.physics->state(actor.body).X_WB;
  if (actor.structure.empty()) {
    const SinCos corner = sin_cos(std::numbers::pi / kRoundSectionCorners);
    // The polygon has the area of the circle.
    const double radius_m =
        ball_radius_m(actor.volume_m3) *
        std::sqrt(std::numbers::pi / (kRoundSectionCorners * corner.sin * corner.cos));
    const Vec3 center_W = X_WB.position - point_W;
    for (int i = 0; i < kRoundSectionCorners; ++i) {
      const SinCos angle = sin_cos(2 * std::numbers::pi * i / kRoundSectionCorners);
      points.push_back(Vec2(u.dot(center_W), v.dot(center_W)) +
                       radius_m * Vec2(angle.cos, angle.sin));
    }
    return;
  }
  const Pose X_WR = rest_pose(actor, X_WB);
  for (const ConvexSlot slot : actor.structure.within(X_WR.inverse() * point_W, reach_m)) {
    for (const Vec3& vertex : actor.structure.convex(slot)->polyhedron.vertices) {
      const Vec3 at_W = X_WR * vertex - point_W;
      points.emplace_back(u.dot(at_W), v.dot(at_W));
    }
  }
}

/// Returns true if a piece of the solid reaches into the prism that the striker sweeps.
bool is_in_prism(const SweptPrism& prism, const Vec3& com_R, double volume_m3) {
  const double reach_m = 0.5 * cube_root(volume_m3);
  const double along_m = (com_R - prism.point_R).dot(prism.direction_R);
  if (along_m > prism.thickness_m) return false;
  for (std::size_t i = 0; i < prism.section_R.size(); ++i) {
    const Vec3& corner = prism.section_R[i];
    const Vec3 side = prism.section_R[(i + 1) % prism.section_R.size()] - corner;
    if (prism.direction_R.cross(side).normalized().dot(com_R - corner) < -reach_m) return false;
  }
  return true;
}

/// Returns true if all convexes of a piece are in a plug. The centre of mass alone does not tell:
/// that of a plate with a hole may be in the hole.
bool is_within(const Plug& plug, const Pose& X_PR, const Actor& piece) {
  bool within = true;
  piece.structure.for_each([&](ConvexSlot, const Convex& convex) {
    within = within && plug.contains(X_PR * convex.solid.centroid);
  });
  return within;
}

/// Returns the speed along an axis that a body gains at a point per impulse along the axis there.
double inverse_effective_mass(const Actor& actor, const BodyState& state, const Vec3& point_W,
                              const Vec3& axis_W) {
  if (actor.is_kinematic) return 0;
  const Mat3 R_WB = state.X_WB.rotation.toRotationMatrix();
  const Vec3 turn_B = R_WB.transpose() * (point_W - state.X_WB.position).cross(axis_W);
  return 1 / actor.weight.mass_kg + turn_B.dot(actor.weight.inertia_R.inverse() * turn_B);
}

/// Returns the median length over the rays, from a point and from halfway to each corner of a
/// section around it, that hit a structure.
template <class LengthOfRay>
double median_behind(const std::vector<Vec3>& section_R, const Vec3& point_R,
                     const LengthOfRay& length_of) {
  std::vector<double> all_m = {length_of(point_R)};
  for (const Vec3& corner : section_R) all_m.push_back(length_of(0.5 * (point_R + corner)));
  std::erase(all_m, 0);
  if (all_m.empty()) return 0;
  const auto middle = all_m.begin() + static_cast<std::ptrdiff_t>(all_m.size() / 2);
  std::ranges::nth_element(all_m, middle);
  return *middle;
}

/// Applies an impulse to an actor at a time of the step: the actor is at that time where it would
/// be without the impulse. Returns the change of kinetic energy.
double push_at(WorldState& world, const Actor& actor, const Vec3& impulse_Ns, const Vec3& point_W,
               double time_s) {
  BodyState moved = world.physics->state(actor.body);
  moved.X_WB.position -= time_s / actor.weight.mass_kg * impulse_Ns;
  world.physics->set_state(actor.body, moved);
  return push_actor(world, actor, impulse_Ns, point_W);
}

/// The striker and its riders, which strike as one.
struct Strikers {
  std::vector<const Actor*> all;  ///< The striker first.
  double mass_kg = 0;

  Vec3 velocity_W(const WorldState& world) const {
    Vec3 momentum_Ns = Vec3::Zero();
    for (const Actor* actor : all)
      momentum_Ns += actor->weight.mass_kg * world.physics->state(actor->body).velocity_W;
    return momentum_Ns / mass_kg;
  }
  /// Applies an impulse to all, shared by mass, so that their velocities change alike.
  double push(WorldState& world, const Vec3& impulse_Ns, double time_s) const {
    double gain_J = 0;
    for (const Actor* actor : all) {
      const double share = actor->weight.mass_kg / mass_kg;
      const Vec3 at_W = world.physics->state(actor->body).X_WB.position;
      gain_J += push_at(world, *actor, share * impulse_Ns, at_W, time_s);
    }
    return gain_J;
  }
};

Strikers strikers_of(const WorldState& world, const PlannedBreak& planned) {
  Strikers strikers;
  const auto add = [&](std::uint32_t key) {
    const Actor* actor = world.actors.find(key);
    if (!actor) return;
    strikers.all.push_back(actor);
    strikers.mass_kg += actor->weight.mass_kg;
  };
  add(planned.striker);
  for (const std::uint32_t key : planned.riders) add(key);
  return strikers;
}

/// Turns the velocity of strikers relative to the rest of a solid into the direction of the path,
/// as the sides of the hole guide them, and takes the part of the work that the impulses of the
/// contacts have not. `rest` is null for a held solid. Returns the change of kinetic energy.
double keep_on_path(WorldState& world, const PlannedBreak& planned, const Strikers& strikers,
                    const Actor* rest, const Vec3& path_W) {
  const Vec3 at_W = world.physics->state(strikers.all[0]->body).X_WB.position;
  Vec3 relative_m_s = strikers.velocity_W(world);
  Vec3 then_W = at_W;  // where the striker is by the rest at the time of the impact
  double inverse_kg = 1 / strikers.mass_kg;
  if (rest) {
    const BodyState state = world.physics->state(rest->body);
    then_W += planned.time_s * (relative_m_s - state.velocity_W);
    relative_m_s -= state.field()(then_W);
    inverse_kg += inverse_effective_mass(*rest, state, then_W, path_W);
  }
  const double left_m2_s2 =
      relative_m_s.squaredNorm() - 2 * inverse_kg * (planned.needed_J - planned.along_normal_J());
  const Vec3 change_m_s = std::sqrt(std::max(0.0, left_m2_s2)) * path_W - relative_m_s;
  if (change_m_s.isZero(0)) return 0;
  const Vec3 impulse_Ns = 1 / inverse_kg * change_m_s;
  double gain_J = strikers.push(world, impulse_Ns, planned.time_s);
  if (rest) gain_J += push_at(world, *rest, -impulse_Ns, then_W, planned.time_s);
  return gain_J;
}

/// Returns true if convexes that stay in place are in the prism that the striker sweeps.
bool is_blocked(const WorldState& world, const PlannedBreak& planned) {
  const Actor* left = world.actors.find(planned.impact.key);
  if (planned.command.plug) return !planned.command.plug->through;
  return left && thickness_along(left->structure, planned.swept.point_R, planned.swept.direction_R,
                                 planned.swept.thickness_m) > 0;
}

}  // namespace

std::vector<Vec3> cross_section(const WorldState& world, std::span<const Actor* const> actors,
                                const Vec3& point_W, const Vec3& direction_W, double reach_m) {
  const auto [u, v] = axes_across(direction_W);
  std::vector<Vec2> hull;
  for (const Actor* actor : actors) add_outline(world, *actor, point_W, u, v, reach_m, hull);
  if (actors.size() > 1 || !actors[0]->structure.empty()) {
    hull = convex_outline(std::move(hull), 0);
    simplify(hull);
  }
  double area_m2 = 0, widest_m = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    area_m2 += 0.5 * cross(hull[i], hull[(i + 1) % hull.size()]);
    for (const Vec2& other : hull) widest_m = std::max(widest_m, (hull[i] - other).norm());
  }
  if (hull.size() < 3 || !(area_m2 > kMinSectionArea * widest_m * widest_m)) return {};
  std::vector<Vec3> section_W;
  for (const Vec2& corner : hull) section_W.push_back(point_W + corner.x() * u + corner.y() * v);
  return section_W;
}

double thickness_behind(const Structure& structure, const std::vector<Vec3>& section_R,
                        const Vec3& point_R, const Vec3& direction_R, double most_m) {
  return median_behind(section_R, point_R, [&](const Vec3& from_R) {
    return thickness_along(structure, from_R, direction_R, most_m);
  });
}

double path_behind(const Structure& structure, const std::vector<Vec3>& section_R,
                   const Vec3& point_R, const Vec3& direction_R, double back_m, double most_m) {
  return median_behind(section_R, point_R, [&](const Vec3& from_R) {
    return path_through(structure, from_R, direction_R, back_m, most_m);
  });
}

double confinement(const Structure& structure, const std::vector<Vec3>& section_R,
                   const Vec3& direction_R, double depth_m) {
  Vec3 middle_R = Vec3::Zero();
  for (const Vec3& corner : section_R) middle_R += corner / static_cast<double>(section_R.size());
  const auto is_filled = [&](const Vec3& corner) {
    const Vec3 point_R = middle_R + kConfinementScale * (corner - middle_R) + depth_m * direction_R;
    return std::ranges::any_of(structure.within(point_R, 0), [&](ConvexSlot slot) {
      return distance_to(*structure.convex(slot), point_R) <= 0;
    });
  };
  return static_cast<double>(std::ranges::count_if(section_R, is_filled)) /
         static_cast<double>(section_R.size());
}

void apply_plastic_collision(WorldState& world, const PlannedBreak& planned,
                             std::uint32_t first_key) {
  const Actor* striker = world.actors.find(planned.striker);
  if (planned.swept.section_R.empty() || !striker || is_blocked(world, planned)) return;
  const std::optional<Plug>& plug = planned.command.plug;
  const BodyStates states = world.physics->states();
  std::vector<const Actor*> pieces;
  const Actor* rest = nullptr;  // the largest piece of a free solid beside the path
  double plug_kg = 0;
  Vec3 moment_kgm = Vec3::Zero();
  const Vec3& axis_W = planned.path_W;
  Vec3 at_rest_Ns = Vec3::Zero();
  const bool breaks_at_bonds = planned.command.pattern.kind == PatternSpec::Kind::kNone;
  const auto is_in_path = [&](const Actor& piece) {
    if (!plug) return is_in_prism(planned.swept, piece.weight.com_R, piece.volume_m3);
    if (breaks_at_bonds) return piece.structure.size() == 1;
    return is_within(*plug, planned.command.X_RP.inverse(), piece);
  };
  for (const Actor& actor : world.actors) {
    if (actor.key < first_key || actor.is_static) continue;
    if (!is_in_path(actor)) {
      if (!rest || rest->weight.mass_kg < actor.weight.mass_kg) rest = &actor;
      continue;
    }
    pieces.push_back(&actor);
    plug_kg += actor.weight.mass_kg;
    moment_kgm += actor.weight.mass_kg * states[actor.body].X_WB.position;
    at_rest_Ns += actor.weight.mass_kg * states[actor.body].velocity_W;
  }
  // Debris of a held solid takes its share of the momentum; debris of a free solid moves as the
  // solid did.
  const bool is_held = world.actors.find(planned.impact.key) != nullptr;
  const double pieces_kg = plug_kg;
  const double debris_kg = is_held && plug ? std::max(0.0, plug->mass_kg - plug_kg) : 0;
  plug_kg += debris_kg;
  if (!(plug_kg > 0)) return;
  const Vec3 middle_W = pieces.empty() ? planned.impact.point_W : Vec3(moment_kgm / pieces_kg);
  const Vec3 middle_m_s_W = pieces.empty() ? Vec3::Zero() : Vec3(at_rest_Ns / pieces_kg);
  const double at_rest_m_s = at_rest_Ns.dot(axis_W) / plug_kg;
  const Strikers strikers = strikers_of(world, planned);
  const bool several = strikers.all.size() > 1;
  double gain_J = 0;
  if (plug && !striker->is_kinematic && (is_held || rest))
    gain_J += keep_on_path(world, planned, strikers, is_held ? nullptr : rest, axis_W);
  const BodyState state = world.physics->state(striker->body);
  const Vec3 velocity_W = several ? strikers.velocity_W(world) : state.field()(middle_W);
  const double closing_m_s = velocity_W.dot(axis_W) - at_rest_m_s;
  if (!(closing_m_s > 0)) return;
  const double inverse_kg =
      several ? 1 / strikers.mass_kg : inverse_effective_mass(*striker, state, middle_W, axis_W);
  const double gain_m_s = closing_m_s / (1 + plug_kg * inverse_kg);
  for (const Actor* piece : pieces) {
    BodyState moved = world.physics->state(piece->body);
    moved.velocity_W += gain_m_s * axis_W;
    moved.X_WB.position -= planned.time_s * gain_m_s * axis_W;
    gain_J += move_actor(world, *piece, moved);
  }
  if (!striker->is_kinematic) {
    const Vec3 impulse_Ns = -plug_kg * gain_m_s * axis_W;
    // The middle of the pieces, as it is by the striker at the time of the impact.
    const Vec3 then_W = middle_W - planned.time_s * (state.velocity_W - middle_m_s_W);
    gain_J += several ? strikers.push(world, impulse_Ns, planned.time_s)
                      : push_at(world, *striker, impulse_Ns, then_W, planned.time_s);
  }
  const double debris_J = debris_kg * gain_m_s * (at_rest_m_s + 0.5 * gain_m_s);
  EnergyFlows& energy = world.log.report.energy;
  energy.debris += debris_J;
  energy.contacts -= gain_J + debris_J;
}

}  // namespace sunder
