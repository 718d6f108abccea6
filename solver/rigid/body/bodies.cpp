// Adds, removes, places, freezes and wakes bodies; adds shapes.
#include "solver/rigid/body/bodies.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "engine/geometry/inertia.h"
#include "engine/model/checks/ranges.h"

namespace sunder::solver {
namespace {

constexpr std::size_t kBodiesAChunk = 256;

/// Principal axes divided by the square roots of the moments; `uneven` if the moments differ by
/// more than rounding.
struct InertiaRoot {
  Mat3f root = Mat3f::Zero();
  Mat3 inertia = Mat3::Zero();
  bool uneven = false;
};

InertiaRoot inertia_root(const Mat3& inertia_B) {
  const auto [axes, moments] = principal_moments(inertia_B);
  SUNDER_CHECK(moments.maxCoeff() > 0);
  InertiaRoot result;
  result.root = (axes * moments.cwiseSqrt().cwiseInverse().asDiagonal()).cast<float>();
  result.inertia = axes * moments.asDiagonal() * axes.transpose();
  result.uneven = moments.minCoeff() < (1 - 1e-6) * moments.maxCoeff();
  return result;
}

double largest(const Vec3& vector) { return vector.cwiseAbs().maxCoeff(); }

Shape make_shape(const ShapeDesc& desc, const Vec3& com_R) {
  Shape shape;
  shape.kind = desc.kind;
  shape.tag = desc.tag;
  shape.friction = static_cast<float>(desc.friction);
  shape.rolling = static_cast<float>(desc.rolling);
  shape.restitution = static_cast<float>(desc.restitution);
  shape.center = (desc.center_R - com_R).cast<float>();
  shape.normal = desc.normal_R.normalized().cast<float>();
  shape.radius_m = static_cast<float>(desc.radius_m);
  if (desc.kind == ShapeDesc::Kind::kHull) {
    shape.hull = Hull(*desc.hull, com_R);
    shape.center = shape.hull.center();
    shape.inner_radius_m = shape.hull.inner_radius_m();
    shape.reach_m = shape.hull.reach_m();
    shape.facet = desc.bends.has_value();
    for (std::size_t i = 0; shape.facet && i < shape.bends.size(); ++i)
      shape.bends[i] = (*desc.bends)[i].cast<float>();
  } else if (desc.kind == ShapeDesc::Kind::kSphere) {
    shape.inner_radius_m = shape.radius_m;
    shape.reach_m = shape.center.norm() + shape.radius_m;
  } else {
    shape.inner_radius_m = 1e30f;
  }
  return shape;
}

}  // namespace

void Bodies::resize(std::uint32_t count) {
  motion.resize(count, Motion::kAbsent);
  generation.resize(count, 0);
  position.resize(count);
  com_R.resize(count);
  rotation.resize(count);
  rotation_f.resize(count);
  velocity.resize(count);
  angular_velocity.resize(count);
  mass_kg.resize(count);
  inertia_B.resize(count);
  inverse_mass.resize(count);
  root_B.resize(count);
  is_gyroscopic.resize(count);
  reach_m.resize(count);
  rotation_path_m.resize(count);
  slow_s.resize(count);
  resting_s.resize(count);
  lost_N.resize(count);
  rest_position.resize(count);
  rest_rotation.resize(count);
  is_new.resize(count);
  changed.resize(count);
  displaced.resize(count);
  reports_load.resize(count);
  filter.resize(count);
  tag.resize(count);
  first_shape.resize(count);
}

const char* Bodies::wrong_field() const {
  if (!have_size(size(), generation, position, com_R, rotation, rotation_f, velocity,
                 angular_velocity, mass_kg, inertia_B, inverse_mass, root_B, is_gyroscopic, reach_m,
                 rotation_path_m, slow_s, resting_s, lost_N, rest_position, rest_rotation, is_new,
                 changed, displaced, reports_load, tag, filter, first_shape))
    return "motion";
  if (!are_different_below(free_slots, size())) return "free_slots";
  const auto absent = static_cast<std::size_t>(std::ranges::count(motion, Motion::kAbsent));
  if (absent != free_slots.size()) return "free_slots";
  for (const BodySlot body : free_slots)
    if (motion[body] != Motion::kAbsent) return "free_slots";
  for (const BodySlot body : slots()) {
    if (motion[body] == Motion::kAbsent) continue;
    if (!is_within(position[body], kMostPlace_m)) return "position";
    if (!is_within(rest_position[body], kMostPlace_m)) return "rest_position";
    if (!is_within(com_R[body], kMostPlace_m)) return "com_R";
    if (rotation_f[body] != rotation[body].toRotationMatrix().cast<float>()) return "rotation_f";
    if (!is_within(velocity[body], kMostSpeed_m_s)) return "velocity";
    if (!is_within(angular_velocity[body], kMostSpeed_m_s)) return "angular_velocity";
    if (!is_bounded(reach_m[body], kMostShape_m)) return "reach_m";
    if (!(rotation_path_m[body] >= 0)) return "rotation_path_m";
    if (!(slow_s[body] >= 0)) return "slow_s";
    if (!(resting_s[body] >= 0)) return "resting_s";
    if (!dynamic(body)) {
      if (inverse_mass[body] != 0) return "inverse_mass";
      if (!root_B[body].isZero(0)) return "root_B";
      continue;
    }
    if (!(mass_kg[body] > 0 && mass_kg[body] < kMostMass_kg)) return "mass_kg";
    if (inverse_mass[body] != static_cast<float>(1 / mass_kg[body])) return "inverse_mass";
    // The root has to be that of the inverse inertia.
    const Mat3 root = root_B[body].cast<double>();
    const Mat3 one = inertia_B[body] * root * root.transpose();
    if (!is_within(one - Mat3::Identity(), kUnitError)) return "root_B";
    if (!(inertia_B[body].diagonal().minCoeff() > 0)) return "inertia_B";
  }
  return nullptr;
}

BodySlot Bodies::add(const BodyDesc& desc) {
  if (free_slots.empty()) {
    free_slots.emplace_back(size());
    resize(size() + 1);
  }
  const BodySlot body = free_slots.back();
  free_slots.pop_back();
  motion[body] = desc.is_static      ? Motion::kStatic
                 : desc.is_kinematic ? Motion::kKinematic
                                     : Motion::kAwake;
  com_R[body] = desc.com_R;
  place(body, desc.X_WB.position, desc.X_WB.rotation);
  velocity[body] = desc.is_static ? Vec3::Zero() : desc.velocity_W;
  angular_velocity[body] = desc.is_static ? Vec3::Zero() : desc.angular_velocity_W;
  mass_kg[body] = desc.mass_kg;
  inertia_B[body] = Mat3::Zero();
  inverse_mass[body] = 0;
  root_B[body].setZero();
  is_gyroscopic[body] = 0;
  if (awake(body)) {
    SUNDER_CHECK(desc.mass_kg > 0 && desc.inertia_B.allFinite());
    const InertiaRoot root = inertia_root(desc.inertia_B);
    inertia_B[body] = root.inertia;
    inverse_mass[body] = static_cast<float>(1 / desc.mass_kg);
    root_B[body] = root.root;
    is_gyroscopic[body] = root.uneven;
  }
  reach_m[body] = 0;
  rotation_path_m[body] = 0;
  disturb(body);
  rest_position[body] = position[body];
  rest_rotation[body] = rotation[body];
  is_new[body] = 1;
  changed[body] = 1;
  displaced[body] = 0;
  reports_load[body] = desc.reports_load;
  filter[body] = desc.filter;
  tag[body] = desc.tag;
  first_shape[body] = {};
  return body;
}

void Bodies::remove(BodySlot body) {
  motion[body] = Motion::kAbsent;
  ++generation[body];
  free_slots.push_back(body);
}

void Bodies::place(BodySlot body, const Vec3& position_W, const Quat& rotation_WB) {
  position[body] = position_W;
  rotation[body] = rotation_WB.normalized();
  rotation_f[body] = rotation[body].toRotationMatrix().cast<float>();
}

bool Bodies::has_finite_pose(BodySlot body) const {
  return position[body].allFinite() && rotation[body].coeffs().allFinite();
}

bool Bodies::is_within_limits(BodySlot body) const {
  return has_finite_pose(body) && largest(velocity[body]) <= ranges::kSpeed_m_s.high &&
         velocity[body].allFinite() &&
         largest(angular_velocity[body]) <= ranges::kSpin_rad_s.high &&
         angular_velocity[body].allFinite();
}

std::optional<Momentum> Bodies::slow_down(BodySlot body) {
  constexpr double kMostSquarable = 1e150;
  Vec3 &v = velocity[body], &w = angular_velocity[body];
  if (!has_finite_pose(body)) return std::nullopt;
  if (!v.allFinite() || !w.allFinite() || std::max(largest(v), largest(w)) > kMostSquarable)
    return std::nullopt;
  Momentum taken{0, mass_kg[body] * v, kinetic_J(body)};
  const auto hold = [](Vec3& speed, const Range& range) {
    if (largest(speed) <= range.high) return;
    speed *= range.high / largest(speed);
    speed = speed.cwiseMax(range.low).cwiseMin(range.high);  // against rounding
  };
  hold(v, ranges::kSpeed_m_s);
  hold(w, ranges::kSpin_rad_s);
  changed[body] = 1;
  taken.momentum_Ns -= mass_kg[body] * v;
  taken.kinetic_J -= kinetic_J(body);
  return taken;
}

Vec3 Bodies::freeze(BodySlot body) {
  const Vec3 momentum =
      velocity[body].allFinite() ? Vec3(mass_kg[body] * velocity[body]) : Vec3(Vec3::Zero());
  motion[body] = Motion::kFrozen;
  velocity[body].setZero();
  angular_velocity[body].setZero();
  inverse_mass[body] = 0;
  root_B[body].setZero();
  changed[body] = 1;
  return momentum;
}

Momentum Bodies::momentum() const {
  std::vector<Momentum> parts((size() + kBodiesAChunk - 1) / kBodiesAChunk);
  for_chunks(size(), kBodiesAChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    Momentum sum;
    for (std::size_t i = begin; i < end; ++i) {
      const BodySlot body(i);
      if (!dynamic(body) && motion[body] != Motion::kFrozen) continue;
      sum.mass_kg += mass_kg[body];
      if (motion[body] != Motion::kAwake) continue;
      sum.momentum_Ns += mass_kg[body] * velocity[body];
      sum.kinetic_J += kinetic_J(body);
    }
    parts[chunk] = sum;
  });
  Momentum sum;
  for (const Momentum& part : parts) {
    sum.mass_kg += part.mass_kg;
    sum.momentum_Ns += part.momentum_Ns;
    sum.kinetic_J += part.kinetic_J;
  }
  return sum;
}

