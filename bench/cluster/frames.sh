#!/usr/bin/env bash
# Draws the frames of a range of a recording that do not exist yet:
#
#   frames.sh RANGE FRAMES SIZE X.take DIR [OPTIONS OF sunder render]
#
# RANGE counts from 1. Ranges have SIZE frames; the last one ends with frame FRAMES - 1. The workers
# of the other scripts of this folder run this script. SUNDER names the program.
set -euo pipefail
range=$1 frames=$2 size=$3 take=$4 folder=$5
shift 5
first=$(((range - 1) * size))
last=$((first + size - 1 < frames - 1 ? first + size - 1 : frames - 1))
for ((frame = first; frame <= last; ++frame)); do
  rm -f "$folder/$(printf 'frame_%05d.png' "$frame")".part-*  # from a worker that died
done
exec "${SUNDER:-build/sunder}" render "$take" --frames "$first:$last" --resume -o "$folder/" --quiet "$@"
