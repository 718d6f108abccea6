#!/usr/bin/python3
"""Scenes, materials, frames, recordings and pictures in Python."""
import gc
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import sunder

PROGRAM = os.environ["SUNDER_PROGRAM"]
SHOT = """
[scene]
description = "A steel ball breaks a pane."
duration_s = 1
[[solid]]
structure = "pane"
[[script.shot]]
time_s = 0
from = [0, 1.2, 4]
at = [0, 1, 0]
speed_m_s = 30
radius_m = 0.1
"""


class Scenes(unittest.TestCase):
    def test_load_by_name_and_from_a_file(self):
        self.assertIn("house", sunder.scene_names())
        house = sunder.load_scene("house")
        self.assertEqual(house.name, "house")
        self.assertGreater(house.solids, 0)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "shot.toml")
            file.write_text(SHOT)
            self.assertEqual(sunder.load_scene(file).name, "shot")

    def test_are_changed_by_preset_and_values(self):
        fine = sunder.load_scene("stack", preset="accurate")
        self.assertNotEqual(fine.accuracy.substeps, sunder.load_scene("stack").accuracy.substeps)
        scene = sunder.parse_scene(SHOT, set={"scene.duration_s": 2.5, "scene.gravity": (0, -3, 0),
                                              "script.enabled": False, "limits.bodies": 50})
        np.testing.assert_array_equal(scene.gravity, [0, -3, 0])
        self.assertEqual(scene.limits.bodies, 50)
        self.assertEqual(scene.duration_s, 2.5)
        self.assertEqual(scene.description, "A steel ball breaks a pane.")

    def test_have_properties(self):
        scene = sunder.Scene()
        scene.name, scene.description, scene.seed, scene.duration_s = "mine", "A scene.", 7, 3
        scene.gravity = (0, -1.6, 0)
        scene.ground_friction, scene.ground_height_m = 0.5, -1
        scene.eye, scene.target, scene.fov_rad = (0, 2, 9), (0, 1, 0), 0.7
        scene.limits.bodies = 123
        scene.accuracy.dt_s = 1 / 240
        copy = scene.copy()
        scene.limits.bodies = 5
        self.assertEqual((copy.name, copy.seed, copy.duration_s, copy.limits.bodies),
                         ("mine", 7, 3, 123))
        np.testing.assert_allclose(copy.gravity, [0, -1.6, 0])
        np.testing.assert_allclose(copy.target, [0, 1, 0])
        self.assertEqual(copy.accuracy.dt_s, 1 / 240)
        self.assertEqual(copy.warnings, [])
        self.assertFalse(copy.planar)

    def test_have_materials(self):
        scene = sunder.Scene()
        names = [material.name for material in scene.materials]
        self.assertEqual(names, [material.name for material in sunder.builtin_materials()])
        mine = sunder.Material("my stone", like="concrete")
        mine.density_kg_m3, mine.pattern, mine.color = 2700, "voronoi:12", (1, 0.5, 0.2)
        self.assertEqual(mine.pattern, "voronoi:12,2")
        self.assertEqual(mine.toughness_J_m2, scene.materials[names.index("concrete")].toughness_J_m2)
        index = scene.add_material(mine)
        self.assertEqual(index, len(names))
        self.assertEqual(scene.add_material(mine), index)
        scene.materials = scene.materials + [sunder.Material("plain")]
        self.assertEqual(len(scene.materials), index + 2)
        self.assertEqual(scene.materials[-1].pattern, "none")
        scene.add_solid(sunder.Asset("box:1,1,1", material=index), origin=(0, 1, 0))
        scene.add_ball((0, 5, 0), material="my stone")
        world = sunder.World(scene)
        self.assertAlmostEqual(world.body(0).mass_kg, 2700, places=6)
        self.assertEqual(world.materials[index], "my stone")
        self.assertEqual((scene.solids, scene.balls), (1, 1))

    def test_that_are_wrong_raise_input_errors(self):
        for wrong in (lambda: sunder.load_scene("hous"), lambda: sunder.parse_scene("[scene]\nx = 1"),
                      lambda: sunder.load_scene("house", preset="best"),
                      lambda: sunder.load_scene("house", set={"no.such": 1}),
                      lambda: sunder.Material("x", like="cheese"),
                      lambda: sunder.Asset("box:1,1"), lambda: sunder.Asset("no.obj"),
                      lambda: sunder.Asset.from_boxes([((0, 0, 0), (1, -1, 1))]),
                      lambda: sunder.Asset.from_boxes([]),
                      lambda: sunder.Asset.from_hulls([np.zeros((5, 3))]),
                      lambda: sunder.Asset.from_hulls([np.zeros((5, 2))]),
                      lambda: sunder.read_recording("no.take"),
                      lambda: sunder.World(sunder.Scene(), threads=-1),
                      lambda: sunder.fracture("box:1,1,1", "voronoi:0")):
            with self.assertRaises(sunder.InputError) as raised:
                wrong()
            self.assertIsInstance(raised.exception, ValueError)
            self.assertGreater(len(str(raised.exception)), 10)

    def test_that_cannot_be_written_raise_file_errors(self):
        self.assertTrue(issubclass(sunder.FileError, OSError))
        with self.assertRaises(sunder.FileError):
            sunder.Recorder("/proc/no/such/folder/x.take")


