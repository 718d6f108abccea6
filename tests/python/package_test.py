#!/usr/bin/python3
"""The module is installed by pip, and by cmake --install, and runs outside the source tree."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["SUNDER_ROOT"])
BUILD = Path(os.environ["SUNDER_BUILD"])
CODE = """
import sunder
world = sunder.World(sunder.load_scene("stack") if {scenes} else sunder.Scene())
world.step()
print(sunder.__file__)
"""


def environment(path=None):
    """Returns the environment without the module of the build, with another path for modules.

    Unless CMAKE_ARGS is set, a build by pip takes the build folder of this test: its own one would
    compile for minutes."""
    left_out = {"PYTHONPATH"} | ({"SUNDER_BUILD"} if "CMAKE_ARGS" in os.environ else set())
    kept = {name: value for name, value in os.environ.items() if name not in left_out}
    return kept | ({"PYTHONPATH": str(path)} if path else {})


class Package(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_is_installed_by_pip(self):
        venv = self.folder / "venv"
        made = subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", venv],
                              capture_output=True, text=True)
        if made.returncode != 0:
            self.skipTest("python3-venv is not installed")
        python = venv / "bin" / "python"
        pip = [python, "-m", "pip", "--disable-pip-version-check"]
        done = subprocess.run([*pip, "install", "--no-build-isolation", "--no-index",
                               ROOT / "scenes" / "api" / "python"], env=environment(), cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        run = subprocess.run([python, "-c", CODE.format(scenes=True)], env=environment(),
                             cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn(str(venv), run.stdout)
        shown = subprocess.run([*pip, "show", "-f", "sunder"], env=environment(), check=True,
                               capture_output=True, text=True).stdout
        for file in ("sunder/__init__.pyi", "sunder/py.typed", "sunder/scenes/buildings/house.toml"):
            self.assertIn(file, shown)
        subprocess.run([*pip, "uninstall", "-y", "sunder"], env=environment(), check=True,
                       capture_output=True)
        self.assertFalse(list(venv.rglob("_core*.so")))

    def test_is_installed_by_cmake(self):
        subprocess.run(["cmake", "--install", BUILD, "--component", "python", "--prefix", self.folder],
                       check=True, capture_output=True)
        modules = self.folder / "lib" / "python3" / "dist-packages"
        run = subprocess.run([sys.executable, "-c", CODE.format(scenes=False)],
                             env=environment(modules), cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn(str(modules), run.stdout)
        for file in (modules / "sunder").iterdir():
            self.assertNotIn(str(ROOT).encode(), file.read_bytes(), file)


if __name__ == "__main__":
    unittest.main()
