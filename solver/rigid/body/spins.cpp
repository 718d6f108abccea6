#include "solver/rigid/body/spins.h"

#include "engine/base/rotation.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

double energy_J(const BodyRow& row) { return 0.5 * double{angular(row.velocity).squaredNorm()}; }

Vec3 turned(const BodyRow& row, const Mat3f& root_W) {
  return (root_W * angular(row.position)).cast<double>();
}

/// Returns the rotation after turning by `angle_W`, of which `alone_W` without impulses. The
/// difference of the two is applied on top of free rotation if it is smaller than the error of a
/// constant angular velocity.
Quat rotation_now(const Quat& R_WB, const Quat& free, const Vec3& alone_W, const Vec3& angle_W) {
  const Vec3 more_W = angle_W - alone_W;
  const Quat wrong = free * (rotation_by(alone_W) * R_WB).conjugate();
  return more_W.squaredNorm() < 4 * wrong.vec().squaredNorm() ? rotation_by(more_W) * free
                                                              : rotation_by(angle_W) * R_WB;
}

}  // namespace

void Spins::resize(std::uint32_t bodies) {
  spin_.resize(bodies);
  pending_.resize(bodies + 1);
}

void Spins::begin(const StepContext& step, BodySlot body, bool midway, Bodies& bodies) {
  pending_[row_of(body)] = Wide{};
  Spin& spin = spin_[body];
  Vec3& w_W = bodies.angular_velocity[body];
  const Mat3 R_WB(bodies.rotation[body]);
  spin.momentum_W = R_WB * (bodies.inertia_B[body] * (R_WB.transpose() * w_W));
  spin.gyroscopic = has_gyroscopic_term(bodies, body, step.dt_s);
  if (!spin.gyroscopic) return;
  spin.state = free_rotation(bodies, body, step.dt_s);
  w_W = midway ? Vec3(0.5 * (w_W + spin.state.w_W)) : spin.state.w_W;
}

double Spins::end(const StepContext& step, BodySlot body, const BodyRow& row, const Mat3f& root_W,
                  const Bodies& bodies) {
  Spin& spin = spin_[body];
  const Quat& R_WB = bodies.rotation[body];
  const Vec3 angle_W = turned(row, root_W);
  const Wide change = row.velocity - row.start + pending_[row_of(body)];
  const Vec3 added_W = (root_W * angular(change)).cast<double>();
  if (angle_W.squaredNorm() < double{kStillAngle * kStillAngle}) {
    spin.state = {rotation_by(angle_W) * R_WB, bodies.angular_velocity[body] + added_W};
    return spin.gain_J = 0;
  }
  const Mat3& inertia_B = bodies.inertia_B[body];
  const Vec3 alone_W = step.dt_s * (root_W * angular(row.start)).cast<double>();
  const Quat R_WB_now = spin.gyroscopic ? rotation_now(R_WB, spin.state.R_WB, alone_W, angle_W)
                                        : rotation_by(angle_W) * R_WB;
  spin.momentum_W += R_WB * (inertia_B * (R_WB.conjugate() * added_W));
  spin.state = rotation_with(inertia_B, R_WB_now, spin.momentum_W);
  return spin.gain_J = 0.5 * spin.state.w_W.dot(spin.momentum_W) - energy_J(row);
}

void Spins::keep_energy(BodySlot body, const BodyRow& row, const Mat3f& root_W,
                        const Bodies& bodies) {
  Spin& spin = spin_[body];
  const Vec3 angle_W = turned(row, root_W);
  spin.state = rotation_with_energy(bodies.inertia_B[body], spin.state.R_WB, spin.momentum_W,
                                    energy_J(row), angle_W.norm());
  if (0.5 * spin.state.w_W.dot(spin.momentum_W) <= energy_J(row)) return;
  const Quat turn = rotation_by(angle_W);
  const Vec3 added_W = (root_W * angular(row.velocity - row.start)).cast<double>();
  spin.state = {turn * bodies.rotation[body], turn * (bodies.angular_velocity[body] + added_W)};
}

}  // namespace sunder::solver
