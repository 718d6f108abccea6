#!/usr/bin/env bash
# Runs examples/ci/pipeline.sh with one program as old and new, on one small scene: it passes and
# writes all pages and JUnit files. With goldens of a wrong picture it fails, and still runs the rest.
#
# usage: pipeline_test.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
root=$(realpath "$(dirname "$0")/../..")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "failed: $*" >&2
  cat "$folder/log" >&2
  exit 1
}

# A source tree with the pipeline and one golden. The program is a copy, which takes the goldens of
# the working directory.
mkdir -p "$folder/examples/ci" "$folder/tests/golden" "$folder/build"
cp "$root/examples/ci/pipeline.sh" "$folder/examples/ci/"
cp "$root"/tests/golden/stack.* "$root/tests/golden/hashes.txt" "$folder/tests/golden/"
cp "$program" "$folder/build/sunder"
ln -s "$root/scenes" "$folder/scenes"

run() {
  (cd "$folder" && NEW=build/sunder OLD=$program SCENES=scenes/stacks/stack.toml GOLDENS=stack \
    FRAMES=5 REPEATS=9 SEEDS=1 SLOWER=1000000% examples/ci/pipeline.sh >"$folder/log" 2>&1)
}

run || fail "the pipeline fails on one program as old and new"
for file in bench.html golden/report.html trade/trade.html bench.xml golden.xml trade.xml; do
  [ -s "$folder/out/ci/$file" ] || fail "$file is missing"
done
for file in bench golden trade; do
  python3 -c "import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])" \
    "$folder/out/ci/$file.xml" || fail "$file.xml is no XML"
  grep -q '<failure' "$folder/out/ci/$file.xml" && fail "$file.xml has a failure"
done

cp "$root/tests/golden/glass.png" "$folder/tests/golden/stack.png"
if run; then fail "the pipeline passes with a wrong picture"; fi
grep -q 'Failed: golden;' "$folder/log" || fail "the pipeline does not name the check that failed"
grep -q '<failure' "$folder/out/ci/golden.xml" || fail "golden.xml has no failure"
[ -s "$folder/out/ci/trade/trade.html" ] || fail "trade did not run after golden failed"
echo "the pipeline passes and fails as it should"
