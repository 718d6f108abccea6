#!/usr/bin/env python3
"""Plants faults, one at a time, in a copy of the tree, and runs the goldens and tests.

Usage: plant.py [--jobs J] [--only ID] [--escapes] [--shard K/N]   tries faults, writes table.md
       plant.py --check                                           fails if a fault does not apply
tests/planted/README.md says more. Begin reading at main().
"""
import argparse
import hashlib
import json
import os
import queue
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from copy_tree import read_sources, write_sources  # noqa: E402

HERE = Path(__file__).resolve().parent
TABLE = HERE / "table.md"
FEWEST, FEWEST_OF_AREA = 60, 10
AREAS = ("drawing", "solver", "fracture", "engine", "files", "program")
KEYS = {"id", "kind", "file", "old", "new", "wrong", "guard"}
MEMORY_BYTES = 8 << 30  # limit of a process: a fault may fill vectors without end
LONGEST_S = {"build": 3600, "golden": 1800, "ctest": 7200}
# The tests of ./test.sh, without those that any change of a source fails.
SLOW_LABELS, QUICK_LABELS = "extreme|truth_all|soak|long|package", "^(unit|property)$"
LEFT_OUT = ["-E", "^source tree: |^planted faults: "]
AT_ONCE = 4  # guards that are checked together
ESCAPED, UNTRIED = "**escaped**", "not tried"


class ListError(Exception):
    """A fault of the list that cannot be tried."""


class Stopped(Exception):
    """The run was interrupted."""


class Fault:
    """One change of one line, and the guard that is expected to notice it."""

    def __init__(self, area, entry):
        if set(entry) != KEYS or not all(isinstance(value, str) for value in entry.values()):
            raise ListError(f"faults/{area}.toml: {entry.get('id', 'a fault')}: the keys must be "
                            + ", ".join(sorted(KEYS)))
        self.area = area
        self.id, self.kind, self.file = entry["id"], entry["kind"], entry["file"]
        self.old, self.new, self.wrong = entry["old"], entry["new"], entry["wrong"]
        self.guard = entry["guard"]  # "golden NAME..." or the expression of ctest -R
        words = "\0".join((self.file, self.old, self.new))
        self.version = hashlib.sha256(words.encode()).hexdigest()[:6]

    def applied(self, text):
        """Returns the source with the fault. Throws ListError if the fault does not apply."""
        where = f"{self.id}: {self.file}"
        if text is None:
            raise ListError(f"{where}: no such file; change the fault in faults/{self.area}.toml")
        if "\n" in self.old + self.new or self.old == self.new:
            raise ListError(f"{where}: a fault replaces a part of one line by another")
        found = text.decode().count(self.old)
        if found != 1:
            raise ListError(f"{where}: the text occurs {found} times, not once; change the fault in "
                            f"faults/{self.area}.toml: {self.old}")
        return text.decode().replace(self.old, self.new).encode()


def read_faults():
    """Returns the faults of all areas in order."""
    faults = []
    for area in AREAS:
        entries = tomllib.loads((HERE / "faults" / f"{area}.toml").read_text())["fault"]
        faults += [Fault(area, entry) for entry in entries]
    return faults


def problems(faults, read):
    """Returns what is wrong with the list; `read` returns the content of a file, or None."""
    messages, ids = [], set()
    for fault in faults:
        try:
            fault.applied(read(fault.file))
        except ListError as error:
            messages.append(str(error))
        if fault.id in ids:
            messages.append(f"{fault.id}: there are two faults of this name")
        ids.add(fault.id)
        if fault.guard.startswith("golden "):
            messages += [f"{fault.id}: there is no golden {name}" for name in fault.guard.split()[1:]
                         if not (ROOT / "tests/golden" / f"{name}.json").exists()]
        if "|" in fault.wrong + fault.kind or not fault.wrong.endswith("."):
            messages.append(f"{fault.id}: wrong must be a sentence without |")
    counts = {area: sum(fault.area == area for fault in faults) for area in AREAS}
    messages += [f"faults/{area}.toml has {count} faults, fewer than {FEWEST_OF_AREA}"
                 for area, count in counts.items()
                 if count < FEWEST_OF_AREA and area not in ("engine", "program")]
    if len(faults) < FEWEST:
        messages.append(f"there are {len(faults)} faults, fewer than {FEWEST}")
    return messages


