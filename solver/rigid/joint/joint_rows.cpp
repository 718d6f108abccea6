#include "solver/rigid/joint/joint_rows.h"

#include <algorithm>

#include "engine/base/rotation.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// One end of a joint at the start of the step.
struct End {
  Vec3 position, arm, axis;
  Quat rotation = Quat::Identity();
};

End end_of(BodySlot body, const Vec3& anchor_R, const Vec3& axis_R, const Bodies& bodies) {
  if (body.none()) return {anchor_R, Vec3::Zero(), axis_R};
  const Quat& q = bodies.rotation[body];
  return {bodies.position[body], q * (anchor_R - bodies.com_R[body]), q * axis_R, q};
}

/// Returns the angular velocity in W, at most a radian per substep: no extrapolation is valid
/// beyond.
Vec3 spin_of(const Mat3f& root, const BodyRow& row, double h_s) {
  const Vec3 spin = (root * angular(row.velocity)).cast<double>();
  return spin / std::max(1.0, h_s * spin.norm());
}

void place_row(JointWork& w, const Vec3& arm_a, const Vec3& arm_b, const Vec3& direction,
               double error, double error_acceleration) {
  JointRow& row = w.row[static_cast<std::size_t>(w.rows++)];
  row.push = direction.cast<float>();
  row.turn.setZero();
  row.angular_a = w.root_a.transpose() * arm_a.cross(direction).cast<float>();
  row.angular_b = w.root_b.transpose() * arm_b.cross(direction).cast<float>();
  row.error = error;
  row.error_acceleration = error_acceleration;
  row.softness = 0;
  ++w.place_rows;
}

void angular_row(JointWork& w, const Vec3& direction, double error, double error_acceleration,
                 double softness = 0) {
  JointRow& row = w.row[static_cast<std::size_t>(w.rows++)];
  row.push.setZero();
  row.turn = direction.cast<float>();
  row.angular_a = w.root_a.transpose() * direction.cast<float>();
  row.angular_b = w.root_b.transpose() * direction.cast<float>();
  row.error = error;
  row.error_acceleration = error_acceleration;
  row.softness = softness;
}

/// Returns the stiffness h²·K/I of a tension that an explicit step turns with the bodies: that of
/// the stiffer side, as if it were pulled alike at its other end; 12·T·h²/(m·L) for a rod. Above 4
/// the step is unstable. `arm_m` is set to the arm of that side.
double tension_stiffness(const JointWork& w, double h_s, double pull_Ns, const Vec3& arm_a,
                         const Vec3& arm_b, double& arm_m) {
  double most = 0;
  const auto consider = [&](Vec3f JointRow::*angular, const Vec3& arm) {
    const double length_m = arm.norm();
    double turns = 0;
    for (std::size_t i = 0; i < 3; ++i) turns += double{(w.row[i].*angular).squaredNorm()};
    if (!(turns * h_s * pull_Ns > most * length_m)) return;
    most = turns * h_s * pull_Ns / length_m;
    arm_m = length_m;
  };
  consider(&JointRow::angular_a, arm_a), consider(&JointRow::angular_b, arm_b);
  return most;
}

/// True if b does not turn against a.
bool is_held(JointDesc::Kind kind) {
  return kind == JointDesc::Kind::kFixed || kind == JointDesc::Kind::kPlastic;
}

/// Adds rows that damp free rotation: a torque and its counterpart that keep the substep stable.
void damp(JointWork& w, double h_s, double pull_Ns, const Vec3& arm_a, const Vec3& arm_b,
          const Vec3& axis) {
  double arm_m = 0;
  const double stiffness = tension_stiffness(w, h_s, pull_Ns, arm_a, arm_b, arm_m);
  if (stiffness <= 1 || is_held(w.kind)) return;
  const double damping = 0.5 * h_s * pull_Ns * arm_m * (1 - 1 / stiffness) *
                         std::max(1.0, stiffness / kMaxTensionStiffness);
  if (w.kind == JointDesc::Kind::kHinge) {
    angular_row(w, axis, 0, 0, 1 / damping);
  } else {
    for (int i = 0; i < 3; ++i) angular_row(w, Vec3::Unit(i), 0, 0, 1 / damping);
  }
}

