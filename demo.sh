#!/usr/bin/env bash
# Installs missing packages on Debian, builds, and renders a house that is shot to rubble. Writes
# out/demo.mp4 and out/demo.png, and prints a table of frame timings. Can be run again at any time.
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
