#!/usr/bin/env python3
"""Fails if a source violates the order of modules and layers (docs/architecture.md, "Modules").

Usage: check_layers.py [ROOT]. Read first: the tables, then check_tree().
"""
import re
import sys
from pathlib import Path

MODULES = ("engine", "fracture", "solver", "render", "scenes", "bench", "tests", "examples")

# Layers of each module, from the lowest up; "" is the module's own folder. A file may include files
# of its own folder and of lower layers, but not of higher ones or of another folder of its layer. A
# header may be in a lower layer than its folder.
LAYERS = {
    "engine": (("base",), ("geometry",), ("geometry/repair", "geometry/walls"), ("model",),
               ("model/checks", "world/tuning.h"), ("world/actors",),
               ("world/break", "world/load", "world/act", "world/particles"), ("world",), ("io",),
               ("io/mesh", "io/recording"), ("io/scene_export",)),
    "fracture": (("tuning.h",), ("pattern",), ("adjacency",), ("cut",), ("stress", "vacd", "check"), ("",)),
    "solver": (("base",), ("impact", "rigid/tuning.h"), ("rigid/body",), ("rigid/collide",),
               ("rigid/joint",), ("rigid/contact/kernels",), ("rigid/contact",),
               ("rigid", "planar", "particles")),
    "render": (("gl", "shaders"), ("image",), ("passes",), ("",)),
    "scenes": (("sculpture",), ("file",), ("structures",), ("",), ("report", "api", "api/python"),
               ("timing", "trade"), ("app",)),
}
LAYER_OF = {str(Path(module, folder)): layer for module, layers in LAYERS.items()
            for layer, folders in enumerate(layers) for folder in folders}

MODULE_LIBRARIES = tuple(LAYERS)

# Module, or folder with rules of its own -> those that its sources may include. Nothing includes
# the program, scenes/app; bench and tests share the fixtures in tests/fixtures.
LIBRARIES = {"engine", "fracture", "solver", "render", "scenes"}
MAY_INCLUDE = {
    "engine": {"engine"},
    "fracture": {"engine", "fracture"},
    "solver": {"engine", "solver"},
    "render": {"engine", "render"},
    "scenes": LIBRARIES,
    "scenes/app": LIBRARIES | {"scenes/app"},
    "tests/fixtures": LIBRARIES | {"tests/fixtures"},
    "bench": LIBRARIES | {"tests/fixtures", "bench"},
    "tests": LIBRARIES | {"tests/fixtures", "bench", "tests"},
    "examples": {"examples"},
}

# Third-party header -> the modules or paths that may include it.
THIRD_PARTY = [
    (r"Eigen/.*", MODULES),
    (r"omp\.h", ("engine/base/parallel", "solver/")),
    (r"nlohmann/.*", ("engine/io/", "tests/")),  # tests parse the JSON of the program
    (r"(zstd.*\.h|xxhash\.h)", ("engine/io/",)),
    (r"box2d/.*", ("solver/planar/",)),
    (r"(EGL|GL|GLES\d|KHR|stb)/.*", ("render/",)),
    (r"toml\+\+/.*", ("scenes/",)),
    (r"CLI/.*", ("scenes/app/",)),
    (r"pybind11/.*", ("scenes/api/python/",)),
    (r"sunder/.*", ("tests/consumer/", "examples/")),  # the installed library
    (r"benchmark/.*", ("bench/",)),
    (r"(bullet/.*|bt[A-Z]\w*\.h|ode/.*)", ("bench/",)),
    (r"(gtest|gmock|rapidcheck)(/.*|\.h)", ("tests/",)),
]
SYSTEM = re.compile(r"[a-z_0-9]+|(sys|linux)/\w+\.h|(dlfcn|fcntl|link|malloc|sched|signal|spawn|"
                    r"unistd|poll|errno|(imm|x86|arm_neo)intrin|cpuid)\.h")
# Headers of C, for sources in C and for the header that is for both languages.
C_SYSTEM = re.compile(r"(math|std(bool|def|int|io|lib)|string|time)\.h")
C_HEADER = "scenes/api/sunder_c.h"
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
# The path of a file from the root, in a page or a comment.
MENTION = re.compile(r"(?<![\w./*])((?:%s|docs|cmake)/[\w/-]+\.(?:h|cpp|py|md|toml|sh|cmake))\b"
                     % "|".join(MODULES))
# Functions and types of the standard library whose results differ between processors, compilers or
# libraries, and the sources that may use them, because they simulate nothing.
UNEQUAL = re.compile(r"\bstd::((?:a?(?:sin|cos|tan)h?|atan2|exp2?|expm1|log(?:2|10|1p)?|pow|cbrt|"
                     r"hypot|fma|erfc?|[lt]gamma)[fl]?(?=\()|hash\b|shuffle\b|random_device\b|"
                     r"\w+_distribution\b)")
SIMULATING = ("engine/", "fracture/", "solver/", "scenes/")
NOT_SIMULATING = ("engine/io/scene_export/", "scenes/app/", "scenes/report/", "scenes/timing/",
                  "scenes/trade/")
PRAGMA_OMP = re.compile(r"^\s*#\s*pragma\s+omp\b", re.MULTILINE)


def sources(root):
    """Returns the paths of the modules' sources in C++ and C, relative to the root, sorted."""
    found = [path for module in MODULES for path in (root / module).rglob("*")]
    return sorted(path.relative_to(root) for path in found if path.suffix in (".h", ".cpp", ".c"))


