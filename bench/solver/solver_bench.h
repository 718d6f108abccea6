// Commands of solver_bench. Each takes the arguments of its own main function.
#pragma once

namespace sunder::bench {

/// Prints times, penetrations and residual speeds of common benchmark scenes.
int measure_piles(int argc, char** argv);
/// Prints the convergence within one step, by number of colours.
int measure_convergence(int argc, char** argv);
/// Prints the time of one sweep over the contacts, and of contact colouring.
int measure_sweep(int argc, char** argv);
/// Prints the time of a frame by stage for 1,000 to 100,000 convexes, and limits of the machine.
int measure_scale(int argc, char** argv);

}  // namespace sunder::bench
