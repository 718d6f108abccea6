#!/usr/bin/env python3
"""Checks the pages against the source tree and the program: links and anchors, the options of
docs/cli.md, the JSON keys of docs/json.md, the commands in code blocks, and the length of README.md.

Usage: check_docs.py ROOT PROGRAM. Takes about fifteen seconds. Read first: main().

Commands of the code blocks of README.md, docs/*.md and bench/README.md are run in a new folder
(make_folder()). Long ones are shortened, as shorten() has it:
  simulate         runs at most 3 frames;
  export, view     write 3 frames of a scene; view is left out where three.js is not installed;
  render           draws 2 frames, or a sheet of 2, of 64x48 pixels unless the command has a size;
  bench            runs 2 frames of each scene once, without warm-up, and of one scene nine times if
                   times are judged; accepts states of one scene;
  trade            lists its runs (--list);
  golden           runs on a folder with one golden.
The lines of docs/cli.md that show the syntax of a command are run as SYNTAX has them. Other commands
(cmake, git, scripts and benchmarks) are not run; the files, presets and targets that they name have
to exist.
"""
import glob
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

MAX_README_LINES = 120
COMMANDS = ("list", "check", "simulate", "render", "export", "view", "bench", "trade", "fracture",
            "vacd", "hull", "golden", "doctor")
GOLDEN = "stack"  # the quickest to test

# Sections of docs/cli.md, beside its own, that have options of a command.
SHARED_SECTIONS = {name: ["Arguments and common options"] for name in COMMANDS}
SHARED_SECTIONS["fracture"] = SHARED_SECTIONS["vacd"] = ["Arguments and common options", "Meshes"]

# Line of docs/cli.md that shows the syntax of a command -> commands that have it.
SYNTAX = {
    "sunder list [--keys]": ["sunder list", "sunder list --keys"],
    "sunder check SCENE...": ["sunder check stack glass"],
    "sunder simulate SCENE": ["sunder simulate stack"],
    "sunder simulate --resume FILE":
        ["sunder simulate stack --save-at 0 stack.state", "sunder simulate --resume stack.state"],
    "sunder render SCENE|X.take|X.frame -o X.mp4|X.webm|X.png|DIR/":
        ["sunder render stack -o x.png", "sunder render house.take -o frames/",
         "sunder render tests/golden/stack.frame -o x.webm"],
    "sunder export SCENE|X.take -o X.glb|DIR/":
        ["sunder export stack -o x.glb", "sunder export house.take -o meshes/"],
    "sunder view SCENE|X.take|X.glb -o X.html":
        ["sunder view stack -o x.html", "sunder view house.take -o x.html"],
    "sunder bench [SCENE...]": ["sunder bench", "sunder bench stack"],
    "sunder trade SCENE... -o DIR": ["sunder trade stack glass -o out/trade"],
    "sunder fracture MESH --pattern SPEC [--at X,Y,Z] [--radius R]":
        ["sunder fracture box:1,1,1 --pattern voronoi:8",
         "sunder fracture tetrahedron.obj --pattern grid:2 --at 0,0,0 --radius 0.5"],
    "sunder fracture X.case": [],  # no command writes a case at will; tests/fracture has cases
    "sunder vacd MESH [--nodes N|FILE] [--convexes N] [-o X.glb|X.png|DIR/] [--hulls X.glb|X.obj]":
        ["sunder vacd tetrahedron.obj", "sunder vacd tetrahedron.obj --nodes 2 -o x.glb",
         "sunder vacd tetrahedron.obj --nodes set.nodes -o x.png",
         "sunder vacd tetrahedron.obj --convexes 2 -o pieces/"],
    "sunder hull MESH --vertices N": ["sunder hull box:1,1,1 --vertices 8"],
    "sunder doctor": ["sunder doctor"],
    "sunder golden test|report [NAME...]":
        ["sunder golden test", "sunder golden report " + GOLDEN],
    "sunder golden accept NAME...": ["sunder golden accept " + GOLDEN],
    "sunder golden record NAME SCENE FRAME":
        ["sunder golden record made stack 1 --folder out/goldens"],
    "sunder golden record NAME X.frame":
        [f"sunder golden record other tests/golden/{GOLDEN}.frame --size 64x48 --folder out/goldens"],
}