def check():
    """Prints what is wrong with the list, and returns the exit code."""
    def read(name):
        return (ROOT / name).read_bytes() if (ROOT / name).is_file() else None
    faults = read_faults()
    messages = problems(faults, read)
    print("\n".join(messages) or f"{len(faults)} faults apply to the sources")
    return 1 if messages else 0


# Running commands

class Runner:
    """Runs commands, all of which end when the program is stopped."""

    def __init__(self):
        self.lock, self.running, self.stopped = threading.Lock(), set(), False

    def run(self, command, longest_s, **options):
        """Returns the exit code and the output; the code is None after `longest_s`."""
        def limit():
            resource.setrlimit(resource.RLIMIT_DATA, (MEMORY_BYTES, MEMORY_BYTES))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        with self.lock:
            if self.stopped:
                raise Stopped()
            child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                     text=True, errors="replace", start_new_session=True,
                                     preexec_fn=limit, **options)
            self.running.add(child)
        try:
            output, _ = child.communicate(timeout=longest_s)
            code = child.returncode
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            output, code = child.communicate()[0], None
        finally:
            with self.lock:
                self.running.discard(child)
        if self.stopped:
            raise Stopped()
        return code, output

    def stop(self):
        with self.lock:
            self.stopped = True
            for child in self.running:
                os.killpg(child.pid, signal.SIGKILL)


def mounted_at_root(copy):
    """Returns the words before a command that run it with the copy mounted over the tree, for it
    alone: paths are those of the tree, so that its build and the compiler cache serve the copy."""
    words = ["unshare", "--mount"] + ([] if os.geteuid() == 0 else ["--map-root-user"])
    script = 'mount --bind "$0" "$1" && cd "$1" && shift && exec "$@"'
    return [*words, "sh", "-c", script, str(copy), str(ROOT)]


# A copy of the tree

