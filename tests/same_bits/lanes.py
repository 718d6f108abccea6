#!/usr/bin/env python3
"""Runs every scene on several numbers of threads and lanes, and fails if their states differ.

Usage: lanes.py [--sunder build/sunder] [--frames 600] [--preset draft] [SCENE...]
The tests compare the first seconds of each scene; this script takes a quarter of an hour.
"""
import argparse
import subprocess
import sys

from compare import are_same, state_hash

RUNS = [(1, 16), (2, 8), (4, 4), (7, 1)]  # (threads, lanes)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sunder", default="build/sunder")
    parser.add_argument("--frames", type=int, default=600)
    parser.add_argument("--preset", default="draft", help="draft has one step per frame")
    parser.add_argument("scenes", nargs="*")
    args = parser.parse_args()
    scenes = args.scenes or subprocess.run([args.sunder, "list", "--quiet"], check=True, text=True,
                                           capture_output=True).stdout.split()
    differ = 0
    for scene in scenes:
        hashes = [state_hash(args.sunder, scene, args.preset, args.frames, "--threads", str(threads),
                             "--set", f"solver.lanes={lanes}",
                             "--set", f"scene.duration_s={args.frames / 60}")
                  for threads, lanes in RUNS]
        same = are_same(hashes)
        differ += not same
        print(f"{scene:16} {' '.join(hashes) if not same else hashes[0]} "
              f"{'same' if same else 'DIFFERENT'}", flush=True)
    print(f"{len(scenes)} scenes, threads and lanes {RUNS}: {differ} differ")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
