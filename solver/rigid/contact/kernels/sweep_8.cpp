// The kernels for eight lanes: AVX2 (x86-64-v3).
#include "solver/rigid/contact/kernels/impact_kernels.h"

namespace sunder::solver {

SUNDER_SWEEP_KERNELS(8)

}  // namespace sunder::solver
