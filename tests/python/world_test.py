#!/usr/bin/python3
"""Worlds in Python: every call, arrays, threads and interrupts."""
import gc
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import sunder


def box_world(**options):
    """Returns a world with a steel box of 1 m that floats at 5 m, and its key."""
    world = sunder.World(sunder.Scene(), **options)
    return world, world.add_solid(sunder.Asset("box:1,1,1", "steel"), origin=(0, 5, 0), name="box")


class Worlds(unittest.TestCase):
    def test_move_bodies_by_gravity(self):
        world, box = box_world(particles=False)
        world.run(0.5)
        self.assertAlmostEqual(world.time_s, 0.5)
        body = world.body(box)
        self.assertAlmostEqual(body.velocity[1], -9.81 * 0.5, places=6)
        self.assertAlmostEqual(body.position[1], 5 - 9.81 * 0.5**2 / 2, delta=0.05)
        np.testing.assert_allclose(body.origin, body.position, atol=1e-9)
        world.run(0.51)
        self.assertAlmostEqual(world.time_s, 1.01)

    def test_describe_bodies(self):
        world, box = box_world()
        ball = world.add_ball((3, 5, 0), radius_m=0.25, velocity=(1, 0, 0), name="ball", category=2,
                              mask=4, user_data=99)
        body = world.body(ball)
        self.assertEqual((body.key, body.root, body.name, body.convexes), (ball, ball, "ball", 0))
        self.assertEqual((body.category, body.mask, body.user_data), (2, 4, 99))
        self.assertEqual((body.is_static, body.is_kinematic, body.asleep), (False, False, False))
        self.assertAlmostEqual(body.volume_m3, 4 / 3 * np.pi * 0.25**3)
        self.assertAlmostEqual(world.body(box).mass_kg / world.body(box).volume_m3,
                               body.mass_kg / body.volume_m3)
        np.testing.assert_allclose(body.velocity, [1, 0, 0])
        np.testing.assert_allclose(body.angular_velocity, [0, 0, 0])
        np.testing.assert_allclose(body.rotation, [0, 0, 0, 1])
        self.assertEqual(len(world), 2)
        self.assertIn("box", repr(world.body(box)))

    def test_set_what_bodies_do(self):
        world, box = box_world()
        world.set_user_data(box, 2**63)
        world.set_filter(box, category=8, mask=1)
        self.assertEqual(world.body(box).user_data, 2**63)
        self.assertEqual(world.body(box).category, 8)
        half = np.sqrt(0.5)
        world.set_motion(box, origin=(1, 9, 0), rotation=(0, 2 * half, 0, 2 * half),
                         velocity=(0, 1, 0), angular_velocity=(0, 0, 2))
        np.testing.assert_allclose(world.body(box).rotation, [0, half, 0, half])
        np.testing.assert_allclose(world.body(box).origin, [1, 9, 0])
        world.set_motion(box, velocity=(0, 0, 0))
        np.testing.assert_allclose(world.body(box).origin, [1, 9, 0])
        world.apply_impulse(box, (world.body(box).mass_kg * 2, 0, 0))
        world.step()
        self.assertAlmostEqual(world.body(box).velocity[0], 2, places=5)
        world.move_to(box, origin=(5, 9, 0), duration_s=0.5)
        world.run(1)
        self.assertTrue(world.body(box).is_kinematic)
        np.testing.assert_allclose(world.body(box).origin, [5, 9, 0], atol=1e-9)
        world.release(box)
        world.run(0.1)
        self.assertLess(world.body(box).origin[1], 9)
        world.remove(box)
        self.assertFalse(world.contains(box))
        self.assertNotIn(box, world)

    def test_drive_bodies(self):
        world, box = box_world()
        world.drive([box], velocity=(3, 0, 0), until_s=0.5)
        world.run(0.4)
        # The drive acts before the solve, which adds gravity for a step.
        np.testing.assert_allclose(world.body(box).velocity, [3, -9.81 / 120, 0], atol=1e-6)
        world.run(0.4)
        self.assertLess(world.body(box).velocity[1], -1)

    def test_join_bodies(self):
        world, box = box_world()
        joint = world.add_joint("distance", box, None, at=(0, 5, 0), to=(0, 8, 0))
        world.run(1)
        self.assertAlmostEqual(np.linalg.norm(world.body(box).position - [0, 8, 0]), 3, delta=0.01)
        self.assertTrue(world.contains_joint(joint))
        world.remove_joint(joint)
        self.assertFalse(world.contains_joint(joint))
        for kind in ("ball", "hinge", "fixed", "rope"):
            other = world.add_ball((5, 20, 5), radius_m=0.1)
            world.add_joint(kind, box, other, at=(0, 5, 0), axis=(1, 0, 0), breaking_N=1e9)
            world.remove(other)
        with self.assertRaises(sunder.InputError):
            world.add_joint("glue", box, None, at=(0, 0, 0))

    def test_break_bodies_and_tell(self):
        scene = sunder.Scene()
        world = sunder.World(scene, threads=1)
        pane = world.add_solid(sunder.Asset.from_boxes([((-1, 0, 0), (1, 2, 0.02))], "glass",
                                                       anchored=True), name="pane")
        world.set_user_data(pane, 5)
        world.report_hits(1)
        world.shoot((0, 1, 2), (0, 0, -30), radius_m=0.1, material="steel", name="shot")
        breaks, hits, appeared = [], [], []

        def watch(world):
            breaks.extend(world.events.breaks)
            hits.extend(world.events.hits)
            appeared.extend(world.events.appeared)

        world.run(0.5, watch)
        self.assertGreater(len(breaks), 0)
        self.assertEqual(breaks[0].parent, pane)
        self.assertGreater(len(breaks[0].children), 1)
        self.assertGreater(breaks[0].energy_J, 0)
        self.assertGreater(breaks[0].new_area_m2, 0)
        self.assertGreaterEqual(breaks[0].pieces, len(breaks[0].children))
        self.assertEqual(world.materials[breaks[0].material], "glass")
        self.assertEqual(breaks[0].point.shape, (3,))
        self.assertGreater(breaks[0].time_s, 0)
        self.assertTrue({hit.a for hit in hits} & set(appeared))
        self.assertTrue(all(hit.speed_m_s >= 1 and hit.mass_kg > 0 for hit in hits))
        self.assertEqual((hits[0].point.shape, hits[0].normal.shape), ((3,), (3,)))
        self.assertTrue(hits[0].b is None or hits[0].b > hits[0].a)
        child = next(key for key in breaks[0].children if key in world)
        self.assertEqual((world.body(child).root, world.body(child).user_data), (pane, 5))
        for name in ("gone", "fell_asleep", "woke", "joints_lost"):
            self.assertIsInstance(getattr(world.events, name), list)

    def test_break_on_request_and_by_blasts(self):
        world = sunder.World(sunder.Scene())
        box = world.add_solid(sunder.Asset("box:1,1,1"), origin=(0, 1, 0))
        world.break_at(box, (0, 1.5, 0), (0, -1, 0), energy_J=1e6, pattern="voronoi:10")
        world.step()
        self.assertGreater(len(world), 5)
        self.assertNotIn(box, world)
        world.blast((0, 0, 0), radius_m=5, impulse_Ns_m2=2000)
        world.blast((0, 0, 0), tnt_kg=1, in_air=True, cover=True)
        world.step()
        self.assertGreater(np.linalg.norm(world.bodies.velocities, axis=1).max(), 0.1)

    def test_add_materials(self):
        world = sunder.World(sunder.Scene())
        index = world.add_material(sunder.Material("lead", like="steel"))
        self.assertEqual(world.materials[index], "lead")
        self.assertIn(world.add_ball((0, 2, 0), material="lead"), world)
        self.assertIn(world.add_solid(sunder.Asset("box:1,1,1", index), origin=(3, 2, 0)), world)
        with self.assertRaisesRegex(sunder.InputError, "no material 'gold'"):
            world.add_ball((0, 2, 0), material="gold")

    def test_answer_queries(self):
        world, box = box_world()
        hit = world.cast((0, 10, 0), (0, -1, 0))
        self.assertEqual((hit.body, hit.slot, world.materials[hit.material]), (box, 0, "steel"))
        self.assertAlmostEqual(hit.distance_m, 4.5, places=5)
        np.testing.assert_allclose(hit.point, [0, 5.5, 0], atol=1e-5)
        np.testing.assert_allclose(hit.normal, [0, 1, 0], atol=1e-5)
        self.assertIsNone(world.cast((0, 10, 0), (0, -1, 0), accepts=lambda key: key != box).body)
        self.assertIsNone(world.cast((0, 10, 0), (0, -1, 0), mask=2, ground=False))
        self.assertAlmostEqual(world.cast((0, 10, 0), (0, -1, 0), radius_m=1).distance_m, 3.5, places=5)
        self.assertEqual([hit.body for hit in world.cast_all((0, 10, 0), (0, -1, 0))], [box, None])
        self.assertEqual([o.body for o in world.overlap((0, 5, 0), 1)], [box])
        self.assertEqual([(o.body, o.slot) for o in world.overlap_box((-1, 4, -1), (1, 6, 1))],
                         [(box, 0)])
        with self.assertRaises(ZeroDivisionError):
            world.cast((0, 10, 0), (0, -1, 0), accepts=lambda key: 1 / 0)

    def test_cannot_change_during_queries(self):
        world, box = box_world()
        ray = ((0, 10, 0), (0, -1, 0))
        self.assertEqual(world.cast(*ray, accepts=lambda key: world.body(key).name == "box").body, box)
        for change in (lambda key: world.remove(key), lambda key: world.step(), lambda key: world.frame()):
            self.assertRaisesRegex(RuntimeError, "during a query", world.cast, *ray, accepts=change)
        world.remove(box)

    def test_go_on_alike_when_restored(self):
        world = sunder.World(sunder.load_scene("glass"))
        world.add_material(sunder.Material("thick glass", like="glass"))
        world.run(0.3)
        saved = world.save()
        restored = sunder.World.restore(saved, threads=1)
        pickled = pickle.loads(pickle.dumps(world))
        self.assertEqual(saved, restored.save())
        self.assertEqual(world.materials, restored.materials)
        for other in (world, restored, pickled):
            other.run(0.2)
        self.assertEqual(world.state_hash(), restored.state_hash())
        self.assertEqual(world.state_hash(), pickled.state_hash())
        with self.assertRaisesRegex(sunder.InputError, "restore.*damaged"):
            sunder.World.restore(saved[:-1])

    def test_go_on_alike_in_a_copy(self):
        world = sunder.World(sunder.load_scene("brick_wall"))
        world.run(0.5)
        kept = world.copy()
        world.run(0.5)
        for _ in range(2):  # a copy can be copied again
            again = kept.copy()
            again.run(0.5)
            self.assertEqual(again.state_hash(), world.state_hash())
        self.assertAlmostEqual(kept.time_s, 0.5)

    def test_list_contacts(self):
        world, box = box_world()
        world.set_motion(box, origin=(0, 0.5, 0))
        world.run(1)
        contacts = world.contacts(box)
        force = sum(contact.force for contact in contacts)
        weight = 9.81 * world.body(box).mass_kg
        self.assertAlmostEqual(force[1] / weight, 1, places=2)
        self.assertTrue(all(contact.other is None for contact in contacts))
        self.assertTrue(all(abs(contact.point[1]) < 0.01 for contact in contacts))

    def test_report(self):
        world, _ = box_world(particles=False)
        world.step()
        report = world.report
        self.assertEqual(report["counts"]["bodies"], 1)
        self.assertEqual(set(report["stage_ms"]), {"act", "collide", "break", "solve", "load",
                                                   "particles", "snapshot"})
        self.assertGreater(report["energy_J"]["gravity"], 0)
        self.assertEqual(world.report["counts"]["dust"], 0)

    def test_warn(self):
        self.assertRegex(sunder.World(sunder.Scene()).warnings[0], "empty")

    def test_have_equal_hashes_for_any_number_of_threads(self):
        hashes = set()
        for threads in (1, 2, 3):
            world = sunder.World(sunder.load_scene("house"), threads=threads)
            world.run(0.4)
            hashes.add(world.state_hash())
        self.assertEqual(len(hashes), 1)


