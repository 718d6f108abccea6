#!/usr/bin/env python3
"""Compares the surface of exported pieces with that of the GLB that they came from: materials, images
and texture coordinates. Shares no code with the program: reads with check_glb.py and numpy alone.

Usage: check_textures.py INPUT.glb OUTPUT.glb [--poses POSES --root NAME] [--metres M] [--uv U] [--area A]

Three points of each triangle of OUTPUT whose material does not end with " inside" are compared with the
triangles of INPUT that are within M of the point: one of them must have an equal material, and at the
nearest point the same texture coordinates within U. The three points are a hundredth of the triangle
away from its edges, so that seams of INPUT do not decide. Triangles of the inside that are on the surface
of INPUT and parallel to it must have less than 1e-5 of its area: slivers at edges. The area of each material
must be that of INPUT within the fraction A of the area of INPUT.

Materials are equal if their colours (linear, as the files have them), roughness, metallic, the bytes of
their images and the scale of their normals are. --poses: OUTPUT is a run of `sunder export`, and POSES the table
of its bodies that check_glb.py describes; the bodies of the last frame that come from the body NAME are
compared, in their rest frame.
Exit code 1 if anything differs. Read first: main().
"""
import argparse
import sys

import numpy as np

from check_glb import Document, Motion, rotate

CORNER_SHARE = 0.98  # of a corner in the points that are compared
MOST_PAIRS = 4_000_000  # of points and triangles that are compared at once


class Surface:
    """The triangles of a document: corners (n, 3, 3), texture coordinates (n, 3, 2), materials (n)."""

    def __init__(self, document, poses=None, root=None):
        self.document = document
        self.motion = Motion(document)
        self.time = 0.0
        self.origins = {}  # of the nodes of bodies, in the rest frame, by key
        if poses is not None:
            run = document.json["asset"]["extras"]["sunder"]
            self.time = run["duration_s"]
            for row in poses[::-1]:
                self.origins[int(row[1])] = row[9:12]
        self.corners, self.uvs, self.numbers = [], [], []
        scenes = document.json["scenes"]
        for node in scenes[document.json.get("scene", 0)]["nodes"]:
            if root is None or document.json["nodes"][node].get("extras", {}).get("root") == root:
                self.add(node, np.eye(4))
        self.corners = np.concatenate(self.corners)
        self.uvs = np.concatenate(self.uvs)
        self.numbers = np.concatenate(self.numbers)
        self.materials = [Material(document, material)
                          for material in document.json.get("materials", [])]

    def local(self, node):
        described = self.document.json["nodes"][node]
        if "matrix" in described:
            return np.asarray(described["matrix"], np.float64).reshape(4, 4).T
        move, turn, scale = (self.motion.at(node, path, np.array([self.time]))[0]
                             for path in ("translation", "rotation", "scale"))
        key = described.get("extras", {}).get("key")
        if key in self.origins:
            move, turn = self.origins[key], np.array([0, 0, 0, 1.0])
        made = np.eye(4)
        # The rows of a rotation of the unit vectors are its columns.
        made[:3, :3] = rotate(np.broadcast_to(turn / np.linalg.norm(turn), (3, 4)),
                              np.eye(3)).T * scale
        made[:3, 3] = move
        return made

    def add(self, node, parent):
        described = self.document.json["nodes"][node]
        world = parent @ self.local(node)
        if np.linalg.det(world[:3, :3]) == 0:
            return
        if "mesh" in described:
            for primitive in self.document.json["meshes"][described["mesh"]]["primitives"]:
                self.add_primitive(primitive, world)
        for child in described.get("children", []):
            self.add(child, world)

    def add_primitive(self, primitive, world):
        attributes = primitive["attributes"]
        points = self.document.array(attributes["POSITION"]).astype(np.float64)
        points = points @ world[:3, :3].T + world[:3, 3]
        uvs = (self.document.array(attributes["TEXCOORD_0"]).astype(np.float64)
               if "TEXCOORD_0" in attributes else np.zeros((len(points), 2)))
        uvs = self.transformed(uvs, primitive.get("material"))
        indices = (self.document.array(primitive["indices"])[:, 0]
                   if "indices" in primitive else np.arange(len(points)))
        triangles = indices.astype(int).reshape(-1, 3)
        if np.linalg.det(world[:3, :3]) < 0:
            triangles = triangles[:, ::-1]
        self.corners.append(points[triangles])
        self.uvs.append(uvs[triangles])
        self.numbers.append(np.full(len(triangles), primitive.get("material", -1)))

    def transformed(self, uvs, material):
        """Returns texture coordinates by the KHR_texture_transform of a material's colour image."""
        if material is None:
            return uvs
        base = self.document.json["materials"][material].get("pbrMetallicRoughness", {})
        given = base.get("baseColorTexture", {}).get("extensions", {}).get("KHR_texture_transform")
        if given is None:
            return uvs
        c, s = np.cos(given.get("rotation", 0)), np.sin(given.get("rotation", 0))
        turn = np.array([[c, s], [-s, c]])  # counter-clockwise in the image, where v points down
        return uvs * given.get("scale", [1, 1]) @ turn.T + given.get("offset", [0, 0])

    def areas(self):
        return 0.5 * np.linalg.norm(self.crossed(), axis=1)

    def normals(self):
        crossed = self.crossed()
        length = np.linalg.norm(crossed, axis=1, keepdims=True)
        return crossed / np.where(length > 0, length, 1)

    def crossed(self):
        return np.cross(self.corners[:, 1] - self.corners[:, 0],
                        self.corners[:, 2] - self.corners[:, 0])


