#!/usr/bin/env python3
"""Fails where a source or page uses a retired term (tests/retired_words.txt), or where too many
comments begin with a word that hides their subject ("What", "Whether", "Of").

Usage: check_words.py [ROOT]. Read first: check_tree().
"""
import fnmatch
import re
import sys
from pathlib import Path

FOLDERS = ("engine", "fracture", "solver", "render", "scenes", "bench", "tests", "examples", "docs", "cmake")
SUFFIXES = (".h", ".cpp", ".c", ".in", ".vert", ".frag", ".glsl", ".cmake", ".py", ".sh", ".toml", ".md")
C_LIKE = (".h", ".cpp", ".c", ".in", ".vert", ".frag", ".glsl")
WORDS_FILE = "tests/retired_words.txt"
# The list itself, and the sources of this check, which have retired words as examples.
SELF = ("tests/retired_words.txt", "tests/check_words.py", "tests/check_words_test.py")

# Comments that begin with one of these do not begin with their subject. Some sentences need them, so
# that each of the two groups of folders may have a few.
OPENINGS = re.compile(r"(What|Whether|Of|Who|Where|How|Lets|That)\b")
MAX_OPENINGS = 30
OPENING_GROUPS = (("engine", "fracture", "solver", "render", "scenes"), ("bench", "tests", "examples"))

# A comment of C++ or GLSL, or a string; strings are matched so that "//" in them begins no comment.
C_TOKEN = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
HASH_TOKEN = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|(?<!\S)#[^\n]*')
# Between two words of a term: spaces, or the end of a line of a comment and the next one's beginning.
GAP = r"(?:[ \t]+|[ \t]*\n[ \t]*(?://[/!<]*|#|\*)?[ \t]*)"


class Term:
    """A line of retired_words.txt: a term, what to use instead, and exceptions.

    A term in backticks is an identifier, which is searched for everywhere. Other terms are words,
    which are searched for in comments and pages, in any letter case. There, a word in backticks, with
    parentheses or behind "::" is an identifier."""

    def __init__(self, line):
        fields = line.split("\t")
        if len(fields) not in (2, 3) or not all(fields):
            raise ValueError(f'"{line}" is not "term TAB instead" or "term TAB instead TAB exceptions"')
        self.name, self.instead = fields[:2]
        exceptions = fields[2].split(", ") if len(fields) == 3 else []
        self.files = [text for text in exceptions if "/" in text or "*" in text]
        self.phrases = [text for text in exceptions if text not in self.files]
        self.used = set()  # exceptions that were needed
        self.is_identifier = self.name.startswith("`")
        self.first = re.search(r"\w+", self.name).group().lower()
        if self.is_identifier:
            self.pattern = re.compile(rf"(?<!\w){re.escape(self.name.strip('`'))}(?!\w)")
        else:
            self.pattern = re.compile(self.expression(self.name), re.IGNORECASE)

    @staticmethod
    def expression(words):
        return r"(?<![\w:.`/-])" + GAP.join(map(re.escape, words.split())) + r"(?![\w(`-])"

    def find(self, path, text, names):
        """Returns the offsets of the term in a file, without those that are exceptions. `names` are
        the words of the file in lower case."""
        if self.first not in names:
            return []
        found = [match.span() for match in self.pattern.finditer(text)]
        if not found:
            return []
        for phrase in self.phrases:
            allowed = [match.span() for match in
                       re.finditer(self.expression(phrase), text, re.IGNORECASE)]
            kept = [span for span in found
                    if not any(a <= span[0] and span[1] <= b for a, b in allowed)]
            if len(kept) < len(found):
                self.used.add(phrase)
            found = kept
        for pattern in self.files:
            if found and fnmatch.fnmatch(path, pattern):
                self.used.add(pattern)
                return []
        return [begin for begin, end in found]


def read_terms(text):
    """Returns the terms of retired_words.txt."""
    return [Term(line) for line in text.splitlines() if line and not line.startswith("#")]


def blank(text):
    """Returns as many spaces, with the same line ends."""
    return re.sub(r"[^\n]", " ", text)


def keep_comments(pattern, text):
    """Returns a source with everything blanked but its comments."""
    out, end = [], 0
    for match in pattern.finditer(text):
        if match.group()[0] in "/#":
            out += [blank(text[end:match.start()]), match.group()]
            end = match.end()
    return "".join(out) + blank(text[end:])


def words_of(path, text):
    """Returns a file with the code blanked: comments of a source, all of a page or Python script."""
    if path.endswith(C_LIKE):
        return keep_comments(C_TOKEN, text)
    if path.endswith((".cmake", "CMakeLists.txt", ".sh", ".toml")):
        return keep_comments(HASH_TOKEN, text)
    return text


def openings(path, text):
    """Returns (line, comment) of comments that begin with one of OPENINGS. A line of a comment that
    goes on with the comment of the line before is no beginning."""
    found = []
    before = ""  # marker of the comment at the end of the last line
    for number, line in enumerate(text.splitlines(), 1):
        comment = next((match for match in C_TOKEN.finditer(line) if match.group().startswith("//")),
                       None)
        if not comment:
            before = ""
            continue
        marker, words = re.match(r"(//[/!<]*)\s*(.*)", comment.group()).groups()
        goes_on = not line[:comment.start()].strip() and before == marker
        if not goes_on and OPENINGS.match(words):
            found.append((number, words))
        before = marker if words else ""
    return found


def sources(root):
    """Returns the paths of the files to check, relative to the root, sorted."""
    files = [path for folder in FOLDERS for path in (root / folder).rglob("*")]
    files += [path for path in root.glob("*") if path.is_file()]
    names = sorted(str(path.relative_to(root)) for path in files
                   if path.suffix in SUFFIXES or path.name == "CMakeLists.txt")
    return [name for name in names if name not in SELF and "__pycache__" not in name]


def check_tree(root):
    """Returns all messages about the source tree at `root`, as "path:line: message"."""
    root = Path(root).resolve()
    terms = read_terms((root / WORDS_FILE).read_text(encoding="utf-8"))
    messages = []
    begun = {group: [] for group in OPENING_GROUPS}
    for path in sources(root):
        text = (root / path).read_text(encoding="utf-8")
        names = set(re.findall(r"\w+", text.lower()))
        words = words_of(path, text)
        for term in terms:
            for offset in term.find(path, text if term.is_identifier else words, names):
                line = text.count("\n", 0, offset) + 1
                messages.append(f"{path}:{line}: {term.name}: use {term.instead}")
        if path.endswith((".h", ".cpp", ".c")):
            for group in OPENING_GROUPS:
                if path.startswith(tuple(folder + "/" for folder in group)):
                    begun[group] += [f"{path}:{line}: {words}" for line, words in openings(path, text)]
    for term in terms:
        messages += [f"{WORDS_FILE}: {term.name}: the exception {name} is not needed: remove it"
                     for name in term.files + term.phrases if name not in term.used]
    for group, found in begun.items():
        if len(found) > MAX_OPENINGS:
            messages += found
            messages.append(f"{len(found)} comments of {', '.join(group)} begin with What, Whether, "
                            f"Of, ...; at most {MAX_OPENINGS} may: begin with the subject")
    return messages


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent
    messages = check_tree(root)
    print("\n".join(messages) or f"{len(sources(root.resolve()))} files, no retired words")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
