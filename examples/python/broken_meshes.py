#!/usr/bin/python3
"""Makes a data set of broken meshes: a folder of pieces, poses and metadata for each mesh.

    broken_meshes.py MESH... -o DIR [--variants N] [--pieces N] [--shard I/N]
                     [--processes N | --dask SCHEDULER | --missing]

A MESH is a file, or a built-in solid such as torus:1,0.3; @LIST reads a file with one in each line.
Each mesh is broken once for each of its variants. The folder of a break has piece_000.obj and so on
in the coordinates of the mesh, poses.json with where the pieces lie after they fell for a second,
and metadata.json. A folder is renamed when it is complete, and complete folders are not made again:
a worker that is lost costs its present mesh, which the next run makes. The files are the same bytes
whatever made them: processes, shares of several machines, or a Dask cluster.
"""
import argparse
import contextlib
import functools
import importlib
import json
import multiprocessing
import multiprocessing.pool
import multiprocessing.resource_tracker
import os
import shutil
import signal
import socket
import sys
import threading
from pathlib import Path
from typing import NamedTuple

import sunder


class Task(NamedTuple):
    """A mesh to break."""
    mesh: str    # as the user names it
    source: str  # what to read: an absolute path, or a built-in solid
    seed: int
    cells: int
    folder: Path

    def wanted(self):
        """Returns the members of metadata.json that say what was made."""
        return {"mesh": self.mesh, "seed": self.seed, "cells": self.cells}


@functools.lru_cache(maxsize=1)
def solid_of(source):
    """Returns the solid of a mesh; that of the last mesh is kept for its next variant."""
    return sunder.Asset(source, material="concrete")


def write_obj(path, piece):
    """Writes the surface of a piece."""
    vertices, triangles = piece.vertices, piece.triangles + 1
    path.write_text("v %.9g %.9g %.9g\n" * len(vertices) % tuple(vertices.ravel().tolist())
                    + "f %d %d %d\n" * len(triangles) % tuple(triangles.ravel().tolist()),
                    encoding="ascii")


def fallen(pieces, lowest_m):
    """Returns the poses of pieces that fell apart from 0.2 m above the ground, and did not break."""
    scene = sunder.Scene()
    materials = scene.materials
    for material in materials:
        material.pattern = "none"
        material.tensile_Pa = material.shear_Pa = material.compressive_Pa = 0
    scene.materials = materials
    world = sunder.World(scene, threads=1, particles=False)
    keys = [world.add_solid(piece.asset, origin=(0, 0.2 - lowest_m, 0)) for piece in pieces]
    world.run(1)
    poses = []
    for number, key in enumerate(keys):
        body = world.body(key)
        poses.append({"piece": number, "origin": body.origin.tolist(),
                      "rotation_xyzw": body.rotation.tolist(), "mass_kg": body.mass_kg})
    return poses


def make(task):
    """Breaks a mesh. Returns the number of pieces."""
    sunder.set_threads(1)
    solid = solid_of(task.source)
    pieces = sunder.fracture(solid, f"voronoi:{task.cells}", seed=task.seed)
    folder = Path(f"{task.folder}.part-{socket.gethostname()}-{os.getpid()}")
    folder.mkdir(parents=True)
    for number, piece in enumerate(pieces):
        write_obj(folder / f"piece_{number:03d}.obj", piece)
    (folder / "poses.json").write_text(json.dumps(fallen(pieces, solid.bounds[0][1])))
    metadata = {**task.wanted(), "volume_m3": solid.volume_m3,
                "pieces": [{"volume_m3": piece.volume_m3, "centroid": piece.centroid.tolist(),
                            "triangles": len(piece.triangles)} for piece in pieces]}
    (folder / "metadata.json").write_text(json.dumps(metadata))
    folder.rename(task.folder)
    return len(pieces)


def report(task, pieces=0, error=None):
    """Prints what became of a task."""
    if error is None:
        print(f"{task.folder}: {pieces} pieces", flush=True)
    else:
        print(f"{task.folder}: {task.mesh}: {error}", file=sys.stderr, flush=True)


def outcome(task):
    """Makes a task. Returns the arguments of report() for it."""
    try:
        return {"pieces": make(task)}
    except Exception as error:
        return {"error": str(error)}


def serve(pipe):
    """Makes the tasks that come through a pipe, until its other end is closed."""
    with contextlib.suppress(EOFError, OSError):
        while True:
            pipe.send(outcome(pipe.recv()))


def run_on_processes(tasks, count):
    """Makes tasks in processes of this machine; one that dies is replaced."""
    # A forked process would lack the threads of this one.
    context = multiprocessing.get_context("spawn")
    # Its start unblocks the signals that feed() blocks.
    multiprocessing.resource_tracker.ensure_running()

    def start():
        pipe, other_end = context.Pipe()
        context.Process(target=serve, args=(other_end,), daemon=True).start()
        other_end.close()
        return pipe

    waiting = iter(tasks)
    stopped = threading.Event()

    def feed(_):
        # An interrupt is for the main thread: a process starts with the blocked signals of its thread.
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        pipe = None
        for task in waiting:
            pipe = pipe or start()
            try:
                pipe.send(task)
                report(task, **pipe.recv())
            except (EOFError, OSError):
                if stopped.is_set():
                    return
                report(task, error="its process was lost; run again to make it")
                pipe = None

    try:
        with multiprocessing.pool.ThreadPool(count) as threads:
            threads.map(feed, range(count), chunksize=1)
    except KeyboardInterrupt:
        stopped.set()
        raise


