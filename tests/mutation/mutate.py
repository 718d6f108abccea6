#!/usr/bin/env python3
"""Mutation testing: changes a hundred lines, one at a time, and runs the tests.

Usage: mutate.py [--seed N] [--count N] [--survivors]. tests/mutation/README.md says more. Begin
reading at main(). All mutants are built at once (mutant.h); one is chosen at run time.
"""
import argparse
import json
import os
import re
import resource
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from draw import draw

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from copy_tree import read_sources, write_sources  # noqa: E402
FOLDERS = ("solver", "fracture", "engine/world")
MEMORY_BYTES = 6 << 30  # limit of a test program: a mutant may fill vectors without end
LABELS = ("unit", "property", "truth", "extreme")
# Of another module; takes minutes; measures processor time, whose clock is coarse under a limit.
LEFT_OUT = ("render_test", "scenes_collapse_test", "timing_test")
FIRST_LINES = '#include "tests/mutation/{}"\n#line 1\n'


class Tree:
    """The copy of the sources with the mutants in it, and its build."""

    def __init__(self, work):
        self.source, self.build = work / "tree", work / "tree" / "build"
        self.texts = read_sources(ROOT)
        self.programs = find_programs(self.texts)  # name -> path of its first source

    def write(self, mutants):
        """Writes the files that differ, with the numbered mutants in place."""
        texts, by_path = dict(self.texts), {}
        for number, mutant in mutants.items():
            by_path.setdefault(mutant.path, []).append((number, mutant))
        for path, edits in by_path.items():
            texts[path] = edited(texts[path].decode(), edits).encode()
        for name in self.programs.values():
            texts[name] = FIRST_LINES.format("reach.h").encode() + texts[name]
        write_sources(ROOT, texts, self.source)
        meshes = self.source.parent / "shared"
        if (ROOT.parent / "shared").exists() and not meshes.exists():
            meshes.symlink_to(ROOT.parent / "shared")

    def make(self, jobs):
        """Builds; returns the output of a failed build, or an empty string."""
        if not (self.build / "build.ninja").exists():
            subprocess.run(["cmake", "--preset", "release"], cwd=self.source, check=True,
                           stdout=subprocess.DEVNULL)
        done = subprocess.run(["cmake", "--build", str(self.build), "-j", str(jobs), "--target",
                               *self.programs, "--", "-k", "0"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        return done.stdout if done.returncode else ""


def edited(text, edits):
    """Returns the text with the mutants in it, with unchanged line numbers."""
    for number, mutant in sorted(edits, key=lambda edit: -edit[1].start):
        text = text[:mutant.start] + mutant.edit(number) + text[mutant.end:]
    return FIRST_LINES.format("mutant.h") + text


def find_programs(texts):
    """Returns the test programs, and the first source of each."""
    programs = {}
    for path, text in texts.items():
        if re.fullmatch(r"tests/\w+/CMakeLists.txt", path):
            for name, label, rest in re.findall(r"sunder_test\((\w+)\s+LABELS (\w+)([^)]*)\)",
                                                text.decode()):
                if label in LABELS and name not in LEFT_OUT:
                    sources = rest.split("SOURCES")[1].split("LINK")[0].split()
                    programs[name] = str(Path(path).parent / sources[0])
    return programs


def fits(mutant, others):
    """True if no other mutant changes the same text."""
    return all(other.path != mutant.path or other.end <= mutant.start or other.start >= mutant.end
               for other in others)


def drawn(texts, seeds, count, wrong):
    """Returns, by number, the first `count` mutants of each seed that compile without overlap."""
    mutants = {}
    for place, seed in enumerate(seeds):
        number, last = place * 1000, len(mutants) + count
        for mutant in draw(texts, FOLDERS, seed):
            if len(mutants) == last:
                break
            if fits(mutant, mutants.values()):
                number += 1
                if str(mutant) not in wrong:
                    mutants[number] = mutant
    return mutants


def build(tree, seeds, count, jobs):
    """Builds and returns the mutants. Those that do not compile are listed in wrong.json."""
    note = tree.source.parent / "wrong.json"
    wrong = set(json.loads(note.read_text())) if note.exists() else set()
    while True:
        mutants = drawn(tree.texts, seeds, count, wrong)
        tree.write(mutants)
        output = tree.make(jobs)
        if not output:
            print(f"{len(mutants)} mutants built", flush=True)
            return mutants
        blamed = {str(m) for k, m in mutants.items()
                  if re.search(rf"{re.escape(m.path)}:{m.line}:", output)
                  or re.search(rf"mutants::(\w+<){k}\b", output)}
        if not blamed:
            sys.exit(output[-6000:] + "\nThe copy does not build, and no mutant is to blame.")
        wrong |= blamed
        note.write_text(json.dumps(sorted(wrong)))


def run(tree, program, tests=None, most_s=600, **environment):
    """Returns True if the program's tests pass within `most_s` of processor time, and the first
    test that fails, after which none is run."""
    environment = {k: str(v) for k, v in environment.items()}
    environment |= {"OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive",
                    "GTEST_FILTER": ":".join(tests or ["*"]), "GTEST_FAIL_FAST": "1",
                    "GTEST_BRIEF": "1"}

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
        resource.setrlimit(resource.RLIMIT_CPU, (most_s, most_s))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        done = subprocess.run([str(tree.build / program)], env=os.environ | environment,
                              cwd=tree.build, timeout=100 * most_s, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, preexec_fn=limit)
    except subprocess.TimeoutExpired:
        return False, "it waits for ever"
    failed = re.search(rb"\[  FAILED  \] ([\w./]+)", done.stdout)
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return False, "endless"
    return done.returncode == 0, failed[1].decode() if failed else "a crash"


def find_reach(tree, programs, jobs):
    """Returns for each mutant the tests that run its line, as (milliseconds, program, test). New
    programs are run without any mutant: all tests must pass."""
    def one(program):
        path, part = tree.build / f"{program}.reach", tree.build / f"{program}.part"
        if not path.exists() or path.stat().st_mtime < (tree.build / program).stat().st_mtime:
            part.unlink(missing_ok=True)
            passed, failed = run(tree, program, SUNDER_REACH=part)
            if not passed:
                raise RuntimeError(f"{program} fails without any mutant: {failed}")
            part.rename(path)  # never a part of a file, even if interrupted
        return program, path.read_text()
    reach = {}
    with ThreadPoolExecutor(jobs) as pool:
        for program, text in pool.map(one, programs):
            for line in text.splitlines():
                test, ms, *numbers = line.split()
                for number in numbers:
                    reach.setdefault(int(number), []).append((int(ms), program, test))
    return reach


def rounds(tests, longest_s):
    """Yields rounds of tests, the quickest first: a program, some of its tests, a time limit."""
    for shortest_ms, longest_ms in ((0, 100), (100, 1000), (1000, 1000 * longest_s)):
        of_program = {}
        for ms, program, test in sorted(tests):
            if shortest_ms <= ms < longest_ms:
                took_ms, names = of_program.setdefault(program, [0, []])
                of_program[program][0] = took_ms + ms
                names.append(test)
        for program, (took_ms, names) in sorted(of_program.items(), key=lambda item: item[1][0]):
            yield program, names, 10 + 10 * took_ms // 1000


def try_mutant(tree, number, tests, longest_s):
    """Returns the test that caught the mutant, or an empty string."""
    for program, names, most_s in rounds(tests, longest_s):
        passed, failed = run(tree, program, names, most_s, SUNDER_MUTANT=number)
        if not passed:
            return f"{program}: {failed}"
    return ""


def equivalents():
    """Returns mutant -> reason why it is equivalent, from equivalent.txt."""
    known = {}
    for line in (Path(__file__).parent / "equivalent.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            path, code, before, after, reason = (part.strip() for part in line.split(" | "))
            known[path, code, before, after] = reason
    return known


def report(tree, mutants, verdicts, reach):
    known = equivalents()

    def key_of(mutant):
        code = tree.texts[mutant.path].decode().splitlines()[mutant.line - 1].strip()
        return mutant.path, code, mutant.before, mutant.after or "nothing"
    caught = sum(1 for verdict in verdicts.values() if verdict)
    same = {k: known[key_of(mutants[k])] for k, verdict in verdicts.items()
            if not verdict and key_of(mutants[k]) in known}
    for k, verdict in verdicts.items():
        if not verdict and k not in same:
            passed = "" if reach.get(k) else "   (no test runs it)"
            print(f"survived  {k:3} {mutants[k]}   in: {key_of(mutants[k])[1]}{passed}")
    for k, reason in same.items():
        print(f"the same  {k:3} {mutants[k]}: {reason}")
    print(f"{caught} of {len(verdicts)} caught, {len(same)} change nothing, "
          f"{len(verdicts) - caught - len(same)} survived")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    arguments.add_argument("--seed", type=int, nargs="+", default=[1])
    arguments.add_argument("--count", type=int, default=100, help="of each seed")
    arguments.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments.add_argument("--longest", type=int, default=5, metavar="SECONDS",
                           help="leave out tests that take longer")
    arguments.add_argument("--work", type=Path, default=ROOT / "build-mutants")
    arguments.add_argument("--survivors", action="store_true",
                           help="try only those that survived the last run of this seed")
    arguments = arguments.parse_args()
    start_s = time.time()
    tree = Tree(arguments.work.resolve())
    mutants = build(tree, arguments.seed, arguments.count, arguments.jobs)
    built_s = time.time()
    reach = find_reach(tree, tree.programs, arguments.jobs)
    reached_s = time.time()
    last = arguments.work / "verdicts.json"
    verdicts = {str(m): "" for m in mutants.values()}
    if arguments.survivors and last.exists():
        known = json.loads(last.read_text())
        verdicts |= {text: known.get(text, "") for text in verdicts}

    def judge(item):
        number, mutant = item
        if not verdicts[str(mutant)]:
            verdicts[str(mutant)] = try_mutant(tree, number, reach.get(number, []),
                                                arguments.longest)
            print(f"{number:3} {verdicts[str(mutant)] or 'SURVIVED'}   {mutant}", flush=True)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        list(pool.map(judge, mutants.items()))
    last.write_text(json.dumps(verdicts, indent=1))
    for place, seed in enumerate(arguments.seed):
        print(f"seed {seed}:")
        mine = {k: verdicts[str(m)] for k, m in mutants.items() if k // 1000 == place}
        report(tree, mutants, mine, reach)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"built in {built_s - start_s:.0f} s, run once in {reached_s - built_s:.0f} s, tried in "
          f"{time.time() - reached_s:.0f} s; {used.ru_utime + used.ru_stime:.0f} s of processor")


if __name__ == "__main__":
    main()
