// Prints the results of validation cases at every preset. docs/truths.md and docs/extremes.md have
// the output of --markdown.
//
//   validation_bench truths|extremes [--only SUBSTRING] [--preset NAME] [--markdown] [--json
//   FILE|-]
#include "bench/commands.h"
#include "bench/extremes/extreme.h"
#include "bench/truths/table.h"

namespace {

using namespace sunder::truths;

int print_truths(int argc, char** argv) { return table_main(argc, argv, all_truths()); }
int print_extremes(int argc, char** argv) { return table_main(argc, argv, all_extremes()); }

}  // namespace

int main(int argc, char** argv) {
  return sunder::bench::run_command(argc, argv,
                                    {{"truths", "deviations from known results", print_truths},
                                     {"extremes", "results for excessive scenes", print_extremes}});
}
