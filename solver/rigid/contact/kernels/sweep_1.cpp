// The kernels for one lane: the reference for the others, and for debugging.
#include "solver/rigid/contact/kernels/impact_kernels.h"

namespace sunder::solver {

SUNDER_SWEEP_KERNELS(1)

}  // namespace sunder::solver
