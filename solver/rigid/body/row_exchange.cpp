#include "solver/rigid/body/row_exchange.h"

#include <algorithm>

namespace sunder::solver {

void load_row(const Bodies& bodies, BodySlot body, BodyRow& row, Mat3f& root_W) {
  const Mat3f& root_B = bodies.root_B[body];
  root_W = bodies.rotation_f[body] * root_B;
  const Vec3 spin_B = bodies.rotation[body].conjugate() * bodies.angular_velocity[body];
  const Vec3f spin = root_B.transpose() * (bodies.inertia_B[body] * spin_B).cast<float>();
  const Vec3f v = bodies.velocity[body].cast<float>();
  row.velocity = Wide{v.x(), v.y(), v.z(), spin.x(), spin.y(), spin.z(), 0, 0};
  row.start = row.base = row.velocity;
  row.position = Wide{};
}

void store_velocity_of_row(const BodyRow& row, const Mat3f& root_W, BodySlot body, Bodies& bodies) {
  const Wide change = row.velocity - row.start;
  bodies.velocity[body] += linear(change).cast<double>();
  bodies.angular_velocity[body] += (root_W * angular(change)).cast<double>();
}

void load_kinematic_rows(const Bodies& bodies, const KinematicRows& to) {
  // Root of an inverse inertia smaller than that of any other body: angular impulses hardly turn a
  // kinematic body, but contacts have all of its angular velocity.
  constexpr float kKinematicRoot = 0x1p-40f;
  to.bodies.clear();
  for (const BodySlot body : bodies.slots())
    if (bodies.is_moving_kinematic(body)) to.bodies.push_back(body);
  const std::size_t count = to.bodies.size();
  to.row.assign(count == 0 ? 0 : bodies.size(), 0);
  to.rows.resize(count + bodies.size() + 1);
  std::fill_n(to.rows.begin(), count + 1, BodyRow{});
  to.root_W.resize(bodies.size());
  for (std::size_t i = 0; i < count; ++i) {
    const BodySlot body = to.bodies[i];
    to.root_W[body] = kKinematicRoot * Mat3f::Identity();
    const Vec3f v = bodies.velocity[body].cast<float>(),
                w = bodies.angular_velocity[body].cast<float>() / kKinematicRoot;
    BodyRow& row = to.rows[count - 1 - i];
    row.velocity = row.base = row.start = Wide{v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), 0, 0};
    to.row[body] = -1 - static_cast<std::int32_t>(i);
  }
}

}  // namespace sunder::solver
