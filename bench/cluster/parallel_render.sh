#!/usr/bin/env bash
# Draws the frames of a recording as pictures, on several processors by GNU parallel:
#
#   bench/cluster/parallel_render.sh FRAMES SIZE X.take DIR [OPTIONS OF sunder render]
#
# in ranges of SIZE of the recording's FRAMES frames. Run it again after a worker was lost: existing
# pictures are not drawn again. Exits with 0 if all pictures exist. SUNDER and PARALLEL as in
# parallel_trade.sh.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
frames=${1:?how many frames has the take?} size=${2:?how many of them in a range?}
seq $(((frames + size - 1) / size)) | parallel --will-cite -q "$here/frames.sh" "{}" "$@"
