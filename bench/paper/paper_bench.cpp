// Tables of the paper's figures that no command of sunder prints; see docs/paper.md.
//
//   paper_bench cuts|hulls|decompositions
#include "bench/paper/paper_bench.h"

#include "bench/commands.h"

int main(int argc, char** argv) {
  using namespace sunder::bench;
  return run_command(
      argc, argv,
      {{"cuts", "polygons and triangles after repeated cuts (figure 9)", measure_cuts},
       {"hulls", "volumes of fitted hulls (figure 13)", measure_hulls},
       {"decompositions", "hulls of decomposed real meshes", measure_decompositions}});
}
