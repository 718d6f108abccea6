// The kernels for four lanes: any x86-64 processor.
#include "solver/rigid/contact/kernels/impact_kernels.h"

namespace sunder::solver {

SUNDER_SWEEP_KERNELS(4)

}  // namespace sunder::solver
