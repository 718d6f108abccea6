// Test fixture: plastic joints with their section strengths, and a world of bodies that they hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/fixtures/presets.h"

namespace sunder::solver {

inline constexpr double kPlasticDt_s = 1.0 / 60;
inline constexpr double kMoment_Nm = 1000;

/// Returns the section strength of a bar of about 1 cm with that plastic moment, normal along x.
inline SectionStrength strength(double moment_Nm = kMoment_Nm) {
  SectionStrength s;
  s.axial_N = 400 * moment_Nm, s.shear_N = 230 * moment_Nm;
  s.moment_Nm = Vec3(0.8, 1, 1) * moment_Nm;
  return s;
}

/// Returns a plastic joint at a point; shapes without a tag do not collide across the joint.
inline JointDesc plastic_at(const RigidWorld& world, BodyId a, BodyId b, const Vec3& at_W,
                            const SectionStrength& bears = strength()) {
  JointDesc joint = joint_at(world, JointKind::kPlastic, a, b, at_W);
  joint.strength = bears;
  joint.quiet_a = joint.quiet_b = {0};
  const Quat X_WA = a.none() ? Quat::Identity() : world.state(a).X_WB.rotation;
  joint.strength.axes_R = X_WA.conjugate() * bears.axes_R;
  return joint;
}

/// Sum of the plastic flow of one joint.
struct FlowSum {
  Vec3 turn_R = Vec3::Zero(), displacement_R = Vec3::Zero();
  double work_J = 0;

  void add(const PlasticFlow& flow) {
    turn_R += flow.turn_R, displacement_R += flow.displacement_R, work_J += flow.work_J;
  }
};

/// A world of bodies in plastic joints, with the plastic flow summed over all steps.
struct Frame {
  RigidWorld world;
  std::vector<JointId> joints;
  std::vector<FlowSum> flowed;
  double work_J = 0;

  explicit Frame(const Vec3& gravity_W = Vec3::Zero(), bool sleeps = false)
      : world([&] {
          RigidOptions options = awake(gravity_W);
          options.sleeping = sleeps;
          return options;
        }()) {}
  void join(BodyId a, BodyId b, const Vec3& at_W, const SectionStrength& bears = strength()) {
    joints.push_back(world.physics().join(plastic_at(world, a, b, at_W, bears)));
    flowed.emplace_back();
  }
  void step(int substeps) {
    world.step(kPlasticDt_s, substeps);
    for (const PlasticFlow& flow : world.physics().plastic_flows()) {
      const auto at = std::ranges::find(joints, flow.joint) - joints.begin();
      flowed[static_cast<std::size_t>(at)].add(flow);
      work_J += flow.work_J;
    }
  }
  void run(double time_s, int substeps) {
    for (int i = 0; i < std::lround(time_s / kPlasticDt_s); ++i) step(substeps);
  }
};

/// Returns the angle by which a body is rotated from the identity, in rad.
inline double angle(const RigidWorld& world, BodyId body) {
  return 2 * std::asin(world.state(body).X_WB.rotation.vec().norm());
}

}  // namespace sunder::solver
