#!/usr/bin/env python3
"""Fails where a source breaks the plan of the house (docs/architecture.md, "Rooms").

Usage: check_rooms.py [ROOT]. Read first: the tables, then check_tree().
"""
import re
import sys
from pathlib import Path

ROOMS = ("engine", "fracture", "solver", "render", "scenes", "bench", "tests")

# The rooms within a room, from the lowest floor up; "" is the room's own folder. A file includes its
# own folder and those of lower floors: neither what is above, nor what is beside it. A header may
# lie on a lower floor than its folder.
FLOORS = {
    "engine": (("base",), ("geometry",), ("geometry/repair", "geometry/walls"), ("model",), ("model/checks",),
               ("world/actors",), ("world/break", "world/load", "world/act", "world/particles"), ("world",), ("io",),
               ("io/mesh", "io/recording")),
    "fracture": (("pattern",), ("adjacency",), ("cut",), ("stress", "vacd", "check"), ("",)),
    "solver": (("base",), ("impact", "rigid/tolerances.h"), ("rigid/body",), ("rigid/collide",),
               ("rigid/joint",), ("rigid/contact/kernels",), ("rigid/contact",),
               ("rigid", "planar", "particles")),
    "render": (("gl", "shaders"), ("image",), ("passes",), ("",)),
    "scenes": (("sculpture",), ("file",), ("structures",), ("",), ("app",)),
}
FLOOR_OF = {str(Path(room, folder)): floor for room, floors in FLOORS.items()
            for floor, folders in enumerate(floors) for folder in folders}

ROOM_LIBRARIES = tuple(FLOORS)

# Room -> the rooms its sources may include. Of scenes, only the library: nothing includes the
# program, which includes every room.
MAY_INCLUDE = {
    "engine": {"engine"},
    "fracture": {"engine", "fracture"},
    "solver": {"engine", "solver"},
    "render": {"engine", "render"},
    "scenes": {"engine", "fracture", "solver", "render", "scenes"},
    "scenes/app": {"engine", "fracture", "solver", "render", "scenes", "bench"},
    "bench": {"engine", "fracture", "solver", "render", "scenes", "bench"},
    "tests": set(ROOMS),
}

# Third-party header -> the places it lives in.
THIRD_PARTY = [
    (r"Eigen/.*", ROOMS),
    (r"omp\.h", ("engine/base/parallel", "solver/")),
    (r"nlohmann/.*", ("engine/io/", "tests/")),  # tests read the JSON as users do
    (r"(zstd.*\.h|xxhash\.h)", ("engine/io/",)),
    (r"box2d/.*", ("solver/planar/",)),
    (r"(EGL|GL|GLES\d|KHR|stb)/.*", ("render/",)),
    (r"toml\+\+/.*", ("scenes/",)),
    (r"CLI/.*", ("scenes/app/",)),
    (r"sunder/.*", ("tests/consumer/",)),  # the installed library, from outside
    (r"benchmark/.*", ("bench/",)),
    (r"(bullet/.*|bt[A-Z]\w*\.h|ode/.*)", ("bench/",)),
    (r"(gtest|gmock|rapidcheck)(/.*|\.h)", ("tests/",)),
]
SYSTEM = re.compile(r"[a-z_0-9]+|(sys|linux)/\w+\.h|(dlfcn|fcntl|malloc|sched|signal|spawn|"
                    r"unistd|poll|errno|(imm|x86|arm_neo)intrin|cpuid)\.h")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
# A file spelled from the root, in a page or a comment.
MENTION = re.compile(r"(?<![\w./*])((?:%s|docs|cmake)/[\w/-]+\.(?:h|cpp|py|md|toml|sh|cmake))\b"
                     % "|".join(ROOMS))
PRAGMA_OMP = re.compile(r"^\s*#\s*pragma\s+omp\b", re.MULTILINE)


def sources(root):
    """Paths of the rooms' C++ files, relative to the root, in order."""
    found = [path for room in ROOMS for path in (root / room).rglob("*")]
    return sorted(path.relative_to(root) for path in found if path.suffix in (".h", ".cpp"))


def owner(path):
    """The row of MAY_INCLUDE that a path belongs to."""
    return "scenes/app" if path.parts[:2] == ("scenes", "app") else path.parts[0]


def place(path):
    """The entry of FLOORS that a file belongs to: its own, or its folder's."""
    return str(path if str(path) in FLOOR_OF else path.parent)


