// Reports of the contacts of the last solve, for the world and its statistics.
#pragma once

#include <vector>

#include "engine/model/physics.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// See Physics::contact_impulses().
std::vector<ContactImpulse> find_contact_impulses(const Contacts& contacts, const Bodies& bodies,
                                                  const Shapes& shapes);
/// See Physics::inspect(); `h_s` is the substep of the stored impulses, 0: none stored.
std::vector<ContactForce> find_contact_forces(const Contacts& contacts, const Bodies& bodies,
                                              double h_s);
/// See Physics::penetrations().
std::vector<float> find_penetrations(const Contacts& contacts);

}  // namespace sunder::solver
