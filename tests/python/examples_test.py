#!/usr/bin/python3
"""The programs in examples/python/ run, and write what they say."""
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["SUNDER_ROOT"])
EXAMPLES = ROOT / "examples" / "python"


def run(name, *arguments):
    """Runs an example. Returns what it prints."""
    return subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], check=True,
                          capture_output=True, text=True).stdout


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_make_a_data_set_by_shards_and_resume(self):
        out = self.folder / "set"
        arguments = ["box:1,1,1", ROOT / "scenes" / "pottery" / "vase.obj", "-o", out, "--pieces", 6,
                     "--processes", 2]
        self.assertIn("1 meshes done", run("broken_meshes.py", *arguments, "--shard", "1/2"))
        self.assertEqual(len(list(out.iterdir())), 1)
        self.assertIn("1 meshes done", run("broken_meshes.py", *arguments))
        self.assertIn("0 meshes done", run("broken_meshes.py", *arguments))
        for folder in out.iterdir():
            metadata = json.loads((folder / "metadata.json").read_text())
            pieces = sorted(folder.glob("piece_*.obj"))
            self.assertEqual(len(pieces), len(metadata["pieces"]))
            self.assertGreater(len(pieces), 3)
            total = sum(piece["volume_m3"] for piece in metadata["pieces"])
            self.assertAlmostEqual(total / metadata["volume_m3"], 1, places=9)
            poses = json.loads((folder / "poses.json").read_text())
            self.assertEqual([pose["piece"] for pose in poses], list(range(len(pieces))))
            for file, piece in zip(pieces, metadata["pieces"]):
                lines = file.read_text().splitlines()
                self.assertEqual(sum(line.startswith("f ") for line in lines), piece["triangles"])

    def test_sweep_a_parameter(self):
        run("sweep.py", "-o", self.folder, "--speeds", "5,20", "--seeds", 6)
        with open(self.folder / "sweep.csv", newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["speed_m_s"]) for row in rows], [5, 20])
        self.assertTrue(all(float(row["pieces_mean"]) > 1 for row in rows))
        self.assertTrue(any(float(row["pieces_error"]) > 0 for row in rows))
        plots = [*self.folder.glob("sweep.svg"), *self.folder.glob("sweep.png")]
        self.assertEqual(len(plots), 1)
        self.assertGreater(plots[0].stat().st_size, 500)

    def test_play_episodes(self):
        first = run("environment.py", "--episodes", 2)
        self.assertEqual(first.count("episode"), 2)
        self.assertIn("down", first)
        self.assertEqual(run("environment.py", "--episodes", 2), first)


if __name__ == "__main__":
    unittest.main()
