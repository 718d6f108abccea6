#!/usr/bin/env python3
"""Runs the program on random wrong inputs, the same for the same seed. Each must be refused with exit
code 1 or 2 and a short message that names the mistake; no file may be left behind or changed.

Usage: wrong_inputs.py PROGRAM GOLDENS [SEED [CASES]]. Begin reading at main(), then check(). Each
function in MAKERS returns the words of a wrong command line, and words of which the message must
contain one.
"""
import hashlib
import json
import os
import random
import shutil
import string
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

CASES = 260
LINES, CHARACTERS = 12, 3000  # largest lengths of a message

NO_NUMBERS = ["nan", "-nan", "inf", "-inf", "x", "1e400", "1,5", "0x10", "1 2", "--", "''", "∞", "1_000"]
NO_COUNTS = NO_NUMBERS + ["1.5", "1e3", "99999999999999999999", "1e24"]

MESH = "fracture t.obj --pattern voronoi:4"
# Valid commands, an option to add to each, and invalid values of the option.
OPTIONS = [
    ("simulate a.toml", "--frames", NO_COUNTS + ["-1", "0", "500"]),
    ("simulate a.toml", "--threads", NO_COUNTS + ["-1", "1025"]),
    ("simulate a.toml", "--preset", ["fast", "Draft", "1", "realtime "]),
    ("simulate a.toml", "--verify", ["nope.take", "d", "a.toml", "noise", "empty", "t.obj", "old.json"]),
    ("check a.toml", "--preset", ["fast", "REALTIME", "0"]),
    ("render a.toml -o x.png", "--speed", NO_NUMBERS + ["0", "-1", "1e9"]),
    ("render a.toml -o x.png", "--fps", NO_COUNTS + ["0", "-30", "1001"]),
    ("render a.toml -o x.png", "--sheet", NO_COUNTS + ["0", "-2", "1001"]),
    ("render a.toml -o x.png", "--samples", NO_COUNTS + ["0", "-1", "1025"]),
    ("render a.toml -o x.png", "--size", ["100", "1x1", "-64x64", "64x-64", "9999x64", "64x64x64", "axb", "nanxnan"]),
    ("render a.toml -o x.png", "--frames", ["5:2", "99", "-1", "a:b", ":", "1:2:3", "1.5", "nan"]),
    ("render a.toml -o x.png", "--view", ["nowhere", "orbit:x", "orbit:nan", "follow:nobody", "nope.toml", "d.toml"]),
    ("render a.toml -o x.png", "--view-mode", ["pretty", "stres", "0"]),
    ("render a.toml -o x.png", "--also", ["smell", "depth,smell", "dept"]),
    ("render a.toml -o x.png", "--gl", ["vulkan", "egl-device:-1", "egl-device:99", "egl-device:x"]),
    ("render k.take -o x.png", "--preset", ["draft"]),
    (MESH, "--radius", NO_NUMBERS + ["0", "-1", "1e10"]),
    (MESH, "--seed", NO_COUNTS + ["-1", "-5"]),
    (MESH, "--at", ["1,2", "1,2,3,4", "a,b,c", "nan,0,0", "1;2;3", "inf,0,0", ",,"]),
    (MESH, "--explode", NO_NUMBERS + ["-1", "1e9"]),
    (MESH, "--walls", ["maybe", "on", "0"]),
    (MESH, "--nodes", ["nope.txt", "0", "-5", "1.5", "d", "noise", "99999999999"]),
    (MESH, "--convexes", NO_COUNTS + ["0", "-3"]),
    (MESH, "--fit", ["round", "hull:2", "hull:nan", "15dop", "hull"]),
    (MESH, "--repair", ["maybe", "on", "1"]),
    ("fracture t.obj", "--pattern", [
        "voronoi:0", "voronoi:nan", "voronoi:6000", "voronoi:1.5", "voronoi:5,0.5", "web:3", "web:0x5", "web:3x2",
        "radial:2", "radial:x", "brick:0,1,1", "brick:1,1", "brick:nan,1,1", "slabs:0", "slabs:-1", "grid:31",
        "grid:1000", "circles:3", "voronoi", "nope.obj", ":", "voronoi:"]),
    ("vacd t.obj", "--convexes", NO_COUNTS + ["0", "-1"]),
    ("vacd t.obj", "--fit", ["hull:1000000", "cube", "26"]),
    ("hull t.obj", "--vertices", NO_COUNTS + ["3", "-4", "10001"]),
    ("bench a.toml --hashes h", "--repeats", NO_COUNTS + ["0", "-1", "1001"]),
    ("bench a.toml --hashes h", "--warm-up", NO_COUNTS + ["-1", "1001"]),
    ("bench a.toml --hashes h", "--compare", ["nope.json", "a.toml", "empty.json", "d", "bad.json", "noise"]),
    ("bench a.toml --hashes h", "--against", ["nope", "a.toml", "d"]),
    ("bench a.toml --hashes h", "--fail-slower", ["10%", "ten", "-5%", "nan"]),
    ("bench --hashes h", "--from", ["nope.json", "a.toml", "d", "bad.json", "empty.json"]),
    ("bench a.toml", "--hashes", ["d", "t.obj", "noise"]),
    ("trade a.toml --list", "--seeds", NO_COUNTS + ["0", "-1", "10001"]),
    ("trade a.toml --list", "--equal", NO_COUNTS + ["0", "-1"]),
    ("trade a.toml --equal 9 --list", "--pool", NO_COUNTS + ["0", "-1", "15", "10001"]),
    ("trade a.toml --list", "--shard", ["3/2", "0/2", "a/b", "1", "1/0", "-1/2", "1/2/3"]),
    ("trade a.toml --list", "--points", ["nope", "d", "t.obj", "noise"]),
    ("trade a.toml --list", "--switch", ["x", "=1", "solver.sweeps="]),
    ("trade a.toml -o out", "--switch", ["nope.key=1", "solver.sweeps=0"]),
    ("golden test --folder g", "--gl", ["vulkan", "egl-device:x"]),
    ("golden test", "--folder", ["nope", "a.toml"]),
    ("golden record n a.toml --folder g", "--size", ["3", "0x0", "xx"]),
    ("golden record n a.toml 0 --folder g --size 32x32", "--view-mode", ["pretty"]),
]

