#!/usr/bin/python3
"""Docstrings and type stubs of the Python module are complete."""
import ast
import os
import subprocess
import sys
import unittest
from pathlib import Path

import sunder

PYTHON = Path(os.environ["SUNDER_ROOT"], "scenes", "api", "python")


def public_members(cls):
    return [name for name in vars(cls) if not name.startswith("_")]


class Stubs(unittest.TestCase):
    def setUp(self):
        tree = ast.parse((PYTHON / "sunder.pyi").read_text(encoding="utf-8"))
        self.classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        self.functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}

    def test_have_every_public_name(self):
        self.assertEqual(set(sunder.__all__), set(self.classes) | self.functions)
        for name, node in self.classes.items():
            cls = getattr(sunder, name)
            if issubclass(cls, Exception):
                continue
            listed = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
            self.assertEqual(set(public_members(cls)), {one for one in listed if one[0] != "_"}, name)

    def test_are_those_of_the_built_module(self):
        run = subprocess.run([sys.executable, PYTHON / "make_stubs.py", PYTHON / "sunder.pyi", "--check"])
        self.assertEqual(run.returncode, 0)

    def test_are_installed_beside_the_module(self):
        package = Path(sunder.__file__).parent
        self.assertTrue((package / "py.typed").is_file())
        self.assertEqual((package / "__init__.pyi").read_text(), (PYTHON / "sunder.pyi").read_text())


class Docstrings(unittest.TestCase):
    def test_are_on_every_public_name(self):
        self.assertIn("load_scene", sunder.__doc__)
        for name in sunder.__all__:
            member = getattr(sunder, name)
            self.assertTrue((member.__doc__ or "").strip(), name)
            self.assertTrue(not isinstance(member, type) or member.__module__ == "sunder", name)
            if isinstance(member, type) and not issubclass(member, Exception):
                for key in public_members(member):
                    doc = (getattr(member, key).__doc__ or "").splitlines()
                    is_bound = bool(doc) and " -> " in doc[0]
                    self.assertTrue([line for line in doc[is_bound:] if line.strip()], f"{name}.{key}")


if __name__ == "__main__":
    unittest.main()