double Bodies::kinetic_J(BodySlot body) const {
  const Vec3 spin_B = rotation[body].conjugate() * angular_velocity[body];
  return 0.5 *
         (mass_kg[body] * velocity[body].squaredNorm() + spin_B.dot(inertia_B[body] * spin_B));
}

void Bodies::set_state(BodySlot body, const BodyState& state) {
  if (!mobile(body)) return;
  wake(body);
  const Quat turn = rotation[body].conjugate() * state.X_WB.rotation;
  rotation_path_m[body] += 3.2 * turn.vec().norm() * reach_m[body];  // angle <= pi * sine
  const Pose before{position[body], rotation[body]};
  place(body, state.X_WB.position, state.X_WB.rotation);
  if (motion[body] == Motion::kKinematic &&
      !(before.position == position[body] && before.rotation.coeffs() == rotation[body].coeffs()))
    displaced[body] = 1;
  velocity[body] = state.velocity_W;
  angular_velocity[body] = state.angular_velocity_W;
  changed[body] = 1;
  disturb(body);
}

void Bodies::apply_impulse(BodySlot body, const Vec3& impulse_W, const Vec3& point_W) {
  if (!dynamic(body)) return;
  wake(body);
  const Quat& q = rotation[body];
  const Vec3 angular_impulse_B = q.conjugate() * (point_W - position[body]).cross(impulse_W);
  velocity[body] += impulse_W / mass_kg[body];
  angular_velocity[body] += q * Vec3(inertia_B[body].inverse() * angular_impulse_B);
  changed[body] = 1;
  disturb(body);
}