# Keys of scenes, and invalid values of each.
KEYS = [
    ("accuracy.dt_s", ["nan", "0", "-1", "0.01", "'fast'", "[1]"]),
    ("accuracy.substeps", ["0", "-1", "1.5", "1e9", "true", "nan"]),
    ("scene.duration_s", ["-1", "nan", "inf", "'long'"]),
    ("scene.gravity", ["[0, nan, 0]", "[0, 1]", "9.81", "[1e30, 0, 0]"]),
    ("scene.seed", ["-1", "1.5", "'x'", "nan"]),
    ("limits.bodies", ["-5", "nan", "1.5", "'many'"]),
    ("solver.sweeps", ["0", "-1", "1e9", "'x'"]),
    ("solver.sleeping", ["1", "'yes'", "nan"]),
    ("solid.0.size_m", ["[1, -1, 1]", "[1, 1]", "[0, 0, 0]", "[nan, 1, 1]", "1", "'big'", "[1, 1, 1e9]"]),
    ("solid.0.structure", ["'boxx'", "''", "1", "'mesh'"]),
    ("solid.0.material", ["'cheese'", "1", "''"]),
    ("solid.0.position", ["[0, nan, 0]", "[0]", "'here'", "[inf, 0, 0]"]),
    ("solid.0.nope", ["1"]),
    ("solid.9.name", ["'x'"]),
    ("solid.x.name", ["'x'"]),
    ("nope.key", ["1"]),
    ("view.fov_deg", ["nan", "0", "-1", "500"]),
    ("view.eye", ["[0, 0]", "[nan, 0, 0]", "'above'"]),
]

# Commands that take a file as their last word and read it first, by the ending of the file.
READERS = {
    "toml": ["check", "simulate", "render -o x.png"],
    "take": ["simulate a.toml --verify", "render -o x.png"],
    "frame": ["render -o x.png", "golden record n --folder g"],
    "obj": ["fracture --pattern voronoi:4", "vacd", "hull --vertices 8"],
    "glb": ["fracture --pattern voronoi:4", "vacd", "hull --vertices 8"],
    "stl": ["fracture --pattern voronoi:4", "vacd", "hull --vertices 8"],
    "case": ["fracture"],
    "json": ["bench a.toml --hashes h --compare", "bench --hashes h --from"],
}

