// The kernels for one lane: the reference that the others must equal, and what debuggers like.
#include "solver/rigid/contact/kernels/impact_kernels.h"

namespace sunder::solver {

SUNDER_SWEEP_KERNELS(1)

}  // namespace sunder::solver
