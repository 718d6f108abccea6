#!/usr/bin/python3
"""examples/python/broken_meshes.py makes the same files by each way of sharing the work, also after
a worker of it was killed."""
import contextlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import watertight

ROOT = Path(os.environ["SUNDER_ROOT"])
PROGRAM = [sys.executable, ROOT / "examples" / "python" / "broken_meshes.py"]
MESHES = ["box:1,1,1", "torus:1,0.3", "column:0.3,2", str(ROOT / "scenes" / "pottery" / "vase.obj")]
OPTIONS = [*MESHES, "--variants", "3", "--pieces", "12"]
COUNT = 12  # of broken meshes

try:
    import distributed
    NO_DASK = None
except ImportError:
    NO_DASK = "the Python package distributed is missing: apt-get install python3-distributed"
NO_PARALLEL = None if shutil.which("parallel") else "GNU parallel is missing: apt-get install parallel"


def contents(folder):
    """Returns the bytes of all files by their names."""
    return {str(file.relative_to(folder)): file.read_bytes()
            for file in folder.rglob("*") if file.is_file()}


def start(command, start_new_session=False, **environment):
    return subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, cwd=ROOT,
                            stderr=subprocess.PIPE, text=True, start_new_session=start_new_session,
                            env={**os.environ, "PYTHON": sys.executable, **environment})


def finish(process, status=0):
    """Waits for a process. Returns what it printed; fails if its exit status is another."""
    out, errors = process.communicate(timeout=300)
    if process.returncode != status:
        raise AssertionError(f"exit status {process.returncode}, not {status}:\n{out}{errors}")
    return out + errors


def run(command, status=0, **environment):
    return finish(start(command, **environment), status)


def kill_worker(process, out, kill=()):
    """Kills the worker that writes an unfinished folder, and the processes of `kill`."""
    deadline = time.monotonic() + 120
    while process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.001)
        for folder in out.glob("*.part-*"):
            worker = int(folder.name.rpartition("-")[2])
            with contextlib.suppress(ProcessLookupError):
                os.kill(worker, signal.SIGSTOP)
                # A worker that has just completed its folder goes on.
                if folder.exists():
                    for victim in (*kill, worker):
                        os.kill(victim, signal.SIGKILL)
                    return
                os.kill(worker, signal.SIGCONT)
    raise AssertionError("no worker to kill:\n" + "".join(process.communicate()))