OUTPUTS = [
    ("simulate a.toml", ["--json", "--take", "--trace"]),
    ("check a.toml", ["--json"]),
    ("list", ["--json"]),
    (MESH, ["--json", "-o"]),
    ("vacd t.obj", ["--json", "-o"]),
    ("hull t.obj --vertices 4", ["--json"]),
    ("bench --hashes h --from old.json", ["--json", "--junit", "--page"]),
    ("render a.toml --size 32x32 --frames 0", ["-o"]),
]
NO_PLACES = ["a.toml/x.json", "t.obj/d/x.glb", "/proc/nope/x.json", "/dev/null/x.png", "d", "noise/"]

INPUTS = [
    ("simulate a.toml", ["--json", "--take", "--trace"], "a.toml"),
    ("simulate a.toml --verify k.take", ["--json", "--take", "--trace"], "k.take"),
    (MESH, ["--json", "-o"], "t.obj"),
    ("bench --hashes h --from old.json", ["--json", "--junit", "--page"], "old.json"),
    ("render k.take --size 32x32 -o x.png", ["--json"], "k.take"),
    ("trade a.toml --list", ["--json"], "a.toml"),
]

MISSING = [
    ("", "commands"), ("simulate", "SCENE"), ("check", "SCENE"), ("render a.toml", "output"), ("render -o x.png", "SCENE"),
    ("fracture", "MESH"), ("fracture t.obj", "--pattern"), ("vacd", "MESH"), ("hull t.obj", "vertices"), ("hull", "MESH"),
    ("trade", "SCENE"), ("trade a.toml", "-o"), ("golden", "commands"), ("golden record", "NAME"),
    ("golden record n", "SCENE"), ("golden accept", "NAME"), ("simulate a.toml --frames", "--frames"),
    ("simulate a.toml --json", "--json"), ("render a.toml -o", "-o"), ("simulate a.toml b.toml", "b.toml"),
    ("simulate a.toml --set", "--set"), ("simulate a.toml --set x", "key=value"), ("simulate a.toml --set =1", "key=value"),
]

COMMANDS = ["list", "check", "simulate", "render", "bench", "trade", "fracture", "vacd", "hull", "golden"]


def misspelt(word, chance):
    """Returns the word with one letter changed, left out, doubled or inserted."""
    while True:
        at = chance.randrange(len(word))
        letter = chance.choice(string.ascii_lowercase)
        changed = chance.choice([word[:at] + letter + word[at + 1:], word[:at] + word[at + 1:],
                                 word[:at] + word[at] + word[at:], word[:at] + letter + word[at:]])
        if changed != word and changed.strip("-"):
            return changed


def a_wrong_value(chance, _):
    command, option, values = chance.choice(OPTIONS)
    value = chance.choice(values)
    return [*command.split(), option, value], [option, option.strip("-"), value.strip("'")]


def a_wrong_key(chance, _):
    key, values = chance.choice(KEYS)
    value = chance.choice(values).replace("'", '"')
    command = chance.choice(["check a.toml", "simulate a.toml", "render a.toml -o x.png", "trade a.toml -o out",
                             "bench a.toml --hashes h --repeats 1 --warm-up 0"])
    return [*command.split(), "--set", f"{key}={value}"], [key.split(".")[-1], key.split(".")[0], key]


def a_misspelt_option(chance, _):
    command, option, values = chance.choice([row for row in OPTIONS if row[1].startswith("--")])
    wrong = "--" + misspelt(option[2:], chance)
    return [*command.split(), wrong, "1"], [wrong, wrong.split("=")[0]]


def a_misspelt_command(chance, _):
    wrong = misspelt(chance.choice(COMMANDS), chance)
    return [wrong, "a.toml"], [wrong]


def a_misspelt_key(chance, folder):
    lines = (folder / "a.toml").read_text().splitlines()
    at = chance.choice([i for i, line in enumerate(lines) if "=" in line])
    key, value = lines[at].split(" = ")
    wrong = misspelt(key, chance)
    lines[at] = f"{wrong} = {value}"
    return made(chance, folder, "toml", "\n".join(lines).encode()), [wrong]


