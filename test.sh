#!/usr/bin/env bash
# Installs missing packages, builds, and runs the tests. With --slow also installs what only some
# tests need (Chromium, other engines and the like: 1.2 GB), and runs these and the tests that take
# more than ten seconds, the extremes, the truths at every preset and the soak test. With --all also
# runs the unit tests under the address and undefined-behaviour sanitizers, whose build takes longer
# than that of the program. Can be run again at any time.
set -euo pipefail
slow=false
sanitized=false
case "${1:-}" in
  "") ;;
  --slow) slow=true ;;
  --all) slow=true sanitized=true ;;
  *) echo "usage: ./test.sh [--slow | --all]" >&2; exit 2 ;;
esac

cd "$(dirname "$0")"
source cmake/setup.sh

# Before the build is configured, which leaves out what needs a missing package.
install_optional pybind11-dev python3-dev python3-numpy python3-venv
if $slow; then
  # The reference, the format, other engines, the page, data sets, other processors, and packages.
  install_optional doxygen
  install_optional clang-format-14
  install_optional libbullet-dev libode-dev
  install_optional libjs-three chromium
  install_optional parallel
  install_optional python3-distributed
  install_optional qemu-user-static
  install_optional mmdebstrap lintian
fi
set_up

say "Building everything"
cmake --build --preset release

say "Running the tests"
mkdir -p out
# ctest has an entry per row of truths and extremes, and one per row at the default preset.
skipped="extreme|truth_all|soak|long|package"
if $slow; then skipped="_default"; fi
ctest --preset release -j "$(nproc)" --output-junit "$PWD/out/tests.xml" -LE "$skipped"
if ! $sanitized; then
  say "Done: the tests pass, listed with their times in out/tests.xml; --all runs the rest"
  exit
fi

say "Building the unit tests with sanitizers, in build-asan/"
cmake --preset asan ${SUNDER_ARCH:+-DSUNDER_ARCH="$SUNDER_ARCH"}
cmake --build --preset asan

say "Running the unit tests with sanitizers"
ctest --preset asan -j "$(nproc)"

say "Done: all tests pass"
