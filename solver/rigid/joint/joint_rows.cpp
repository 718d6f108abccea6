#include "solver/rigid/joint/joint_rows.h"

#include <algorithm>

#include "engine/base/rotation.h"

namespace sunder::solver {
namespace {

/// One end of a joint as the step begins.
struct End {
  Vec3 position, arm, axis;
  Quat rotation = Quat::Identity();
};

End end_of(BodySlot body, const Vec3& anchor_R, const Vec3& axis_R, const Bodies& bodies) {
  if (body.none()) return {anchor_R, Vec3::Zero(), axis_R};
  const Quat& q = bodies.rotation[body];
  return {bodies.position[body], q * (anchor_R - bodies.com_R[body]), q * axis_R, q};
}

/// How far a body has turned since the step began.
Quat rotation_of(const Mat3f& root, const BodyRow& row) {
  return rotation_by((root * angular(row.position)).cast<double>());
}

void place_row(JointWork& w, const Vec3& arm_a, const Vec3& arm_b, const Vec3& direction,
               double error) {
  JointRow& row = w.row[static_cast<std::size_t>(w.rows++)];
  row.push = direction.cast<float>();
  row.angular_a = w.root_a.transpose() * arm_a.cross(direction).cast<float>();
  row.angular_b = w.root_b.transpose() * arm_b.cross(direction).cast<float>();
  row.error = error;
  ++w.place_rows;
}

void angular_row(JointWork& w, const Vec3& direction, double error) {
  JointRow& row = w.row[static_cast<std::size_t>(w.rows++)];
  row.push.setZero();
  row.angular_a = w.root_a.transpose() * direction.cast<float>();
  row.angular_b = w.root_b.transpose() * direction.cast<float>();
  row.error = error;
}

Vec3 across(const Vec3& axis) {
  const Vec3 helper = std::abs(axis.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY();
  return axis.cross(helper).normalized();
}

}  // namespace

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
  if (row_a != 0) add(-inverse_mass_a * p.push, -p.angular_a, body_rows[row_a].velocity);
  if (row_b != 0) add(inverse_mass_b * p.push, p.angular_b, body_rows[row_b].velocity);
}

JointWork begin_joint(const Joint& joint, std::uint32_t index, const Bodies& bodies,
                      SpanByBody<const Mat3f> root_W) {
  const JointDesc& desc = joint.desc;
  JointWork w;
  w.joint = index;
  w.kind = desc.kind;
  const auto take = [&](BodySlot body, std::uint32_t& row, float& inverse_mass, Mat3f& root) {
    if (body.none() || !bodies.awake(body)) return;
    row = row_of(body);
    inverse_mass = bodies.inverse_mass[body];
    root = root_W[body];
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
  if (w.kind == JointDesc::Kind::kFixed)
    w.twist = b.rotation * (a.rotation * desc.rotation_RaRb).conjugate();
  w.length_m = desc.length_m;
  w.breaking_N = desc.breaking_N, w.breaking_Nm = desc.breaking_Nm;
  w.impulse = joint.impulse;
  return w;
}

void refresh_rows(JointWork& w, const BodyRow* rows) {
  const Quat rotation_a = rotation_of(w.root_a, rows[w.row_a]),
             rotation_b = rotation_of(w.root_b, rows[w.row_b]);
  const Vec3 arm_a = rotation_a * w.arm_a, arm_b = rotation_b * w.arm_b;
  const Vec3 way = (linear(rows[w.row_b].position) - linear(rows[w.row_a].position)).cast<double>();
  const Vec3 gap = w.gap + way + (arm_b - w.arm_b) - (arm_a - w.arm_a);
  w.rows = w.place_rows = 0;
  if (w.kind == JointDesc::Kind::kDistance || w.kind == JointDesc::Kind::kRope) {
    const double length = gap.norm();
    const Vec3 direction = length > 1e-9 ? Vec3(gap / length) : Vec3(Vec3::UnitY());
    place_row(w, arm_a, arm_b, direction, length - w.length_m);
    return;
  }
  // Both ends push at one point, midway between the anchors: across a gap an impulse and its
  // counterpart would be a couple, which spins the pair up or down.
  const Vec3 to_a = arm_a + 0.5 * gap, to_b = arm_b - 0.5 * gap;
  for (int i = 0; i < 3; ++i) place_row(w, to_a, to_b, Vec3::Unit(i), gap[i]);
  if (w.kind == JointDesc::Kind::kHinge) {
    const Vec3 axis = rotation_a * w.axis_a, lean = axis.cross(rotation_b * w.axis_b);
    const Vec3 side = rotation_a * w.side_a, other = axis.cross(side);
    angular_row(w, side, side.dot(lean));
    angular_row(w, other, other.dot(lean));
  } else if (w.kind == JointDesc::Kind::kFixed) {
    const Quat twist = rotation_b * w.twist * rotation_a.conjugate();
    const Vec3 angle = (twist.w() < 0 ? -2.0 : 2.0) * twist.vec();
    for (int i = 0; i < 3; ++i) angular_row(w, Vec3::Unit(i), angle[i]);
  }
}

}  // namespace sunder::solver