# Commands whose JSON docs/json.md describes. The last three need an OpenGL context.
JSON_COMMANDS = (
    "list", "check stack", "check wrong.toml", "simulate glass --frames 80",
    "bench glass --frames 60 --repeats 1 --warm-up 0 --features --set scene.seed=2",
    "bench stack --frames 2 --repeats 9 --warm-up 0 --draw 1 --against build/sunder",
    "simulate stack --frames 2 --without sleeping",
    "trade stack --frames 2 --seeds 1 -o out/trade",
    "fracture tetrahedron.obj --pattern voronoi:8", "vacd tetrahedron.obj --nodes 2",
    "hull box:1,1,1 --vertices 8", "render stack -o x.png --frames 0 --size 64x48",
    "export stack -o x.glb --frames 3", "view stack -o x.html --frames 3",
    "golden test " + GOLDEN, "doctor")

# Paths in the JSON whose keys are names of stages, parts of work, features or keys of a scene.
NAMES = re.compile(r"(.*/)?(stages|stages_ms|stages_cpu_ms|repeat_ms|modelled|features|set|work|"
                   r"work/[a-z ]+)")

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def pages(root):
    """Returns the Markdown files of the tree."""
    return sorted(path for path in [*root.glob("*.md"),
                                    *(page for folder in ("docs", "scenes", "bench", "tests", "engine",
                                                          "fracture", "solver", "render", "cmake")
                                      for page in (root / folder).rglob("*.md"))])


def without_blocks(text):
    """Returns a page with its fenced code blocks blanked."""
    return re.sub(r"(?ms)^```.*?^```", lambda block: re.sub(r"[^\n]", "", block.group()), text)


def anchors(page):
    """Returns the anchors of a page's headings, as GitHub makes them."""
    found = set()
    for heading in re.findall(r"(?m)^#{1,6} +(.*)$", without_blocks(page.read_text(encoding="utf-8"))):
        text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.strip()).lower()
        name = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        number, unique = 0, name
        while unique in found:
            number += 1
            unique = f"{name}-{number}"
        found.add(unique)
    return found


def check_links(root):
    """Returns messages about links to files and headings that do not exist."""
    messages = []
    for page in pages(root):
        text = without_blocks(page.read_text(encoding="utf-8"))
        text = re.sub(r"`[^`\n]*`(?!\])", "", text)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if re.match(r"\w+:", target):
                continue
            name, _, anchor = target.partition("#")
            file = (page.parent / name).resolve() if name else page
            where = page.relative_to(root)
            if not file.exists():
                messages.append(f"{where}: link to {target}: there is no such file")
            elif anchor and (file.suffix != ".md" or anchor not in anchors(file)):
                messages.append(f"{where}: link to {target}: there is no such heading")
    return messages


def sections(text):
    """Returns a page's text by second-level heading; "" is the part before the first."""
    parts = re.split(r"(?m)^## +(.*)$", text)
    return {"": parts[0]} | dict(zip(parts[1::2], parts[2::2]))


def options_in(text):
    """Returns the long options that a text names."""
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text))


class Program:
    """A copy of the program under test, run in a folder of its own. Where it was built, the program
    would use the goldens of the source tree, and `golden accept` and `bench --accept` change them."""

    def __init__(self, program, folder):
        self.program = folder / "build/sunder"
        self.folder = folder
        self.program.parent.mkdir()
        shutil.copy(program, self.program)

    def run(self, arguments):
        environment = os.environ | {"SUNDER_CACHE": str(self.folder / "cache"),
                                    "OMP_WAIT_POLICY": "passive"}
        return subprocess.run([self.program, *arguments], cwd=self.folder, env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300,
                              check=False)

    def options(self, command):
        """Returns the long options that the help of a command and its subcommands list."""
        text = self.run([*command, "--help"]).stdout
        found = set(re.findall(r"(?m)^\s+(?:-\w,)?(--[a-z][a-z-]*)", text))
        _, _, rest = text.partition("Subcommands:\n")
        for name in re.findall(r"(?m)^  (\w+) ", rest) if command else []:
            found |= self.options([*command, name])
        return found


def check_options(root, program):
    """Returns messages about options that docs/cli.md lacks, or has beyond the program's."""
    listed = re.findall(r"(?m)^  (\w+) ", program.run(["--help"]).stdout.partition("Subcommands:\n")[2])
    if sorted(listed) != sorted(COMMANDS):
        return [f"tests/check_docs.py: COMMANDS are not those of the program: {', '.join(listed)}"]
    page = sections((root / "docs/cli.md").read_text(encoding="utf-8"))
    messages, known = [], program.options([])
    for command in COMMANDS:
        if command not in page:
            messages.append(f"docs/cli.md: no section about {command}")
            continue
        options = program.options([command])
        known |= options
        shared = "".join(page.get(name, "") for name in SHARED_SECTIONS[command])
        messages += [f"docs/cli.md: {command} lacks {option}" for option in
                     sorted(options - options_in(page[command] + shared))]
    # The text of a section may name options of other commands; its table may not.
    for name, text in page.items():
        messages += [f'docs/cli.md: "{name}" has {option}, which no command has'
                     for option in sorted(options_in(text) - known)]
        tables = "\n".join(re.findall(r"(?m)^\| (`-.*?) \|", text))
        if name in COMMANDS:
            messages += [f"docs/cli.md: the table of {name} has {option}, which is no option of it"
                         for option in sorted(options_in(tables) - program.options([name]))]
    return messages