class Copy:
    """A copy of the tree and its build, in which one fault at a time is planted."""

    def __init__(self, folder, texts, runner, threads):
        self.folder, self.texts, self.runner, self.threads = folder, texts, runner, threads
        if not folder.exists():
            part = folder.with_suffix(".part")
            shutil.rmtree(part, ignore_errors=True)
            for name in texts:
                (part / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, part / name)
            if (ROOT / "build").exists():
                shutil.copytree(ROOT / "build", part / "build", symlinks=True)
            part.rename(folder)
        write_sources(ROOT, texts, folder)

    def run(self, command, longest_s):
        return self.runner.run([*mounted_at_root(self.folder), *command], longest_s)

    def plant(self, fault):
        (self.folder / fault.file).write_bytes(fault.applied(self.texts[fault.file]))

    def restore(self, fault):
        (self.folder / fault.file).write_bytes(self.texts[fault.file])

    def build(self, targets):
        """Builds the targets, or everything without any. Throws ListError if that fails."""
        if not (self.folder / "build/build.ninja").exists():
            code, output = self.run(["cmake", "--preset", "release"], LONGEST_S["build"])
            if code != 0:
                raise ListError("cmake --preset release fails:\n" + output[-3000:])
        code, output = self.run(["ninja", "-C", "build", *targets], LONGEST_S["build"])
        if code != 0:
            raise ListError("it does not compile:\n" + output[-3000:])

    def golden(self, names):
        """Runs `golden test`. Returns the golden that failed, or an empty string."""
        code, output = self.run(["build/sunder", "golden", "test", *names], LONGEST_S["golden"])
        if code is None:
            return "golden test (endless)"
        failed = re.findall(r"^FAIL (\S+): (.*)", output, re.MULTILINE)
        if failed:
            parts = re.split("; (?=simulation)", failed[0][1])
            words = ["drawing" if part.startswith(("drawing", "picture")) else "states"
                     for part in parts if not re.match(r"\w+ (same|similar)", part)]
            return f"golden {failed[0][0]} ({', '.join(words) or 'fails'})"
        return f"golden test (exit code {code})" if code else ""

    def tests(self, options):
        """Runs tests. Returns the first that failed, or an empty string."""
        code, output = self.run(["ctest", "--test-dir", "build", "--stop-on-failure", "-j",
                                 str(self.threads), "--no-tests=error", *options],
                                LONGEST_S["ctest"])
        if "No tests were found" in output:
            raise ListError("no test has a name that matches " + " ".join(options))
        failed = re.findall(r"^\s+\d+ - (.+?) \((?:Failed|Timeout|SEGFAULT|Not Run|[^()]*)\)",
                            output, re.MULTILINE)
        if code is None:
            return "ctest (endless)"
        return failed[0] if failed else f"ctest (exit code {code})" if code else ""

    def targets_of(self, expression):
        """Returns the targets that the tests of an expression of ctest need: the programs in their
        commands and variables."""
        code, output = self.run(["ctest", "--test-dir", "build", "-R", expression,
                                 "--show-only=json-v1"], LONGEST_S["ctest"])
        begin = output.find("{")
        if code != 0 or begin < 0:
            raise ListError(f"ctest lists no tests for {expression}:\n{output[-3000:]}")
        targets = set()
        for test in json.loads(output[begin:])["tests"]:
            words = list(test.get("command", []))
            for entry in test.get("properties", []):
                if entry["name"] == "ENVIRONMENT":
                    words += [word.split("=", 1)[-1] for word in entry["value"]]
            for word in words:
                path = Path(word)
                if path == ROOT / "build/python":
                    targets.add("sunder_python")
                elif path.parent == ROOT / "build" and not path.suffix:
                    targets.add(path.name)
                elif path.name.startswith("libsunder.so"):
                    targets.add("sunder_c")
        return sorted(targets)

    def guard(self, guard):
        """Runs the guard of a fault, after a build of what it needs. Returns what failed."""
        if guard.startswith("golden "):
            self.build(["sunder"])
            return self.golden(guard.split()[1:])
        self.build(self.targets_of(guard))
        return self.tests(["-R", guard, "-LE", SLOW_LABELS, *LEFT_OUT])

    def catcher(self, fault, only_expected):
        """Returns the first guard that notices the planted fault: the expected one, or else one of
        all goldens and tests; or an empty string."""
        caught = self.guard(fault.guard)
        if only_expected:
            return caught
        if not caught:
            self.build(["sunder"])
            caught = self.golden([])
        if not caught:
            self.build([])
            caught = (self.tests(["-L", QUICK_LABELS, *LEFT_OUT])
                      or self.tests(["-LE", f"{SLOW_LABELS}|{QUICK_LABELS}", *LEFT_OUT]))
        return caught

    def confirm(self, caught):
        """Throws ListError if a test of the whole suite, which caught a fault, fails without it."""
        if caught.startswith("golden "):
            failed = self.guard(" ".join(caught.split()[:2]))
        else:
            failed = self.guard("^" + re.escape(caught) + "$")
        if failed:
            raise ListError(f"{failed} fails without the fault as well")


# The table

