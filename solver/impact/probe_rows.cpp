#include "solver/impact/probe_rows.h"

#include "engine/base/rotation.h"

namespace sunder::solver {
namespace {

/// Returns a row with this Jacobian of two bodies.
ContactRow make_row(const std::vector<ProbeBody>& bodies, std::uint32_t a, std::uint32_t b,
                    const Vec3& normal_W, const Vec3& angular_a_W, const Vec3& angular_b_W) {
  const ProbeBody &body_a = bodies[a], &body_b = bodies[b];
  ContactRow row;
  row.a = a, row.b = b;
  row.moves_a = body_a.inverse_mass > 0, row.moves_b = body_b.inverse_mass > 0;
  row.normal = normal_W;
  row.angular_a = angular_a_W;
  row.angular_b = angular_b_W;
  row.linear_response_a = body_a.inverse_mass * normal_W;
  row.linear_response_b = body_b.inverse_mass * normal_W;
  row.angular_response_a = body_a.inverse_inertia_W * row.angular_a;
  row.angular_response_b = body_b.inverse_inertia_W * row.angular_b;
  return row;
}

/// Current centres of mass and lever arms of a contact or joint.
struct Ends {
  Vec3 center_a, center_b, arm_a, arm_b;

  template <typename Pair>
  Ends(const std::vector<ProbePose>& poses, const Pair& pair)
      : center_a(poses[pair.a].center_W),
        center_b(poses[pair.b].center_W),
        arm_a(poses[pair.a].rotation_W * pair.arm_a_W),
        arm_b(poses[pair.b].rotation_W * pair.arm_b_W) {}

  /// Returns the unit vector from b's end to a's; `fallback` if the ends coincide.
  Vec3 direction_from_b(const Vec3& fallback) const {
    const Vec3 between = center_a + arm_a - (center_b + arm_b);
    const double length = between.norm();
    return length > 0 ? Vec3(between / length) : fallback;
  }
  /// Moves the ends of both arms to their midpoint: impulses at different points would create
  /// angular momentum.
  void move_arms_to_midpoint() {
    const Vec3 point = 0.5 * (center_a + arm_a + center_b + arm_b);
    arm_a = point - center_a;
    arm_b = point - center_b;
  }
};

}  // namespace

std::vector<ProbePose> poses_after(const std::vector<ProbeBody>& bodies,
                                   const std::vector<BodyVelocity>& displacements) {
  std::vector<ProbePose> poses(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    poses[b] = {bodies[b].position_W + displacements[b].linear,
                rotation_by(displacements[b].angular)};
  }
  return poses;
}

ContactRow make_row(const std::vector<ProbeBody>& bodies, const ProbeContact& contact,
                    const Vec3& arm_a_W, const Vec3& arm_b_W) {
  const Vec3& n = contact.normal_W;
  ContactRow row = make_row(bodies, contact.a, contact.b, n, arm_a_W.cross(n), arm_b_W.cross(n));
  row.rope = contact.rope;
  row.inverse_mass = bodies[contact.a].inverse_mass + bodies[contact.b].inverse_mass +
                     row.angular_a.dot(row.angular_response_a) +
                     row.angular_b.dot(row.angular_response_b);
  return row;
}

ContactRow make_current_row(const std::vector<ProbeBody>& bodies,
                            const std::vector<ProbePose>& poses, const ProbeContact& contact) {
  Ends ends(poses, contact);
  if (!contact.rope) {
    ends.move_arms_to_midpoint();
    return make_row(bodies, contact, ends.arm_a, ends.arm_b);
  }
  ProbeContact rope = contact;
  rope.normal_W = ends.direction_from_b(contact.normal_W);
  return make_row(bodies, rope, ends.arm_a, ends.arm_b);
}

std::vector<ContactRow> make_joint_rows(const std::vector<ProbeBody>& bodies,
                                        const std::vector<ProbePose>& poses,
                                        const std::vector<ProbeJoint>& joints) {
  std::vector<ContactRow> rows;
  for (const ProbeJoint& joint : joints) {
    if (bodies[joint.a].inverse_mass <= 0 && bodies[joint.b].inverse_mass <= 0) continue;
    Ends ends(poses, joint);
    const auto add_linear_row = [&](const Vec3& n) {
      rows.push_back(
          make_row(bodies, joint.a, joint.b, n, ends.arm_a.cross(n), ends.arm_b.cross(n)));
    };
    const auto add_angular_row = [&](const Vec3& axis) {
      rows.push_back(make_row(bodies, joint.a, joint.b, Vec3::Zero(), axis, axis));
    };
    if (joint.kind == JointKind::kDistance) {
      add_linear_row(ends.direction_from_b(Vec3::UnitX()));
      continue;
    }
    ends.move_arms_to_midpoint();
    for (int i = 0; i < 3; ++i) add_linear_row(Vec3::Unit(i));
    if (joint.kind == JointKind::kHinge) {
      const Vec3 axis = poses[joint.a].rotation_W * joint.axis_W;
      const Vec3 across = axis.unitOrthogonal();
      add_angular_row(across);
      add_angular_row(axis.cross(across));
    } else if (joint.kind == JointKind::kFixed) {  // yielding joints transmit no moment at once
      for (int i = 0; i < 3; ++i) add_angular_row(Vec3::Unit(i));
    }
  }
  return rows;
}

}  // namespace sunder::solver
