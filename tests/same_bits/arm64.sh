#!/usr/bin/env bash
# Compiles Sunder for 64-bit ARM, and fails if a unit test fails there under QEMU, or if scenes have
# other states than by the program in build/. Exit code 77 if a compiler, QEMU or packages are
# missing. Takes three quarters of an hour.
#
# Usage: tests/same_bits/arm64.sh [--install] [--frames N] [--no-tests]
#   --install    install the compiler and QEMU, and download the packages for arm64, if missing
#   --frames N   compare N frames of each scene instead of all
#   --no-tests   compare the states only
set -euo pipefail
cd "$(dirname "$0")/../.."
# shellcheck source=cmake/setup.sh
source cmake/setup.sh

install=false frames=0 with_tests=true
while [ $# -gt 0 ]; do
  case $1 in
    --install) install=true ;;
    --frames) frames=${2:?a number of frames} && shift ;;
    --no-tests) with_tests=false ;;
    *) fail "unknown option $1; see the first lines of $0" ;;
  esac
  shift
done

if $install; then
  install_packages g++-aarch64-linux-gnu qemu-user-static
  [ -d build-arm64/packages ] || cmake/arm64_packages.sh
fi
skip() {
  echo "skipped: $*; tests/same_bits/arm64.sh --install installs it"
  exit 77
}
for package in g++-aarch64-linux-gnu qemu-user-static; do
  [ -z "$(missing $package)" ] || skip "the package $package is missing"
done
[ -d build-arm64/packages ] || skip "the packages for arm64 are missing in build-arm64/packages"
[ -x build/sunder ] || fail "build/sunder, the program to compare with, is missing: run ./demo.sh"

# Tests that need no other program. Left out: those that take many minutes under QEMU, and those that
# start themselves again.
tests=(engine_test geometry_test scene_export_test mesh_test fracture_unit fracture_property
  fracture_visual solver_unit solver_property scenes_test)
left_out='*hold_over_ten_thousand*:*AnySoupEndsInTime*:*ACopyGoesOn*:*ARestoredWorldGoesOn*:*DeathTest*'
qemu=(qemu-aarch64-static -L /usr/aarch64-linux-gnu)

say "Compiling for arm64"
cmake --preset arm64 >/dev/null
targets=(sunder)
if $with_tests; then targets+=("${tests[@]}"); fi
cmake --build --preset arm64 --target "${targets[@]}"

status=0
OBJDUMP=aarch64-linux-gnu-objdump tests/same_bits/fused.sh \
  build-arm64/{engine,fracture,solver,scenes}/libsunder_*.a || status=1
say "Comparing states"
python3 tests/same_bits/compare.py --frames "$frames" build/sunder "${qemu[*]} build-arm64/sunder" ||
  status=1
if $with_tests; then
  for test in "${tests[@]}"; do
    say "$test under QEMU"
    "${qemu[@]}" "build-arm64/$test" --gtest_brief=1 --gtest_filter="-$left_out" || status=1
  done
fi
exit $status