class Table:
    """The results of the faults, in table.md. A result is that of a version of a fault: one that has
    been changed since is not tried."""

    def __init__(self, faults):
        self.faults, self.lock, self.rows = faults, threading.Lock(), {}
        for line in TABLE.read_text().splitlines() if TABLE.exists() else ():
            cells = [cell.strip() for cell in line.strip("|").split(" | ")]
            if len(cells) == 6 and re.fullmatch(r"[0-9a-f]{6}", cells[5]):
                self.rows[cells[0], cells[5]] = cells[3:5]

    def of(self, fault):
        return self.rows.get((fault.id, fault.version), [UNTRIED, ""])

    def record(self, fault, caught, seconds):
        """Adds a result and writes the table."""
        with self.lock:
            self.rows[fault.id, fault.version] = [caught.replace("|", "/") or ESCAPED,
                                                  f"{seconds:.0f}"]
            self.write()

    def write(self):
        states = [self.of(fault)[0] for fault in self.faults]
        tried = len(states) - states.count(UNTRIED)
        lines = ["# Planted faults", "",
                 "Written by `python3 tests/planted/plant.py` "
                 "([what the columns mean](README.md)). "
                 f"{tried} of {len(states)} faults are tried: "
                 f"{tried - states.count(ESCAPED)} are caught, {states.count(ESCAPED)} escaped."]
        for area in AREAS:
            lines += ["", f"## {area.capitalize()}", "",
                      "| fault | file | what is wrong | caught by | seconds | version |",
                      "|---|---|---|---|---|---|"]
            lines += [f"| {fault.id} | {fault.file} | {fault.wrong} | {' | '.join(self.of(fault))} | "
                      f"{fault.version} |" for fault in self.faults if fault.area == area]
        part = TABLE.with_suffix(".part")
        part.write_text("\n".join(lines) + "\n")
        part.replace(TABLE)


class Progress:
    """The faults that an interrupted run has tried; the next run goes on with the others."""

    def __init__(self, file):
        self.file, self.lock = file, threading.Lock()
        self.tried = set(json.loads(file.read_text())) if file.exists() else set()

    def has(self, fault):
        return fault.version in self.tried

    def add(self, fault):
        with self.lock:
            self.tried.add(fault.version)
            self.file.write_text(json.dumps(sorted(self.tried)))


def chosen(faults, table, progress, options):
    """Returns the faults to try."""
    if options.only:
        unknown = set(options.only) - {fault.id for fault in faults}
        if unknown:
            sys.exit(f"There is no fault {', '.join(sorted(unknown))} in tests/planted/faults/.")
        return [fault for fault in faults if fault.id in options.only]
    if options.escapes:
        faults = [fault for fault in faults if table.of(fault)[0] == ESCAPED]
    elif options.untried:
        faults = [fault for fault in faults if table.of(fault)[0] == UNTRIED]
    part, parts = options.shard
    return [fault for k, fault in enumerate(faults)
            if k % parts == part - 1 and not progress.has(fault)]


def check_guards(copy, faults):
    """Runs the expected guards without a fault: all must pass."""
    names = sorted({name for fault in faults if fault.guard.startswith("golden ")
                    for name in fault.guard.split()[1:]})
    expressions = sorted({fault.guard for fault in faults if not fault.guard.startswith("golden ")})
    guards = [f"golden {' '.join(names)}"] if names else []
    # An expression of ctest with many groups matches nothing.
    guards += ["|".join(f"({expression})" for expression in expressions[k:k + AT_ONCE])
               for k in range(0, len(expressions), AT_ONCE)]
    for guard in guards:
        failed = copy.guard(guard)
        if failed:
            raise ListError(f"{failed} fails without a fault; no result would mean anything")