def a_file_cut_short(chance, folder):
    """Makes a truncated file of a kind that has its length, or of TOML or JSON."""
    name = chance.choice(["k.take", "s.frame", "m.glb", "m.stl", "a.toml", "old.json", "b.case"])
    whole = (folder / name).read_bytes()
    first_frame = 60  # bytes: a recording cut after its first frame can still be played
    end = chance.randrange(first_frame if name == "k.take" else len(whole) - 1)
    part = whole[:end]
    if name == "a.toml":
        try:
            tomllib.loads(part.decode())
            part += b"["
        except tomllib.TOMLDecodeError:
            pass
    return made(chance, folder, name.split(".")[-1], part), ["wrong."]


def a_file_of_noise(chance, folder):
    kind = chance.choice(sorted(READERS))
    noise = chance.randbytes(chance.choice([0, 1, 7, 100, 5000])).replace(b"#", b"$")
    return made(chance, folder, kind, noise + b"\x00=" if kind == "toml" else noise), ["wrong."]


def a_file_of_another_kind(chance, folder):
    kind = chance.choice(sorted(READERS))
    sources = ["a.toml", "t.obj", "m.glb", "old.json"]
    if kind not in ("toml", "take", "frame"):  # `render` knows recordings and frames by their content
        sources += ["k.take", "s.frame"]
    source = chance.choice([name for name in sources if not name.endswith(kind)])
    if (kind, source) == ("stl", "t.obj"):
        source = "a.toml"
    return made(chance, folder, kind, (folder / source).read_bytes()), ["wrong."]


def a_nested_file(chance, folder):
    """Makes a file of thousands of keys, tables or arrays within each other."""
    deep = chance.choice([40, 300, 20000, 200000])
    kind, text = chance.choice([("toml", "a" + ".a" * deep + " = 1"), ("toml", "[a" + ".a" * deep + "]"),
                                ("toml", "[[a" + ".a" * deep + "]]"), ("toml", "a = " + "[" * deep + "]" * deep),
                                ("toml", "a = " + "{a = " * deep + "1" + "}" * deep),
                                ("json", "[" * deep + "]" * deep), ("json", '{"a":' * deep + "1" + "}" * deep)])
    start = (folder / "a.toml").read_text() if kind == "toml" else ""
    return made(chance, folder, kind, (start + text).encode()), ["wrong."]


def made(chance, folder, kind, content):
    """Writes a file with that content, before the folder is compared; returns a command that reads it."""
    (folder / f"wrong.{kind}").write_bytes(content)
    return [*chance.choice(READERS[kind]).split(), f"wrong.{kind}"]


def no_such_file(chance, _):
    kind = chance.choice(sorted(READERS))
    if kind == "case":
        return ["fracture", "nope.case"], ["nope.case"]
    name = chance.choice(["nope." + kind, "nowhere/x." + kind, "d", "d/", "/dev/null", "x" * 300 + "." + kind, "é\n." + kind])
    if name.startswith("d") and kind in ("json", "take"):
        name = "nope"
    return [*chance.choice(READERS[kind]).split(), name], [name.strip("/"), repr(name), name[:40], "empty"]


def no_such_place(chance, _):
    command, options = chance.choice(OUTPUTS)
    option, place = chance.choice(options), chance.choice(NO_PLACES)
    if option == "-o" and place == "d":
        place = "a.toml/x.png"
    return [*command.split(), option, place], [place, option, str(Path(place).parent), place.split("/")[0]]


def an_output_that_is_read(chance, _):
    command, options, name = chance.choice(INPUTS)
    other = chance.choice([name, "./" + name, "d/../" + name])
    return [*command.split(), chance.choice(options), other], [name]


def something_missing(chance, _):
    words, named = chance.choice(MISSING)
    return words.split(), [named, named.strip("-")]


MAKERS = [(a_wrong_value, 8), (a_wrong_key, 4), (a_misspelt_option, 2), (a_misspelt_command, 1), (a_misspelt_key, 2),
          (a_file_cut_short, 3), (a_file_of_noise, 2), (a_nested_file, 2), (a_file_of_another_kind, 3), (no_such_file, 2),
          (no_such_place, 2), (an_output_that_is_read, 1), (something_missing, 2)]