void Bodies::wake(BodySlot body) {
  if (motion[body] != Motion::kAsleep) return;
  motion[body] = Motion::kAwake;
  changed[body] = 1;
  disturb(body);
}

void Bodies::disturb(BodySlot body) {
  slow_s[body] = 0;
  restart_rest(body);
}

void Bodies::restart_rest(BodySlot body) {
  resting_s[body] = 0;
  lost_N[body] = 0;
}

void Bodies::clear_step_flags() {
  std::fill(is_new.begin(), is_new.end(), std::uint8_t{0});
  std::fill(displaced.begin(), displaced.end(), std::uint8_t{0});
}

namespace {

std::uint64_t tag_key(BodySlot body, std::uint32_t tag) {
  return std::uint64_t{body.value} << 32 | tag;
}

}  // namespace

std::vector<ShapeSlot> Shapes::add(std::span<const NewShape> added, Bodies& bodies) {
  std::vector<ShapeSlot> slots;
  slots.reserve(added.size());
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (free_slots.empty()) {
      free_slots.emplace_back(size());
      items.emplace_back();
    }
    slots.push_back(free_slots.back());
    free_slots.pop_back();
  }
  for_chunks(slots.size(), 32, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      items[slots[i]] = make_shape(*added[i].desc, bodies.com_R[added[i].body]);
      items[slots[i]].body = added[i].body;
    }
  });
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const ShapeSlot s = slots[i];
    const BodySlot body = added[i].body;
    items[s].next = bodies.first_shape[body];
    if (!items[s].next.none()) items[items[s].next].previous = s;
    bodies.first_shape[body] = s;
    bodies.reach_m[body] = std::max(bodies.reach_m[body], double{items[s].reach_m});
    if (bodies.motion[body] != Motion::kStatic) continue;
    const std::uint64_t key = tag_key(body, items[s].tag);
    if (!static_with_tag_.contains(key)) static_with_tag_.insert(key, s.value);
  }
  return slots;
}