class Material:
    """What a material says; numbers with the defaults of glTF, images as bytes."""

    def __init__(self, document, described):
        self.document = document
        base = described.get("pbrMetallicRoughness", {})
        relief = described.get("normalTexture", {})
        self.name = described.get("name", "")
        self.numbers = np.array(
            base.get("baseColorFactor", [1, 1, 1, 1]) +
            [base.get("roughnessFactor", 1), base.get("metallicFactor", 1), relief.get("scale", 1)])
        self.images = [self.image(use) for use in (base.get("baseColorTexture"),
                                                   base.get("metallicRoughnessTexture"),
                                                   described.get("normalTexture"))]

    def image(self, use):
        """Returns the bytes of the image of a reference; None without one."""
        if use is None:
            return None
        json = self.document.json
        source = json["textures"][use["index"]]["source"]
        view = json["bufferViews"][json["images"][source]["bufferView"]]
        start = view.get("byteOffset", 0)
        return self.document.binary[start:start + view["byteLength"]]

    def difference(self, other):
        """Returns in what two materials differ; "" if they are equal."""
        if np.abs(self.numbers - other.numbers).max() > 1e-6:
            return f"numbers {self.numbers} and {other.numbers}"
        for kind, mine, its in zip(("colour", "gloss", "normal"), self.images, other.images):
            if (mine is None) != (its is None):
                return f"one has no {kind} image"
            if mine != its:
                return f"the {kind} images have different bytes"
        return ""


