#!/usr/bin/python3
"""Pieces of broken solids in Python, measured from their arrays alone."""
import os
import unittest
from collections import Counter
from pathlib import Path

import numpy as np

import sunder

MESHES = Path(os.environ["SUNDER_ROOT"], "scenes")


def volume_of(vertices, triangles):
    """Returns the volume that triangles enclose, by the divergence theorem."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def open_edges(triangles):
    """Returns the number of directed edges that do not have their opposite exactly once."""
    edges = Counter((int(t[i]), int(t[(i + 1) % 3])) for t in triangles for i in range(3))
    return sum(count != 1 or edges[end, start] != 1 for (start, end), count in edges.items())


class Pieces(unittest.TestCase):
    def check(self, asset, pieces, least):
        self.assertGreaterEqual(len(pieces), least)
        total = 0
        for piece in pieces:
            self.assertEqual(open_edges(piece.triangles), 0)
            self.assertEqual((piece.vertices.shape[1], piece.triangles.shape[1]), (3, 3))
            self.assertLess(piece.triangles.max(), len(piece.vertices))
            volume = volume_of(piece.vertices, piece.triangles)
            self.assertAlmostEqual(volume, piece.volume_m3, delta=1e-9 * asset.volume_m3)
            self.assertGreater(volume, 0)
            self.assertEqual(len(piece.is_inside), len(piece.triangles))
            low, high = piece.vertices.min(axis=0), piece.vertices.max(axis=0)
            self.assertTrue((low <= piece.centroid).all() and (piece.centroid <= high).all())
            total += volume
        self.assertAlmostEqual(total / asset.volume_m3, 1, places=9)
        self.assertTrue(any(piece.is_inside.any() for piece in pieces))
        self.assertTrue(any(not piece.is_inside.all() for piece in pieces))

    def test_of_boxes_are_watertight_and_sum_to_the_whole(self):
        asset = sunder.Asset("box:1,2,3")
        for pattern in ("voronoi:40", "voronoi:25,4", "grid:3", "slabs:5", "brick:0.5,0.5,0.5",
                        "web:4x8", "radial:6"):
            with self.subTest(pattern):
                self.check(asset, sunder.fracture(asset, pattern), 4)

    def test_of_meshes_are_watertight_and_sum_to_the_whole(self):
        for mesh in ("pottery/vase.obj", "meshes/torus.obj"):
            with self.subTest(mesh):
                asset = sunder.Asset(MESHES / mesh)
                self.check(asset, sunder.fracture(asset, "voronoi:30"), 10)

    def test_of_a_solid_that_a_text_names(self):
        self.check(sunder.Asset("torus:1,0.3"), sunder.fracture("torus:1,0.3", "voronoi:20"), 10)

    def test_are_few_where_the_radius_is_small(self):
        asset = sunder.Asset("grid:8,1,1")
        near = sunder.fracture(asset, "voronoi:30", point=(0, 0.5, 0.5), radius_m=1)
        self.check(asset, near, 3)
        self.assertLess(len(near), len(sunder.fracture(asset, "voronoi:30")) + 8)
        self.assertGreater(max(piece.volume_m3 for piece in near), 4)

    def test_depend_on_the_seed_alone(self):
        def vertices(seed):
            return np.concatenate([p.vertices for p in sunder.fracture("box:1,1,1", seed=seed)])

        np.testing.assert_array_equal(vertices(3), vertices(3))
        self.assertNotEqual(vertices(3).tolist(), vertices(4).tolist())

    def test_follow_from_a_material_and_an_energy(self):
        glass = next(m for m in sunder.builtin_materials() if m.name == "glass")
        asset = sunder.Asset.from_boxes([((-1, -1, 0), (1, 1, 0.02))], "glass")
        self.check(asset, sunder.fracture(asset, glass, point=(0, 0, 0.02), energy_J=10), 2)
        with self.assertRaisesRegex(sunder.InputError, "unbreakable"):
            sunder.fracture(asset, sunder.Material("iron"))

    def test_outlive_each_other(self):
        vertices = [piece.vertices for piece in sunder.fracture("box:1,1,1")]
        self.assertTrue(all(np.isfinite(v).all() and not v.flags.owndata for v in vertices))

    def test_are_assets_of_worlds(self):
        world = sunder.World(sunder.Scene())
        pieces = sunder.fracture("box:1,1,1", "voronoi:8")
        keys = [world.add_solid(piece.asset, origin=(0, 3, 0)) for piece in pieces]
        for key, piece in zip(keys, pieces):
            np.testing.assert_allclose(world.body(key).position, piece.centroid + [0, 3, 0],
                                       atol=1e-9)
        world.run(0.2)
        self.assertEqual(len(world), len(pieces))

    def test_that_cannot_be_raise_input_errors(self):
        for wrong in (lambda: sunder.fracture("box:1,1,1", "dust:9"),
                      lambda: sunder.fracture("box:1,1,1", radius_m=0),
                      lambda: sunder.fracture("box:1,1,1", point=(0, float("nan"), 0)),
                      lambda: sunder.fracture("box:1,1,1", "brick:1e-6,1e-6,1e-6"),
                      lambda: sunder.fracture("nowhere.obj")):
            self.assertRaises(sunder.InputError, wrong)


if __name__ == "__main__":
    unittest.main()
