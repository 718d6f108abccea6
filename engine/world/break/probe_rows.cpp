#include "engine/world/break/probe_rows.h"

#include "engine/base/rotation.h"

namespace sunder {
namespace {

/// From what it asks of the two bodies.
ContactRow make_row(const std::vector<ProbeBody>& bodies, std::uint32_t a, std::uint32_t b,
                    const Vec3& normal_W, const Vec3& angular_a_W, const Vec3& angular_b_W) {
  const ProbeBody &body_a = bodies[a], &body_b = bodies[b];
  ContactRow row;
  row.a = a, row.b = b;
  row.moves_a = body_a.inverse_mass > 0, row.moves_b = body_b.inverse_mass > 0;
  row.normal = normal_W;
  row.angular_a = angular_a_W;
  row.angular_b = angular_b_W;
  row.push_a = body_a.inverse_mass * normal_W;
  row.push_b = body_b.inverse_mass * normal_W;
  row.spin_a = body_a.inverse_inertia_W * row.angular_a;
  row.spin_b = body_b.inverse_inertia_W * row.angular_b;
  return row;
}

/// Where the ends of two arms are by now.
struct Ends {
  Vec3 center_a, center_b, arm_a, arm_b;

  template <typename Pair>
  Ends(const std::vector<ProbePlace>& places, const Pair& pair)
      : center_a(places[pair.a].center_W),
        center_b(places[pair.b].center_W),
        arm_a(places[pair.a].turn_W * pair.arm_a_W),
        arm_b(places[pair.b].turn_W * pair.arm_b_W) {}

  /// The direction from b's to a's.
  Vec3 apart(const Vec3& otherwise) const {
    const Vec3 between = center_a + arm_a - (center_b + arm_b);
    const double length = between.norm();
    return length > 0 ? Vec3(between / length) : otherwise;
  }
  /// Moves both to midway between them: or a blow would make angular momentum.
  void unite() {
    const Vec3 point = 0.5 * (center_a + arm_a + center_b + arm_b);
    arm_a = point - center_a;
    arm_b = point - center_b;
  }
};

}  // namespace

std::vector<ProbePlace> places_after(const std::vector<ProbeBody>& bodies,
                                     const std::vector<BodyVelocity>& way) {
  std::vector<ProbePlace> places(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    places[b] = {bodies[b].position_W + way[b].linear, rotation_by(way[b].angular)};
  }
  return places;
}

ContactRow make_row(const std::vector<ProbeBody>& bodies, const ProbeContact& contact,
                    const Vec3& arm_a_W, const Vec3& arm_b_W) {
  const Vec3& n = contact.normal_W;
  ContactRow row = make_row(bodies, contact.a, contact.b, n, arm_a_W.cross(n), arm_b_W.cross(n));
  row.rope = contact.rope;
  row.inverse_mass = bodies[contact.a].inverse_mass + bodies[contact.b].inverse_mass +
                     row.angular_a.dot(row.spin_a) + row.angular_b.dot(row.spin_b);
  return row;
}

ContactRow meet(const std::vector<ProbeBody>& bodies, const std::vector<ProbePlace>& places,
                const ProbeContact& contact) {
  Ends ends(places, contact);
  if (!contact.rope) {
    ends.unite();
    return make_row(bodies, contact, ends.arm_a, ends.arm_b);
  }
  ProbeContact rope = contact;
  rope.normal_W = ends.apart(contact.normal_W);
  return make_row(bodies, rope, ends.arm_a, ends.arm_b);
}

std::vector<ContactRow> joint_rows(const std::vector<ProbeBody>& bodies,
                                   const std::vector<ProbePlace>& places,
                                   const std::vector<ProbeJoint>& joints) {
  std::vector<ContactRow> rows;
  for (const ProbeJoint& joint : joints) {
    if (bodies[joint.a].inverse_mass <= 0 && bodies[joint.b].inverse_mass <= 0) continue;
    Ends ends(places, joint);
    const auto hold = [&](const Vec3& n) {
      rows.push_back(
          make_row(bodies, joint.a, joint.b, n, ends.arm_a.cross(n), ends.arm_b.cross(n)));
    };
    const auto hold_turn = [&](const Vec3& axis) {
      rows.push_back(make_row(bodies, joint.a, joint.b, Vec3::Zero(), axis, axis));
    };
    if (joint.kind == JointKind::kDistance) {
      hold(ends.apart(Vec3::UnitX()));
      continue;
    }
    ends.unite();
    for (int i = 0; i < 3; ++i) hold(Vec3::Unit(i));
    if (joint.kind == JointKind::kHinge) {
      const Vec3 axis = places[joint.a].turn_W * joint.axis_W;
      const Vec3 across = axis.unitOrthogonal();
      hold_turn(across);
      hold_turn(axis.cross(across));
    } else if (joint.kind == JointKind::kFixed) {  // within no time, what flows bears no moment
      for (int i = 0; i < 3; ++i) hold_turn(Vec3::Unit(i));
    }
  }
  return rows;
}

}  // namespace sunder
