// Sweeps the centres of shapes along the paths that their bodies took.
#include "solver/rigid/passages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/base/parallel.h"
#include "engine/base/rotation.h"
#include "solver/rigid/body/motion.h"
#include "solver/rigid/collide/narrow_phase.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

using Kind = ShapeDesc::Kind;

constexpr double kPartAngle = 0.25;  // rad; a path is straight in a frame that turns by less
constexpr int kMostParts = 16, kTouchRounds = 12;

/// Two bodies that met at a part of their paths, 0 being the start of the step and 1 its end.
struct Passage {
  BodySlot a, b;
  double part;
};

/// TakenPath of a body between the start of the step and its end.
struct TakenPath {
  Pose start, end;
  Vec3 turn_W = Vec3::Zero();

  Pose at(double part) const {
    if (part == 0) return start;
    if (part == 1) return end;
    return {start.position + part * (end.position - start.position),
            turn_W.isZero(0) ? end.rotation : rotation_by(part * turn_W) * start.rotation};
  }
};

/// TakenPaths of all bodies.
struct TakenPaths {
  const ByBody<Vec3>& position;
  const ByBody<Quat>& rotation;
  const Bodies& bodies;

  bool moves(BodySlot body) const { return bodies.awake(body) || bodies.is_moving_kinematic(body); }
  TakenPath operator[](BodySlot body) const {
    TakenPath path;
    path.end = path.start = {bodies.position[body], bodies.rotation[body]};
    if (!moves(body)) return path;
    path.start = {position[body], rotation[body]};
    path.turn_W = rotation_vector(path.end.rotation * path.start.rotation.conjugate());
    return path;
  }
};

/// Returns the part of a straight way, in the frame of the shape, at which it goes into the shape
/// from outside.
std::optional<double> entry(const Shape& shape, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  if (shape.kind == Kind::kSphere) {
    const Vec3 off = from - shape.center.cast<double>();
    const double a = way.squaredNorm(), b = off.dot(way),
                 c = off.squaredNorm() - double{shape.radius_m} * double{shape.radius_m};
    const double root = b * b - a * c;
    if (c < 0 || b >= 0 || root < 0 || !(a > 0)) return {};
    const double part = (-b - std::sqrt(root)) / a;
    return part <= 1 ? std::optional(part) : std::nullopt;
  }
  double enter = -1, leave = 1;
  std::uint32_t by = 0;
  const auto cut = [&](const Vec3& normal, double d, std::uint32_t face) {
    const double start = normal.dot(from) + d, end = normal.dot(to) + d;
    if (start >= 0 && end >= 0) leave = -2;
    if (start >= 0 && end < 0 && start / (start - end) > enter)
      enter = start / (start - end), by = face;
    if (start < 0 && end >= 0) leave = std::min(leave, start / (start - end));
  };
  if (shape.kind == Kind::kHalfSpace) {
    cut(shape.normal.cast<double>(), -shape.normal.dot(shape.center), 0);
  } else {
    for (std::uint32_t f = 0; f < shape.hull.face_count() && leave >= enter; ++f)
      cut(shape.hull.normal(f).cast<double>(), double{shape.hull.plane_d(f)}, f);
  }
  if (enter < 0 || enter > leave || (shape.facet && by != 0)) return {};
  return enter;
}

/// Two shapes and the paths of their bodies.
struct Passing {
  const Shape &a, &b;
  const TakenPath &path_a, &path_b;

  /// Pose of b in a.
  RelativePose pose(double part) const {
    const Pose at_a = path_a.at(part), at_b = path_b.at(part);
    const Quat back = at_a.rotation.conjugate();
    return {(back * at_b.rotation).toRotationMatrix().cast<float>(),
            (back * (at_b.position - at_a.position)).cast<float>()};
  }
  double separation_m(double part, NarrowScratch& scratch) const {
    return double{solver::separation_m(a, b, pose(part), scratch)};
  }
};

