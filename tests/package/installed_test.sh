#!/usr/bin/env bash
# Installs the program into an empty prefix and runs it in an empty folder: it finds the scenes and
# goldens that were installed with it, writes only to that folder, and never changes what is installed.
#
# usage: installed_test.sh CMAKE BUILD
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "failed: $*" >&2
  exit 1
}

"$1" --install "$2" --component program --prefix "$folder/prefix" >/dev/null
mkdir "$folder/work"
cd "$folder/work"
export SUNDER_CACHE=$folder/work/cache
sunder=$folder/prefix/bin/sunder
state() { (cd "$folder/prefix" && find . -type f -exec sha256sum {} + | sort); }
before=$(state)

"$sunder" list --json list.json >/dev/null
grep -q "$folder/prefix/share/sunder/scenes" list.json || fail "the scenes are others"
"$sunder" golden test stack >golden.txt || fail "golden test: $(cat golden.txt)"
grep -qx "goldens of $folder/prefix/share/sunder/golden, installed with the program; there is no \
$folder/work/tests/golden" golden.txt || fail "the goldens are others: $(cat golden.txt)"
"$sunder" bench stack --repeats 1 --warm-up 0 --json bench.json >bench.txt || fail "bench"
grep -q "^stored states of $folder/prefix/.*; there is no $folder/work/tests/golden/hashes.txt$" bench.txt ||
  fail "the stored states are others: $(cat bench.txt)"
if "$sunder" golden accept stack 2>refused.txt; then fail "an installed golden was accepted"; fi
grep -q "tests/golden: no goldens" refused.txt || fail "golden accept: $(cat refused.txt)"

# A golden that differs: the message names a command that works.
mkdir tests
cp -r "$folder/prefix/share/sunder/golden" tests/
cp tests/golden/glass.png tests/golden/stack.png
if "$sunder" golden test stack >golden.txt; then fail "a wrong picture passes"; fi
grep -q "sunder golden accept stack" golden.txt || fail "no remedy is named: $(cat golden.txt)"
"$sunder" golden accept stack --rebase "the picture was replaced by hand" --quiet
"$sunder" golden test stack >golden.txt || fail "golden test after accept: $(cat golden.txt)"
grep -qx "goldens of $folder/work/tests/golden" golden.txt || fail "$(cat golden.txt)"
rm -r tests
"$sunder" bench stack --accept --repeats 1 --warm-up 0 --quiet
[ -s tests/golden/hashes.txt ] || fail "bench --accept stored no states"

[ "$before" = "$(state)" ] || fail "installed files were changed"
echo "the installed program finds its files and changes none"
