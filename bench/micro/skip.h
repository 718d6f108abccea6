// Benchmarks whose input is missing are skipped, so that the others of the program run.
#pragma once

#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "bench/real_mesh.h"

namespace sunder::bench {

/// Skips the benchmark and returns true if the file of a real mesh is missing.
inline bool skip_without(benchmark::State& state, const std::string& name) {
  const std::filesystem::path file = real_mesh(name);
  if (std::filesystem::exists(file)) return false;
  state.SkipWithError(("no " + file.string() + ": set SUNDER_MESHES").c_str());
  return true;
}

}  // namespace sunder::bench
