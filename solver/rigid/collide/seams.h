// Seams: contacts with the inner edges and faces of ground that consists of several shapes. A body
// that slides from one tile to the next overlaps the side of the next by its motion in a step,
// often less than it overlaps the top, and would collide with that side.
#pragma once

#include <span>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/dense_clusters.h"

namespace sunder::solver {

/// True if a contact closes with a shape that may form a surface with others.
bool may_be_at_seam(const StepContext& step, const Shapes& shapes, const Bodies& bodies,
                    const Pair& pair, const Manifold& m);

/// Leaves out those contacts of ContactChanges::closing that another contact of the same shape
/// covers. The contact with A is covered by that with A' if
/// - A does not rise above the face of A' that bears the shape: it is not in the way;
/// - A' rises above the plane of the contact with A, and at one of its points something goes on
///   from A that rises above that plane and not above that face: the plane touches no surface
///   that they form together.
/// No two contacts cover each other. Contacts that are left out are tested again in the next step.
/// The result does not depend on the number of threads.
void drop_covered(const StepContext& step, std::span<ContactChanges> changes, Contacts& contacts,
                  const Shapes& shapes, const Bodies& bodies);

}  // namespace sunder::solver