const char* Shape::wrong_field() const {
  const auto is_number = [](float number) { return is_bounded(number, kMostShape_m); };
  if (!is_number(friction)) return "friction";
  if (!is_number(rolling)) return "rolling";
  if (!(restitution >= 0 && restitution <= 1)) return "restitution";
  if (!is_number(radius_m)) return "radius_m";
  if (!is_number(reach_m)) return "reach_m";
  if (!is_within(center, kMostShape_m)) return "center";
  if (kind == ShapeDesc::Kind::kHalfSpace) {
    if (inner_radius_m != 1e30f) return "inner_radius_m";
    return is_unit(normal) ? nullptr : "normal";
  }
  if (!is_number(inner_radius_m)) return "inner_radius_m";
  // A facet is a triangle with a front, three sides and a back.
  if (facet && (hull.vertex_count() == 0 || hull.face_count() < 5)) return "hull";
  if (body.none()) return nullptr;
  return (kind == ShapeDesc::Kind::kHull) == (hull.vertex_count() > 0) ? nullptr : "hull";
}

const char* Shapes::wrong_field() const {
  if (!are_different_below(free_slots, size())) return "free_slots";
  const auto is_free = [](const Shape& shape) { return shape.body.none(); };
  if (static_cast<std::size_t>(std::ranges::count_if(items, is_free)) != free_slots.size())
    return "free_slots";
  for (const ShapeSlot s : free_slots)
    if (!is_free(items[s])) return "free_slots";
  for (const Shape& shape : items) {
    for (const ShapeSlot other : {shape.next, shape.previous})
      if (!other.none() && other.value >= size()) return "items";
    if (is_free(shape) && !(shape.next.none() && shape.previous.none())) return "items";
  }
  return nullptr;
}

const char* Shapes::wrong_field(const Bodies& bodies) const {
  std::size_t listed = 0, with_tag = 0;
  for (const BodySlot body : bodies.slots()) {
    if (bodies.motion[body] == Motion::kAbsent) continue;
    ShapeSlot previous;
    for (ShapeSlot s = bodies.first_shape[body]; !s.none(); s = items[s].next) {
      if (s.value >= size() || items[s].body != body || items[s].previous != previous)
        return "items";
      if (double{items[s].reach_m} > bodies.reach_m[body]) return "items";
      if (bodies.motion[body] == Motion::kStatic) {
        const std::uint32_t known = static_with_tag_.find(tag_key(body, items[s].tag));
        if (known >= size() || items[ShapeSlot(known)].body != body ||
            items[ShapeSlot(known)].tag != items[s].tag)
          return "static_with_tag_";
        with_tag += known == s.value;
      }
      previous = s;
      ++listed;
    }
  }
  if (listed + free_slots.size() != size()) return "items";
  return with_tag == static_with_tag_.size() ? nullptr : "static_with_tag_";
}

std::vector<ShapeSlot> Shapes::of_body(BodySlot body, const Bodies& bodies) const {
  std::vector<ShapeSlot> slots;
  for (ShapeSlot s = bodies.first_shape[body]; !s.none(); s = items[s].next) slots.push_back(s);
  return slots;
}

ShapeSlot Shapes::with_tag(BodySlot body, std::uint32_t tag) const {
  const std::uint32_t s = static_with_tag_.find(tag_key(body, tag));
  SUNDER_CHECK(s != KeyMap::kAbsent);
  return ShapeSlot(s);
}

void Shapes::remove(std::span<const ShapeSlot> removed, Bodies& bodies) {
  for (const ShapeSlot s : removed) {
    const Shape& shape = items[s];
    const std::uint64_t key = tag_key(shape.body, shape.tag);
    if (static_with_tag_.find(key) == s.value) static_with_tag_.erase(key);
    if (!shape.next.none()) items[shape.next].previous = shape.previous;
    if (!shape.previous.none())
      items[shape.previous].next = shape.next;
    else
      bodies.first_shape[shape.body] = shape.next;
    items[s] = Shape();
    free_slots.push_back(s);
  }
}

}  // namespace sunder::solver
