#!/usr/bin/python3
"""The recipes of docs/python.md run as they are."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PAGE = Path(os.environ["SUNDER_ROOT"], "docs", "python.md")


class Recipes(unittest.TestCase):
    def test_run(self):
        recipes = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
        self.assertEqual(len(recipes), 6)
        for recipe in recipes:
            with self.subTest(recipe.partition("world")[0]), tempfile.TemporaryDirectory() as folder:
                run = subprocess.run([sys.executable, "-W", "error", "-c", recipe], cwd=folder,
                                     capture_output=True, text=True)
                if "Renderer" in recipe and "InputError" in run.stderr and " GL " in run.stderr:
                    continue  # there is no GL driver
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertTrue(run.stdout.strip(), recipe)


if __name__ == "__main__":
    unittest.main()
