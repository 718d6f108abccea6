#!/usr/bin/env bash
# Shares a study among processors by GNU parallel, and merges it:
#
#   bench/cluster/parallel_trade.sh SHARDS SCENE... -o DIR [OPTIONS OF sunder trade]
#
# Run it again after a worker was lost: it does what is missing. Exits as the merge does: 0 if all
# runs are there. SUNDER names the program, PARALLEL holds options of GNU parallel (--jobs 8,
# --sshlogin ...), one job a processor by default.
set -euo pipefail
sunder=${SUNDER:-build/sunder}
shards=${1:?how many shards?}
shift
# What a worker leaves undone is found by the merge.
seq "$shards" | parallel --will-cite -q "$sunder" trade --quiet --shard "{}/$shards" "$@" || true
exec "$sunder" trade --merge "$@"