def check_mentions(root, path):
    """Files that a page or a comment names, which must be there."""
    text = INCLUDE.sub("", (root / path).read_text(encoding="utf-8"))
    return [f'names "{name}", which is not there'
            for name in sorted(set(MENTION.findall(text)))
            if not (root / name).exists() and not (root / (name + ".in")).is_file()]


def check_own_include(root, path, target):
    """An include in quotes: spelled from the root, and towards a lower room or floor."""
    if not (root / target).is_file() and not (root / (target + ".in")).is_file():
        return f'"{target}" is not a path from the root of the project'
    target = Path(target)
    if owner(target) == "scenes/app" and owner(path) != "scenes/app":
        return f'"{target}": nothing includes the program'
    if target.parts[0] not in MAY_INCLUDE[owner(path)]:
        return f'{path.parts[0]} may not include {target.parts[0]}: "{target}"'
    mine, other = place(path), place(target)
    if path.parts[0] == target.parts[0] and mine != other and mine in FLOOR_OF:
        if FLOOR_OF.get(other, 99) >= FLOOR_OF[mine]:
            return f'{mine} may not include {other}, which is not below it: "{target}"'
    return None


def check_foreign_include(path, header):
    """An include in angle brackets: the standard library, or a third party in its room."""
    for pattern, places in THIRD_PARTY:
        if re.fullmatch(pattern, header):
            if str(path).startswith(tuple(places)):
                return None
            return f"<{header}> lives only in {', '.join(places)}"
    if SYSTEM.fullmatch(header):
        return None
    return f"<{header}> belongs to no room: use the C++ header, or name its room in check_rooms.py"


def check_folders(paths):
    """Folders that are on no floor, and names that a room has twice."""
    found = []
    units = sorted({path.with_suffix("") for path in paths})
    for folder in sorted({unit.parent for unit in units}):
        if folder.parts[0] in FLOORS and str(folder) not in FLOOR_OF:
            found.append(f"{folder}/: on no floor of FLOORS in check_rooms.py")
    first = {}
    for unit in units:
        room = owner(unit)
        other = first.setdefault((room, unit.name), unit)
        if room in ROOM_LIBRARIES and other != unit:
            found.append(f"{unit}: {room} has a file of that name already: {other}")
    return found


def check_source(root, path):
    """The messages about one source file."""
    text = (root / path).read_text(encoding="utf-8")
    found = []
    for bracket, target in INCLUDE.findall(text):
        found.append(check_foreign_include(path, target) if bracket == "<"
                     else check_own_include(root, path, target))
    if PRAGMA_OMP.search(text) and not str(path).startswith(("engine/base/parallel", "solver/")):
        found.append("OpenMP pragmas live only in engine/base/parallel and the solver")
    lines = text.splitlines() or [""]
    if path.suffix == ".h":
        if not lines[0].startswith("//"):
            found.append("a header opens with a comment that says what it is for")
        if "#pragma once" not in text:
            found.append("no #pragma once")
    return [message for message in found if message]


def listed(root):
    """The .cpp paths named in the rooms' CMakeLists.txt, relative to the root; generated ones,
    which begin with a variable, are not."""
    names = set()
    for room in ROOMS:
        for cmake in (root / room).rglob("CMakeLists.txt"):
            text = re.sub(r"#.*", "", cmake.read_text(encoding="utf-8"))
            names |= {(cmake.parent / name).resolve().relative_to(root)
                      for name in re.findall(r"(?<![\w./+}-])[\w.+-][\w./+-]*\.cpp\b", text)}
    return names


def check_tree(root):
    """Every message about the tree at `root`, as "path: message"."""
    root = Path(root).resolve()
    strays = [path for path in root.glob("*") if path.suffix in (".h", ".cpp")]
    messages = [f"{path.name}: no source lives outside a room" for path in strays]
    messages += check_folders(sources(root))
    in_cmake = listed(root)
    pages = [path.relative_to(root) for path in [*root.glob("*.md"), *root.glob("docs/**/*.md"),
                                                 *root.glob("scenes/**/*.md")]]
    for path in sorted(pages):
        messages += [f"{path}: {message}" for message in check_mentions(root, path)]
    for path in sources(root):
        messages += [f"{path}: {message}"
                     for message in check_source(root, path) + check_mentions(root, path)]
        if path.suffix == ".cpp" and path not in in_cmake:
            messages.append(f"{path}: listed in no CMakeLists.txt")
    return messages


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent
    messages = check_tree(root)
    print("\n".join(messages) or f"{len(sources(root.resolve()))} files are where they belong")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
