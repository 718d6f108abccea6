#!/usr/bin/env python3
"""Pieces of `sunder fracture` have the materials, images and texture coordinates of the GLB that they
came from, by readers that share no code with the program: one in NumPy, and three.js."""
import base64
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

sys.path.insert(0, str(Path(__file__).parents[1] / "view"))
import chromium  # noqa: E402

THREE = Path("/usr/share/javascript/three")
LOADER = THREE / "examples/js/loaders/GLTFLoader.js"
PROGRAM = os.environ["SUNDER_PROGRAM"]


def compare(given, made):
    """Returns the comparison of two files."""
    comparison = check_textures.Comparison(check_textures.Surface(Document(given)),
                                           check_textures.Surface(Document(made)), 1e-5, 1e-3)
    comparison.compare()
    return comparison


class Exchange(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = Path(made.name)

    def write(self, name, data):
        (self.folder / name).write_bytes(data)
        return self.folder / name

    def fracture(self, given, *options, output="pieces.glb", warning=""):
        run = subprocess.run([PROGRAM, "fracture", given, "--quiet", "-o", self.folder / output,
                              *options], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0)
        self.assertTrue(run.stderr == "" or warning and run.stderr.startswith(warning), run.stderr)
        return self.folder / output


class RoundTrip(Exchange):
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
        # The outer faces of a piece are those of the input, also after another file. Where the
        # pieces of the first file touch, rounding to single precision may leave walls.
        twice = self.fracture(once, "--pattern", "voronoi:9", output="twice.glb",
                              warning="warning: inner walls are kept in 5 pieces")
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


@unittest.skipUnless(chromium.find() and LOADER.exists(),
                     "Chromium or three.js is missing; install chromium and libjs-three")
class Picture(Exchange):
    """three.js draws the pieces as it draws the mesh that they came from."""

    SCRIPT = """
      const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
      renderer.setSize(400, 400);
      const camera = new THREE.OrthographicCamera(-2, 2, 2, -2, 0.1, 20);
      function draw(file, side) {
        window.pixels = null;
        const bytes = Uint8Array.from(atob(file), letter => letter.charCodeAt(0));
        new THREE.GLTFLoader().parse(bytes.buffer, '', ({scene}) => {
          const shown = new THREE.Scene();
          shown.add(scene);
          scene.traverse(mesh => {
            if (!mesh.isMesh) return;
            const {map, color} = mesh.material;
            mesh.material = new THREE.MeshBasicMaterial({map, color});
          });
          camera.position.set(4 * side, 3 * side, 5 * side);
          camera.lookAt(0, 0, 0);
          renderer.render(shown, camera);
          const gl = renderer.getContext(), pixels = new Uint8Array(4 * 400 * 400);
          gl.readPixels(0, 0, 400, 400, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
          window.pixels = pixels;
        }, error => { window.pixels = 'failed: ' + error; });
      }
      function isDone() { return window.pixels !== null; }
      function share(isWanted) {
        let count = 0;
        for (let at = 0; at < pixels.length; at += 4) if (isWanted(at)) ++count;
        return 4 * count / pixels.length;
      }"""

    def test_is_that_of_the_mesh(self):
        # three.js r111 turns images after it has scaled them: the scales have to be equal.
        files = {"small": textured_glb.small_box(),
                 "transformed": textured_glb.transformed_box(scale=(2, 2))}
        page = self.write("x.html", b"<script>" + (THREE / "build/three.min.js").read_bytes() +
                          b"</script><script>" + LOADER.read_bytes() + b"</script><script>" +
                          self.SCRIPT.encode() + b"</script>")
        with chromium.Chromium(400, 400) as browser:
            browser.open(page)
            browser.wait("typeof draw === 'function'")
            for name, data in files.items():
                pieces = self.fracture(self.write(name + ".glb", data), "--pattern", "voronoi:12")
                for side in (1, -1):
                    for file in (data, pieces.read_bytes()):
                        browser.evaluate("window.before = window.pixels; "
                                         f"draw('{base64.b64encode(file).decode()}', {side}); 0")
                        browser.wait("isDone()")
                    self.assertGreater(browser.evaluate("share(at => pixels[at] > 0)"), 0.3, name)
                    different = browser.evaluate(
                        "share(at => [0, 1, 2].some(c => Math.abs(before[at + c] - pixels[at + c]) > 30))")
                    self.assertLess(different, 0.001, name)


if __name__ == "__main__":
    unittest.main()
