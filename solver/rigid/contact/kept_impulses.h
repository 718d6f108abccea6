// The impulses that contacts and joints keep from step to step, when the length of a step changes.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/joint/joint.h"

namespace sunder::solver {

/// Length of a step and of its substeps, s; 0 before the first step.
struct StepLengths {
  double dt_s = 0, h_s = 0;

  bool operator==(const StepLengths&) const = default;
};

/// Changes kept impulses, those of sleeping bodies included, to what the same forces give in a step
/// of other lengths. The stiffness of a contact follows from the substep, so that the rest
/// separations of contacts at rest are moved too: they bear their load in place.
void change_step(const StepLengths& from, const StepLengths& to, const Bodies& bodies,
                 Contacts& contacts, Joints& joints);

}  // namespace sunder::solver
