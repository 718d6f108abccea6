#!/usr/bin/env bash
# Fails if an instruction of an object file or library multiplies and adds with one rounding (FMA):
# other processors, and other compilers, round twice. Prints the functions that have one.
#
# Usage: tests/same_bits/fused.sh FILE...     (OBJDUMP: the program, objdump by default)
set -euo pipefail

status=0
for file in "$@"; do
  found=$("${OBJDUMP:-objdump}" -dC "$file" | awk '
    /^[0-9a-f]+ <.*>:$/ { functions++; name = $0; sub(/^[0-9a-f]+ </, "", name); sub(/>:$/, "", name) }
    /[ \t](vfn?m(add|sub|addsub|subadd)[0-9]+[ps][sd]|fn?m(add|sub)|fml[as])[ \t]/ { print name }
    END { if (!functions) exit 1 }' | sort | uniq -c) || {
    echo "$file: no code that ${OBJDUMP:-objdump} understands"
    status=1
    continue
  }
  [ -z "$found" ] && continue
  printf '%s: fused operations, by function:\n%s\n' "$file" "$found"
  status=1
done
exit $status