class Arrays(unittest.TestCase):
    NAMES = ("keys", "positions", "rotations", "velocities", "angular_velocities", "is_static", "asleep")

    def test_outlive_steps_and_the_world(self):
        world = sunder.World(sunder.load_scene("house"))
        world.run(0.6)
        bodies = world.bodies
        arrays = {name: getattr(bodies, name) for name in self.NAMES}
        copies = {name: array.copy() for name, array in arrays.items()}
        world.run(0.3)
        self.assertFalse(np.array_equal(world.bodies.positions, copies["positions"]))
        del world, bodies
        gc.collect()
        other = sunder.World(sunder.load_scene("stack"))  # takes the memory, if it was freed
        other.run(0.1)
        for name, array in arrays.items():
            np.testing.assert_array_equal(array, copies[name])
            self.assertFalse(array.flags.owndata or array.flags.writeable, name)

    def test_are_copied_once_per_step(self):
        world, _ = box_world()
        address = world.bodies.positions.ctypes.data
        self.assertEqual(world.bodies.positions.ctypes.data, address)
        world.step()
        self.assertNotEqual(world.bodies.positions[0, 1], 5)

    def test_have_the_types_and_the_order_that_are_documented(self):
        world, box = box_world()
        half = np.sqrt(0.5)
        world.set_motion(box, rotation=(half, 0, 0, half))
        bodies = world.bodies
        self.assertEqual(len(bodies), 1)
        np.testing.assert_allclose(bodies.rotations, [[half, 0, 0, half]])
        self.assertEqual([getattr(bodies, name).dtype for name in self.NAMES],
                         [np.uint32, *[np.float64] * 4, bool, bool])
        empty = sunder.World(sunder.Scene()).bodies
        self.assertEqual((empty.positions.shape, empty.rotations.shape), ((0, 3), (0, 4)))


