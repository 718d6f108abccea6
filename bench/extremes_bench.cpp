// Prints results for extreme scenes at every preset; docs/extremes.md has the output of --markdown.
#include "bench/extremes/extreme.h"
#include "bench/truths/table.h"

int main(int argc, char** argv) {
  return sunder::truths::table_main(argc, argv, sunder::truths::all_extremes());
}
