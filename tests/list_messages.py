#!/usr/bin/env python3
"""Writes docs/messages.md: the errors and warnings of the program, from the literals of its sources.

usage: list_messages.py ROOT          write the page
       list_messages.py ROOT --check  exit code 1 if the page is out of date

Read first: messages_of(). An error is the text of a thrown InputError or FileError, or of a call of
a function in HELPERS, which throws one. A warning is a text that a function named *_warning(s)
makes, or one that is appended to `warnings`. Everything that is no literal is shown as …
"""
import re
import sys
from pathlib import Path

MODULES = {
    "engine": "Data model, meshes, and stored files",
    "fracture": "Breaking and decomposition",
    "solver": "Motion of bodies and particles",
    "render": "Images and videos",
    "scenes": "Scene files, structures and commands",
}
HELPERS = "fail|fail_at|refuse|require|in_plane"
# Functions whose literals are part of the message; those of other calls (names of keys) are not.
FORMATTERS = {"", "string", "printed", "unknown"}
TOKEN = re.compile(r"""//[^\n]* | '(?:[^'\\\n]|\\.)+' | (?P<raw>R"\((?:.*?)\)") |
                       "(?P<text>(?:[^"\\\n]|\\.)*)" | (?P<call>[A-Za-z_]\w*)?\s*\( | [)\]}{,] | \S""",
                   re.S | re.X)


def without_comments(source):
    """Returns the source with its comments blanked out, at unchanged places."""
    def blank(match):
        return match[0] if match[0][0] in "\"'R" else " " * len(match[0])
    return re.sub(r"""R"\(.*?\)"|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+'|//[^\n]*""", blank, source,
                  flags=re.S)


def arguments(source, start):
    """Returns the texts of the arguments of a call whose opening bracket is at `start`."""
    texts, text, stack = [], "", []
    between = ""
    for token in TOKEN.finditer(source, start):
        if token["text"] is not None:
            if any(name not in FORMATTERS for name in stack[1:]):
                continue
            rest = between.strip(" ()")
            if rest.startswith(":") and not rest.startswith("::"):
                text += " | " + ("…" if len(rest) > 1 else "")
            elif between.strip():
                text += "…"
            text += token["text"]
            between = ""
            continue
        if token[0].endswith("("):
            stack.append(token["call"] or "")
        elif token[0] == ")":
            stack.pop()
            if not stack:
                break
        elif token[0] == "," and len(stack) == 1:
            texts.append(text + ("…" if text and between.strip() else ""))
            text = between = ""
            continue
        if len(stack) > 1 or not token[0].endswith("("):
            between += token[0]
    texts.append(text + ("…" if text and between.strip() else ""))
    return texts


def plain(text):
    """Returns a literal as it is printed, on one line."""
    text = text.replace('\\"', '"').replace("\\n", " ").replace("%%", "% ").replace("\\t", " ")
    text = re.sub(r"%[-+]?[0-9.*]*(?:zu|td|llu|[dufgs])", "…", text)
    text = re.sub(r"\s+", " ", re.sub("…+", "…", text)).strip(" |")
    return "…" + text if text.startswith(":") else text


def is_message(text):
    """Returns true if the text has two words."""
    return sum(bool(re.search(r"[A-Za-z]{2,}", word)) for word in text.split()) >= 2


def body_at(source, start):
    """Returns the end of the block whose opening brace is at `start`."""
    depth = 0
    for token in TOKEN.finditer(source, start):
        depth += {"{": 1, "}": -1}.get(token[0], 0)
        if depth == 0:
            return token.end()
    return len(source)


def returned(source, start, end):
    """Yields place and text of the return statements with a literal between two places."""
    for found in re.finditer(r"\breturn\b", source[:end]):
        if found.start() >= start:
            stop = next(token.start() for token in TOKEN.finditer(source, found.end())
                        if token[0] == ";")
            yield found.start(), arguments("(" + source[found.end():stop] + ")", 0)[0]


