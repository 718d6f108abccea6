// The program `sunder`. Read first: one file a command, then run.cpp for what a run is made of.
#include <cstdio>

#include "engine/base/check.h"
#include "scenes/app/options.h"

namespace {

constexpr int kDone = 0, kFailed = 1, kBadInput = 2;

int run(int argc, char** argv) {
  using namespace sunder;
  CLI::App app("Simulates and renders destruction.", "sunder");
  app.set_version_flag("--version", SUNDER_VERSION);
  app.require_subcommand(1);
  app::Command chosen;
  app::add_list(app, chosen);
  app::add_check(app, chosen);
  app::add_simulate(app, chosen);
  app::add_render(app, chosen);
  app::add_bench(app, chosen);
  app::add_golden(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  return chosen();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const sunder::InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failed: %s\n", error.what());
    return kFailed;
  }
}
