#!/usr/bin/env python3
"""Makes GLB files with textures, several materials, mirrored and scaled nodes, without other files.

Usage: textured_glb.py small_box|mirrored_box|transformed_box|ball X.glb
"""
import json
import math
import struct
import sys
import zlib
from pathlib import Path

import numpy as np

REPEAT, CLAMP, MIRROR = 10497, 33071, 33648


def png(width, height, color_at):
    """Returns the bytes of a PNG; `color_at(x, y)` returns three numbers up to 255."""
    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in color_at(x, y))
                    for y in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def checks(a, b, cells=4):
    """Returns a PNG with squares of two colours."""
    return png(16, 16, lambda x, y: a if (x * cells // 16 + y * cells // 16) % 2 else b)


def box_sides():
    """Yields (corners, texture coordinates, normal) of the six sides of the cube from -1 to 1. Each
    side has a rectangle of its own in the image."""
    for side in range(6):
        axis, sign = side // 2, 1 - 2 * (side % 2)
        u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3] * sign
        normal = np.eye(3)[axis] * sign
        corners = np.array([normal - u - v, normal + u - v, normal + u + v, normal - u + v])
        x, y = side % 3 / 3, side // 3 / 2
        uvs = np.array([[x, y], [x + 0.3, y], [x + 0.3, y + 0.45], [x, y + 0.45]])
        yield corners, uvs, normal


def sphere(slices, rings, radius, repeats):
    """Returns points, texture coordinates, normals and triangles of a sphere with a seam and poles."""
    points, uvs, triangles = [], [], []
    for ring in range(rings + 1):
        for turn in range(slices + 1):
            latitude, longitude = math.pi * ring / rings, 2 * math.pi * (turn % slices) / slices
            points.append([math.sin(latitude) * math.cos(longitude), math.cos(latitude),
                           -math.sin(latitude) * math.sin(longitude)])
            uvs.append([repeats * turn / slices, ring / rings])
    row = slices + 1
    for ring in range(rings):
        for turn in range(slices):
            a, b = ring * row + turn, (ring + 1) * row + turn
            if ring > 0:
                triangles.append([a, b, a + 1])
            if ring < rings - 1:
                triangles.append([a + 1, b, b + 1])
    normals = np.array(points)
    # Points at the poles are equal for all turns.
    for ring in (0, rings):
        normals[ring * row:(ring + 1) * row] = [0, 1 - 2 * (ring > 0), 0]
    return radius * normals, np.array(uvs), normals, np.array(triangles)


class Writer:
    """Collects the parts of a GLB."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}],
                     "nodes": [], "meshes": [], "materials": [], "textures": [], "images": [],
                     "samplers": [], "accessors": [], "bufferViews": [], "buffers": [{}]}
        self.binary = b""

    def add_to(self, kind, item):
        self.json[kind].append(item)
        return len(self.json[kind]) - 1

    def view(self, data):
        self.binary += bytes(-len(self.binary) % 4)
        made = self.add_to("bufferViews", {"buffer": 0, "byteOffset": len(self.binary),
                                           "byteLength": len(data)})
        self.binary += data
        return made

    def accessor(self, rows, kind, component, layout):
        rows = np.asarray(rows, layout)
        described = {"bufferView": self.view(rows.tobytes()), "componentType": component,
                     "count": len(rows), "type": kind}
        if kind == "VEC3":
            described |= {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()}
        return self.add_to("accessors", described)

    def image(self, data, kind="image/png"):
        return self.add_to("images", {"bufferView": self.view(data), "mimeType": kind})

    def texture(self, image, wrap=None):
        described = {"source": image}
        if wrap is not None:
            described["sampler"] = self.add_to("samplers", {"wrapS": wrap[0], "wrapT": wrap[1]})
        return {"index": self.add_to("textures", described)}

    def material(self, name, **described):
        return self.add_to("materials", {"name": name, **described})

    def primitive(self, points, uvs, normals, triangles, material):
        return {"attributes": {"POSITION": self.accessor(points, "VEC3", 5126, "<f4"),
                               "NORMAL": self.accessor(normals, "VEC3", 5126, "<f4"),
                               "TEXCOORD_0": self.accessor(uvs, "VEC2", 5126, "<f4")},
                "indices": self.accessor(np.ravel(triangles), "SCALAR", 5123, "<u2"),
                "material": material}

    def node(self, primitives, **described):
        mesh = self.add_to("meshes", {"primitives": primitives})
        return self.add_to("nodes", {"mesh": mesh, **described})

    def bytes(self, roots):
        self.json["scenes"][0]["nodes"] = roots
        self.binary += bytes(-len(self.binary) % 4)
        self.json["buffers"][0]["byteLength"] = len(self.binary)
        used = {key: value for key, value in self.json.items() if value != []}
        text = json.dumps(used).encode()
        text += b" " * (-len(text) % 4)
        return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(self.binary), len(text),
                            0x4e4f534a) + text + struct.pack("<II", len(self.binary), 0x004e4942) +
                self.binary)


def box(writer, materials, **node):
    """Adds a cube whose sides have the materials in turn. Returns the node."""
    primitives = []
    for side, (corners, uvs, normal) in enumerate(box_sides()):
        primitives.append(writer.primitive(corners, uvs, [normal] * 4, [0, 1, 2, 0, 2, 3],
                                           materials[side % len(materials)]))
    return writer.node(primitives, **node)


def materials(writer):
    """Adds materials of each kind. Returns their numbers."""
    red = writer.image(checks((200, 40, 30), (240, 220, 200)))
    fine = writer.image(checks((30, 60, 160), (90, 160, 90), 8))
    gloss = writer.image(checks((0, 40, 250), (0, 220, 10)))
    relief = writer.image(checks((100, 128, 250), (156, 128, 250)))
    return [
        writer.material("Varnish", pbrMetallicRoughness={
            "baseColorTexture": writer.texture(red), "baseColorFactor": [0.9, 0.8, 0.7, 1],
            "metallicFactor": 0, "roughnessFactor": 0.6}),
        writer.material("Plain red", pbrMetallicRoughness={
            "baseColorFactor": [0.5, 0.05, 0.02, 1], "metallicFactor": 0.75,
            "roughnessFactor": 0.125}),
        writer.material("Tiles", pbrMetallicRoughness={
            "baseColorTexture": writer.texture(fine), "metallicRoughnessTexture": writer.texture(gloss),
            "metallicFactor": 0.5}, normalTexture={**writer.texture(relief), "scale": 0.5}),
    ]


def small_box():
    """Returns a box of 2 x 2 x 2 with three materials."""
    writer = Writer()
    return writer.bytes([box(writer, materials(writer))])


def mirrored_box():
    """Returns a box by nodes that move, turn, scale and mirror."""
    writer = Writer()
    inner = box(writer, materials(writer), scale=[-0.5, 1, 0.25],
                rotation=[0, math.sin(0.4), 0, math.cos(0.4)])
    outer = writer.add_to("nodes", {"children": [inner], "translation": [3, 2, -1]})
    return writer.bytes([outer])


def transformed_box(other=0.25, webp=False, scale=(2, 3)):
    """Returns a box whose images are moved, turned and scaled (KHR_texture_transform). `other`: offset
    of the image of normals. `webp`: the second material has an image by an extension alone."""
    writer = Writer()
    kinds = materials(writer)
    tiles = writer.json["materials"][kinds[2]]
    uses, relief = tiles["pbrMetallicRoughness"], tiles["normalTexture"]
    for use, offset in ((uses["baseColorTexture"], 0.25), (uses["metallicRoughnessTexture"], 0.25),
                        (relief, other)):
        use["extensions"] = {"KHR_texture_transform": {
            "offset": [offset, -0.5], "rotation": 0.3, "scale": list(scale)}}
    writer.json["extensionsUsed"] = ["KHR_texture_transform"]
    if webp:
        texture = writer.add_to("textures", {"extensions": {"EXT_texture_webp": {"source": 0}}})
        writer.json["materials"][kinds[1]]["pbrMetallicRoughness"]["baseColorTexture"] = {
            "index": texture}
    return writer.bytes([box(writer, kinds)])


def ball():
    """Returns a sphere whose image is repeated three times around it."""
    writer = Writer()
    kinds = materials(writer)
    return writer.bytes([writer.node([writer.primitive(*sphere(24, 12, 0.5, 3), kinds[2])])])


if __name__ == "__main__":
    Path(sys.argv[2]).write_bytes(globals()[sys.argv[1]]())
