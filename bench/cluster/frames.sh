#!/usr/bin/env bash
# Draws those of a range of a take's frames that are not there yet:
#
#   frames.sh RANGE FRAMES SIZE X.take DIR [OPTIONS OF sunder render]
#
# RANGE counts from 1; ranges are of SIZE frames, the last one ends with frame FRAMES - 1. What the
# other scripts of this folder have their workers do. SUNDER names the program.
set -euo pipefail
range=$1 frames=$2 size=$3 take=$4 folder=$5
shift 5
first=$(((range - 1) * size))
last=$((first + size - 1 < frames - 1 ? first + size - 1 : frames - 1))
for ((frame = first; frame <= last; ++frame)); do
  rm -f "$folder/$(printf 'frame_%05d.png' "$frame")".part-*  # of a worker that died
done
exec "${SUNDER:-build/sunder}" render "$take" --frames "$first:$last" --resume -o "$folder/" --quiet "$@"