/// Returns the part of the paths at which the centre of `of` goes into `into`.
std::optional<double> entry(const Shape& of, const TakenPath& path, const Shape& into,
                            const TakenPath& path_into) {
  const double angle = path.turn_W.norm() + path_into.turn_W.norm();
  const int parts = std::clamp(static_cast<int>(std::ceil(angle / kPartAngle)), 1, kMostParts);
  const auto place = [&](double part) -> Vec3 {
    const Pose own = path.at(part), other = path_into.at(part);
    const Vec3 center_W = own.position - other.position + own.rotation * of.center.cast<double>();
    return other.rotation.conjugate() * center_W;
  };
  Vec3 from = place(0);
  for (int i = 0; i < parts; ++i) {
    const Vec3 to = place((i + 1.) / parts);
    if (const std::optional<double> met = entry(into, from, to)) return (i + *met) / parts;
    from = to;
  }
  return {};
}

/// Returns the last part of the paths before `part` at which the shapes did not overlap, or no more
/// than at the start; none if they overlapped deeply then, as contacts push such shapes apart.
std::optional<double> before_touch(const Passing& pair, double part, NarrowScratch& scratch) {
  const float size_m = std::min(pair.a.inner_radius_m, pair.b.inner_radius_m);
  const double at_start_m = std::min(0., pair.separation_m(0, scratch));
  if (at_start_m < -double{kPassageOverlap * size_m}) return {};
  double before = 0, after = part;
  for (int round = 0; round < kTouchRounds; ++round) {
    const double middle = 0.5 * (before + after);
    (pair.separation_m(middle, scratch) >= at_start_m ? before : after) = middle;
  }
  return before;
}

/// Positions in W of the centre of a shape, at the start of the step and at its end.
struct CenterPath {
  Vec3 from, to;
};

CenterPath center_path(const Shape& shape, const TakenPaths& paths) {
  const Vec3 center = shape.center.cast<double>();
  const auto at = [&](const Vec3& position, const Quat& rotation) -> Vec3 {
    return position + rotation * center;
  };
  const Bodies& bodies = paths.bodies;
  const BodySlot body = shape.body;
  const Vec3 to = at(bodies.position[body], bodies.rotation[body]);
  return {paths.moves(body) ? at(paths.position[body], paths.rotation[body]) : to, to};
}

/// Distance from the centre of a shape beyond which it has no point.
double radius_m(const Shape& shape) {
  return shape.kind == Kind::kHalfSpace ? 1e30 : double{shape.reach_m + shape.center.norm()};
}

/// True if one of two centres, which move straight, comes within a distance of the other.
bool come_near(const CenterPath& a, const CenterPath& b, double distance_m) {
  const Vec3 from = b.from - a.from, way = b.to - a.to - from;
  const double square = way.squaredNorm();
  const double part = square > 0 ? std::clamp(-from.dot(way) / square, 0., 1.) : 0;
  return (from + part * way).squaredNorm() < distance_m * distance_m;
}

/// Appends the passages of the shapes of a body through others, and of others through them.
void find_passages(BodySlot body, const TakenPaths& paths, const BroadPhase& broad_phase,
                   std::span<const ShapeSlot> strays, const Shapes& shapes, const Joints& joints,
                   std::vector<Passage>& found) {
  const Bodies& bodies = paths.bodies;
  const TakenPath path = paths[body];
  NarrowScratch scratch;
  for (ShapeSlot own = bodies.first_shape[body]; !own.none(); own = shapes[own].next) {
    const Shape& shape = shapes[own];
    const CenterPath way = center_path(shape, paths);
    if (!((way.to - way.from).norm() > double{shape.inner_radius_m})) continue;
    const Vec3f low = way.from.cwiseMin(way.to).cast<float>(),
                high = way.from.cwiseMax(way.to).cast<float>();
    const float pad = static_cast<float>(radius_m(shape)) +
                      4e-7f * (low.cwiseAbs().maxCoeff() + high.cwiseAbs().maxCoeff());
    const FloatBox box{low - Vec3f::Constant(pad), high + Vec3f::Constant(pad)};
    broad_phase.in_box(box, strays, [&](ShapeSlot other) {
      const Shape& into = shapes[other];
      if (into.body == body || !bodies.filter[body].collides_with(bodies.filter[into.body])) return;
      const double near_m = std::max(radius_m(shape), radius_m(into));
      if (!come_near(way, center_path(into, paths), near_m)) return;
      const TakenPath other_path = paths[into.body];
      std::optional<double> part = entry(shape, path, into, other_path);
      if (!part && into.kind != Kind::kHalfSpace) part = entry(into, other_path, shape, path);
      if (!part) return;
      const Pair pair = pair_of(own, other, shapes);
      if (joints.ignores(pair, shapes, bodies)) return;
      const bool is_a = pair.body_a == body;
      const Passing both{shapes[pair.shape_a], shapes[pair.shape_b], is_a ? path : other_path,
                         is_a ? other_path : path};
      if (const std::optional<double> touch = before_touch(both, *part, scratch))
        found.push_back({pair.body_a, pair.body_b, *touch});
    });
  }
}