def binary_stl():
    triangles = [((0, 0, 0), (0, 1, 0), (1, 0, 0)), ((0, 0, 0), (1, 0, 0), (0, 0, 1)),
                 ((0, 0, 0), (0, 0, 1), (0, 1, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    import struct
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *(x for corner in t for x in corner), 0) for t in triangles)
    return b"\0" * 80 + struct.pack("<I", len(triangles)) + rows


def make_inputs(program, goldens, folder):
    """Writes valid and invalid input files."""
    (folder / "a.toml").write_text('[scene]\ndescription = "a block"\nduration_s = 0.2\n[[solid]]\nstructure = "box"\n'
                                   'size_m = [1, 1, 1]\nmaterial = "concrete"\n')
    (folder / "t.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    (folder / "m.stl").write_bytes(binary_stl())
    (folder / "noise").write_bytes(random.Random(1).randbytes(300))
    (folder / "empty").touch()
    (folder / "empty.json").write_text("{}")
    (folder / "bad.json").write_text("{")
    (folder / "d").mkdir()
    (folder / "d.toml").mkdir()
    (folder / "g").mkdir()
    shutil.copy(goldens / "stack.frame", folder / "s.frame")
    for name in ("stack.frame", "stack.json", "stack.png", "hashes.txt"):
        shutil.copy(goldens / name, folder / "g")
    shutil.copy(next(iter(sorted((goldens.parent / "fuzz/corpus/case").iterdir()))), folder / "b.case")
    for words in ("simulate a.toml --take k.take --json old.json", "fracture t.obj --pattern grid:2 -o m.glb",
                  "bench --hashes h --from old.json --accept"):
        run(program, folder, words.split())


def run(program, folder, words):
    environment = dict(os.environ, SUNDER_CACHE=str(folder) + "-cache", OMP_WAIT_POLICY="passive")
    return subprocess.run([program, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL, timeout=60,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def contents(folder):
    """Returns all paths in the folder, with a hash of each file."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""
            for path in sorted(folder.rglob("*"))}


def check(program, folder, words, named):
    """Runs the command; returns the mistakes in how the program refused it, or an empty string."""
    before = contents(folder)
    try:
        done = run(program, folder, words)
    except subprocess.TimeoutExpired:
        return "takes over a minute"
    said = done.stderr.decode(errors="replace")
    after = contents(folder)
    wrong = []
    if done.returncode not in (1, 2):
        wrong.append(f"exit code {done.returncode}")
    if not said.strip():
        wrong.append("no message")
    if said.count("\n") > LINES or len(said) > CHARACTERS:
        wrong.append(f"a message of {said.count(chr(10))} lines, {len(said)} characters")
    if not any(word and word in said for word in named):
        wrong.append(f"a message that names none of {named}")
    if before != after:
        changed = sorted(name for name in before.keys() | after.keys() if before.get(name) != after.get(name))
        wrong.append(f"left behind or changed {changed}")
        for name in set(after) - set(before):
            path = folder / name
            shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)
    return "; ".join(wrong) + (f"\n    said: {said.strip()[:600]}" if wrong else "")


def main(program, goldens, seed=1, cases=CASES):
    chance = random.Random(seed)
    makers = [maker for maker, weight in MAKERS for _ in range(weight)]
    failed = 0
    seen = set()
    with tempfile.TemporaryDirectory(prefix="sunder-wrong-") as place:
        folder = Path(place) / "in"
        folder.mkdir()
        make_inputs(program, Path(goldens), folder)
        while len(seen) < cases:
            words, named = chance.choice(makers)(chance, folder)
            key = (tuple(words), contents(folder).get(words[-1]) if words else "")
            if key in seen:
                continue
            seen.add(key)
            wrong = check(program, folder, words, named)
            for left in folder.glob("wrong.*"):
                left.unlink()
            if wrong:
                failed += 1
                print(f"sunder {' '.join(words)}\n    {wrong}")
    print(f"{len(seen)} wrong inputs, {failed} of them not refused as they should be")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(str(Path(sys.argv[1]).resolve()), sys.argv[2], *(int(word) for word in sys.argv[3:])))
