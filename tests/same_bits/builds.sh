#!/usr/bin/env bash
# Compiles the program for several instruction sets of x86-64 and by several compilers, and fails if
# scenes have other states than by the program in build/. Takes five minutes a build.
#
# Usage: tests/same_bits/builds.sh [BUILD...]     (sse2 avx512 clang o1 by default)
set -euo pipefail
cd "$(dirname "$0")/../.."
# shellcheck source=cmake/setup.sh
source cmake/setup.sh

[ -x build/sunder ] || fail "build/sunder, the program to compare with, is missing: run ./demo.sh"
builds=("$@")
[ $# -gt 0 ] || builds=(sse2 avx512 clang o1)
programs=(build/sunder)
for name in "${builds[@]}"; do
  options=(-DCMAKE_BUILD_TYPE=Release)
  case $name in
    sse2) options+=(-DSUNDER_ARCH=x86-64) ;;
    avx512) options+=(-DSUNDER_ARCH=x86-64-v4) ;;
    clang) options+=(-DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_C_COMPILER=clang-14) ;;
    o1) options=(-DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -D_GLIBCXX_ASSERTIONS") ;;
    *) fail "unknown build $name: sse2, avx512, clang or o1" ;;
  esac
  if [ "$name" = avx512 ] && ! grep -qw avx512vl /proc/cpuinfo; then
    echo "skipped avx512: this processor lacks it"
    continue
  fi
  if [ "$name" = clang ] && [ -n "$(missing clang-14 libomp-14-dev)" ]; then
    echo "skipped clang: the packages clang-14 and libomp-14-dev are missing"
    continue
  fi
  say "Compiling $name in build-$name"
  cmake -G Ninja -S . -B "build-$name" "${options[@]}" -DSUNDER_QUICK_BUILD=ON -DSUNDER_TESTS=OFF \
    -DSUNDER_BENCH=OFF >/dev/null
  cmake --build "build-$name" --target sunder
  programs+=("build-$name/sunder")
done
say "Comparing states of ${programs[*]}"
python3 tests/same_bits/compare.py "${programs[@]}"