def keys_of(value, path=""):
    """Returns (path, key) of every key of a JSON value whose key is no name."""
    found = set()
    if isinstance(value, dict):
        for key, inner in value.items():
            if not NAMES.fullmatch(path):
                found.add((path, key))
            found |= keys_of(inner, f"{path}/{key}" if path else key)
    elif isinstance(value, list):
        for inner in value:
            found |= keys_of(inner, path)
    return found


def check_keys(root, program):
    """Returns messages about keys that commands write and docs/json.md does not name."""
    text = (root / "docs/json.md").read_text(encoding="utf-8")
    names = {name for code in re.findall(r"`([^`\n]+)`", text) for name in re.findall(r"\w+", code)}
    # "the same in processor time, `cpu_p50_ms` and so on"
    names |= {"cpu_" + name for name in names if re.fullmatch(r"(p\d\d|max|mean)_ms", name)}
    messages = set()
    for line in JSON_COMMANDS:
        if is_without_three(line.split()):
            continue
        file = program.folder / "figures.json"
        file.unlink(missing_ok=True)
        done = program.run([*line.split(), "--json", file.name])
        if not file.exists():
            messages.add(f"sunder {line}: wrote no JSON, exit code {done.returncode}: {done.stdout}")
            continue
        figures = json.loads(file.read_text(encoding="utf-8"))
        messages |= {f"docs/json.md: lacks {key}, which sunder {line.split()[0]} writes"
                     for path, key in keys_of(figures) if key not in names}
    return sorted(messages)


def code_lines(text):
    """Returns the lines of a page's code blocks."""
    fenced = "\n".join(re.findall(r"(?ms)^```\w*\n(.*?)^```", text))
    return [line.strip() for line in re.findall(r"(?m)^    .*$", without_blocks(text))
            ] + [line.strip() for line in fenced.splitlines()]


def add(arguments, *option):
    """Appends an option if the command does not have it."""
    return arguments if option[0] in arguments else [*arguments, *option]


def with_value(arguments, option, value):
    """Gives an option another value, or appends it."""
    arguments = add(arguments, option, value)
    at = arguments.index(option) + 1
    return [*arguments[:at], value, *arguments[at + 1:]]


def is_without_three(arguments):
    """True for a command that needs three.js if that is not installed."""
    return arguments[0] == "view" and not Path("/usr/share/javascript/three").exists()


def shorten(arguments):
    """Returns a command that does the same in less time, see the head of this file."""
    command = arguments[0]
    if command == "simulate":
        given = arguments[arguments.index("--frames") + 1] if "--frames" in arguments else "3"
        return with_value(arguments, "--frames", str(min(3, int(given))))
    if command in ("export", "view") and not arguments[1].endswith((".take", ".glb")):
        return add(arguments, "--frames", "3")
    if command == "render":
        if "--frames" in arguments:
            arguments = with_value(arguments, "--frames", "1:2")
        elif "--sheet" in arguments:
            arguments = with_value(arguments, "--sheet", "2")
        elif not arguments[1].endswith(".frame"):
            arguments = add(arguments, "--frames", "0:1")
        return add(arguments, "--size", "64x48")
    if command == "bench":
        if "--accept" in arguments:  # refuses a part of the run that states are stored of
            return [*arguments, "glass"]
        repeats = "1"
        if "--fail-slower" in arguments:  # refuses fewer repeats than can tell anything
            arguments, repeats = [*arguments, "stack"], "9"
        arguments = add(add(arguments, "--repeats", repeats), "--warm-up", "0")
        return with_value(arguments, "--frames", "2")
    if command == "trade":
        return add(arguments, "--list")
    return arguments


