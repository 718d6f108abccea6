// Timing and convergence of the rigid solver, in tables: solver_bench COMMAND [OPTIONS].
#include "bench/solver/solver_bench.h"

#include "bench/commands.h"

int main(int argc, char** argv) {
  using namespace sunder::bench;
  return run_command(argc, argv,
                     {{"piles", "time, depth and speed of common scenes", measure_piles},
                      {"convergence", "error of a step by number of sweeps", measure_convergence},
                      {"sweep", "time of a sweep by number of lanes", measure_sweep},
                      {"scale", "time of a frame by number of convexes", measure_scale}});
}
