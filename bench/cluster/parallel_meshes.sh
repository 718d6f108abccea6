#!/usr/bin/env bash
# Makes a data set of broken meshes on several processors by GNU parallel:
#
#   bench/cluster/parallel_meshes.sh SHARDS MESH... -o DIR [OPTIONS OF broken_meshes.py]
#
# Run it again after a worker was lost: it makes what is missing. Exits with 0 if nothing is
# missing. PYTHON names the interpreter, which must find the module sunder. PARALLEL as in
# parallel_trade.sh.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
make=("${PYTHON:-python3}" "$here/../../examples/python/broken_meshes.py")
shards=${1:?how many shards?}
shift
# The last command reports the meshes that a failed worker leaves unmade.
seq "$shards" |
  parallel --will-cite -q "${make[@]}" --processes 1 --shard "{}/$shards" "$@" || true
exec "${make[@]}" --missing "$@"