Vec3 across(const Vec3& axis) {
  const Vec3 helper = std::abs(axis.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY();
  return axis.cross(helper).normalized();
}

}  // namespace

Quat rotation_of(const Mat3f& root, const BodyRow& row) {
  return rotation_by((root * angular(row.position)).cast<double>());
}

double JointWork::speed(int i, const BodyRow* body_rows) const {
  const JointRow& r = row[static_cast<std::size_t>(i)];
  const Wide &a = body_rows[row_a].velocity, &b = body_rows[row_b].velocity;
  return double{r.push.dot(linear(b) - linear(a))} + double{r.angular_b.dot(angular(b))} -
         double{r.angular_a.dot(angular(a))};
}

JointPush JointWork::sum(std::span<const double> by) const {
  JointPush sum;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rows); ++i) {
    const auto impulse_f = static_cast<float>(by[i]);
    sum.push += impulse_f * row[i].push;
    sum.angular_a += impulse_f * row[i].angular_a;
    sum.angular_b += impulse_f * row[i].angular_b;
  }
  return sum;
}

void JointWork::apply(const JointPush& p, BodyRow* body_rows) const {
  const auto add = [](const Vec3f& v, const Vec3f& w, Wide& velocity) {
    velocity += Wide{v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), 0, 0};
  };
  if (row_a > 0) add(-inverse_mass_a * p.push, -p.angular_a, body_rows[row_a].velocity);
  if (row_b > 0) add(inverse_mass_b * p.push, p.angular_b, body_rows[row_b].velocity);
}

JointWork begin_joint(const Joint& joint, std::uint32_t index, const Bodies& bodies,
                      const JointStep& at) {
  const JointDesc& desc = joint.desc;
  JointWork w;
  w.joint = index;
  w.kind = desc.kind;
  const auto take = [&](BodySlot body, std::int32_t& row, float& inverse_mass, Mat3f& root) {
    if (body.none()) return;
    if (bodies.is_moving_kinematic(body)) row = at.kinematic_row[body], root = at.root_W[body];
    if (!bodies.awake(body)) return;
    row = static_cast<std::int32_t>(row_of(body));
    inverse_mass = bodies.inverse_mass[body];
    root = at.root_W[body];
    w.reach_m = w.reach_m > 0 ? std::min(w.reach_m, bodies.reach_m[body]) : bodies.reach_m[body];
  };
  take(joint.body_a, w.row_a, w.inverse_mass_a, w.root_a);
  take(joint.body_b, w.row_b, w.inverse_mass_b, w.root_b);
  const End a = end_of(joint.body_a, desc.anchor_a_R, desc.axis_a_R, bodies);
  const End b = end_of(joint.body_b, desc.anchor_b_R, desc.axis_b_R, bodies);
  w.arm_a = a.arm, w.arm_b = b.arm;
  w.gap = (b.position - a.position) + b.arm - a.arm;
  w.axis_a = a.axis, w.axis_b = b.axis;
  w.side_a = a.rotation * across(desc.axis_a_R);
  if (is_held(w.kind)) w.twist = b.rotation * (a.rotation * desc.rotation_RaRb).conjugate();
  w.length_m = desc.length_m;
  w.breaking_N = desc.breaking_N, w.breaking_Nm = desc.breaking_Nm;
  w.impulse = joint.impulse;
  if (w.kind == JointDesc::Kind::kRope) w.bounds[0].most = 0;  // a rope only pulls
  if (w.kind == JointDesc::Kind::kPlastic) {
    const SectionStrength& strength = desc.strength;
    w.axes = a.rotation * strength.axes_R;
    w.plastic.strength << strength.axial_N, strength.shear_N, strength.shear_N, strength.moment_Nm;
    w.plastic.state = joint.plastic;
  }
  return w;
}

