#include "solver/rigid/contact/kept_impulses.h"

#include <algorithm>

#include "engine/base/parallel.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// Moves the rest separations, so that springs that are `softness` times as soft have the forces of
/// before.
void move_rest(float softness, const Bodies& bodies, Manifold& m) {
  const float most_m = kMaxRestOffset * m.size_m;
  for (int i = 0; i < m.count; ++i) {
    ManifoldPoint& p = m.points[i];
    const float compression_m = p.rest_m - p.separation_m;
    if (!(p.impulse_Ns > 0 && compression_m > 0)) continue;
    const float rest_m = p.separation_m + softness * compression_m;
    p.rest_m = std::clamp(rest_m, std::min(-most_m, p.rest_m), std::max(most_m, p.rest_m));
  }
  Vec3f stretch = (softness - 1) * m.drift_W;
  if (const float length_m = stretch.norm(); length_m > most_m) stretch *= most_m / length_m;
  m.drift_W += stretch;
  m.friction_arm_B += stretch;
  m.friction_anchor_B = bodies.rotation_f[m.body_b].transpose() * m.friction_arm_B;
}

}  // namespace

void change_step(const StepLengths& from, const StepLengths& to, const Bodies& bodies,
                 Contacts& contacts, Joints& joints) {
  if (from == to || from == StepLengths{}) return;
  const double of_step = to.dt_s / from.dt_s, of_substep = to.h_s / from.h_s;
  const auto h = static_cast<float>(of_substep);
  for_chunks(contacts.manifolds.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (ManifoldSlot i(begin); i.value < end; ++i.value) {
      Manifold& m = contacts.manifolds[i];
      if (m.count == 0) continue;
      move_rest(h * h, bodies, m);
      for (ManifoldPoint& point : m.points) point.impulse_Ns *= h;
      m.friction_impulse_W *= h;
      m.twist_impulse *= h;
      m.roll_impulse_W *= h;
      m.step_impulse_W *= static_cast<float>(of_step);
    }
  });
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    for (double& impulse : joints[i].impulse) impulse *= of_substep;
    joints[i].total.linear_W *= of_step;
    joints[i].total.angular_W *= of_step;
  }
}

}  // namespace sunder::solver