class Assets(unittest.TestCase):
    def test_of_boxes_hulls_triangles_and_files_have_the_same_volume(self):
        low, high = np.zeros(3), np.array([1.0, 2.0, 3.0])
        corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], float)
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.uint32)
        assets = [sunder.Asset.from_boxes([(low, high)]), sunder.Asset.from_hulls([corners]),
                  sunder.Asset.from_triangles(corners, triangles), sunder.Asset("box:1,2,3")]
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "box.obj")
            file.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) +
                            "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles))
            assets.append(sunder.Asset(file))
            assets.append(sunder.Asset(str(file), scale=1, nodes="4", fit="26dop"))
        for asset in assets:
            self.assertAlmostEqual(asset.volume_m3, 6, places=9)
            self.assertFalse(asset.anchored)
            np.testing.assert_allclose(np.subtract(*asset.bounds[::-1]), high, atol=1e-6)

    def test_of_touching_boxes_are_one_solid(self):
        asset = sunder.Asset.from_boxes([((0, 0, 0), (1, 1, 1)), ((1, 0, 0), (2, 1, 1))], "brick",
                                        anchored=True)
        self.assertEqual(asset.convexes, 2)
        self.assertTrue(asset.anchored)
        self.assertAlmostEqual(asset.volume_m3, 2)

    def test_of_parts_that_do_not_touch_have_islands(self):
        asset = sunder.Asset.from_boxes([((0, 0, 0), (1, 1, 1)), ((2, 0, 0), (3, 1, 2))])
        self.assertEqual([island.volume_m3 for island in asset.islands()], [1, 2])

    def test_of_triangles_with_a_wrong_index_raise(self):
        with self.assertRaisesRegex(sunder.InputError, "vertex 9"):
            sunder.Asset.from_triangles(np.eye(3), [[0, 1, 9]])
        for wrong in (-1, 2**32, 2**32 + 1, -2**32, 2**63, 0.5, float("nan")):  # some of them wrapped
            with self.assertRaises(sunder.InputError):
                sunder.Asset.from_triangles(np.eye(3), [[0, 1, wrong]])