/// True if the body moved by more than the way from the centre of a shape to its surface.
bool is_fast(BodySlot body, const TakenPaths& paths, const Shapes& shapes) {
  const Bodies& bodies = paths.bodies;
  if (!bodies.awake(body)) return false;
  const double way_m = (bodies.position[body] - paths.position[body]).norm();
  if (!(way_m > double{kMinInnerRadius} * bodies.reach_m[body])) return false;
  for (ShapeSlot s = bodies.first_shape[body]; !s.none(); s = shapes[s].next)
    if (way_m > double{shapes[s].inner_radius_m}) return true;
  return false;
}

/// Bodies that met, directly or through others, and all that joints hold to them.
struct Group {
  double part = 1;       ///< Earliest part of the step at which two of them met.
  bool is_held = false;  ///< True if one of them met a body that does not move.
  BodySlot carrier;      ///< Kinematic body that one of them met; none() if there is none.
  double mass_kg = 0;
  Vec3 mass_way_kgm = Vec3::Zero();
};

/// Returns a body to an earlier rotation on its path, with the angular momentum that it has now and
/// no more energy: it keeps its rotation if it would have more in every one near the earlier one.
Quat turn_back(double part, const TakenPath& path, BodySlot body, Bodies& bodies) {
  const Mat3& inertia_B = bodies.inertia_B[body];
  const Vec3& w_W = bodies.angular_velocity[body];
  const Vec3 spin_W = path.end.rotation * (inertia_B * (path.end.rotation.conjugate() * w_W));
  const double energy_J = 0.5 * spin_W.dot(w_W), turn = path.turn_W.norm();
  RotationState earlier =
      rotation_with_energy(inertia_B, path.at(part).rotation, spin_W, energy_J, turn);
  if (0.5 * spin_W.dot(earlier.w_W) > energy_J) earlier = {path.end.rotation, w_W};
  bodies.angular_velocity[body] = earlier.w_W;
  bodies.rotation_path_m[body] += 1.1 * 2 * turn * bodies.reach_m[body];
  return earlier.R_WB;
}

/// Returns the position at the end of the step of a body of a group, from that at the group's part:
/// the group stays, moves with its carrier, or goes on with its centre of mass.
Vec3 carried(const Vec3& position, const Group& group, const TakenPaths& paths) {
  if (group.is_held) return position;
  if (group.carrier.none()) return position + (1 - group.part) / group.mass_kg * group.mass_way_kgm;
  const TakenPath path = paths[group.carrier];
  const Pose then = path.at(group.part);
  return path.end.position +
         path.end.rotation * (then.rotation.conjugate() * (position - then.position));
}

/// Stops two bodies in the direction in which they went into each other, as their contact did not,
/// and returns the impulse on what is not awake.
Vec3 stop(const Passage& passage, const TakenPaths& paths, Bodies& bodies) {
  const auto way_m = [&](BodySlot body) -> Vec3 {
    if (!paths.moves(body)) return Vec3::Zero();
    return bodies.position[body] - paths.position[body];
  };
  const Vec3 along = (way_m(passage.a) - way_m(passage.b)).normalized();
  const double speed_m_s = along.dot(bodies.velocity[passage.a] - bodies.velocity[passage.b]);
  if (!(speed_m_s > 0)) return Vec3::Zero();
  const double inverse_a = bodies.awake(passage.a) ? 1 / bodies.mass_kg[passage.a] : 0,
               inverse_b = bodies.awake(passage.b) ? 1 / bodies.mass_kg[passage.b] : 0;
  const Vec3 impulse_Ns = speed_m_s / (inverse_a + inverse_b) * along;
  bodies.velocity[passage.a] -= inverse_a * impulse_Ns;
  bodies.velocity[passage.b] += inverse_b * impulse_Ns;
  if (inverse_a == 0) return -impulse_Ns;
  return inverse_b == 0 ? impulse_Ns : Vec3(0, 0, 0);
}

}  // namespace

