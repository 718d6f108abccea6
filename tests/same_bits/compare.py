#!/usr/bin/env python3
"""Runs scenes by several builds of the program, and fails if their states differ.

Usage: compare.py [--scenes S,...] [--presets P,...] [--frames N] [--markdown] PROGRAM PROGRAM...
A PROGRAM is a command, as in "qemu-aarch64-static build-arm64/sunder". The first is the reference.
"""
import argparse
import json
import shlex
import subprocess
import sys

SCENES = "stack,brick_wall,glass,column_row,vase"
PRESETS = "draft,realtime,accurate"


def state_hash(program, scene, preset, frames, *options):
    """Returns the hash of the states of a run, or the last line of what went wrong."""
    command = [*shlex.split(program), "simulate", scene, "--preset", preset, "--quiet", "--json", "-",
               *options]
    if frames:
        command += ["--frames", str(frames)]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        return f"exit code {run.returncode}: {run.stderr.strip().splitlines()[-1:]}"
    return json.loads(run.stdout)["state_hash"]


def are_same(hashes):
    return len(set(hashes)) == 1 and not hashes[0].startswith("exit")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", default=SCENES)
    parser.add_argument("--presets", default=PRESETS)
    parser.add_argument("--frames", type=int, default=0, help="0: the whole scenes")
    parser.add_argument("--markdown", action="store_true", help="write a table in Markdown")
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    args = parser.parse_args()
    row = "| `{}` | {} | {} | {} |" if args.markdown else "{:14} {:9} {} {}"
    runs = [(scene, preset) for scene in args.scenes.split(",")
            for preset in args.presets.split(",")]
    differ = 0
    for scene, preset in runs:
        hashes = [state_hash(program, scene, preset, args.frames) for program in args.programs]
        same = are_same(hashes)
        differ += not same
        print(row.format(scene, preset, hashes[0] if same else " ".join(hashes),
                         "same" if same else "DIFFERENT"), flush=True)
    print(f"{len(runs)} runs by {len(args.programs)} programs: {differ} differ")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
