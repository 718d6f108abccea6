#!/usr/bin/env python3
"""Makes small source trees with one violation each; check_layers.py has to find exactly that one."""
import tempfile
import unittest
from pathlib import Path

import check_layers

HEADER = "// A description.\n#pragma once\n"

# A source tree without violations.
GOOD = {
    "engine/CMakeLists.txt": "sunder_module(engine SOURCES base/a.cpp io/file.cpp)",
    "render/CMakeLists.txt": "sunder_module(render SOURCES ${CMAKE_CURRENT_BINARY_DIR}/made.cpp)",
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
    "solver/particles/tuning.h": HEADER,
    "fracture/tuning.h": HEADER,
    "fracture/pattern/p.h": HEADER + '#include "fracture/tuning.h"\n',
    "solver/rigid/body/low.h": HEADER + '#include "solver/rigid/tuning.h"\n',
    "render/r.h": HEADER + '#include <GL/glcorearb.h>\n#include "engine/world/w.h"\n',
    "scenes/s.h": HEADER + '#include <toml++/toml.h>\n#include "fracture/f.h"\n',
    "scenes/app/app.h": HEADER + '#include "scenes/s.h"\n#include "scenes/timing/time.h"\n'
                        'inline double half_width(double angle) { return std::tan(0.5 * angle); }\n',
    "scenes/timing/time.h": HEADER + '#include "scenes/report/page.h"\n',
    "scenes/report/page.h": HEADER + '#include "render/r.h"\n',
    "bench/b.h": HEADER + '#include <benchmark/benchmark.h>\n#include "tests/fixtures/f.h"\n',
    "tests/fixtures/f.h": HEADER + '#include "scenes/s.h"\n#include "solver/rigid/r.h"\n',
    "tests/t.h": HEADER + '#include <gtest/gtest.h>\n#include "bench/b.h"\n'
                 '#include "tests/fixtures/f.h"\n',
}

# Violation -> file to add to GOOD, its text, and a part of the expected message.
BAD = {
    "a layer includes a higher one":
        ("engine/base/b.h", HEADER + '#include "engine/world/w.h"\n', "may not include engine/world"),
    "a folder includes one of a higher layer":
        ("fracture/cut/b.h", HEADER + '#include "fracture/stress/s.h"\n', "not in a lower layer"),
    "a folder includes another one of its layer":
        ("fracture/vacd/b.h", HEADER + '#include "fracture/stress/s.h"\n', "not in a lower layer"),
    "a folder includes the module's own folder, which is higher":
        ("fracture/stress/b.h", HEADER + '#include "fracture/f.h"\n', "not in a lower layer"),
    "a header in a lower layer includes its folder":
        ("solver/rigid/tuning.h", HEADER + '#include "solver/rigid/r.h"\n',
         "not in a lower layer"),
    "a folder in no layer":
        ("solver/cloth/b.h", HEADER, "in no layer"),
    "two files of one name in a module":
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
        ("tests/b.h", HEADER + '#include "scenes/app/app.h"\n', "tests may not include scenes/app"),
    "scenes include the program":
        ("scenes/b.h", HEADER + '#include "scenes/app/app.h"\n',
         "scenes may not include scenes/app"),
    "the program includes a benchmark":
        ("scenes/app/b.h", HEADER + '#include "bench/b.h"\n', "scenes/app may not include bench"),
    "the commands' libraries include each other":
        ("scenes/trade/b.h", HEADER + '#include "scenes/timing/time.h"\n', "not in a lower layer"),
    "a fixture includes a benchmark":
        ("tests/fixtures/c.h", HEADER + '#include "bench/b.h"\n',
         "tests/fixtures may not include bench"),
    "a fixture includes a test":
        ("tests/fixtures/c.h", HEADER + '#include "tests/t.h"\n',
         "tests/fixtures may not include tests"),
    "an include is not spelled from the root":
        ("fracture/b.h", HEADER + '#include "f.h"\n', "not a path from the root"),
    "OpenMP outside its modules":
        ("engine/world/b.h", HEADER + "#include <omp.h>\n", "<omp.h> is allowed only in"),
    "an OpenMP pragma outside its modules":
        ("fracture/b.h", HEADER + "#pragma omp parallel for\n", "OpenMP pragmas"),
    "zstd outside engine/io":
        ("render/b.h", HEADER + "#include <zstd.h>\n", "<zstd.h> is allowed only in engine/io"),
    "JSON in scenes":
        ("scenes/b.h", HEADER + "#include <nlohmann/json.hpp>\n", "is allowed only in engine/io"),
    "TOML in the engine":
        ("engine/io/b.h", HEADER + "#include <toml++/toml.h>\n", "is allowed only in scenes"),
    "the command line outside the program":
        ("scenes/b.h", HEADER + "#include <CLI/CLI.hpp>\n", "is allowed only in scenes/app"),
    "GL outside render":
        ("bench/c.h", HEADER + "#include <EGL/egl.h>\n", "is allowed only in render"),
    "a library that is not listed":
        ("fracture/b.h", HEADER + "#include <boost/graph.hpp>\n", "is of no module"),
    "a source that CMake does not list":
        ("engine/base/b.cpp", "int b;\n", "listed in no CMakeLists.txt"),
    "a source outside the modules":
        ("main.cpp", "int main() {}\n", "outside the modules"),
    "a root of the C library":
        ("solver/rigid/b.h", HEADER + "inline double b(double x) { return std::cbrt(x); }\n",
         "std::cbrt differs between machines"),
    "a distribution of random numbers":
        ("fracture/b.h", HEADER + "inline std::normal_distribution<> b;\n",
         "std::normal_distribution differs between machines"),
    "a header without a guard":
        ("fracture/b.h", "// A description.\n", "no #pragma once"),
    "a page that names a file that does not exist":
        ("docs/page.md", "See `engine/base/gone.h`.\n", "which does not exist"),
    "a comment that names a file that does not exist":
        ("fracture/b.h", "// As in engine/base/gone.h.\n#pragma once\n", "which does not exist"),
    "a header without a description":
        ("fracture/b.h", "#pragma once\n", "begin with a comment"),
}


def messages_of(files):
    """Returns the messages of check_layers about a source tree of these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_layers.check_tree(folder)


class CheckLayers(unittest.TestCase):
    def test_a_tree_without_violations_passes(self):
        self.assertEqual(messages_of(GOOD), [])

    def test_every_violation_is_found_alone(self):
        for name, (path, text, expected) in BAD.items():
            with self.subTest(name):
                messages = messages_of(GOOD | {path: text})
                self.assertEqual(len(messages), 1, messages)
                self.assertIn(str(Path(path).parent), messages[0])
                self.assertIn(expected, messages[0])


if __name__ == "__main__":
    unittest.main()