class DataSet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        run([*PROGRAM, *OPTIONS, "-o", cls.folder / "whole", "--processes", 1])
        cls.whole = contents(cls.folder / "whole")

    def setUp(self):
        self.out = self.folder / self.id().rpartition(".")[2]

    def command(self, *options):
        return [*PROGRAM, *OPTIONS, "-o", self.out, *options]

    def assert_same(self):
        made = contents(self.out)
        self.assertEqual(sorted(made), sorted(self.whole))
        self.assertEqual(made, self.whole)

    def assert_some_missing(self):
        """Part of the set is complete, nothing else differs, and --missing lists the rest."""
        made = {name: data for name, data in contents(self.out).items() if ".part-" not in name}
        self.assertTrue(made.items() <= self.whole.items())
        folders = {name.partition("/")[0] for name in made}
        self.assertLess(len(folders), COUNT)
        listed = run(self.command("--missing"), 1)
        self.assertEqual(len(re.findall("(?m)^missing: ", listed)), COUNT - len(folders))
        return COUNT - len(folders)

    def test_pieces_are_closed_and_fill_the_mesh(self):
        folders = sorted((self.folder / "whole").iterdir())
        self.assertEqual(len(folders), COUNT)
        for folder in folders:
            faults, pieces = watertight.faults_of_mesh(folder)
            self.assertEqual(faults, [])
            self.assertGreater(pieces, 5)

    def test_the_check_finds_an_open_surface(self):
        vertices, triangles = watertight.read_obj(self.folder / "whole/00000_001/piece_000.obj")
        self.assertEqual(watertight.faults_of_surface(vertices, triangles)[0], [])
        self.assertIn("open", str(watertight.faults_of_surface(vertices, triangles[1:])[0]))
        self.assertIn("inside", str(watertight.faults_of_surface(vertices, triangles[:, ::-1])[0]))

    def test_processes_with_one_killed(self):
        process = start(self.command("--processes", 2))
        kill_worker(process, self.out)
        self.assertIn("its process was lost", finish(process, 1))
        # The other process goes on, and a new one replaces the lost one.
        self.assertEqual(self.assert_some_missing(), 1)
        self.assertIn("1 meshes done, 0 missing", run(self.command()))
        self.assert_same()
        self.assertIn("0 meshes done, 0 missing", run(self.command()))

    def test_shards_with_one_killed(self):
        for number in 1, 2, 3:
            process = start(self.command("--processes", 1, "--shard", f"{number}/3"))
            if number == 2:
                kill_worker(process, self.out, [process.pid])
                finish(process, -signal.SIGKILL)
            else:
                self.assertIn("4 meshes done", finish(process))
        missing = self.assert_some_missing()
        done = run(self.command("--processes", 1, "--shard", "2/3"))
        self.assertIn(f"{missing} meshes done, 0 missing", done)
        self.assert_same()

    def test_slurm_array_with_a_task_killed(self):
        def task(number):
            return start(["bench/cluster/slurm_meshes.sh", *OPTIONS, "-o", self.out],
                         SLURM_ARRAY_TASK_ID=str(number), SLURM_ARRAY_TASK_COUNT="2")
        doomed = task(1)
        kill_worker(doomed, self.out, [doomed.pid])
        finish(doomed, -signal.SIGKILL)
        finish(task(2))
        self.assert_some_missing()
        finish(task(1))
        self.assert_same()

    @unittest.skipIf(NO_PARALLEL, NO_PARALLEL)
    def test_gnu_parallel_with_a_worker_killed(self):
        command = ["bench/cluster/parallel_meshes.sh", 4, *OPTIONS, "-o", self.out]
        process = start(command, PARALLEL="--jobs 2")
        kill_worker(process, self.out)
        self.assertIn("missing: ", finish(process, 1))
        self.assert_some_missing()
        run(command, PARALLEL="--jobs 2")
        self.assert_same()

    @unittest.skipIf(NO_DASK, NO_DASK)
    def test_local_dask_with_a_worker_killed(self):
        process = start(self.command("--dask", "local", "--processes", 2))
        kill_worker(process, self.out)
        # Dask gives the mesh of the lost worker to another.
        self.assertIn(f"{COUNT} meshes done, 0 missing", finish(process))
        self.assert_same()

    @unittest.skipIf(NO_DASK, NO_DASK)
    def test_dask_scheduler_with_a_worker_killed(self):
        file = self.folder / "scheduler.json"
        options = ["--scheduler-file", file, "--no-dashboard"]
        here = self.folder / "elsewhere"
        here.mkdir()

        def serve(name, *more):
            process = subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.dask_{name}", *map(str, options), *more],
                cwd=here, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.addCleanup(process.wait)
            self.addCleanup(process.kill)

        serve("scheduler", "--port", "0", "--host", "127.0.0.1")
        for _ in range(2):
            serve("worker", "--nthreads", "1", "--no-nanny")
        deadline = time.monotonic() + 60
        while not (file.exists() and file.read_text().endswith("}")):
            self.assertLess(time.monotonic(), deadline, "no Dask scheduler")
            time.sleep(0.1)
        address = re.search(r'"address": "(.*?)"', file.read_text()).group(1)
        process = start(self.command("--dask", address))
        kill_worker(process, self.out)
        self.assertIn(f"{COUNT} meshes done, 0 missing", finish(process))
        self.assert_same()

    def test_dask_is_optional(self):
        without = self.folder / "without"
        without.mkdir()
        (without / "dask.py").write_text("raise ImportError")
        path = f"{without}:{os.environ['PYTHONPATH']}"
        self.assertIn("apt-get install python3-distributed",
                      run(self.command("--dask", "local"), 2, PYTHONPATH=path))
        self.assertFalse(self.out.exists())

    @unittest.skipIf(NO_DASK, NO_DASK)
    def test_a_dask_scheduler_that_is_not_there_is_named(self):
        self.assertIn("address of a scheduler", run(self.command("--dask", "nowhere"), 1))

    def test_a_bad_mesh_does_not_stop_the_others(self):
        out = run([*PROGRAM, "box:1,1", "nowhere.obj", "box:1,1,1", "-o", self.out], 1)
        self.assertIn("nowhere.obj", out)
        self.assertIn("box:1,1: ", out)
        self.assertIn("1 meshes done, 2 missing", out)
        self.assertEqual([folder.name for folder in self.out.iterdir()], ["00002_001"])

    def test_stops_when_it_is_interrupted(self):
        process = start(self.command("--variants", "500"), start_new_session=True)
        deadline = time.monotonic() + 120
        while not list(self.out.glob("*_00?")):
            self.assertLess(time.monotonic(), deadline, "no mesh is made")
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGINT)
        out, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertEqual(errors, "stopped; run again to make the rest\n")
        self.assertNotIn("missing", out)

    def test_bad_options_are_refused(self):
        for shard in "0/3", "4/3", "2", "a/b", "-1/3", "1/0":
            self.assertIn("expected I/N", run(self.command(f"--shard={shard}"), 2))
        for option in "--variants=0", "--pieces=0", "--processes=0":
            self.assertIn("a whole number above 0", run(self.command(option), 2))
        self.assertFalse(self.out.exists())
        run([*PROGRAM, "box:1,1,1", "-o", self.out])
        before = contents(self.out)
        self.assertIn("use a new folder", run([*PROGRAM, "box:1,1,2", "-o", self.out], 2))
        self.assertEqual(contents(self.out), before)


if __name__ == "__main__":
    unittest.main()
