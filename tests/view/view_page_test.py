#!/usr/bin/env python3
"""`sunder view` writes one file without links, and leaves nothing behind if the input is wrong."""
import base64
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["SUNDER_PROGRAM"]
THREE = Path("/usr/share/javascript/three")


def view(folder, *arguments):
    return subprocess.run([PROGRAM, "view", *arguments], cwd=folder, capture_output=True, text=True)


class Pages(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = Path(made.name)

    def write_page(self, *arguments):
        run = view(self.folder, *arguments, "-o", "x.html")
        self.assertEqual(run.returncode, 0, run.stderr)
        return (self.folder / "x.html").read_text(encoding="utf-8")

    def test_has_no_links_and_forbids_them(self):
        page = self.write_page("stack", "--frames", "5")
        head = page[:page.index("<script>")]
        self.assertIn("default-src 'none'", head)
        self.assertNotRegex(re.sub(r"(?s)<script.*?</script>", "", page), r"(src|href)\s*=|@import|url\(")
        self.assertIn("The MIT License", page)
        self.assertEqual(os.listdir(self.folder), ["x.html"])

    def test_contains_the_exported_run(self):
        done = subprocess.run([PROGRAM, "export", "stack", "--frames", "5", "-o", "x.glb"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        run = base64.b64encode((self.folder / "x.glb").read_bytes()).decode()
        self.assertIn(run, self.write_page("x.glb"))

    def test_plays_a_recording(self):
        subprocess.run([PROGRAM, "simulate", "stack", "--frames", "5", "--take", "x.take"],
                       cwd=self.folder, check=True, capture_output=True)
        page = self.write_page("x.take")
        self.assertIn('id="run"', page)
        (self.folder / "x.take").rename(self.folder / "x.rec")  # is recognised by its content
        self.assertEqual(self.write_page("x.rec"), page)

    def test_is_not_replaced_if_the_input_is_wrong(self):
        (self.folder / "text.glb").write_text("text")
        header = struct.pack("<III", 0x46546c67, 2, 100) + struct.pack("<II", 80, 0x4e4f534a)
        (self.folder / "short.glb").write_bytes(header + b"{}")
        json = b'{"asset":{},"extensionsRequired":["EXT_meshopt_compression"]}   '
        (self.folder / "packed.glb").write_bytes(
            struct.pack("<III", 0x46546c67, 2, 20 + len(json)) +
            struct.pack("<II", len(json), 0x4e4f534a) + json)
        (self.folder / "x.html").write_text("older")
        before = sorted(os.listdir(self.folder))
        for arguments, message in (
                (["text.glb"], "not a GLB file"), (["short.glb"], "truncated"),
                (["packed.glb"], "EXT_meshopt_compression"), (["absent.glb"], "absent.glb"),
                (["no_such_scene"], "no_such_scene"), (["packed.glb", "--frames", "3"], "--frames"),
                (["stack", "--three", "."], "libjs-three")):
            with self.subTest(arguments):
                run = view(self.folder, *arguments, "-o", "x.html")
                self.assertEqual(run.returncode, 2, run.stderr)
                self.assertIn(message, run.stderr)
                self.assertEqual((self.folder / "x.html").read_text(), "older")
                self.assertEqual(sorted(os.listdir(self.folder)), before)
        for output in ("x.htm", "x.glb"):
            self.assertEqual(view(self.folder, "stack", "-o", output).returncode, 2, output)

    def test_has_the_frames_up_to_a_stop(self):
        run = subprocess.Popen([PROGRAM, "view", "house", "-o", "x.html"], cwd=self.folder,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        time.sleep(2)
        run.send_signal(signal.SIGINT)
        text = run.communicate()[0].decode()
        self.assertEqual(run.returncode, 128 + signal.SIGINT, text)
        self.assertEqual(os.listdir(self.folder), ["x.html"])


if __name__ == "__main__":
    if not THREE.exists():
        print("skipped: three.js is missing; install libjs-three")
        sys.exit(77)
    unittest.main()
