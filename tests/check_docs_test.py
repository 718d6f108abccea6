#!/usr/bin/env python3
"""Tests the parts of check_docs.py that need no program."""
import tempfile
import unittest
from pathlib import Path

import check_docs

PAGE = """# Title

See [a part](#a-part-of-it), [it again](#a-part-of-it-1), [other](docs/other.md#the-code-x_y) and
[the web](https://example.org/x#y). `[not](a-link.md)`

## A part, of it

## A part, of it

```
[not](a-link.md)
```
"""
OTHER = "# Other\n\n## The code `x_y`\n\n![picture](picture.png)\n"

# Violation -> text to replace in PAGE, its replacement, and a part of the message.
BAD = {
    "a file that does not exist": ("docs/other.md#the-code-x_y", "docs/gone.md", "no such file"),
    "a heading that does not exist": ("#a-part-of-it)", "#a-part)", "no such heading"),
    "a heading of another page that does not exist": ("#the-code-x_y", "#x", "no such heading"),
    "a second heading of a name that there is once": ("#a-part-of-it-1", "#title-1",
                                                      "no such heading"),
}


def links_of(page):
    """Returns the messages of check_docs about the links of a small tree."""
    with tempfile.TemporaryDirectory() as name:
        root = Path(name).resolve()
        (root / "docs").mkdir()
        (root / "README.md").write_text(page, encoding="utf-8")
        (root / "docs/other.md").write_text(OTHER, encoding="utf-8")
        (root / "docs/picture.png").write_bytes(b"")
        return check_docs.check_links(root)


class FakeProgram:
    """A program with two commands, in place of check_docs.Program."""

    OPTIONS = {"": {"--help", "--version"}, "walk": {"--help", "--far", "--slow"},
               "run": {"--help", "--far"}}

    def __init__(self):
        self.help = "Subcommands:\n  walk   Walk\n  run   Run\n"

    def run(self, arguments):
        return type("Done", (), {"stdout": self.help})

    def options(self, command):
        return self.OPTIONS["".join(command)]


CLI = """# Commands

## Arguments and common options

| `--help` | Prints the options; `--version` the version. |

## walk

`run` has no `--slow`.

| `--far M` | How far. |
| `--slow` | Slowly. |

## run

| `--far M` | How far. |
"""


def options_of(page):
    """Returns the messages of check_docs about a docs/cli.md."""
    commands, shared = check_docs.COMMANDS, check_docs.SHARED_SECTIONS
    check_docs.COMMANDS = ("walk", "run")
    check_docs.SHARED_SECTIONS = {name: ["Arguments and common options"] for name in ("walk", "run")}
    try:
        with tempfile.TemporaryDirectory() as name:
            (Path(name) / "docs").mkdir()
            (Path(name) / "docs/cli.md").write_text(page, encoding="utf-8")
            return check_docs.check_options(Path(name), FakeProgram())
    finally:
        check_docs.COMMANDS, check_docs.SHARED_SECTIONS = commands, shared


class CheckDocs(unittest.TestCase):
    def test_links_that_exist_pass(self):
        self.assertEqual(links_of(PAGE), [])

    def test_every_broken_link_is_found_alone(self):
        for name, (old, new, expected) in BAD.items():
            with self.subTest(name):
                messages = links_of(PAGE.replace(old, new))
                self.assertEqual(len(messages), 1, messages)
                self.assertIn(expected, messages[0])

    def test_a_page_with_all_options_passes(self):
        self.assertEqual(options_of(CLI), [])

    def test_every_wrong_option_is_found(self):
        for old, new, expected in (
                ("| `--slow` | Slowly. |\n", "| `--slowly` | Slowly. |\n", "--slowly, which no command"),
                ("## run\n\n| `--far M` |", "## run\n\n| `far M` |", "run lacks --far"),
                ("## run\n", "## run\n\n| `--slow` | Slowly. |\n", "table of run has --slow"),
                ("## run\n", "## runs\n", "no section about run")):
            with self.subTest(expected):
                self.assertIn(expected, "\n".join(options_of(CLI.replace(old, new))))

    def test_keys_are_those_of_objects_but_not_names(self):
        figures = {"stages": {"act": {"p50_ms": 1}}, "work": {"act": {"boxes": {"count": 1}}},
                   "per_frame": [{"ms": 1, "set": {"seed": 1}}]}
        self.assertEqual({key for _, key in check_docs.keys_of(figures)},
                         {"stages", "p50_ms", "work", "count", "per_frame", "ms", "set"})

    def test_lines_of_code_are_found_in_both_kinds_of_blocks(self):
        self.assertEqual(check_docs.code_lines("Text\n\n    one\n\n```sh\ntwo\n    three\n```\nfour\n"),
                         ["one", "two", "three"])

    def test_shortened_commands_keep_what_they_say(self):
        for given, expected in (
                ("simulate house --take a.take", "simulate house --take a.take --frames 3"),
                ("simulate house --frames 1", "simulate house --frames 1"),
                ("simulate house --frames 300", "simulate house --frames 3"),
                ("render a.take -o x.mp4 --frames 60:120", "render a.take -o x.mp4 --frames 1:2 "
                                                           "--size 64x48"),
                ("render house -o x.png --size 8x8", "render house -o x.png --size 8x8 --frames 0:1"),
                ("trade a.toml -o out", "trade a.toml -o out --list"),
                ("hull box:1,1,1 --vertices 8", "hull box:1,1,1 --vertices 8")):
            self.assertEqual(" ".join(check_docs.shorten(given.split())), expected)

    def test_other_commands_need_their_files(self):
        with tempfile.TemporaryDirectory() as name:
            (Path(name) / "test.sh").write_text("", encoding="utf-8")
            for line, message in (("./test.sh --all  # all", None), ("./gone.sh", "no ./gone.sh"),
                                  ("cmake --preset dev", None), ("cmake --preset x", "no preset x"),
                                  ("build/a_bench --all", None), ("build/b_bench", "no target b_bench"),
                                  ("git diff docs/gone.md", "no docs/gone.md")):
                found = check_docs.check_other(Path(name), line, {"dev"}, {"a_bench"})
                self.assertEqual(found is None, message is None, found)
                self.assertIn(message or "", found or "")


if __name__ == "__main__":
    unittest.main()