def make_folder(root, folder, program):
    """Makes the files that commands of the pages name."""
    (folder / "old/build").mkdir(parents=True)
    (folder / "old/build/sunder").symlink_to(program.program)
    (folder / "scenes").symlink_to(root / "scenes")
    (folder / "bench").symlink_to(root / "bench")
    (folder / "tests/golden").mkdir(parents=True)
    for file in [*(root / "tests/golden").glob(GOLDEN + ".*"), root / "tests/golden/hashes.txt"]:
        shutil.copy(file, folder / "tests/golden")
    (folder / "tetrahedron.obj").write_text(TETRAHEDRON, encoding="utf-8")
    (folder / "set.nodes").write_text("0.1 0.1 0.1\n0.6 0.1 0.1\n", encoding="utf-8")
    (folder / "wrong.toml").write_text("[scene]\n", encoding="utf-8")
    scene = re.search(r"(?ms)^```toml\n(.*?)^```", (root / "README.md").read_text(encoding="utf-8"))
    for name in ("my.toml", "my_scene.toml"):
        (folder / name).write_text(scene.group(1) if scene else "", encoding="utf-8")
    program.run(shorten(["simulate", "house", "--take", "house.take"]))
    program.run(shorten(["export", "house", "-o", "house.glb"]))
    program.run(shorten(["bench", "--json", "old.json"]))
    program.run(shorten(["bench", "--json", "new.json"]))


def check_command(root, program, line):
    """Runs a command of a page. Returns a message if it fails."""
    arguments = shorten(shlex.split(line, comments=True)[1:])
    if is_without_three(arguments):
        return None
    expanded = []
    for argument in arguments:
        files = sorted(glob.glob(argument, root_dir=program.folder)) if "*" in argument else []
        expanded += files or [argument]
    if not shutil.which("ffmpeg"):
        expanded = [re.sub(r"\.(mp4|webm)$", ".png", argument) for argument in expanded]
    done = program.run(expanded)
    # A comparison of times may fail here: other tests run at the same time.
    allowed = (0, 1) if "--fail-slower" in expanded else (0,)
    if done.returncode in allowed:
        return None
    return f"`{line}` fails, run as `sunder {shlex.join(expanded)}`:\n{done.stdout.strip()[-1000:]}"


def check_other(root, line, presets, targets):
    """Returns a message about a file, preset or target that a line names and that does not exist."""
    words = shlex.split(line, comments=True)
    for i, word in enumerate(words):
        if word == "--preset" and words[i + 1] not in presets:
            return f"`{line}`: there is no preset {words[i + 1]}"
        if re.fullmatch(r"build/\w+", word) and word.partition("/")[2] not in targets:
            return f"`{line}`: there is no target {word.partition('/')[2]}"
        if re.fullmatch(r"(\./[\w/]+\.sh|(docs|tests|scenes|bench|cmake)/[\w./-]+)", word) and not (
                root / word).exists():
            return f"`{line}`: there is no {word}"
    return None


def check_commands(root, program):
    """Returns messages about commands in the code blocks of pages that do not work."""
    presets = {preset["name"] for kind in ("configure", "build", "test", "workflow") for preset in
               json.loads((root / "CMakePresets.json").read_text(encoding="utf-8")).get(
                   kind + "Presets", [])}
    cmake = "\n".join(path.read_text(encoding="utf-8") for folder in ("bench", "tests", "scenes", "examples")
                      for path in (root / folder).rglob("CMakeLists.txt"))
    targets = set(re.findall(r"\b(?:sunder_\w+|add_executable)\((\w+)", cmake))
    messages, shown, ran = [], set(), set()
    for page in [root / "README.md", *sorted((root / "docs").glob("*.md")), root / "bench/README.md"]:
        for line in code_lines(page.read_text(encoding="utf-8")):
            command = line.partition("#")[0].strip()
            found = []
            if command in SYNTAX:
                shown.add(command)
                found = [check_command(root, program, one) for one in SYNTAX[command]]
            elif re.match(r"(build/)?sunder ", command) and command not in ran:
                ran.add(command)
                found = [check_command(root, program, command)]
            elif re.match(r"\./|cmake |git |ctest |build/", command):
                found = [check_other(root, part, presets, targets) for part in command.split("&&")]
            messages += [f"{page.relative_to(root)}: {message}" for message in found if message]
    messages += [f"tests/check_docs.py: docs/cli.md has no line `{line}`: correct SYNTAX"
                 for line in SYNTAX if line not in shown]
    return messages


def main():
    root, program = Path(sys.argv[1]).resolve(), sys.argv[2]
    lines = len((root / "README.md").read_text(encoding="utf-8").splitlines())
    messages = [f"README.md has {lines} lines; at most {MAX_README_LINES} may be"
                ] if lines > MAX_README_LINES else []
    messages += check_links(root)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tool = Program(program, folder)
        make_folder(root, folder, tool)
        messages += check_options(root, tool)
        messages += check_keys(root, tool)
        messages += check_commands(root, tool)
    print("\n".join(messages) or "links, options, JSON keys and commands of the pages are right")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
