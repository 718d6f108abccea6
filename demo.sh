#!/usr/bin/env bash
# From a fresh Debian to a video: installs what is missing, builds, and has a house shot to rubble.
# Ends with out/demo.mp4, out/demo.png and a table of frame timings. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")"
source cmake/setup.sh

set_up

say "Building build/sunder"
cmake --build --preset release --target sunder

say "Frame timing of house, without pictures"
mkdir -p out
build/sunder simulate house

say "Rendering house to out/demo.mp4"
build/sunder render house -o out/demo.mp4

say "Rendering one frame of it to out/demo.png"
build/sunder render house -o out/demo.png --frames 210:210

say "Done: out/demo.mp4, out/demo.png"
