#!/usr/bin/env bash
# Checks the commit that scenes/app/commit.cmake writes for a program: that of the checkout, with
# "+changes" if a source differs from it, "unknown" without a checkout, or what the user gives; and
# that the file is left alone while the commit is the same, so that a build compiles nothing.
#
# usage: commit_test.sh
set -euo pipefail
script=$(realpath "$(dirname "$0")/../../scenes/app/commit.cmake")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tree=$folder/tree
mkdir -p "$tree/engine" "$tree/docs"
echo 1 >"$tree/engine/a.cpp"
echo 1 >"$tree/docs/a.md"

# Expects a commit to be written, with what the user gives as SUNDER_COMMIT.
expect() {
  cmake -DOUT="$folder/commit.cpp" -DCOMMIT="${2:-}" -DGIT=git -DFOLDER="$tree" -P "$script"
  grep -qF "kCommit = \"$1\";" "$folder/commit.cpp" && return
  echo "failed: expected the commit $1, found:" >&2
  cat "$folder/commit.cpp" >&2
  exit 1
}

git_here() { git -C "$tree" -c user.name=x -c user.email=x@x.invalid "$@"; }

expect unknown
expect 1.0 1.0
git_here init -q
git_here add -A
git_here commit -qm first
commit=$(git_here rev-parse --short=12 HEAD)
expect "$commit"
touch -d '1 hour ago' "$folder/commit.cpp"
before=$(stat -c %Y "$folder/commit.cpp")
expect "$commit"
echo 2 >"$tree/docs/a.md"
expect "$commit"
[ "$(stat -c %Y "$folder/commit.cpp")" = "$before" ] || { echo "failed: written again" >&2; exit 1; }
echo 2 >"$tree/engine/a.cpp"
expect "$commit+changes"
git_here commit -qam second
expect "$(git_here rev-parse --short=12 HEAD)"
echo "the commit is that of the sources"
