#!/usr/bin/env bash
# Installs missing packages on Debian, builds, and renders a house that is shot to rubble. Writes
# out/demo.png and out/demo.mp4, and prints a table of frame timings. Can be run again at any time.
set -euo pipefail
cd "$(dirname "$0")"
source cmake/setup.sh

set_up

say "Building build/sunder"
cmake --build --preset release --target sunder

say "Rendering one frame of house to out/demo.png"
mkdir -p out
build/sunder render house -o out/demo.png --frames 210:210

say "Frame timing of it, without pictures"
build/sunder simulate house

say "Rendering all of it to out/demo.mp4"
build/sunder render house -o out/demo.mp4

say "Done: out/demo.png, out/demo.mp4"
