// Prints reference behaviour at every preset; docs/truths.md has the output of --markdown.
#include "bench/truths/table.h"

int main(int argc, char** argv) {
  return sunder::truths::table_main(argc, argv, sunder::truths::all_truths());
}
