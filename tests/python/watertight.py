#!/usr/bin/python3
"""Checks that the pieces of broken meshes are closed, by the text of their files alone.

    watertight.py DIR

DIR is the output of examples/python/broken_meshes.py. Lists what is wrong, and exits with 1 if
anything is.
"""
import json
import sys
from pathlib import Path

import numpy as np


def read_obj(path):
    """Returns the vertices and the triangles of a file that has nothing else."""
    kinds, rows = [], []
    for line in path.read_text(encoding="ascii").splitlines():
        kind, *row = line.split()
        kinds.append(kind)
        rows.append(row)
    count = kinds.count("v")
    if kinds != ["v"] * count + ["f"] * (len(kinds) - count):
        raise ValueError(f"{path}: other lines than vertices and then faces")
    return np.array(rows[:count], float), np.array(rows[count:], int) - 1


def faults_of_surface(vertices, triangles):
    """Returns what keeps triangles from being the surface of a solid, and the volume."""
    if len(triangles) == 0 or triangles.min() < 0 or triangles.max() >= len(vertices):
        return ["no triangles, or vertices that are not there"], 0
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    faults = []
    if (edges[:, 0] == edges[:, 1]).any():
        faults.append("a triangle has a vertex twice")
    # On a closed surface, each edge is walked equally often in both directions.
    codes = np.sort(edges[:, 0] * len(vertices) + edges[:, 1])
    reverse = np.sort(edges[:, 1] * len(vertices) + edges[:, 0])
    if not np.array_equal(codes, reverse):
        faults.append("the surface is open")
    a, b, c = (vertices[triangles[:, corner]] - vertices.mean(axis=0) for corner in range(3))
    volume_m3 = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    if not volume_m3 > 0:
        faults.append("the surface is inside out")
    return faults, volume_m3


def faults_of_mesh(folder):
    """Returns what is wrong with a folder, as sentences, and the number of its pieces."""
    metadata = json.loads((folder / "metadata.json").read_text())
    files = sorted(folder.glob("piece_*.obj"))
    faults, sum_m3 = [], 0
    for file in files:
        found, volume_m3 = faults_of_surface(*read_obj(file))
        faults += [f"{file}: {fault}" for fault in found]
        sum_m3 += volume_m3
    if len(files) < 2 or len(files) != len(metadata["pieces"]):
        faults.append(f"{folder}: {len(files)} pieces")
    if not abs(sum_m3 / metadata["volume_m3"] - 1) < 1e-5:
        faults.append(f"{folder}: the pieces have {sum_m3} of {metadata['volume_m3']} m3")
    return faults, len(files)


def main():
    folders = sorted(Path(sys.argv[1]).iterdir())
    results = [faults_of_mesh(folder) for folder in folders]
    faults = [fault for found, _ in results for fault in found]
    print(*faults, sep="\n", end="\n" if faults else "")
    print(f"{len(folders)} meshes, {sum(count for _, count in results)} pieces, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
