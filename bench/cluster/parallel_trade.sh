#!/usr/bin/env bash
# Runs a study on several processors by GNU parallel, and merges the results:
#
#   bench/cluster/parallel_trade.sh SHARDS SCENE... -o DIR [OPTIONS OF sunder trade]
#
# Run it again after a worker was lost: it does the missing runs. Exits with the status of the
# merge: 0 if no run is missing. SUNDER names the program. PARALLEL has options of GNU parallel
# (--jobs 8, --sshlogin ...); the default is one job per processor.
set -euo pipefail
sunder=${SUNDER:-build/sunder}
shards=${1:?how many shards?}
shift
# The merge reports the runs that a failed worker leaves undone.
seq "$shards" | parallel --will-cite -q "$sunder" trade --quiet --shard "{}/$shards" "$@" || true
exec "$sunder" trade --merge "$@"