void refresh_rows(JointWork& w, double h_s, const BodyRow* rows) {
  const Quat rotation_a = rotation_of(w.root_a, rows[w.row_a]),
             rotation_b = rotation_of(w.root_b, rows[w.row_b]);
  const Vec3 arm_a = rotation_a * w.arm_a, arm_b = rotation_b * w.arm_b;
  const Vec3 displacement =
      (linear(rows[w.row_b].position) - linear(rows[w.row_a].position)).cast<double>();
  const Vec3 gap = w.gap + displacement + (arm_b - w.arm_b) - (arm_a - w.arm_a);
  const Vec3 spin_a = spin_of(w.root_a, rows[w.row_a], h_s),
             spin_b = spin_of(w.root_b, rows[w.row_b], h_s);
  const Vec3 bend = spin_b.cross(spin_b.cross(arm_b)) - spin_a.cross(spin_a.cross(arm_a));
  const double pull_Ns = Vec3(w.impulse[0], w.impulse[1], w.impulse[2]).norm();
  w.rows = w.place_rows = 0;
  if (w.kind == JointDesc::Kind::kDistance || w.kind == JointDesc::Kind::kRope) {
    const double length = gap.norm();
    const Vec3 direction = length > 1e-9 ? Vec3(gap / length) : Vec3(Vec3::UnitY());
    const Vec3 speed =
        (linear(rows[w.row_b].velocity) - linear(rows[w.row_a].velocity)).cast<double>() +
        spin_b.cross(arm_b) - spin_a.cross(arm_a);
    const double swing = length > 1e-9 ? direction.cross(speed).squaredNorm() / length : 0;
    place_row(w, arm_a, arm_b, direction, length - w.length_m, direction.dot(bend) + swing);
    w.held_rows = w.rows;
    return;
  }
  // The impulses on both ends act at one point, midway between the anchors: across a gap, an
  // impulse and its counterpart would be a couple and change the angular momentum.
  const Vec3 to_a = arm_a + 0.5 * gap, to_b = arm_b - 0.5 * gap;
  const Mat3 axes = w.kind == JointDesc::Kind::kPlastic ? Mat3(rotation_a * w.axes) : w.axes;
  const auto along = [&](int i, const Vec3& v) { return axes.col(i).dot(v); };
  for (int i = 0; i < 3; ++i) place_row(w, to_a, to_b, axes.col(i), along(i, gap), along(i, bend));
  const Vec3 axis = rotation_a * w.axis_a;
  if (w.kind == JointDesc::Kind::kHinge) {
    const Vec3 axis_b = rotation_b * w.axis_b, lean = axis.cross(axis_b);
    const Vec3 side = rotation_a * w.side_a, other = axis.cross(side);
    const Vec3 turn_a = spin_a.cross(axis), turn_b = spin_b.cross(axis_b);
    const Vec3 lean_bend = axis.cross(spin_b.cross(turn_b)) + spin_a.cross(turn_a).cross(axis_b) +
                           2 * turn_a.cross(turn_b);
    angular_row(w, side, side.dot(lean), side.dot(lean_bend));
    angular_row(w, other, other.dot(lean), other.dot(lean_bend));
  } else if (is_held(w.kind)) {
    const Quat twist = rotation_b * w.twist * rotation_a.conjugate();
    const Vec3 angle = (twist.w() < 0 ? -2.0 : 2.0) * twist.vec();
    for (int i = 0; i < 3; ++i) angular_row(w, axes.col(i), along(i, angle), 0);
  }
  w.held_rows = w.rows;
  damp(w, h_s, pull_Ns, to_a, to_b, axis);
  for (auto i = static_cast<std::size_t>(w.rows); i < kMostJointRows; ++i) w.impulse[i] = 0;
}

}  // namespace sunder::solver
