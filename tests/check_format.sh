#!/bin/sh
# Fails if clang-format 14 (Debian 12's) would change a source; exits 77 (skipped) without it.
cd "$(dirname "$0")/.." || exit 1
format=$(command -v clang-format-14 || command -v clang-format)
case $("${format:-false}" --version 2>/dev/null) in
  *"version 14."*) ;;
  *) echo "clang-format 14 is missing: apt-get install clang-format-14"; exit 77 ;;
esac
find engine fracture solver render scenes bench tests examples \
  \( -name '*.h' -o -name '*.cpp' -o -name '*.c' \) -print0 |
  xargs -0 "$format" --dry-run -Werror
