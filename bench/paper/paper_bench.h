// Commands of paper_bench. Each takes the arguments of its own main function.
#pragma once

namespace sunder::bench {

/// Prints faces, ill-shaped triangles and times of repeated cuts (figure 9).
int measure_cuts(int argc, char** argv);
/// Prints the volumes of fitted hulls relative to that of the true hull (figure 13).
int measure_hulls(int argc, char** argv);
/// Prints the volumes of the hulls of decomposed meshes relative to those of the meshes.
int measure_decompositions(int argc, char** argv);

}  // namespace sunder::bench
