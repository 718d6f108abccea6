#!/usr/bin/env python3
"""Builds small trees with one violation each; check_rooms.py must find exactly that one."""
import tempfile
import unittest
from pathlib import Path

import check_rooms

HEADER = "// What it is for.\n#pragma once\n"

# A house where everything is as it should be.
GOOD = {
    "engine/CMakeLists.txt": "sunder_room(engine SOURCES base/a.cpp io/file.cpp)",
    "render/CMakeLists.txt": "sunder_room(render SOURCES ${CMAKE_CURRENT_BINARY_DIR}/made.cpp)",
    "engine/base/a.h": HEADER + "#include <vector>\n#include <Eigen/Core>\n",
    "engine/base/a.cpp": '#include "engine/base/a.h"\n',
    "engine/base/parallel.h": HEADER + "#include <omp.h>\n#pragma omp parallel\n",
    "engine/geometry/g.h": HEADER + '#include "engine/base/a.h"\n',
    "engine/world/w.h": HEADER + '#include "engine/geometry/g.h"\n',
    "engine/io/file.cpp": '#include <zstd.h>\n#include "engine/world/w.h"\n',
    "fracture/f.h": HEADER + '#include "engine/world/w.h"\n',
    "fracture/stress/s.h": HEADER + '#include "fracture/cut/c.h"\n',
    "fracture/cut/c.h": HEADER + '#include "engine/model/m.h"\n',
    "engine/model/m.h": HEADER,
    "solver/rigid/r.h": HEADER + '#include "engine/world/w.h"\n',
    "solver/rigid/tuning.h": HEADER,
    "solver/rigid/body/low.h": HEADER + '#include "solver/rigid/tuning.h"\n',
    "render/r.h": HEADER + '#include <GL/glcorearb.h>\n#include "engine/world/w.h"\n',
    "scenes/s.h": HEADER + '#include <toml++/toml.h>\n#include "fracture/f.h"\n',
    "scenes/app/app.h": HEADER + '#include "bench/b.h"\n#include "scenes/s.h"\n',
    "bench/b.h": HEADER + '#include <benchmark/benchmark.h>\n#include "solver/rigid/r.h"\n',
    "tests/t.h": HEADER + '#include <gtest/gtest.h>\n#include "bench/b.h"\n',
}

# What is put into the good house, and what must be said about it.
BAD = {
    "a floor includes a higher one":
        ("engine/base/b.h", HEADER + '#include "engine/world/w.h"\n', "may not include engine/world"),
    "a room within a room includes one above it":
        ("fracture/cut/b.h", HEADER + '#include "fracture/stress/s.h"\n', "not below it"),
    "a room within a room includes one beside it":
        ("fracture/vacd/b.h", HEADER + '#include "fracture/stress/s.h"\n', "not below it"),
    "a folder includes the steps above it":
        ("fracture/stress/b.h", HEADER + '#include "fracture/f.h"\n', "not below it"),
    "a header on a lower floor includes its folder":
        ("solver/rigid/tuning.h", HEADER + '#include "solver/rigid/r.h"\n', "not below it"),
    "a folder on no floor":
        ("solver/cloth/b.h", HEADER, "on no floor"),
    "two files of one name in a room":
        ("solver/rigid/body/r.h", HEADER, "a file of that name already: solver/rigid/body/r"),
    "the engine includes fracture":
        ("engine/world/b.h", HEADER + '#include "fracture/f.h"\n', "engine may not include"),
    "fracture includes the solver":
        ("fracture/b.h", HEADER + '#include "solver/rigid/r.h"\n', "fracture may not include"),
    "the solver includes rendering":
        ("solver/base/b.h", HEADER + '#include "render/r.h"\n', "solver may not include render"),
    "rendering includes scenes":
        ("render/b.h", HEADER + '#include "scenes/s.h"\n', "render may not include scenes"),
    "scenes include a benchmark":
        ("scenes/b.h", HEADER + '#include "bench/b.h"\n', "scenes may not include bench"),
    "a benchmark includes a test":
        ("bench/c.h", HEADER + '#include "tests/t.h"\n', "bench may not include tests"),
    "a test includes the program":
        ("tests/b.h", HEADER + '#include "scenes/app/app.h"\n', "nothing includes the program"),
    "an include is not spelled from the root":
        ("fracture/b.h", HEADER + '#include "f.h"\n', "not a path from the root"),
    "OpenMP outside its place":
        ("engine/world/b.h", HEADER + "#include <omp.h>\n", "<omp.h> lives only in"),
    "an OpenMP pragma outside its place":
        ("fracture/b.h", HEADER + "#pragma omp parallel for\n", "OpenMP pragmas"),
    "zstd outside engine/io":
        ("render/b.h", HEADER + "#include <zstd.h>\n", "<zstd.h> lives only in engine/io"),
    "JSON in scenes":
        ("scenes/b.h", HEADER + "#include <nlohmann/json.hpp>\n", "lives only in engine/io"),
    "TOML in the engine":
        ("engine/io/b.h", HEADER + "#include <toml++/toml.h>\n", "lives only in scenes"),
    "the command line outside the program":
        ("scenes/b.h", HEADER + "#include <CLI/CLI.hpp>\n", "lives only in scenes/app"),
    "GL outside render":
        ("bench/c.h", HEADER + "#include <EGL/egl.h>\n", "lives only in render"),
    "a library nobody named":
        ("fracture/b.h", HEADER + "#include <boost/graph.hpp>\n", "belongs to no room"),
    "a source that CMake does not know":
        ("engine/base/b.cpp", "int b;\n", "listed in no CMakeLists.txt"),
    "a source outside the rooms":
        ("main.cpp", "int main() {}\n", "outside a room"),
    "a header without a guard":
        ("fracture/b.h", "// What it is for.\n", "no #pragma once"),
    "a page that names a file that is gone":
        ("docs/page.md", "See `engine/base/gone.h`.\n", "which is not there"),
    "a comment that names a file that is gone":
        ("fracture/b.h", "// As in engine/base/gone.h.\n#pragma once\n", "which is not there"),
    "a header that does not say what it is for":
        ("fracture/b.h", "#pragma once\n", "opens with a comment"),
}


def messages_of(files):
    """What check_rooms says about a tree of these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_rooms.check_tree(folder)


class CheckRooms(unittest.TestCase):
    def test_a_good_house_passes(self):
        self.assertEqual(messages_of(GOOD), [])

    def test_every_violation_is_found_alone(self):
        for what, (path, text, expected) in BAD.items():
            with self.subTest(what):
                messages = messages_of(GOOD | {path: text})
                self.assertEqual(len(messages), 1, messages)
                self.assertIn(str(Path(path).parent), messages[0])
                self.assertIn(expected, messages[0])


if __name__ == "__main__":
    unittest.main()
