#!/usr/bin/env bash
# Fuzzes every target for SECONDS each (60) under the address and undefined-behaviour sanitizers, and
# prints a table: target, executions, faults. Builds the fuzzer first (preset fuzz: clang-14,
# libomp-dev). Inputs that reach new code, and those that make a fault, are kept in build-fuzz/found.
#   tests/fuzz/run_all.sh [SECONDS [TARGET...]]
set -u
cd "$(dirname "$0")/../.."
seconds=${1:-60}
shift
cmake --preset fuzz > /dev/null && cmake --build --preset fuzz > /dev/null || exit 1
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for corpus in tests/fuzz/corpus/*/; do targets+=("$(basename "$corpus")"); done
fi
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 OMP_NUM_THREADS=1
printf '%-12s %12s %7s\n' target executions faults
failed=0
for target in "${targets[@]}"; do
  kept=build-fuzz/found/$target
  mkdir -p "$kept/new"
  rm -f "$kept"/{crash,oom,timeout,leak}-*
  build-fuzz/fuzzer "$target" "$kept/new" "tests/fuzz/corpus/$target" -max_total_time="$seconds" \
    -timeout=60 -rss_limit_mb=4096 -print_final_stats=1 -artifact_prefix="$kept/" > "$kept/log" 2>&1
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$kept/log")
  faults=$(find "$kept" -maxdepth 1 -name 'crash-*' -o -maxdepth 1 -name 'oom-*' \
    -o -maxdepth 1 -name 'timeout-*' -o -maxdepth 1 -name 'leak-*' | wc -l)
  printf '%-12s %12s %7s\n' "$target" "${executions:-none}" "$faults"
  [ "$faults" -eq 0 ] && [ -n "$executions" ] || { failed=1; echo "  see $kept/log"; }
done
exit $failed
