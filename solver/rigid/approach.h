// Which contacts of breakable bodies close, how fast, and with how much mass behind them.
#pragma once

#include <vector>

#include "solver/rigid/bodies.h"
#include "solver/rigid/contacts.h"

namespace sunder::solver {

/// One approach for each manifold that touches a breakable body and closes, or would within dt_s;
/// in order of pair keys.
std::vector<Approach> find_approaches(const Contacts& contacts, const Bodies& bodies,
                                      const Shapes& shapes, double dt_s);

/// Approach speed at an arm, along the manifold's normal; > 0 when closing.
double closing_speed(const Manifold& m, const Bodies& bodies, const Vec3f& arm_A,
                     const Vec3f& arm_B);

}  // namespace sunder::solver