class Keywords(unittest.TestCase):
    def test_that_are_misspelt_are_named(self):
        world, box = box_world()
        for call, named in ((lambda: world.add_ball(centre=(0, 3, 0)), "'centre'; did you mean 'center'"),
                            (lambda: world.step(dt=0.01), "step() has no keyword 'dt'"),
                            (lambda: sunder.World(sunder.Scene(), thread=1), "'thread'; did you mean 'threads'"),
                            (lambda: sunder.Asset.from_boxes(box=[]), "'box'; did you mean 'boxes'"),
                            (lambda: sunder.load_scene("house", prest="draft"), "'prest'; did you mean 'preset'")):
            with self.assertRaises(TypeError) as refused:
                call()
            self.assertIn(named, str(refused.exception))
        with self.assertRaises(TypeError) as refused:
            world.add_ball(center="here")  # its value is wrong, not its name
        self.assertIn("incompatible", str(refused.exception))


class Materials(unittest.TestCase):
    def test_of_one_world_are_not_taken_for_those_of_another(self):
        granite = sunder.Material("granite", like="concrete")
        mud = sunder.Material("mud", like="concrete")
        mud.density_kg_m3 = 1500
        for make in (sunder.Scene, lambda: sunder.World(sunder.Scene())):
            one, two = make(), make()
            index = one.add_material(granite)
            self.assertEqual((index, two.add_material(mud)), (len(sunder.builtin_materials()),) * 2)
            self.assertIsInstance(index, int)
            asset = sunder.Asset.from_boxes([((0, 0, 0), (1, 1, 1))], material=index)
            for call in (lambda: two.add_solid(asset),
                         lambda: two.add_ball((0, 3, 0), material=index)):
                with self.assertRaises(sunder.InputError) as refused:
                    call()
                self.assertIn("granite", str(refused.exception))
            one.add_solid(asset)
            one.add_ball((0, 3, 0), material=index)
            two.add_ball((0, 3, 0), material=int(index))  # a plain number is what is there


