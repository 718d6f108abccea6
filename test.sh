#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test; then the unit tests once more under the
# address and undefined-behaviour sanitizers. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")"
source cmake/setup.sh

set_up
install_optional clang-format-14
install_optional libbullet-dev libode-dev
install_optional parallel

say "Building everything"
cmake --build --preset release

say "Running the tests"
ctest --preset release -j "$(nproc)"

say "Building the unit tests with sanitizers, in build-asan/"
cmake --preset asan ${SUNDER_ARCH:+-DSUNDER_ARCH="$SUNDER_ARCH"}
cmake --build --preset asan

say "Running the unit tests with sanitizers"
ctest --preset asan -j "$(nproc)"

say "Done: all tests pass"
