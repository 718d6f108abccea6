// Which bodies the impacts of a step can move within it, through contacts and joints.
#pragma once

#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/speculative_contacts.h"
#include "solver/rigid/joint/joint.h"

namespace sunder::solver {

/// A body that will be struck within the step.
struct Hit {
  BodySlot body;          ///< The body that is struck.
  ManifoldSlot manifold;  ///< None: struck through a joint.
  Vec3 arm_W;             ///< Lever arm of the place on the body.
  Vec3 direction_W;       ///< Unit direction of the impulse on the body.
  double speed_m_s = 0;   ///< Closing speed.
  double mass_kg = 0;     ///< Mass that closes.
};

/// Returns the closing speed from which a contact is a hit.
double least_hit_m_s(const StepContext& step, double reach_m);

/// Returns the hits of a step; empty if no sleeping body touches an awake one.
std::vector<Hit> find_hits(const StepContext& step, const Contacts& contacts, const Bodies& bodies);

/// Returns the sleeping bodies that these hits can move. A mass that closes on a body with some
/// speed goes on together with it (a plastic impact, in which momentum is kept): the speed falls
/// with the sum of the masses, and with the angle to the contact. Bodies that would get less than
/// kPassedSpeed are not reached.
std::vector<BodySlot> find_reached(const StepContext& step, std::vector<Hit> hits,
                                   const Contacts& contacts,
                                   const ContactsOfBodies& contacts_of_bodies, const Joints& joints,
                                   const Bodies& bodies);

}  // namespace sunder::solver