class Accuracy(unittest.TestCase):
    def test_has_preset_and_sweeps(self):
        scene = sunder.Scene()
        self.assertEqual(scene.accuracy.preset, "realtime")
        found = set()
        for name in ("draft", "realtime", "accurate", "reference"):
            scene.accuracy.preset = name
            self.assertEqual(scene.accuracy.preset, name)
            loaded = sunder.parse_scene("[scene]\ndescription = 'x'\n", preset=name)
            values = [(one.accuracy.dt_s, one.accuracy.substeps, one.accuracy.sweeps,
                       one.limits.full_detail, one.limits.chip_size_factor)
                      for one in (scene, loaded)]
            self.assertEqual(*values)
            found.add(values[0])
        self.assertEqual(len(found), 4)
        scene.accuracy.sweeps = 7
        self.assertEqual((scene.accuracy.sweeps, scene.accuracy.preset), (7, "custom"))
        with self.assertRaises(sunder.InputError) as refused:
            scene.accuracy.preset = "fast"
        self.assertIn("draft", str(refused.exception))


class WrongKeys(unittest.TestCase):
    def test_raise_input_errors_and_change_nothing(self):
        world, box = box_world()
        before = world.state_hash()
        for key in (-1, 7, 2**32 - 1, 2**40):
            for call in (lambda: world.body(key), lambda: world.remove(key),
                         lambda: world.remove_joint(key), lambda: world.contacts(key),
                         lambda: world.set_motion(key, velocity=(0, 0, 0)),
                         lambda: world.move_to(key), lambda: world.release(key),
                         lambda: world.apply_impulse(key, (1, 0, 0)),
                         lambda: world.break_at(key, (0, 0, 0), (0, 1, 0), 1),
                         lambda: world.set_user_data(key, 1), lambda: world.set_filter(key),
                         lambda: world.add_joint("ball", box, key, at=(0, 0, 0))):
                self.assertRaises(sunder.InputError, call)
            self.assertNotIn(key, world)
            self.assertFalse(world.contains_joint(key))
        for call in (lambda: world.step(0), lambda: world.step(1), lambda: world.run(-1),
                     lambda: world.run(float("inf")), lambda: world.run(float("nan")),
                     lambda: world.set_motion(box, rotation=(0, 0, 0, 0)),
                     lambda: world.cast((0, 0, 0), (0, 0, 0)),
                     lambda: world.overlap_box((1, 1, 1), (0, 0, 0))):
            self.assertRaises(sunder.InputError, call)
        self.assertEqual(world.state_hash(), before)


