#!/usr/bin/env python3
"""Counts how often `sunder bench --against` calls one of two identical programs slower.

Usage: identical_builds.py PROGRAM [--commands 40] [--scenes stack ...] [--repeats N] [--frames N]
                           [--fail-slower P] [--draw N]

Makes a new copy of PROGRAM for each command, and times PROGRAM against it. Prints a line for each
command, with the figures that it calls slower or faster, and at the end the share of commands that
call any figure slower, which is to be at most 5 % (bench/README.md). The exit code is 1 if there are
so many that a share of 5 % would give them in less than one campaign of a hundred.
"""
import argparse
import json
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

STATED = 0.05    # kJudgeError in scenes/timing/judge.h
UNLIKELY = 0.01


def probability(count, of):
    """Returns the probability of at least `count` alarms in `of` commands at the stated rate."""
    return sum(math.comb(of, k) * STATED ** k * (1 - STATED) ** (of - k) for k in range(count, of + 1))


def judge(program, arguments, folder):
    """Times a program against a copy of itself. Returns the scenes of its JSON."""
    copy, figures = folder / "build/sunder", folder / "figures.json"
    copy.parent.mkdir(exist_ok=True)
    copy.unlink(missing_ok=True)  # a new file, which has other pages of memory
    shutil.copy(program, copy)
    done = subprocess.run([program, "bench", *arguments, "--against", copy, "--quiet", "--json", figures],
                          check=False, text=True, stderr=subprocess.PIPE)
    if done.returncode not in (0, 1) or not figures.exists():
        sys.exit(f"{program} bench fails with exit code {done.returncode}: {done.stderr}")
    scenes = json.loads(figures.read_text(encoding="utf-8"))["scenes"]
    figures.unlink()
    return scenes, done


def main():
    """Runs the commands."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--commands", type=int, default=40, help="number of commands; 40 by default")
    parser.add_argument("--scenes", nargs="+", default=["glass"], help="glass by default")
    parser.add_argument("--repeats", type=int)
    parser.add_argument("--frames", type=int, default=60, help="60 by default")
    parser.add_argument("--fail-slower", help="count commands that fail at these bounds as well")
    parser.add_argument("--draw", type=int)
    given = parser.parse_args()
    arguments = [*given.scenes, "--frames", str(given.frames)]
    for option in ("repeats", "fail_slower", "draw"):
        if getattr(given, option) is not None:
            arguments += ["--" + option.replace("_", "-"), str(getattr(given, option))]
    print(f"{given.commands} commands: sunder bench {' '.join(arguments)} --against a copy of itself")
    alarms, failures = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        share = given.program.resolve().parent.parent / "share"
        if share.exists():  # the scenes of an installed program
            (Path(folder) / "share").symlink_to(share)
        for command in range(given.commands):
            scenes, done = judge(given.program.resolve(), arguments, Path(folder))
            figures = [(scene["scene"], figure) for scene in scenes
                       for figure in scene["against"]["figures"]]
            if any(figure["judgement"] == "too few repeats" for _, figure in figures):
                sys.exit(f"too few repeats: at least {scenes[0]['against']['least_repeats']} are needed")
            found = [f"{scene} {figure['what']} {figure['figure']}, {figure['unit']}: "
                     f"{figure['judgement']}"
                     for scene, figure in figures if figure["judgement"] in ("slower", "faster")]
            alarms += any(figure["judgement"] == "slower" for _, figure in figures)
            failures += any(figure["fails"] for _, figure in figures)
            print(f"{command + 1:3}  {len(figures)} figures  {'; '.join(found) or '-'}", flush=True)
    chance = probability(alarms, given.commands)
    print(f"slower: {alarms} of {given.commands} commands, {100 * alarms / given.commands:.0f} %; at "
          f"most {100 * STATED:.0f} % are stated, which give as many or more in {100 * chance:.0f} % of "
          "campaigns")
    if given.fail_slower:
        print(f"failed by --fail-slower {given.fail_slower}: {failures} of {given.commands} commands")
    return 1 if chance < UNLIKELY else 0


if __name__ == "__main__":
    sys.exit(main())
