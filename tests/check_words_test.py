#!/usr/bin/env python3
"""Makes small source trees with one violation each; check_words.py has to find exactly that one."""
import tempfile
import unittest
from pathlib import Path

import check_words

WORDS = """# A comment.
`WaitingRoom`\tDeferredImpacts
crowd\tdense cluster\ta crowd of people, docs/old/*
own weight\tself-weight
paint\tappearance
"""

# A source tree without violations; it needs every exception.
GOOD = {
    "tests/retired_words.txt": WORDS,
    "engine/a.h": '// Pays for `paint` and Scene::paint and paint().\nint paint = 1;  // "crowds"\n',
    "engine/a.cpp": 'const char* a = "// paint in a string is no word";\nint WaitingRooms;\n',
    "docs/page.md": "A crowd of people weighs its own: weightless. Painters.\n",
    "docs/old/page.md": "A crowd.\n",
    "CMakeLists.txt": 'set(paint "# crowd")\n',
}

# Violation -> files to add to GOOD, and the message without the path of the file.
BAD = {
    "a retired identifier in code":
        ("solver/b.h", "// A type.\nstruct WaitingRoom;\n", ":2: `WaitingRoom`: use DeferredImpacts"),
    "a retired identifier in a page":
        ("README.md", "See `WaitingRoom`.\n", ":1: `WaitingRoom`: use DeferredImpacts"),
    "a retired identifier in an include":
        ("solver/b.h", '#include "WaitingRoom.h"\n', ":1: `WaitingRoom`: use DeferredImpacts"),
    "a word in a comment":
        ("solver/b.h", "int a;\nint b;  // A Crowd.\n", ":2: crowd: use dense cluster"),
    "a word in a shader":
        ("render/b.frag", "// Paint.\n", ":1: paint: use appearance"),
    "a word in a page":
        ("docs/b.md", "# Page\n\nThe crowd.\n", ":3: crowd: use dense cluster"),
    "a word in a CMake file":
        ("engine/CMakeLists.txt", "# No crowd.\n", ":1: crowd: use dense cluster"),
    "a word in a script":
        ("bench/b.sh", "echo  # no crowd\n", ":1: crowd: use dense cluster"),
    "a word in a scene":
        ("scenes/b.toml", "# no crowd\n", ":1: crowd: use dense cluster"),
    "a phrase over two lines of a comment":
        ("solver/b.h", "// Bears its own\n  /// weight.\n", ":1: own weight: use self-weight"),
    "a phrase over two lines of a page":
        ("docs/b.md", "By its own\nweight.\n", ":1: own weight: use self-weight"),
    "a word beside an exception":
        ("docs/b.md", "A crowd of people, a crowd of\nboxes.\n", ":1: crowd: use dense cluster"),
}


def messages_of(files):
    """Returns the messages of check_words about a source tree of these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_words.check_tree(folder)


class CheckWords(unittest.TestCase):
    def test_a_tree_without_violations_passes(self):
        self.assertEqual(messages_of(GOOD), [])

    def test_every_violation_is_found_alone(self):
        for name, (path, text, expected) in BAD.items():
            with self.subTest(name):
                self.assertEqual(messages_of(GOOD | {path: text}), [path + expected])

    def test_an_exception_that_is_not_needed_is_found(self):
        messages = messages_of(GOOD | {"docs/old/page.md": "Nothing.\n"})
        self.assertEqual(len(messages), 1, messages)
        self.assertIn("exception docs/old/* is not needed", messages[0])

    def test_a_line_of_the_list_without_a_replacement_is_refused(self):
        with self.assertRaises(ValueError):
            messages_of(GOOD | {"tests/retired_words.txt": "crowd\n"})

    def test_a_few_comments_may_begin_without_their_subject(self):
        few = "/// What it is.\nint a;\n" * check_words.MAX_OPENINGS
        self.assertEqual(messages_of(GOOD | {"engine/b.h": few, "tests/b.cpp": few}), [])
        for path in ("solver/c.h", "bench/c.cpp"):
            for comment in ("int c;  ///< Whether it is.\n", "// How it is.\n", "//! Of it.\n"):
                messages = messages_of(GOOD | {"engine/b.h": few, "tests/b.cpp": few, path: comment})
                self.assertEqual(len(messages), check_words.MAX_OPENINGS + 2, messages)
                self.assertTrue(any(text.startswith(path + ":1: ") for text in messages), messages)

    def test_a_comment_that_goes_on_does_not_begin(self):
        text = ("// The position\n// Of a body.\nint a;  ///< The rotation\n        ///< That it has.\n"
                'auto b = "// What is no comment";\n// Whatever it is.\n')
        self.assertEqual([line for line, _ in check_words.openings("b.h", text)], [])
        text = "// The position.\nint a;  // Of a body.\n//\n// What.\n"
        self.assertEqual([line for line, _ in check_words.openings("b.h", text)], [2, 4])


if __name__ == "__main__":
    unittest.main()
