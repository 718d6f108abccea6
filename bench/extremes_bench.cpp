// What becomes of scenes that ask for too much, at every preset: docs/extremes.md is what
// --markdown prints.
#include "bench/extremes/extreme.h"
#include "bench/truths/table.h"

int main(int argc, char** argv) {
  return sunder::truths::table_main(argc, argv, sunder::truths::all_extremes());
}