def warnings_of(source):
    """Returns place, kind and text of the warnings in a source."""
    found = []
    for head in re.finditer(r"^[\w:<>]+ (?:\w+::)?\w*_warnings?\([^;{]*\) (?:const )?\{", source, re.M):
        end = body_at(source, head.end() - 1)
        found += returned(source, head.end(), end)
        for call in re.finditer(r"\bsnprintf\(", source[:end]):
            if call.start() > head.end():
                texts = [text for text in arguments(source, call.end() - 1) if " " in text]
                found.append((call.start(), texts[0]))
    for call in re.finditer(r"\bwarnings(?:\.|->)(?:push|emplace)_back\(", source):
        found.append((call.start(), arguments(source, call.end() - 1)[0]))
    for call in re.finditer(r"\bfprintf\(stderr, \"warning: ", source):
        texts = arguments(source, source.index("(", call.start()))
        found.append((call.start(), texts[1].removeprefix("warning: ")))
    return [(place, "warning: ", text) for place, text in found]


def local_texts(source, start, end):
    """Yields place and text of the local strings that the expression between two places uses."""
    function = max(source.rfind("\n}", 0, start), source.rfind("\n  }\n\n", 0, start), 0)
    for name in sorted(set(re.findall(r"\b[a-z]\w*\b", source[start:end]))):
        for local in re.finditer(rf"const std::string {name} =", source[function:start]):
            place = function + local.end()
            stop = next(token.start() for token in TOKEN.finditer(source, place) if token[0] == ";")
            yield place, arguments("(" + source[place:stop] + ")", 0)[0]
        for call in re.finditer(rf"snprintf\({name}, ", source[function:start]):
            place = function + call.start()
            yield place, arguments(source, source.index("(", place))[2]


def messages_of(source):
    """Returns the messages of a source in their order, as they are printed."""
    source = without_comments(source)
    found = warnings_of(source)
    separator = "; expected " if "; expected \" + expected" in source else "; "
    for call in re.finditer(r"\bthrow (?:sunder::)?(InputError|FileError)\(", source):
        kind = "error: " if call[1] == "InputError" else "failed: "
        found.append((call.start(), kind, arguments(source, call.end() - 1)[0]))
        end = next(token.start() for token in TOKEN.finditer(source, call.end()) if token[0] == ";")
        found += [(place, kind, text) for place, text in local_texts(source, call.end(), end)]
    for call in re.finditer(rf"(?<!void )(?<!&)\b(?:{HELPERS})\(", source):
        texts = [text for text in arguments(source, call.end() - 1) if " " in text]
        found.append((call.start(), "error: ", separator.join(texts)))
    lines = []
    for _, kind, text in sorted(found):
        line = plain(text)
        if is_message(line) and kind + line not in lines:
            lines.append(kind + line)
    return lines


def page(root):
    text = ("# Messages of the program\n\n"
            "For users who search for a message. `error` ends the program with exit code 2 and is about "
            "the input; `failed` ends it with exit code 1; after a `warning` it goes on. … stands for a "
            "name, a number or another text; | separates alternatives. The place (a file, a line, an "
            "option) often comes before the text.\n\n"
            "This page is written by `tests/list_messages.py .`, and a test compares it with the "
            "sources.\n")
    for module, title in MODULES.items():
        text += f"\n## {title}\n"
        for file in sorted([*(root / module).rglob("*.h"), *(root / module).rglob("*.cpp")]):
            lines = messages_of(file.read_text())
            if lines:
                text += f"\n### {file.relative_to(root)}\n\n"
                text += "".join(f"* `{line}`\n" if "`" not in line else f"* ``{line}``\n" for line in lines)
    return text


def main():
    root = Path(sys.argv[1])
    file = root / "docs" / "messages.md"
    if sys.argv[2:] != ["--check"]:
        file.write_text(page(root))
        return 0
    if file.exists() and file.read_text() == page(root):
        return 0
    print("docs/messages.md is out of date; write it by tests/list_messages.py .")
    return 1


sys.exit(main())