class Frames(unittest.TestCase):
    def setUp(self):
        self.world = sunder.World(sunder.parse_scene(SHOT))
        self.world.run(0.5)
        self.frame = self.world.frame()

    def test_give_views_that_outlive_world_and_frame(self):
        bodies = self.frame.bodies
        columns = {name: getattr(bodies, name) for name in (
            "keys", "previous_keys", "positions", "rotations", "centers", "velocities",
            "angular_velocities", "masses_kg", "is_static", "asleep")}
        instances, mesh = self.frame.instances, self.frame.mesh(self.frame.instances[0, 0])
        vertices, indices, normals, looks = mesh.vertices, mesh.indices, mesh.normals, mesh.looks
        count = len(bodies)
        copies = {name: column.copy() for name, column in columns.items()}
        corners = vertices.copy()
        self.world.run(0.2)
        del self.world, self.frame, bodies, mesh
        gc.collect()
        for name, column in columns.items():
            self.assertEqual(len(column), count)
            self.assertFalse(column.flags.owndata or column.flags.writeable, name)
            np.testing.assert_array_equal(column, copies[name])
        np.testing.assert_array_equal(vertices, corners)
        self.assertEqual((instances.dtype, instances.shape[1]), (np.uint32, 3))
        self.assertEqual((vertices.dtype, indices.dtype), (np.float32, np.uint32))
        self.assertLess(indices.max(), len(vertices))
        self.assertEqual(normals.shape, vertices.shape)
        self.assertEqual(len(looks), len(vertices))

    def test_have_meshes_in_the_world(self):
        frame = self.frame
        for k, (mesh, body, _) in enumerate(frame.instances):
            points = frame.world_vertices(k)
            self.assertEqual(len(points), len(frame.mesh(mesh).vertices))
            reach = np.linalg.norm(points - frame.bodies.positions[body], axis=1)
            self.assertLess(reach.max(), 4)
        self.assertEqual(frame.mesh(frame.instances[0, 0]).origin.shape, (3,))
        self.assertLess(frame.mesh(frame.instances[0, 0]).material, len(frame.materials))
        with self.assertRaises(sunder.InputError):
            frame.mesh(10**6)
        with self.assertRaises(sunder.InputError):
            frame.world_vertices(10**6)

    def test_report_what_the_program_reports(self):
        report = self.frame.report
        self.assertEqual(report["counts"]["bodies"], len(self.frame.bodies) - self.frame.bodies.is_static.sum())
        self.assertIn("solve", report["stage_ms"])
        self.assertGreater(report["mass_kg"], 0)
        self.assertEqual(len(self.frame.debris_positions), report["counts"]["debris"])
        self.assertEqual(len(self.frame.debris_radii_m), report["counts"]["debris"])
        self.assertEqual(len(self.frame.dust_positions), report["counts"]["dust"])
        self.assertAlmostEqual(self.frame.time_s, 0.5)
        self.assertEqual(len(self.frame.state_hash()), 16)
        self.assertIsInstance(self.frame.index, int)
        self.assertIsInstance(self.frame.breaks, list)

    def test_hash_as_those_of_the_program(self):
        run = subprocess.run([PROGRAM, "simulate", "house", "--frames", "60", "--quiet", "--json", "-"],
                             check=True, capture_output=True, text=True)
        world, state = sunder.World(sunder.load_scene("house")), sunder.StateHash()
        state.take(world.frame())
        for _ in range(60):
            world.step(1 / 60)
            state.take(world.frame())
        self.assertEqual(state.hex(), json.loads(run.stdout)["state_hash"])

    def test_are_recorded_and_read(self):
        world = sunder.World(sunder.parse_scene(SHOT))
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "shot.take")
            with sunder.Recorder(file) as recorder:
                recorder.take(world.frame())
                world.run(0.25, lambda world: recorder.take(world.frame()))
            with self.assertRaises(sunder.InputError):
                recorder.take(world.frame())
            recording = sunder.read_recording(file)
            self.assertEqual(len(recording), 16)
            frames = list(recording)
            self.assertEqual([frame.index for frame in frames], list(range(16)))
            self.assertTrue(recording.is_complete)
            self.assertEqual(recording.damage, "")
            recording.seek(15)
            last = next(recording)
            np.testing.assert_allclose(last.bodies.positions, world.bodies.positions, atol=1e-3)
            np.testing.assert_array_equal(last.bodies.keys, world.bodies.keys)

    def test_are_drawn(self):
        try:
            image = sunder.render(self.frame, 64, 48)
        except sunder.InputError as error:
            self.skipTest(f"no GL driver: {error}")
        self.assertEqual((image.shape, image.dtype), ((48, 64, 3), np.uint8))
        self.assertGreater(image.std(), 1)
        self.assertEqual(sunder.render(self.frame, 64, 48, transparent=True).shape, (48, 64, 4))
        renderer = sunder.Renderer(64, 48, layers=["depth_m", "ids"])
        np.testing.assert_array_equal(renderer.draw(self.frame), image)
        self.assertEqual(renderer.layers["depth_m"].shape, (48, 64))
        self.assertEqual(renderer.layers["ids"].dtype, np.uint16)
        moved = renderer.draw(self.frame, eye=(0, 20, 1), target=(0, 0, 0), fov_rad=0.5)
        self.assertTrue((moved != image).any())
        self.assertTrue(renderer.description)
        with self.assertRaises(sunder.InputError):
            sunder.render(self.frame, 0, 48)


if __name__ == "__main__":
    unittest.main()
