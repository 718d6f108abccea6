"""Imports a GLB of `sunder export` into Blender, and saves it as a Blender file.

    blender -b -P blender_import.py -- house.glb house.blend

Sets what the importer does not: the frame rate, so that every frame of the run is a frame of Blender;
the range of frames; the camera; the strength of the sun; a material preview for the viewport. Prints
the number of bodies. Tested with Blender 3.4.
"""
import json
import struct
import sys

import bpy
import numpy

if not hasattr(numpy, "bool"):  # the importer of Blender 3.4 is older than NumPy 1.24 of Debian 12
    numpy.bool = bool


def side_data(path):
    """Returns asset.extras.sunder of a GLB: frame rate, number of frames, breaks."""
    with open(path, "rb") as file:
        file.seek(12)
        length, _ = struct.unpack("<I4s", file.read(8))
        return json.loads(file.read(length))["asset"]["extras"]["sunder"]


def import_run(path):
    """Imports a GLB into an empty scene; returns the objects of bodies by their key."""
    run = side_data(path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    # The importer converts seconds to frames by the frame rate of the scene.
    scene.render.fps = int(run["fps"])
    scene.render.fps_base = 1
    # Irradiance stays what Sunder renders with, and is not converted from lux.
    bpy.ops.import_scene.gltf(filepath=path, convert_lighting_mode="RAW")
    scene.frame_start, scene.frame_end = 0, run["frames"] - 1
    for thing in scene.objects:
        if thing.type == "CAMERA":
            scene.camera = thing
    return {thing["key"]: thing for thing in scene.objects if "key" in thing}


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if len(arguments) != 2:
        sys.exit("usage: blender -b -P blender_import.py -- X.glb X.blend")
    bodies = import_run(arguments[0])
    print(f"{len(bodies)} bodies, frames 0 to {bpy.context.scene.frame_end}")
    bpy.ops.wm.save_as_mainfile(filepath=arguments[1])


if __name__ == "__main__":
    main()
