// Sweeps the centres of shapes along the paths that their bodies took.
#include "solver/rigid/collide/passages.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/base/parallel.h"
#include "engine/base/rotation.h"
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

/// Paths of bodies between the start of the step and its end.
struct Paths {
  const ByBody<Vec3>& position;
  const ByBody<Quat>& rotation;
  const Bodies& bodies;

  bool moved(BodySlot body) const { return bodies.awake(body) || bodies.is_moving_kinematic(body); }
  Pose at(BodySlot body, double part) const {
    const Pose end{bodies.position[body], bodies.rotation[body]};
    if (!moved(body)) return end;
    return {position[body] + part * (end.position - position[body]),
            rotation_by(part * turn_W(body)) * rotation[body]};
  }
  Vec3 turn_W(BodySlot body) const {
    return rotation_vector(bodies.rotation[body] * rotation[body].conjugate());
  }
  double angle(BodySlot body) const { return moved(body) ? turn_W(body).norm() : 0; }
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

/// Returns the part of the paths at which the centre of `of` goes into `into`.
std::optional<double> entry(const Paths& paths, const Shape& of, const Shape& into) {
  const double angle = paths.angle(of.body) + paths.angle(into.body);
  const int parts = std::clamp(static_cast<int>(std::ceil(angle / kPartAngle)), 1, kMostParts);
  const auto place = [&](double part) -> Vec3 {
    const Pose own = paths.at(of.body, part), other = paths.at(into.body, part);
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

/// Returns the last part of the paths before `part` at which the shapes did not overlap.
double before_touch(const Paths& paths, const Shape& a, const Shape& b, double part,
                    NarrowScratch& scratch) {
  double apart = 0, overlapping = part;
  for (int round = 0; round < kTouchRounds; ++round) {
    const double middle = 0.5 * (apart + overlapping);
    const Pose at_a = paths.at(a.body, middle), at_b = paths.at(b.body, middle);
    const Quat back = at_a.rotation.conjugate();
    const RelativePose pose{(back * at_b.rotation).toRotationMatrix().cast<float>(),
                            (back * (at_b.position - at_a.position)).cast<float>()};
    (separation_m(a, b, pose, scratch) >= 0 ? apart : overlapping) = middle;
  }
  return apart;
}

/// Returns the passages of the shapes of a body.
void find_passages(BodySlot body, const Paths& paths, const BroadPhase& broad_phase,
                   std::span<const ShapeSlot> strays, const Shapes& shapes, const Joints& joints,
                   std::vector<Passage>& found) {
  const Bodies& bodies = paths.bodies;
  const Vec3 from = paths.position[body], to = bodies.position[body];
  const auto reach = static_cast<float>(bodies.reach_m[body]);
  const Vec3f low = from.cwiseMin(to).cast<float>(), high = from.cwiseMax(to).cast<float>();
  const float pad =
      reach + 4e-7f * (low.cwiseAbs().maxCoeff() + high.cwiseAbs().maxCoeff() + reach);
  const FloatBox box{low - Vec3f::Constant(pad), high + Vec3f::Constant(pad)};
  NarrowScratch scratch;
  broad_phase.in_box(box, strays, [&](ShapeSlot other) {
    const BodySlot other_body = shapes[other].body;
    if (other_body == body || !bodies.filter[body].collides_with(bodies.filter[other_body])) return;
    for (ShapeSlot own = bodies.first_shape[body]; !own.none(); own = shapes[own].next) {
      const Pair pair = pair_of(own, other, shapes);
      const Shape &a = shapes[pair.shape_a], &b = shapes[pair.shape_b];
      std::optional<double> part = entry(paths, b, a);
      if (b.kind == Kind::kHull && a.kind != Kind::kHalfSpace && !part) part = entry(paths, a, b);
      if (!part || joints.ignores(pair, shapes, bodies)) continue;
      found.push_back({pair.body_a, pair.body_b, before_touch(paths, a, b, *part, scratch)});
    }
  });
}

/// True if the centre of a shape of the body moved by more than the way to the shape's surface.
bool is_fast(BodySlot body, const Paths& paths, const Shapes& shapes) {
  const Bodies& bodies = paths.bodies;
  if (!bodies.awake(body)) return false;
  const double way_m = (bodies.position[body] - paths.position[body]).norm();
  if (!(way_m > double{kMinInnerRadius} * bodies.reach_m[body])) return false;
  for (ShapeSlot s = bodies.first_shape[body]; !s.none(); s = shapes[s].next)
    if (way_m > double{shapes[s].inner_radius_m}) return true;
  return false;
}

}  // namespace

void Passages::begin(const Bodies& bodies) {
  position_ = bodies.position;
  rotation_ = bodies.rotation;
}

std::size_t Passages::put_back(const BroadPhase& broad_phase, const Shapes& shapes,
                               const Joints& joints, Bodies& bodies) const {
  constexpr std::size_t kBodies = 256;
  const Paths paths{position_, rotation_, bodies};
  const auto fast = collect_chunks<BodySlot>(
      bodies.size(), kBodies,
      [&](std::size_t begin, std::size_t end, std::vector<BodySlot>& found) {
        for (BodySlot body(begin); body.value < end; ++body.value)
          if (is_fast(body, paths, shapes)) found.push_back(body);
      });
  if (fast.empty()) return 0;
  const std::vector<ShapeSlot> strays = broad_phase.strays(shapes, bodies);
  const auto passages = collect_chunks<Passage>(
      fast.size(), 16, [&](std::size_t begin, std::size_t end, std::vector<Passage>& found) {
        for (std::size_t i = begin; i < end; ++i)
          find_passages(fast[i], paths, broad_phase, strays, shapes, joints, found);
      });
  if (passages.empty()) return 0;
  // Bodies that met, and bodies in joints, return to the same time.
  ByBody<double> part(bodies.size());
  std::fill(part.begin(), part.end(), 1.);
  std::vector<BodySlot> returned;
  for (bool changed = true; std::exchange(changed, false);) {
    const auto lower = [&](BodySlot body, double to) {
      if (!bodies.awake(body) || part[body] <= to) return;
      for (const BodySlot joined : joints.joined_to(body, bodies)) {
        if (part[joined] == 1) returned.push_back(joined);
        part[joined] = std::min(part[joined], to);
      }
      changed = true;
    };
    for (const Passage& passage : passages) {
      const double least = std::min({passage.part, part[passage.a], part[passage.b]});
      lower(passage.a, least), lower(passage.b, least);
    }
  }
  for (const BodySlot body : returned) {
    const Pose pose = paths.at(body, part[body]);
    bodies.rotation_path_m[body] += 1.1 * paths.angle(body) * bodies.reach_m[body];
    bodies.place(body, pose.position, pose.rotation);
    bodies.changed[body] = 1;
  }
  return returned.size();
}

}  // namespace sunder::solver
