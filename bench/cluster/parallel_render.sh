#!/usr/bin/env bash
# Draws a take as pictures, its frames shared among processors by GNU parallel:
#
#   bench/cluster/parallel_render.sh FRAMES SIZE X.take DIR [OPTIONS OF sunder render]
#
# in ranges of SIZE of the take's FRAMES frames. Run it again after a worker was lost: ranges whose
# pictures are all there are not drawn again. Exits with 0 if all are there. SUNDER and PARALLEL as
# in parallel_trade.sh.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
frames=${1:?how many frames has the take?} size=${2:?how many of them in a range?}
seq $(((frames + size - 1) / size)) | parallel --will-cite -q "$here/frames.sh" "{}" "$@"
