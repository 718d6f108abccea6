#!/usr/bin/python3
"""Makes a data set of broken meshes: a folder of pieces, poses and metadata for each mesh.

    broken_meshes.py MESH... -o DIR [--variants N] [--pieces N] [--processes N] [--shard K/N]

A MESH is a file, or a built-in solid such as torus:1,0.3. Each folder has piece_000.obj and so on in
the coordinates of the mesh, poses.json with where the pieces lie after they fell for a second, and
metadata.json, which is written last: folders that have it are not made again.
"""
import argparse
import json
import multiprocessing
from pathlib import Path

import sunder


def write_obj(path, piece):
    """Writes the surface of a piece."""
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in piece.vertices)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in piece.triangles + 1)


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
    """Breaks one mesh with one seed. Returns its folder and the number of pieces."""
    mesh, seed, count, folder = task
    asset = sunder.Asset(mesh, material="concrete")
    pieces = sunder.fracture(asset, f"voronoi:{count}", seed=seed)
    folder.mkdir(parents=True, exist_ok=True)
    for number, piece in enumerate(pieces):
        write_obj(folder / f"piece_{number:03d}.obj", piece)
    (folder / "poses.json").write_text(json.dumps(fallen(pieces, asset.bounds[0][1])))
    metadata = {"mesh": str(mesh), "seed": seed, "volume_m3": asset.volume_m3,
                "pieces": [{"volume_m3": piece.volume_m3, "centroid": piece.centroid.tolist(),
                            "triangles": len(piece.triangles)} for piece in pieces]}
    unfinished = folder / "metadata.json.part"
    unfinished.write_text(json.dumps(metadata))
    unfinished.rename(folder / "metadata.json")
    return folder, len(pieces)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="DIR")
    parser.add_argument("--variants", type=int, default=1, help="seeds of each mesh")
    parser.add_argument("--pieces", type=int, default=20, help="cells of the pattern")
    parser.add_argument("--processes", type=int, default=multiprocessing.cpu_count())
    parser.add_argument("--shard", default="1/1", metavar="K/N", help="do share K of N")
    options = parser.parse_args()
    part, parts = map(int, options.shard.split("/"))
    tasks = [(mesh, seed, options.pieces, options.output / f"{number:05d}_{seed:03d}")
             for number, mesh in enumerate(options.meshes)
             for seed in range(1, options.variants + 1)]
    tasks = [task for task in tasks[part - 1::parts] if not (task[3] / "metadata.json").exists()]
    # A forked process would lack the threads of this one.
    with multiprocessing.get_context("spawn").Pool(options.processes) as pool:
        for folder, count in pool.imap_unordered(make, tasks):
            print(f"{folder}: {count} pieces")
    print(f"{len(tasks)} meshes done")


if __name__ == "__main__":
    main()