def import_dask():
    """Returns the module for Dask clusters, which is needed for nothing else."""
    try:
        return importlib.import_module("dask.distributed")
    except ImportError:
        raise ValueError("--dask needs the Python package distributed: "
                         "apt-get install python3-distributed") from None


def run_on_dask(tasks, scheduler, count):
    """Makes tasks on the workers of a Dask scheduler, or of a local one with `count` processes.
    Dask gives the task of a lost worker to another."""
    dask = import_dask()
    # Workers import this file by its name, which __main__ is not.
    program = importlib.import_module(Path(__file__).stem)
    with contextlib.ExitStack() as stack:
        if scheduler == "local":
            scheduler = stack.enter_context(dask.LocalCluster(
                n_workers=count, threads_per_worker=1, dashboard_address=None))
        try:
            client = stack.enter_context(dask.Client(scheduler))
        except (OSError, ValueError) as error:
            sys.exit(f"--dask {scheduler}: {error}; expected local, or the address of a scheduler")
        client.upload_file(__file__)
        futures = {client.submit(program.make, program.Task(*task), pure=False): task
                   for task in tasks}
        for future in dask.as_completed(futures):
            error = future.exception()
            report(futures[future], 0 if error else future.result(), error)


def count_of(text):
    """Returns the number that an option has."""
    if not (text.isdigit() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"expected a whole number above 0, not {text}")
    return int(text)


def share_of(tasks, shard):
    """Returns share I of N, for I/N: every N-th task, from the I-th on."""
    number, _, count = shard.partition("/")
    if not (number.isdigit() and count.isdigit() and 1 <= int(number) <= int(count)):
        raise ValueError(f"--shard {shard}: expected I/N with 1 <= I <= N, such as 3/8")
    return tasks[int(number) - 1::int(count)]


def is_made(task):
    """Tells if the folder of a task is complete. Throws ValueError if it has something else."""
    file = task.folder / "metadata.json"
    if not task.folder.exists():
        return False
    metadata = json.loads(file.read_text())
    made = {key: metadata.get(key) for key in task.wanted()}
    if made != task.wanted():
        raise ValueError(f"{file} is of {made}, not of {task.wanted()}; use a new folder")
    return True


def remove_unfinished(tasks):
    """Removes what lost workers left of tasks."""
    for task in tasks:
        for folder in task.folder.parent.glob(f"{task.folder.name}.part-*"):
            # A worker that is still alive can neither write to the renamed folder nor complete it.
            renamed = folder.with_name(f"{folder.name}-removed")
            folder.rename(renamed)
            shutil.rmtree(renamed)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0],
                                     fromfile_prefix_chars="@")
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="DIR")
    parser.add_argument("--variants", type=count_of, default=1, help="seeds of each mesh")
    parser.add_argument("--pieces", type=count_of, default=20, help="cells of the pattern")
    parser.add_argument("--shard", default="1/1", metavar="I/N", help="do share I of N")
    parser.add_argument("--processes", type=count_of, default=len(os.sched_getaffinity(0)), metavar="N",
                        help="processes of this machine; the default: as many as processors")
    parser.add_argument("--dask", metavar="SCHEDULER",
                        help="address of a Dask scheduler, or local; workers share the folders")
    parser.add_argument("--missing", action="store_true", help="list what is missing, make nothing")
    options = parser.parse_args()
    output = options.output.resolve()
    tasks = [Task(mesh, str(Path(mesh).resolve()) if Path(mesh).exists() else mesh, seed,
                  options.pieces, output / f"{number:05d}_{seed:03d}")
             for number, mesh in enumerate(options.meshes)
             for seed in range(1, options.variants + 1)]
    try:
        if options.dask:
            import_dask()
        tasks = [task for task in share_of(tasks, options.shard) if not is_made(task)]
    except (ValueError, OSError) as error:
        parser.error(str(error))
    if not options.missing:
        remove_unfinished(tasks)
        output.mkdir(parents=True, exist_ok=True)
        if options.dask:
            run_on_dask(tasks, options.dask, options.processes)
        elif tasks:
            run_on_processes(tasks, options.processes)
        remove_unfinished(tasks)
    missing = [task for task in tasks if not task.folder.exists()]
    for task in missing if options.missing else ():
        print(f"missing: {task.folder}: {task.mesh}, seed {task.seed}")
    print(f"{len(tasks) - len(missing)} meshes done, {len(missing)} missing")
    return 1 if missing else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("stopped; run again to make the rest")