def closest(points, corners):
    """Returns the distances (p, t) of points to triangles, and barycentric coordinates (p, t, 3)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac = b - a, c - a
    offset = points[:, None] - a
    d00, d01, d11 = (ab * ab).sum(1), (ab * ac).sum(1), (ac * ac).sum(1)
    d20, d21 = (offset * ab).sum(2), (offset * ac).sum(2)
    denominator = np.where(d00 * d11 - d01 * d01 > 0, d00 * d11 - d01 * d01, 1)
    v, w = (d11 * d20 - d01 * d21) / denominator, (d00 * d21 - d01 * d20) / denominator
    best = np.stack([1 - v - w, v, w], 2)
    inside = (best >= 0).all(2)
    on_plane = np.linalg.norm(offset - v[..., None] * ab - w[..., None] * ac, axis=2)
    distance = np.where(inside, on_plane, np.inf)
    for i, j in ((0, 1), (1, 2), (2, 0)):  # points beyond an edge
        p, e = corners[:, i], corners[:, j] - corners[:, i]
        length = np.where((e * e).sum(1) > 0, (e * e).sum(1), 1)
        t = np.clip(((points[:, None] - p) * e).sum(2) / length, 0, 1)
        away = np.linalg.norm(points[:, None] - p - t[..., None] * e, axis=2)
        nearer = ~inside & (away < distance)
        on_edge = np.zeros(best.shape)
        on_edge[..., i], on_edge[..., j] = 1 - t, t
        best = np.where(nearer[..., None], on_edge, best)
        distance = np.where(nearer, away, distance)
    return distance, best


def samples(surface):
    """Returns the points (n, 3, 3) that are compared, and their texture coordinates (n, 3, 2)."""
    rest = (1 - CORNER_SHARE) / 2
    weights = np.full((3, 3), rest) + np.eye(3) * (CORNER_SHARE - rest)
    return weights @ surface.corners, weights @ surface.uvs


class Comparison:
    def __init__(self, given, made, metres, area):
        self.given, self.made, self.metres, self.area = given, made, metres, area
        self.messages = []
        self.farthest, self.widest, self.compared = 0.0, 0.0, 0

    def same_material(self, number):
        """Returns for each material of the input if a material of the output equals it."""
        return np.array([material.difference(self.made.materials[number]) == ""
                         for material in self.given.materials], bool)

    def compare(self):
        points, uvs = samples(self.made)
        inside = np.array([material.name.endswith(" inside") for material in self.made.materials])
        is_inside = inside[self.made.numbers]
        areas = self.made.areas()
        least = 1e-10 * areas.max()  # slivers are below the precision of positions
        normals, given_normals = self.made.normals(), self.given.normals()
        step = max(1, MOST_PAIRS // (3 * len(self.given.corners)))
        for number in np.unique(self.made.numbers):
            name = self.made.materials[number].name
            of_number = np.flatnonzero((self.made.numbers == number) & (areas > least))
            for start in range(0, len(of_number), step):
                triangles = of_number[start:start + step]
                distance, weights = closest(points[triangles].reshape(-1, 3), self.given.corners)
                cosines = np.repeat(normals[triangles], 3, 0) @ given_normals.T
                near = (distance < self.metres) & (cosines > 0.9)
                if inside[number]:
                    self.check_inside(near, areas[triangles], name)
                else:
                    self.check_outside(near, distance, weights, uvs[triangles].reshape(-1, 2),
                                       self.same_material(number), name)
        self.compare_areas(areas, is_inside)

    def check_inside(self, near, areas, name):
        """Finds triangles of the inside all of whose points are on the surface of the input."""
        touching = near.any(1).reshape(-1, 3).all(1)
        if areas[touching].sum() > 1e-5 * self.given.areas().sum():
            self.messages.append(f"{touching.sum()} triangles of the surface have material '{name}'")

    def check_outside(self, near, distance, weights, uvs, same, name):
        given = self.given
        self.compared += len(near)
        lost = ~near.any(1)
        if lost.any():
            self.messages.append(f"'{name}': {lost.sum()} points are not on the surface, by "
                                 f"{distance[lost].min(1).max():.3g} m")
        self.farthest = max(self.farthest, distance.min(1)[~lost].max(initial=0))
        fits = near & same[given.numbers]
        other = ~lost & ~fits.any(1)
        if other.any():
            number = given.numbers[np.argmax(near[other][0])]
            self.messages.append(
                f"'{name}': {other.sum()} points have another material than the input: " +
                given.materials[number].difference(self.made.materials[self.number_of(name)]))
        # Of the triangles that fit, the one with the closest texture coordinates counts: both sides of
        # a seam are near to its points.
        rows = np.flatnonzero(fits.any(1))
        for row in rows:
            columns = np.flatnonzero(fits[row])
            expected = np.einsum("tk,tkc->tc", weights[row, columns], given.uvs[columns])
            difference = np.abs(expected - uvs[row]).max(1).min()
            self.widest = max(self.widest, difference)

    def number_of(self, name):
        return next(i for i, m in enumerate(self.made.materials) if m.name == name)

    def compare_areas(self, areas, is_inside):
        """Compares the area of each material of the input with that of the output's equal ones."""
        given_areas = self.given.areas()
        total = given_areas.sum()
        for number, material in enumerate(self.given.materials):
            equal = [i for i, other in enumerate(self.made.materials)
                     if material.difference(other) == ""]
            twins = [i for i, other in enumerate(self.given.materials)
                     if material.difference(other) == ""]
            expected = given_areas[np.isin(self.given.numbers, twins)].sum()
            found = areas[np.isin(self.made.numbers, equal) & ~is_inside].sum()
            if abs(found - expected) > self.area * total:
                self.messages.append(f"material {number} '{material.name}' covers {found:.6g} m², "
                                     f"not {expected:.6g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--poses")
    parser.add_argument("--root")
    parser.add_argument("--metres", type=float, default=1e-5)
    parser.add_argument("--uv", type=float, default=1e-4)
    parser.add_argument("--area", type=float, default=1e-3)
    options = parser.parse_args()
    poses = options.poses and np.fromfile(options.poses, np.float64).reshape(-1, 12)
    given = Surface(Document(options.input))
    made = Surface(Document(options.output), poses, options.root)
    comparison = Comparison(given, made, options.metres, options.area)
    comparison.compare()
    messages = comparison.messages
    print(f"{len(made.corners)} triangles, {comparison.compared} points: largest distance "
          f"{comparison.farthest:.3g} m, largest difference of texture coordinates "
          f"{comparison.widest:.3g}")
    if comparison.widest > options.uv:
        messages.append("texture coordinates differ")
    for message in messages:
        print(message)
    return 1 if messages or comparison.compared == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
