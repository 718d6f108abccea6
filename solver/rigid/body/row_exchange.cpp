#include "solver/rigid/body/row_exchange.h"

namespace sunder::solver {

void take_row(const Bodies& bodies, BodySlot body, BodyRow& row, Mat3f& root_W) {
  const Mat3f& root_B = bodies.root_B[body];
  root_W = bodies.rotation_f[body] * root_B;
  const Vec3 spin_B = bodies.rotation[body].conjugate() * bodies.angular_velocity[body];
  const Vec3f spin = root_B.transpose() * (bodies.inertia_B[body] * spin_B).cast<float>();
  const Vec3f v = bodies.velocity[body].cast<float>();
  row.velocity = Wide{v.x(), v.y(), v.z(), spin.x(), spin.y(), spin.z(), 0, 0};
  row.start = row.base = row.velocity;
  row.position = Wide{};
}

void give_row(const BodyRow& row, const Mat3f& root_W, BodySlot body, Bodies& bodies) {
  const Wide change = row.velocity - row.start;
  bodies.velocity[body] += linear(change).cast<double>();
  bodies.angular_velocity[body] += (root_W * angular(change)).cast<double>();
}

}  // namespace sunder::solver
