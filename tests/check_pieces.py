#!/usr/bin/env python3
"""Checks exported pieces without code of the project: every edge is in exactly two faces.

    check_pieces.py X.glb|DIR [--volume M3] [--within 1e-12]

A piece is a node of a GLB file, or an OBJ file of a folder. Vertices with equal coordinates are
one vertex, as for importers that merge vertices; coordinates are not rounded. Each edge of a piece
has to be in two triangles that run through it in opposite directions, no triangle may have equal
corners, each piece has to enclose a positive volume, and the volumes have to sum to --volume. Prints one line of JSON; exit code 1 if a
check fails.
"""

import argparse
import json
import math
import struct
import sys
from pathlib import Path


def read_obj(path):
    """Returns the vertices and triangles of an OBJ file, as written."""
    vertices, triangles = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append(tuple(float(word) for word in words[1:4]))
        elif words[0] == "f":
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            triangles += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    return vertices, triangles


def accessor(document, binary, number):
    """Yields the items of a glTF accessor: numbers, or tuples of them."""
    described = document["accessors"][number]
    view = document["bufferViews"][described["bufferView"]]
    count = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[described["type"]]
    layout = "<" + str(count) + {5125: "I", 5123: "H", 5126: "f"}[described["componentType"]]
    size = struct.calcsize(layout)
    start = view.get("byteOffset", 0) + described.get("byteOffset", 0)
    step = view.get("byteStride", size)
    for i in range(described["count"]):
        item = struct.unpack_from(layout, binary, start + i * step)
        yield item if count > 1 else item[0]


def read_glb(path):
    """Yields the name, vertices and triangles of each node, relative to the origin of its mesh."""
    data = path.read_bytes()
    magic, version, size = struct.unpack_from("<4sII", data)
    if magic != b"glTF" or version != 2 or size != len(data):
        raise ValueError(f"{path}: not a GLB file")
    json_size = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + json_size])
    binary = data[28 + json_size :]
    for node in document["nodes"]:
        vertices, triangles = [], []
        for primitive in document["meshes"][node["mesh"]]["primitives"]:
            first = len(vertices)
            vertices += accessor(document, binary, primitive["attributes"]["POSITION"])
            indices = [first + i for i in accessor(document, binary, primitive["indices"])]
            triangles += zip(indices[0::3], indices[1::3], indices[2::3])
        yield node["name"], vertices, triangles


def pieces_of(path):
    """Yields the name, vertices and triangles of each piece."""
    if path.is_dir():
        for file in sorted(path.glob("*.obj")):
            yield (file.stem, *read_obj(file))
    else:
        yield from read_glb(path)


def weld(vertices, triangles):
    """Returns the distinct places, triangles of their indices, and the number of all triangles.

    Triangles with fewer than three distinct places are left out.
    """
    places = {}
    number = [places.setdefault((x + 0.0, y + 0.0, z + 0.0), len(places)) for x, y, z in vertices]
    welded = [tuple(number[corner] for corner in triangle) for triangle in triangles]
    return list(places), [t for t in welded if len(set(t)) == 3], len(welded)


def volume_of(places, triangles):
    """Returns the enclosed volume, summed exactly about the middle, and that of the bounding box."""
    low = [min(p[i] for p in places) for i in range(3)]
    high = [max(p[i] for p in places) for i in range(3)]
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    at = [tuple(c - m for c, m in zip(place, middle)) for place in places]
    terms = []
    for a, b, c in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = at[a], at[b], at[c]
        terms += [ax * (by * cz - bz * cy), ay * (bz * cx - bx * cz), az * (bx * cy - by * cx)]
    return math.fsum(terms) / 6, math.prod(b - a for a, b in zip(low, high))


def check(vertices, triangles):
    """Returns the counts of edges and faulty edges of a piece, and its volumes."""
    places, welded, all_triangles = weld(vertices, triangles)
    directed = {}
    for a, b, c in welded:
        for edge in ((a, b), (b, c), (c, a)):
            directed[edge] = directed.get(edge, 0) + 1
    edges = {(min(e), max(e)) for e in directed}
    counts = [(directed.get((a, b), 0), directed.get((b, a), 0)) for a, b in edges]
    found = {
        "edges": len(edges),
        "in_one_face": sum(f + r == 1 for f, r in counts),
        "in_more_faces": sum(f + r > 2 for f, r in counts),
        "unbalanced": sum(f != r for f, r in counts),
        "collapsed_triangles": all_triangles - len(welded),
    }
    found["volume_m3"], found["box_m3"] = volume_of(places, welded) if welded else (0.0, 0.0)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("export", type=Path)
    parser.add_argument("--volume", type=float)
    parser.add_argument("--within", type=float, default=1e-12)
    arguments = parser.parse_args()
    total = {"pieces": 0, "bad_pieces": [], "negative": []}
    volumes = []
    for name, vertices, triangles in pieces_of(arguments.export):
        found = check(vertices, triangles)
        total["pieces"] += 1
        volumes.append(found.pop("volume_m3"))
        found.pop("box_m3")
        for key, value in found.items():
            total[key] = total.get(key, 0) + value
        if found["in_one_face"] or found["in_more_faces"] or found["unbalanced"] or \
                found["collapsed_triangles"]:
            total["bad_pieces"].append(name)
        if not volumes[-1] > 0:
            total["negative"].append(name)
    total["volume_m3"] = math.fsum(volumes)
    good = total["pieces"] > 0 and not total["bad_pieces"] and not total["negative"]
    if arguments.volume is not None:
        total["volume_error"] = abs(total["volume_m3"] - arguments.volume) / abs(arguments.volume)
        good = good and total["volume_error"] <= arguments.within
    print(json.dumps(total))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
