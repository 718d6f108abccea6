// Free flight: torque-free rotation by the implicit midpoint rule with Cayley updates.
#include "solver/rigid/body/motion.h"

#include <algorithm>
#include <cmath>

#include "engine/base/rotation.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr int kMidpointRounds = 12;
constexpr double kMostTurn = 100;  // rad per step; the integration is not valid above
constexpr int kEnergyRounds = 6;
constexpr double kEnergyStep = 1.0001;  // factor of Newton's step, so that it ends below the energy

struct Spin {
  Quat rotation;
  Vec3 w_B;
};

/// One midpoint step: w1 = w0 + h I⁻¹((I wm) × wm), wm = (w0 + w1)/2, then R1 = R0 Cay(h wm). The
/// rule keeps angular momentum for Cayley's map only, so rotation_by() cannot be used.
void midpoint_step(const Mat3& inertia_B, const Mat3& inverse_B, double h, Quat& rotation,
                   Vec3& w_B) {
  const Vec3 w0 = w_B;
  Vec3 w1 = w0;
  for (int round = 0; round < kMidpointRounds; ++round) {
    const Vec3 wm = 0.5 * (w0 + w1);
    const Vec3 next = w0 + h * (inverse_B * (inertia_B * wm).cross(wm));
    const double change = (next - w1).cwiseAbs().maxCoeff();
    w1 = next;
    if (change <= 1e-16 * w0.cwiseAbs().maxCoeff()) break;
  }
  const Vec3 half = 0.25 * h * (w0 + w1);
  rotation = (rotation * Quat(1, half.x(), half.y(), half.z())).normalized();
  w_B = w1;
}

Spin rotated_freely(const Bodies& bodies, BodySlot body, double dt_s) {
  Spin spin{bodies.rotation[body],
            bodies.rotation[body].conjugate() * bodies.angular_velocity[body]};
  const double angle = spin.w_B.norm() * dt_s;
  const int parts = std::max(1, static_cast<int>(std::ceil(angle / kMaxMidpointAngle)));
  const Mat3& inertia_B = bodies.inertia_B[body];
  const Mat3 inverse_B = inertia_B.inverse();
  for (int i = 0; i < parts; ++i)
    midpoint_step(inertia_B, inverse_B, dt_s / parts, spin.rotation, spin.w_B);
  return spin;
}

}  // namespace

bool has_gyroscopic_term(const Bodies& bodies, BodySlot body, double dt_s) {
  const double angle = bodies.angular_velocity[body].norm() * dt_s;
  return bodies.is_gyroscopic[body] != 0 && angle >= double{kStillAngle} && angle < kMostTurn;
}

void move_freely(const StepContext& step, BodySlot body, Bodies& bodies) {
  const double dt_s = step.dt_s;
  const Vec3 displacement = dt_s * (bodies.velocity[body] + 0.5 * dt_s * step.gravity_W);
  bodies.velocity[body] += dt_s * step.gravity_W;
  const Vec3 angle_W = dt_s * bodies.angular_velocity[body];
  Quat rotation;
  if (has_gyroscopic_term(bodies, body, dt_s)) {
    const Spin spin = rotated_freely(bodies, body, dt_s);
    rotation = spin.rotation;
    bodies.angular_velocity[body] = spin.rotation * spin.w_B;
  } else {
    rotation = rotation_by(angle_W) * bodies.rotation[body];
  }
  bodies.place(body, bodies.position[body] + displacement, rotation);
  bodies.rotation_path_m[body] += 1.1 * angle_W.norm() * bodies.reach_m[body];
}

void move_kinematic(const StepContext& step, BodySlot body, Bodies& bodies) {
  const Vec3 angle_W = step.dt_s * bodies.angular_velocity[body];
  bodies.place(body, bodies.position[body] + step.dt_s * bodies.velocity[body],
               rotation_by(angle_W) * bodies.rotation[body]);
  bodies.rotation_path_m[body] += 1.1 * angle_W.norm() * bodies.reach_m[body];
  bodies.changed[body] = 1;
}

RotationState free_rotation(const Bodies& bodies, BodySlot body, double dt_s) {
  const Spin spin = rotated_freely(bodies, body, dt_s);
  return {spin.rotation, bodies.rotation[body] * spin.w_B};
}

RotationState rotation_with(const Mat3& inertia_B, const Quat& R_WB, const Vec3& spin_W) {
  return {R_WB, R_WB * (inertia_B.inverse() * (R_WB.conjugate() * spin_W))};
}

RotationState rotation_with_energy(const Mat3& inertia_B, const Quat& R_WB, const Vec3& spin_W,
                                   double energy_J, double reach_rad) {
  const RotationState first = rotation_with(inertia_B, R_WB, spin_W);
  RotationState now = first;
  for (int round = 0; round < kEnergyRounds && reach_rad > 0; ++round) {
    const double excess_J = 0.5 * spin_W.dot(now.w_W) - energy_J;
    if (excess_J <= 0) return now;
    const Vec3 slope = now.w_W.cross(spin_W);  // of the energy, per rotation
    if (!(slope.squaredNorm() > 0)) break;
    const Vec3 turn = -kEnergyStep * excess_J / slope.squaredNorm() * slope;
    reach_rad -= turn.norm();
    now = rotation_with(inertia_B, rotation_by(turn) * now.R_WB, spin_W);
  }
  return first;
}

}  // namespace sunder::solver