void Passages::begin(const Bodies& bodies) {
  position_ = bodies.position;
  rotation_ = bodies.rotation;
}

Passages::PutBack Passages::put_back(const StepContext& step, const BroadPhase& broad_phase,
                                     const Shapes& shapes, const Joints& joints,
                                     Bodies& bodies) const {
  constexpr std::size_t kBodies = 256;
  const TakenPaths paths{position_, rotation_, bodies};
  const auto fast = collect_chunks<BodySlot>(
      bodies.size(), kBodies,
      [&](std::size_t begin, std::size_t end, std::vector<BodySlot>& found) {
        for (BodySlot body(begin); body.value < end; ++body.value)
          if (is_fast(body, paths, shapes)) found.push_back(body);
      });
  if (fast.empty()) return {};
  const std::vector<ShapeSlot> strays = broad_phase.strays(shapes, bodies);
  const auto passages = collect_chunks<Passage>(
      fast.size(), 16, [&](std::size_t begin, std::size_t end, std::vector<Passage>& found) {
        for (std::size_t i = begin; i < end; ++i)
          find_passages(fast[i], paths, broad_phase, strays, shapes, joints, found);
      });
  if (passages.empty()) return {};
  DisjointSets sets(bodies.size());
  ByBody<std::uint8_t> is_returned(bodies.size());
  std::vector<BodySlot> returned;
  for (const Passage& passage : passages) {
    for (const BodySlot body : {passage.a, passage.b}) {
      if (!bodies.awake(body)) continue;
      for (const BodySlot joined : joints.joined_to(body, bodies)) {
        if (!std::exchange(is_returned[joined], 1)) returned.push_back(joined);
        sets.join(body.value, joined.value);
      }
    }
    if (bodies.awake(passage.a) && bodies.awake(passage.b))
      sets.join(passage.a.value, passage.b.value);
  }
  std::map<std::size_t, Group> groups;
  const auto group_of = [&](BodySlot body) -> Group& { return groups[sets.root(body.value)]; };
  for (const BodySlot body : returned) {
    Group& group = group_of(body);
    group.mass_kg += bodies.mass_kg[body];
    group.mass_way_kgm += bodies.mass_kg[body] * (bodies.position[body] - paths.position[body]);
  }
  PutBack all;
  all.bodies = returned.size();
  for (const Passage& passage : passages) {
    const bool a_awake = bodies.awake(passage.a);
    Group& group = group_of(a_awake ? passage.a : passage.b);
    group.part = std::min(group.part, passage.part);
    const BodySlot other = a_awake ? passage.b : passage.a;
    if (bodies.is_moving_kinematic(other))
      group.carrier = other;
    else if (!bodies.awake(other))
      group.is_held = true;
    if (passage.part == 0) all.impulse_Ns += stop(passage, paths, bodies);
  }
  for (const BodySlot body : returned) {
    const Group& group = group_of(body);
    if (group.is_held || !group.carrier.none()) {
      const Vec3 fall_m_s = (1 - group.part) * step.dt_s * step.gravity_W;
      bodies.velocity[body] -= fall_m_s;
      all.impulse_Ns += bodies.mass_kg[body] * fall_m_s;
    }
    const TakenPath path = paths[body];
    const Vec3 position_W = carried(path.at(group.part).position, group, paths);
    bodies.place(body, position_W, turn_back(group.part, path, body, bodies));
    bodies.changed[body] = 1;
  }
  return all;
}

}  // namespace sunder::solver
