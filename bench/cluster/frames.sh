#!/usr/bin/env bash
# Draws one range of a take's frames, unless all its pictures are there:
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
  if [ ! -e "$folder/$(printf 'frame_%05d.png' "$frame")" ]; then
    # In a folder of its own: workers on other machines write to the same one.
    mkdir -p "$folder"
    part="$folder/frames-$first-$last"
    rm -rf "$part" "$part".part-*  # of a worker that died
    "${SUNDER:-build/sunder}" render "$take" --frames "$first:$last" -o "$part/" --quiet "$@"
    mv "$part"/*.png "$folder/"
    rm -r "$part"
    exit
  fi
done