def try_all(faults, copies, table, progress, only_expected):
    """Tries the faults, several at a time. Returns the faults that could not be tried; with
    `only_expected`, also those that their guards do not notice."""
    todo, wrong = queue.SimpleQueue(), []
    for fault in faults:
        todo.put(fault)

    def work(copy):
        while True:
            try:
                fault = todo.get_nowait()
            except queue.Empty:
                return
            start_s = time.time()
            try:
                copy.plant(fault)
                try:
                    caught = copy.catcher(fault, only_expected)
                finally:
                    copy.restore(fault)
                seconds = time.time() - start_s
                if only_expected and not caught:
                    raise ListError(f"its guard does not notice it: {fault.guard}")
                # Tests of the whole suite were not run without the fault.
                if caught and not re.search(r"\((endless|exit code)", caught):
                    expected = fault.guard.split()[1:] if fault.guard.startswith("golden ") else []
                    is_expected = (caught.split()[1] in expected if caught.startswith("golden ")
                                   else not expected and re.search(fault.guard, caught))
                    if not is_expected:
                        copy.confirm(caught)
                table.record(fault, caught, seconds)
                progress.add(fault)
                print(f"{fault.id}: {caught or 'ESCAPED'}, {seconds:.0f} s", flush=True)
            except ListError as error:
                wrong.append(fault)
                print(f"{fault.id}: {error}", file=sys.stderr, flush=True)
            except Stopped:
                return
    workers = [threading.Thread(target=work, args=(copy,)) for copy in copies]
    for worker in workers:
        worker.start()
    for worker in workers:
        while worker.is_alive():
            worker.join(1)
    return wrong


def shard(text):
    part, _, parts = text.partition("/")
    if not (part.isdigit() and parts.isdigit() and 1 <= int(part) <= int(parts)):
        raise argparse.ArgumentTypeError("expected K/N, the part of the list to try, such as 2/3")
    return int(part), int(parts)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    arguments.add_argument("--check", action="store_true",
                           help="only check that every fault applies to the sources")
    arguments.add_argument("--jobs", type=int, default=1, help="copies of the tree, at once")
    arguments.add_argument("--only", nargs="+", metavar="ID", help="try these faults")
    arguments.add_argument("--escapes", action="store_true", help="try those that escaped last time")
    arguments.add_argument("--untried", action="store_true", help="try those without a result")
    arguments.add_argument("--expected", action="store_true",
                           help="run the expected guards only")
    arguments.add_argument("--shard", type=shard, default=(1, 1), metavar="K/N",
                           help="try part K of N parts of the list")
    arguments.add_argument("--again", action="store_true",
                           help="forget what an interrupted run has tried")
    arguments.add_argument("--work", type=Path, default=ROOT / "build-planted",
                           help="folder of the copies")
    options = arguments.parse_args()
    if options.check:
        sys.exit(check())
    faults, texts = read_faults(), read_sources(ROOT)
    messages = problems(faults, texts.get)
    if messages:
        sys.exit("\n".join(messages))
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    if options.again:
        (work / "tried.json").unlink(missing_ok=True)
    table, progress, runner = Table(faults), Progress(work / "tried.json"), Runner()
    faults = chosen(faults, table, progress, options)
    print(f"{len(faults)} faults to try", flush=True)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        probe, output = runner.run([*mounted_at_root(ROOT), "true"], 60)
        if probe != 0:
            sys.exit("A copy cannot be mounted over the tree; run this as root, or where user "
                     f"namespaces are allowed: {output.strip()}")
        jobs = max(1, min(options.jobs, len(faults)))
        threads = max(1, (os.cpu_count() or 1) // jobs)
        copies = [Copy(work / f"copy-{k}", texts, runner, threads) for k in range(jobs)]
        check_guards(copies[0], faults)
        wrong = try_all(faults, copies, table, progress, options.expected)
    except KeyboardInterrupt:
        runner.stop()
        sys.exit("Stopped; the next run goes on with the faults that are left.")
    except ListError as error:
        sys.exit(str(error))
    if not options.only and not wrong:
        progress.file.unlink(missing_ok=True)
    escaped = [fault.id for fault in faults if table.of(fault)[0] == ESCAPED]
    print(f"{len(faults) - len(escaped) - len(wrong)} of {len(faults)} caught, in {TABLE.relative_to(ROOT)}"
          + (f"; escaped: {', '.join(escaped)}" if escaped else "")
          + (f"; not tried: {', '.join(fault.id for fault in wrong)}" if wrong else ""))
    sys.exit(1 if escaped or wrong else 0)


if __name__ == "__main__":
    main()
