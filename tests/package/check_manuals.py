#!/usr/bin/env python3
"""Checks the manual pages and completions that the program writes against its help: every command
and option of `--help` is in the page and in both completions, and no other; the page has no fault
that groff finds, and the completions complete.

Usage: check_manuals.py PROGRAM. Parts that need man, bash or zsh are left out without them. Read
first: main().
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path


def run(*words, text=None):
    """Returns the output of a command, which must succeed."""
    return subprocess.run(words, input=text, check=True, capture_output=True, text=True).stdout


def help_of(program, command):
    """Returns the names of the subcommands and of the options of a command's help."""
    text = run(program, *command.split(), "--help")
    _, _, rest = text.partition("Subcommands:\n")
    commands = re.findall(r"(?m)^  (\w+) ", rest)
    options = set()
    for short, long in re.findall(r"(?m)^  (?:(-\w),)?(--[a-z][a-z-]*)", text.partition("Subcommands:")[0]):
        options |= {long} | ({short} if short else set())
    return commands, options


def leaves(program, command=""):
    """Returns the options of each command that has no subcommands, by name."""
    commands, options = help_of(program, command)
    if not commands:
        return {command: options}
    found = {}
    for name in commands:
        found |= leaves(program, f"{command} {name}".strip())
    return found


def page_options(page, section):
    """Returns the options that a section of a manual page lists."""
    text = page.replace("\\-", "-").replace("\\fB", "").replace("\\fR", "")
    parts = dict(re.findall(r"(?ms)^\.SH ([^\n]+)\n(.*?)(?=^\.SH |\Z)", text))
    heads = re.findall(r"(?m)^\.TP\n(-.*)$", parts.get(section, ""))
    return {name for head in heads for name in re.findall(r"(?<!\S)(--?[a-z][a-z-]*)", head)}


def bash_options(completion, command):
    """Returns the options in the list of a command in the completion for bash."""
    found = re.search(rf"(?m)^ *'{command}'\) words='([^']*)'", completion)
    return set(found.group(1).split()) if found else set()


def zsh_options(completion, command):
    """Returns the options in the list of a command in the completion for zsh."""
    found = re.search(rf"(?ms)^    '{command}'\)\n(.*?);;", completion)
    return set(re.findall(r"(?m)^ +'\*?(--?[a-z][a-z-]*)\[", found.group(1))) if found else set()


def difference(where, expected, found):
    """Returns messages about options that are missing or too many."""
    return [f"{where}: lacks {name}" for name in sorted(expected - found)] + [
        f"{where}: has {name}, which the help lacks" for name in sorted(found - expected)]


def completed(bash, words):
    """Returns what bash offers for the last of the words."""
    line = " ".join(f"'{word}'" for word in words)
    script = (f"source '{bash}'\nCOMP_WORDS=({line})\nCOMP_CWORD={len(words) - 1}\n_sunder\n"
              'printf "%s\\n" "${COMPREPLY[@]}"\n')
    return set(run("bash", "--norc", "-c", script).split())


def check_bash(program, folder):
    """Returns messages about words that the completion for bash does not offer."""
    bash = folder / "bash/sunder"
    (folder / "bin").mkdir()
    (folder / "bin/sunder").symlink_to(program)
    run("bash", "-n", str(bash))
    messages = []
    for words, expected in [
            (["sunder", "rend"], {"render"}), (["sunder", "golden", "te"], {"test"}),
            (["sunder", "render", "x", "--sam"], {"--samples"}),
            (["sunder", "golden", "test", "--fu"], {"--full"}),
            (["sunder", "simulate", "x", "--preset", "re"], {"realtime", "reference"}),
            (["sunder", "render", "x", "--view", "fo"], {"follow:"}),
            (["sunder", "fracture", "x", "--pattern", "br"], {"brick:"}),
            (["sunder", "fracture", "x", "--walls", ""], {"remove", "keep"}),
            (["sunder", "simulate", "brick_w"], {"brick_wall"})]:
        found = completed(bash, words)
        if found != expected:
            messages.append(f"bash: {' '.join(words)}: offers {sorted(found)}, not {sorted(expected)}")
    return messages


def main():
    program = str(Path(sys.argv[1]).resolve())
    messages = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(program, "manual", str(folder))
        bash = (folder / "bash/sunder").read_text("utf-8")
        zsh = (folder / "zsh/_sunder").read_text("utf-8")
        commands, own = help_of(program, "")
        messages += difference("sunder.1", own, page_options((folder / "man1/sunder.1").read_text("utf-8"),
                                                             "OPTIONS"))
        pages = {page.stem for page in (folder / "man1").iterdir()}
        messages += difference("man1", {"sunder"} | {"sunder-" + name for name in commands}, pages)
        for command, options in leaves(program).items():
            first, _, second = command.partition(" ")
            page = (folder / f"man1/sunder-{first}.1").read_text("utf-8")
            messages += difference(f"sunder-{first}.1", options,
                                   page_options(page, second.upper() or "OPTIONS"))
            messages += difference(f"bash, {command}", options, bash_options(bash, command))
            messages += difference(f"zsh, {command}", options, zsh_options(zsh, command))
        if shutil.which("groff"):
            for page in sorted((folder / "man1").iterdir()):
                done = subprocess.run(["groff", "-man", "-ww", "-z", "-Tutf8", page], check=True,
                                      capture_output=True, text=True)
                messages += [f"{page.name}: {line}" for line in done.stderr.splitlines()]
        if shutil.which("bash"):
            os.environ["PATH"] = f"{folder}/bin:{os.environ['PATH']}"
            messages += check_bash(program, folder)
        if shutil.which("zsh"):
            run("zsh", "-n", str(folder / "zsh/_sunder"))
    print("\n".join(messages) or "every option is in the manual pages and completions")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
