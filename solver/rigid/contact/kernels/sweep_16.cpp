// The kernels for sixteen lanes: AVX-512 (x86-64-v4).
#include "solver/rigid/contact/kernels/impact_kernels.h"

namespace sunder::solver {

SUNDER_SWEEP_KERNELS(16)

}  // namespace sunder::solver
