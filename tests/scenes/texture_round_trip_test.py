#!/usr/bin/env python3
"""Pieces of `sunder fracture` have the materials, images and texture coordinates of the GLB that they
came from, by a reader that shares no code with the program."""
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: NumPy is missing; install python3-numpy")
    sys.exit(77)

import textured_glb

sys.path.insert(0, str(Path(__file__).parents[1]))
import check_textures  # noqa: E402
from check_glb import Document  # noqa: E402

PROGRAM = os.environ["SUNDER_PROGRAM"]


def compare(given, made):
    """Returns the comparison of two files."""
    comparison = check_textures.Comparison(check_textures.Surface(Document(given)),
                                           check_textures.Surface(Document(made)), 1e-5, 1e-3)
    comparison.compare()
    return comparison


class RoundTrip(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = Path(made.name)

    def write(self, name, data):
        (self.folder / name).write_bytes(data)
        return self.folder / name

    def fracture(self, given, *options, output="pieces.glb"):
        run = subprocess.run([PROGRAM, "fracture", given, "--quiet", "-o", self.folder / output,
                              *options], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return self.folder / output

    def expect_equal(self, given, made):
        comparison = compare(given, made)
        self.assertEqual(comparison.messages, [])
        self.assertLess(comparison.widest, 1e-5)
        self.assertGreater(comparison.compared, 500)

    def test_of_boxes_and_a_sphere(self):
        for name in ("small_box", "mirrored_box", "transformed_box", "ball"):
            given = self.write(name + ".glb", getattr(textured_glb, name)())
            for pattern in ("voronoi:20", "web:4x7"):
                for walls in ("remove", "keep"):
                    with self.subTest(name=name, pattern=pattern, walls=walls):
                        self.expect_equal(given, self.fracture(given, "--pattern", pattern, "--walls",
                                                               walls))

    def test_by_endings_in_upper_case(self):
        given = self.write("BOX.GLB", textured_glb.small_box())
        self.expect_equal(given, self.fracture(given, "--pattern", "voronoi:20", output="PIECES.GLB"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["BOX.GLB", "PIECES.GLB"])

    def test_of_pieces_that_are_broken_again(self):
        given = self.write("box.glb", textured_glb.small_box())
        once = self.fracture(given, "--pattern", "grid:2")
        document = Document(once)
        # The outer faces of a piece are those of the input, also after another file.
        twice = self.fracture(once, "--pattern", "voronoi:9", output="twice.glb")
        pictures = {image for material in check_textures.Surface(document).materials
                    for image in material.images if image}
        again = {image for material in check_textures.Surface(Document(twice)).materials
                 for image in material.images if image}
        self.assertEqual(len(pictures), 4)
        self.assertEqual(again, pictures)

    def test_names_images_that_cannot_be_kept(self):
        for options, message in (({"webp": True}, "an image neither PNG nor JPEG"),
                                 ({"other": 0.5}, "an image with a transform of its own")):
            given = self.write("box.glb", textured_glb.transformed_box(**options))
            run = subprocess.run([PROGRAM, "fracture", given, "--quiet", "--pattern", "grid:2"],
                                 capture_output=True, text=True)
            self.assertEqual(run.returncode, 0)
            self.assertIn(message, run.stderr)

    def test_fails_for_files_that_differ(self):
        given = self.write("box.glb", textured_glb.small_box())
        pieces = self.fracture(given, "--pattern", "voronoi:20")
        described = Document(pieces).json
        images = [described["bufferViews"][image["bufferView"]]["byteOffset"]
                  for image in described["images"]]
        uvs = described["accessors"][next(
            primitive["attributes"]["TEXCOORD_0"] for mesh in described["meshes"]
            for primitive in mesh["primitives"]
            if not described["materials"][primitive["material"]]["name"].endswith(" inside"))]
        uv = described["bufferViews"][uvs["bufferView"]]["byteOffset"] + uvs["byteOffset"]

        def change_json(edit):
            def change(text, binary):
                document = json.loads(text)
                edit(document)
                return json.dumps(document).encode(), binary
            return change

        def swap_materials(document):
            primitives = [primitive for mesh in document["meshes"]
                          for primitive in mesh["primitives"]]
            primitives[0]["material"] = 1 - primitives[0]["material"] % 2

        def darken(document):
            for material in document["materials"]:
                material["pbrMetallicRoughness"]["baseColorFactor"][0] *= 0.999

        def change_image(text, binary):
            at = images[-1] + 60
            return text, binary[:at] + bytes([binary[at] ^ 1]) + binary[at + 1:]

        def shift_uvs(text, binary):
            count = 2 * uvs["count"]
            moved = np.frombuffer(binary, "<f4", count, uv) + np.float32(0.001)
            return text, binary[:uv] + moved.tobytes() + binary[uv + 4 * count:]

        for change in (change_json(swap_materials), change_json(darken), change_image, shift_uvs):
            with self.subTest(change=change):
                comparison = compare(given, self.changed(pieces, change))
                self.assertTrue(comparison.messages or comparison.widest > 5e-4)

    def changed(self, file, change):
        """Writes a GLB with other JSON or another binary chunk."""
        data = file.read_bytes()
        length, = struct.unpack_from("<I", data, 12)
        text, binary = change(data[20:20 + length], data[28 + length:])
        text += b" " * (-len(text) % 4)
        return self.write("changed.glb", struct.pack(
            "<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4e4f534a) + text +
            struct.pack("<II", len(binary), 0x004e4942) + binary)


if __name__ == "__main__":
    unittest.main()
