#include "solver/rigid/joint/plastic.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/base/rotation.h"

namespace sunder::solver {
namespace {

constexpr int kAlong = 1;                  // turned row of the transverse impulse; 0 is axial
constexpr int kBending = 4;                // section row, direction of a small transverse impulse
constexpr double kSurfaceDistance = 0.02;  // from the ball, that counts as on its surface
constexpr double kMinDirectedImpulse = 0.25;  // minimum transverse impulse that has a direction

/// Householder's reflection, which is its own inverse.
Vec6 mirrored(const PlasticWork& plastic, const Vec6& x) {
  return x - plastic.mirror.dot(x) * plastic.mirror;
}

Vec6 impulse(const JointWork& work) { return Vec6(work.impulse.data()); }

/// Returns the radius of the ball of transverse impulses for an axial impulse.
double radius(double axial) { return std::max(kSurfaceDistance, 1 - axial * axial); }

/// Returns speeds or errors along the turned rows.
Vec6 turned(const PlasticWork& plastic, const Vec6& along_section) {
  return mirrored(plastic, plastic.strength.cwiseProduct(along_section));
}

/// Returns the impulses along the turned rows.
Vec6 turned_impulse(const JointWork& work) {
  return mirrored(work.plastic, impulse(work).cwiseQuotient(work.plastic.strength));
}

Vec6 turned_speed(const JointWork& work, const BodyRow* rows) {
  Vec6 speed;
  for (int i = 0; i < kMostJointRows; ++i) speed[i] = work.speed(i, rows);
  return turned(work.plastic, speed);
}

/// True if the section flows along its axis, or across it for other rows.
bool flows(const JointWork& work, int row) {
  if (row < kAlong) return work.bounds[0].pin != 0;
  const auto across = std::span(work.bounds).subspan(kAlong);
  return work.plastic.softness > 0 ||
         std::ranges::any_of(across, [](const RowBounds& bounds) { return bounds.pin != 0; });
}

}  // namespace

void turn_rows(const JointWork& of, const JointWork& to, Mat6& response) {
  if (of.kind == JointKind::kPlastic)
    for (int i = 0; i < to.rows; ++i) response.col(i) = turned(of.plastic, response.col(i));
  if (to.kind == JointKind::kPlastic)
    for (int i = 0; i < of.rows; ++i)
      response.row(i) = turned(to.plastic, response.row(i).transpose()).transpose();
  for (int i = kAlong + 1; i < kMostJointRows && &of == &to; ++i)
    response(i, i) += of.plastic.softness;
}

void turn_target(JointWork& work, std::span<double> target) {
  const Vec6 now = turned_impulse(work), turned_target = turned(work.plastic, Vec6(target.data()));
  for (std::size_t i = 0; i < kMostJointRows; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    work.bounds[i].now = now[at];
    target[i] = turned_target[at] - (at > kAlong ? work.plastic.softness * now[at] : 0);
  }
}

void turn_back(const JointWork& work, std::span<double> change) {
  const PlasticWork& plastic = work.plastic;
  Vec6::Map(change.data()) = plastic.strength.cwiseProduct(mirrored(plastic, Vec6(change.data())));
}

void align_rows(JointWork& work, double h_s) {
  PlasticWork& plastic = work.plastic;
  Vec6 part = impulse(work).cwiseQuotient(h_s * plastic.strength);
  const double bears = radius(plastic.state.axial);
  part[0] = 0;
  const double load = part.norm() / bears;
  Vec6 mirror = load > kMinDirectedImpulse ? Vec6(part / part.norm()) : Vec6(Vec6::Unit(kBending));
  mirror[kAlong] -= 1;
  const double square = mirror.squaredNorm();
  plastic.mirror = square > 0 ? Vec6(std::sqrt(2 / square) * mirror) : Vec6(Vec6::Zero());
  plastic.softness = plastic.state.speed / (h_s * bears);
  work.bounds[0].least = -h_s;
  for (std::size_t i = kAlong; i < kMostJointRows; ++i)
    work.bounds[i] = {0, -h_s * bears, h_s * bears, 0};
}

bool exceeds_strength(const JointWork& work, double h_s) {
  Vec6 part = impulse(work).cwiseQuotient(h_s * work.plastic.strength);
  const double bears = radius(work.plastic.state.axial);
  part[0] = 0;
  return part.norm() > (1 + kSurfaceDistance) * bears;
}

void record_flow_speed(JointWork& work, const BodyRow* rows) {
  const bool along = work.bounds[kAlong].pin != 0;
  work.plastic.state.speed = along ? std::abs(turned_speed(work, rows)[kAlong]) : 0;
}

void record_axial(JointWork& work, double h_s) {
  work.plastic.state.axial = work.impulse[0] / (h_s * work.plastic.strength[0]);
}

void absorb_flow(JointWork& work, const BodyRow* rows) {
  PlasticWork& plastic = work.plastic;
  // The current error of a flowing row is its flow. The work is that of its speed, since a contact
  // may push the bodies further.
  Vec6 flow = Vec6::Zero(), taken_J = Vec6::Zero();
  for (int i = 0; i < kMostJointRows; ++i) {
    if (!flows(work, i)) continue;
    flow[i] = work.row[static_cast<std::size_t>(i)].error;
    taken_J[i] = -work.speed(i, rows) * impulse(work)[i];
  }
  const Vec6 against = -flow.cwiseProduct(impulse(work));
  if (against[0] <= 0) flow[0] = taken_J[0] = 0;
  if (against.tail<5>().sum() <= 0) flow.tail<5>().setZero(), taken_J.tail<5>().setZero();
  if (flow.isZero(0)) return;
  plastic.work_J += std::max(0.0, taken_J.sum());
  for (int i = 0; i < kMostJointRows; ++i) work.row[static_cast<std::size_t>(i)].error -= flow[i];
  const Vec3 extension = flow.head<3>(), turn = flow.tail<3>();
  plastic.extension += extension;
  plastic.turn = rotation_by(turn) * plastic.turn;
  work.twist = work.twist * rotation_by(-work.axes * turn);
  const Vec3 extension_W = rotation_of(work.root_a, rows[work.row_a]) * (work.axes * extension);
  const Vec3 shift = rotation_of(work.root_b, rows[work.row_b]).conjugate() * extension_W;
  work.arm_b -= shift, work.gap -= shift;
  plastic.shift_b += work.axes.transpose() * shift;
}

void fix_flow(JointWork& work) {
  const bool axial = flows(work, 0), across = flows(work, kAlong);
  work.bounds = {};
  for (int i = 0; i < kMostJointRows; ++i)
    if (i < kAlong ? axial : across) work.bounds[static_cast<std::size_t>(i)] = {0, 0, 0, 1};
}

void store_flow(const JointWork& work, Joint& joint) {
  const PlasticWork& plastic = work.plastic;
  joint.plastic = plastic.state;
  if (!(plastic.work_J > 0)) return;
  const Mat3& axes_R = joint.desc.strength.axes_R;
  const Vec3 turn_R = axes_R * rotation_vector(plastic.turn);
  Quat& rotation = joint.desc.rotation_RaRb;
  joint.desc.anchor_b_R -= rotation.conjugate() * (axes_R * plastic.shift_b);
  rotation = (rotation_by(turn_R) * rotation).normalized();
  joint.flow = {{}, turn_R, axes_R * plastic.extension, plastic.work_J};
}

}  // namespace sunder::solver
