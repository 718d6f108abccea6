// Adding, removing, placing, freezing and waking of bodies; adding of shapes.
#include "solver/rigid/bodies.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "engine/base/check.h"
#include "engine/base/parallel.h"

namespace sunder::solver {
namespace {

/// Principal axes scaled by the square roots of the inverse moments, and whether those differ by
/// 5 % or more. A degenerate inertia is filled up, so that no axis can be spun without effort.
struct InertiaRoot {
  Mat3f root = Mat3f::Zero();
  Mat3 inertia = Mat3::Zero();
  bool uneven = false;
};

InertiaRoot inertia_root(const Mat3& inertia_B) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (inertia_B + inertia_B.transpose()));
  const double largest = solver.eigenvalues().maxCoeff();
  SUNDER_CHECK(largest > 0);
  const Vec3 moments = solver.eigenvalues().cwiseMax(1e-4 * largest);
  const Mat3 axes = solver.eigenvectors();
  InertiaRoot result;
  result.root = (axes * moments.cwiseSqrt().cwiseInverse().asDiagonal()).cast<float>();
  result.inertia = axes * moments.asDiagonal() * axes.transpose();
  result.uneven = moments.minCoeff() < 0.95 * moments.maxCoeff();
  return result;
}

Shape make_shape(const ShapeDesc& desc, const Vec3& com_R) {
  Shape shape;
  shape.kind = desc.kind;
  shape.present = true;
  shape.tag = desc.tag;
  shape.friction = static_cast<float>(desc.friction);
  shape.restitution = static_cast<float>(desc.restitution);
  shape.center = (desc.center_R - com_R).cast<float>();
  shape.normal = desc.normal_R.normalized().cast<float>();
  shape.radius_m = static_cast<float>(desc.radius_m);
  if (desc.kind == ShapeDesc::Kind::kHull) {
    shape.hull = Hull(*desc.hull, com_R);
    shape.center = shape.hull.center();
    shape.inner_radius_m = shape.hull.inner_radius_m();
    shape.reach_m = shape.hull.reach_m();
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
  rotation.resize(count);
  rotation_f.resize(count);
  velocity.resize(count);
  angular_velocity.resize(count);
  mass_kg.resize(count);
  inertia_B.resize(count);
  inverse_mass.resize(count);
  root_B.resize(count);
  spins_freely.resize(count);
  reach_m.resize(count);
  travelled_m.resize(count);
  slow_s.resize(count);
  changed.resize(count);
  breakable.resize(count);
  bears_load.resize(count);
  group.resize(count);
  tag.resize(count);
  first_shape.resize(count, kNone);
  next_asleep.resize(count, kNone);
}

std::uint32_t Bodies::add(const BodyDesc& desc) {
  if (free_slots.empty()) {
    free_slots.push_back(size());
    resize(size() + 1);
  }
  const std::uint32_t body = free_slots.back();
  free_slots.pop_back();
  motion[body] = desc.is_static ? Motion::kStatic : Motion::kAwake;
  place(body, desc.X_WB.position, desc.X_WB.rotation);
  velocity[body] = desc.is_static ? Vec3::Zero() : desc.velocity_W;
  angular_velocity[body] = desc.is_static ? Vec3::Zero() : desc.angular_velocity_W;
  mass_kg[body] = desc.mass_kg;
  inertia_B[body] = Mat3::Zero();
  inverse_mass[body] = 0;
  root_B[body].setZero();
  spins_freely[body] = 0;
  if (!desc.is_static) {
    SUNDER_CHECK(desc.mass_kg > 0 && desc.inertia_B.allFinite());
    const InertiaRoot root = inertia_root(desc.inertia_B);
    inertia_B[body] = root.inertia;
    inverse_mass[body] = static_cast<float>(1 / desc.mass_kg);
    root_B[body] = root.root;
    spins_freely[body] = root.uneven;
  }
  reach_m[body] = 0;
  travelled_m[body] = 0;
  slow_s[body] = 0;
  changed[body] = 1;
  breakable[body] = desc.breakable;
  bears_load[body] = desc.bears_load;
  group[body] = desc.group;
  tag[body] = desc.tag;
  first_shape[body] = kNone;
  next_asleep[body] = kNone;
  return body;
}

void Bodies::remove(std::uint32_t body) {
  wake(body);
  motion[body] = Motion::kAbsent;
  ++generation[body];
  free_slots.push_back(body);
}

void Bodies::place(std::uint32_t body, const Vec3& position_W, const Quat& rotation_WB) {
  position[body] = position_W;
  rotation[body] = rotation_WB.normalized();
  rotation_f[body] = rotation[body].toRotationMatrix().cast<float>();
}

bool Bodies::finite(std::uint32_t body) const {
  // Beyond 1e9 m/s squares no longer fit a float: as good as infinite.
  return position[body].allFinite() && rotation[body].coeffs().allFinite() &&
         velocity[body].cwiseAbs().maxCoeff() < 1e9 && velocity[body].allFinite() &&
         angular_velocity[body].cwiseAbs().maxCoeff() < 1e9 && angular_velocity[body].allFinite();
}

Vec3 Bodies::freeze(std::uint32_t body) {
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

void Bodies::wake(std::uint32_t body) {
  if (motion[body] != Motion::kAsleep) return;
  std::uint32_t at = body;
  do {
    const std::uint32_t next = next_asleep[at];
    next_asleep[at] = kNone;
    motion[at] = Motion::kAwake;
    slow_s[at] = 0;
    changed[at] = 1;
    at = next;
  } while (at != body);
}

std::vector<std::uint32_t> Shapes::add(std::span<const BodyDesc> descs,
                                       std::span<const std::uint32_t> slots, Bodies& bodies) {
  struct Job {
    const ShapeDesc* desc;
    Vec3 com_R;
    std::uint32_t body, slot;
  };
  std::vector<Job> jobs;
  std::vector<std::uint32_t> added;
  for (std::size_t i = 0; i < descs.size(); ++i) {
    for (const ShapeDesc& desc : descs[i].shapes) {
      if (free_slots.empty()) {
        free_slots.push_back(size());
        items.emplace_back();
      }
      jobs.push_back({&desc, descs[i].com_R, slots[i], free_slots.back()});
      added.push_back(free_slots.back());
      free_slots.pop_back();
    }
  }
  for_chunks(jobs.size(), 32, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t j = begin; j < end; ++j) {
      items[jobs[j].slot] = make_shape(*jobs[j].desc, jobs[j].com_R);
      items[jobs[j].slot].body = jobs[j].body;
    }
  });
  for (const Job& job : jobs) {
    items[job.slot].next = bodies.first_shape[job.body];
    bodies.first_shape[job.body] = job.slot;
    bodies.reach_m[job.body] = std::max(bodies.reach_m[job.body], double{items[job.slot].reach_m});
  }
  return added;
}

void Shapes::remove_of_body(std::uint32_t body, Bodies& bodies) {
  for (std::uint32_t s = bodies.first_shape[body]; s != kNone;) {
    const std::uint32_t next = items[s].next;
    items[s] = Shape();
    free_slots.push_back(s);
    s = next;
  }
  bodies.first_shape[body] = kNone;
}

}  // namespace sunder::solver
