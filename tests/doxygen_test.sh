#!/usr/bin/env bash
# Makes the reference of the public headers, as the target docs_html does. Fails if Doxygen warns,
# or if a type or a function has no description; members whose names say all, and operators, need
# none. Exits with 77 (skipped) without Doxygen.
#
#   doxygen_test.sh BUILD_FOLDER
set -euo pipefail
if ! command -v doxygen >/dev/null || [ ! -e "$1/Doxyfile" ]; then
  echo "Doxygen is missing, or was when the build was configured: apt-get install doxygen"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Reads the Doxyfile with other settings, given as arguments.
doxygen_with() {
  { cat "$1/Doxyfile" && printf '%s\n' "OUTPUT_DIRECTORY = $work" "${@:2}"; } | doxygen - 2>&1
}
doxygen_with "$1"
[ -e "$work/docs/classsunder_1_1World.html" ]
[ -e "$work/docs/sunder__c_8h.html" ]
doxygen_with "$1" "EXTRACT_ALL = NO" "WARN_AS_ERROR = NO" >"$work/log"
grep -q "(variable)" "$work/log"  # the log has what is not described
! grep -Ev "\((variable|enumvalue|typedef|macro definition)\)|operator" "$work/log"
