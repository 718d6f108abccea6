#!/usr/bin/python3
"""The shared library and the Python module on a processor that is too old for them.

usage: old_processor_test.py LIBRARY PROGRAM   PROGRAM is linked with the library

Such a processor is emulated by qemu-x86_64-static; without it the script exits with 77. So it does
if the loader knows no instruction sets (glibc before 2.33). The module is left out unless PYTHONPATH
has it.
"""
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

QEMU = "qemu-x86_64-static"
REFUSED = "CPU ISA level is lower than required"
LOAD = "import ctypes, sys; print(ctypes.CDLL(sys.argv[1]).sunder_result_name(0) != 0)"


def run(processor, *command):
    """Runs a command on an emulated processor."""
    return subprocess.run([QEMU, "-cpu", processor, *command], capture_output=True, text=True,
                          check=False)


class OldProcessor(unittest.TestCase):
    library, program = "", ""

    def test_a_host_that_loads_the_library_gets_an_error(self):
        done = run("Nehalem", sys.executable, "-c", LOAD, self.library)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("OSError", done.stderr)
        self.assertIn(REFUSED, done.stderr)

    def test_a_newer_processor_loads_the_library(self):
        done = run("max", sys.executable, "-c", LOAD, self.library)
        self.assertEqual(done.stdout, "True\n", done.stderr)

    def test_a_program_that_is_linked_with_the_library_ends_with_a_message(self):
        done = run("Nehalem", self.program)
        self.assertEqual(done.returncode, 127, done.stderr)
        self.assertIn("libsunder.so", done.stderr)
        self.assertIn(REFUSED, done.stderr)

    def test_the_module_names_the_remedy(self):
        if not Path(os.environ.get("PYTHONPATH", ""), "sunder").is_dir():
            self.skipTest("the Python module was not built")
        done = run("Nehalem", sys.executable, "-c", "import sunder")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("ImportError: the module sunder is compiled for processors", done.stderr)
        self.assertIn("CMAKE_ARGS=-DSUNDER_ARCH=x86-64-v2 pip install", done.stderr)


if __name__ == "__main__":
    if not shutil.which(QEMU):
        print("skipped: needs the package qemu-user-static")
        sys.exit(77)
    if tuple(map(int, os.confstr("CS_GNU_LIBC_VERSION").split()[1].split("."))) < (2, 33):
        print("skipped: glibc is older than 2.33")
        sys.exit(77)
    OldProcessor.library, OldProcessor.program = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