class Threads(unittest.TestCase):
    def test_count_while_a_world_steps(self):
        world = sunder.World(sunder.load_scene("house"), threads=1)
        world.run(0.5)
        counted, done = [], threading.Event()

        def count():
            while not done.is_set():
                counted.append(time.perf_counter())

        thread = threading.Thread(target=count)
        thread.start()
        inside = 0
        for _ in range(200):
            if inside >= 5:
                break
            begin = time.perf_counter()
            world.step()
            end = time.perf_counter()
            # Had the step held the interpreter, the thread could count only around its ends.
            low, high = begin + 0.25 * (end - begin), begin + 0.75 * (end - begin)
            inside += any(low < when < high for when in counted)
            counted.clear()
        done.set()
        thread.join()
        self.assertGreaterEqual(inside, 5)

    def test_cannot_use_one_world_at_once(self):
        world = sunder.World(sunder.load_scene("house"), threads=1)
        refused = []
        done = threading.Event()

        def ask():
            while not done.is_set():
                try:
                    len(world)
                except RuntimeError as error:
                    refused.append(str(error))

        thread = threading.Thread(target=ask)
        thread.start()
        failed = 0
        for _ in range(400):
            if refused:
                break
            try:
                world.step()
            except RuntimeError:
                failed += 1
        done.set()
        thread.join()
        self.assertGreater(len(refused), 0)
        self.assertIn("another thread", refused[0])
        self.assertEqual(failed, 0)

    def test_run_a_world_each(self):
        hashes = []

        def run():
            world = sunder.World(sunder.load_scene("stack"), threads=1)
            world.run(0.5)
            hashes.append(world.state_hash())

        threads = [threading.Thread(target=run) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(hashes)), 1)
        self.assertEqual(len(hashes), 3)


class Interrupts(unittest.TestCase):
    def test_stop_a_long_run(self):
        code = ("import sunder; world = sunder.World(sunder.load_scene('stack'))\n"
                "print('ready', flush=True)\n"
                "try: world.run(1e6)\n"
                "except KeyboardInterrupt: print('stopped', 0 < world.time_s < 1e6)\n")
        process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True,
                                   env=os.environ)
        self.assertEqual(process.stdout.readline(), "ready\n")
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.communicate(timeout=30)[0], "stopped True\n")

    def test_of_the_callback_reach_the_caller(self):
        world, _ = box_world()

        def fail(world):
            raise LookupError("mine")

        with self.assertRaisesRegex(LookupError, "mine"):
            world.run(1, fail)
        self.assertAlmostEqual(world.time_s, 1 / 60)
        world.run(1, lambda world: world.time_s < 0.2)
        self.assertAlmostEqual(world.time_s, 0.2, delta=0.02)


if __name__ == "__main__":
    unittest.main()