def owner(path):
    """Returns the row of MAY_INCLUDE that a path belongs to."""
    folder = "/".join(path.parts[:2])
    return folder if folder in MAY_INCLUDE else path.parts[0]


def place(path):
    """Returns the entry of LAYERS that a file belongs to: its own, or that of its folder."""
    return str(path if str(path) in LAYER_OF else path.parent)


def check_mentions(root, path):
    """Returns messages about files that a page or a comment names and that do not exist."""
    text = INCLUDE.sub("", (root / path).read_text(encoding="utf-8"))
    return [f'names "{name}", which does not exist'
            for name in sorted(set(MENTION.findall(text)))
            if not (root / name).exists() and not (root / (name + ".in")).is_file()]


def check_own_include(root, path, target):
    """Returns a message if an include in quotes is not a root path to a lower module or layer."""
    if not (root / target).is_file() and not (root / (target + ".in")).is_file():
        return f'"{target}" is not a path from the root of the project'
    target = Path(target)
    if owner(target) not in MAY_INCLUDE[owner(path)]:
        return f'{owner(path)} may not include {owner(target)}: "{target}"'
    mine, other = place(path), place(target)
    if path.parts[0] == target.parts[0] and mine != other and mine in LAYER_OF:
        if LAYER_OF.get(other, 99) >= LAYER_OF[mine]:
            return f'{mine} may not include {other}, which is not in a lower layer: "{target}"'
    return None


def check_foreign_include(path, header):
    """Returns a message if an include in angle brackets is neither standard nor allowed here."""
    for pattern, places in THIRD_PARTY:
        if re.fullmatch(pattern, header):
            if str(path).startswith(tuple(places)):
                return None
            return f"<{header}> is allowed only in {', '.join(places)}"
    is_c = path.suffix == ".c" or str(path) == C_HEADER
    if (C_SYSTEM if is_c else SYSTEM).fullmatch(header):
        return None
    return f"<{header}> is of no module: use the C++ header, or add it in check_layers.py"


def check_folders(paths):
    """Returns messages about folders in no layer, and about names that a module has twice; tuning.h
    may be in several folders."""
    found = []
    units = sorted({path.with_suffix("") for path in paths})
    for folder in sorted({unit.parent for unit in units}):
        if folder.parts[0] in LAYERS and str(folder) not in LAYER_OF:
            found.append(f"{folder}/: in no layer of LAYERS in check_layers.py")
    first = {}
    for unit in units:
        module = owner(unit)
        other = first.setdefault((module, unit.name), unit)
        if module in MODULE_LIBRARIES and other != unit and unit.name != "tuning":
            found.append(f"{unit}: {module} has a file of that name already: {other}")
    return found


def check_source(root, path):
    """Returns the messages about one source file."""
    text = (root / path).read_text(encoding="utf-8")
    found = []
    for bracket, target in INCLUDE.findall(text):
        found.append(check_foreign_include(path, target) if bracket == "<"
                     else check_own_include(root, path, target))
    if PRAGMA_OMP.search(text) and not str(path).startswith(("engine/base/parallel", "solver/")):
        found.append("OpenMP pragmas are allowed only in engine/base/parallel and the solver")
    if str(path).startswith(SIMULATING) and not str(path).startswith(NOT_SIMULATING):
        found += [f"std::{name} differs between machines: use engine/base"
                  for name in sorted({match[1] for match in UNEQUAL.finditer(text)})]
    lines = text.splitlines() or [""]
    if path.suffix == ".h":
        if not lines[0].startswith("//"):
            found.append("a header has to begin with a comment that describes it")
        if "#pragma once" not in text:
            found.append("no #pragma once")
    return [message for message in found if message]


def listed(root):
    """Returns the .cpp and .c paths that the modules' CMakeLists.txt name, relative to the root, without
    generated ones, which begin with a variable."""
    names = set()
    for module in MODULES:
        for cmake in (root / module).rglob("CMakeLists.txt"):
            text = re.sub(r"#.*", "", cmake.read_text(encoding="utf-8"))
            names |= {(cmake.parent / name).resolve().relative_to(root)
                      for name in re.findall(r"(?<![\w./+}-])[\w.+-][\w./+-]*\.(?:cpp|c)\b", text)}
    return names


def check_tree(root):
    """Returns all messages about the source tree at `root`, as "path: message"."""
    root = Path(root).resolve()
    strays = [path for path in root.glob("*") if path.suffix in (".h", ".cpp", ".c")]
    messages = [f"{path.name}: a source outside the modules" for path in strays]
    messages += check_folders(sources(root))
    in_cmake = listed(root)
    pages = [path.relative_to(root) for path in [*root.glob("*.md"), *root.glob("docs/**/*.md"),
                                                 *root.glob("scenes/**/*.md")]]
    for path in sorted(pages):
        messages += [f"{path}: {message}" for message in check_mentions(root, path)]
    for path in sources(root):
        messages += [f"{path}: {message}"
                     for message in check_source(root, path) + check_mentions(root, path)]
        if path.suffix in (".cpp", ".c") and path not in in_cmake:
            messages.append(f"{path}: listed in no CMakeLists.txt")
    return messages


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent
    messages = check_tree(root)
    print("\n".join(messages) or f"{len(sources(root.resolve()))} files, no violations")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
