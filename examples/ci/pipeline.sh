#!/usr/bin/env bash
# Checks a change: times it against the program before, compares goldens, and measures what accuracy
# costs. Runs in any shell, and so in any build server; github.yml and gitlab.yml call it.
#
# usage: examples/ci/pipeline.sh [BASE]     BASE: the commit before the change; HEAD~1 by default
#
# Environment, each with a default:
#   SCENES   scenes to time and to measure        GOLDENS  goldens to compare; empty: all
#   SLOWER   allowed slowdown (--fail-slower)      SEEDS    runs of each scene at each setting
#   FRAMES   frames of each run; empty: all        REPEATS  timed runs of each scene
#   OUT      folder of the results                 NEW, OLD programs, if they are built already
#   DRAW     time every so many pictures, too; empty: none
#
# Writes to OUT: bench.html, golden/report.html and trade/trade.html to look at; bench.xml,
# golden.xml and trade.xml, JUnit for the build server. All checks run, also after one that fails;
# the exit code is 1 if one failed.
set -euo pipefail
cd "$(dirname "$0")/../.."

read -ra scenes <<<"${SCENES:-house brick_wall glass}"
read -ra goldens <<<"${GOLDENS:-}"
slower=${SLOWER:-5%}
seeds=${SEEDS:-2}
repeats=${REPEATS:-15}
out=${OUT:-out/ci}
frames=()
if [ -n "${FRAMES:-}" ]; then frames=(--frames "$FRAMES"); fi
draw=()
if [ -n "${DRAW:-}" ]; then draw=(--draw "$DRAW"); fi

say() { printf '\n== %s\n' "$*"; }

# Builds the program of a source tree in its folder build-ci/.
build() {
  cmake -S "$1" -B "$1/build-ci" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSUNDER_TESTS=OFF \
    -DSUNDER_BENCH=OFF >/dev/null
  cmake --build "$1/build-ci" --target sunder
}

new=${NEW:-}
if [ -z "$new" ]; then
  say "Building the change"
  build .
  new=build-ci/sunder
fi
old=${OLD:-}
if [ -z "$old" ]; then
  base=${1:-HEAD~1}
  say "Building $base"
  tree=$(mktemp -d)
  trap 'git worktree remove --force "$tree"' EXIT
  git worktree add --force --detach "$tree" "$base"
  build "$tree"
  old=$tree/build-ci/sunder
fi

failed=()
# Runs a check, and notes its name if it fails.
check() {
  local name=$1
  shift
  say "$name: sunder ${*:2}"
  "$@" || failed+=("$name")
}

# Writes a JUnit file with one test, for a check that writes none.
write_junit() {
  local name=$1 failure='' count=0
  if [[ " ${failed[*]} " == *" $name "* ]]; then
    count=1
    failure="<failure message=\"$name failed; its output has the reason\"/>"
  fi
  printf '<testsuite name="%s" tests="1" failures="%d"><testcase name="%s">%s</testcase></testsuite>\n' \
    "$name" "$count" "$name" "$failure" >"$out/$name.xml"
}

rm -rf "$out"
mkdir -p "$out"
"$new" doctor
check bench "$new" bench "${scenes[@]}" "${frames[@]}" "${draw[@]}" --repeats "$repeats" \
  --against "$old" --fail-slower "$slower" --junit "$out/bench.xml" --page "$out/bench.html" --json "$out/bench.json"
check golden "$new" golden report "${goldens[@]}" --junit "$out/golden.xml" --out "$out/golden"
check trade "$new" trade "${scenes[@]}" "${frames[@]}" --seeds "$seeds" -o "$out/trade"
write_junit trade

if [ ${#failed[@]} -gt 0 ]; then
  say "Failed: ${failed[*]}; see the pages in $out"
  exit 1
fi
say "Done: all checks passed; the pages are in $out"
