#!/usr/bin/python3
"""Writes sunder.pyi, the types of the module, from the signatures in its docstrings.

usage: make_stubs.py FILE            writes the file
       make_stubs.py FILE --check    exit code 1 if the file is out of date

The built module must be on PYTHONPATH. Read first: function_stub().
"""
import re
import sys
import textwrap
from pathlib import Path

import sunder

HEADER = '''"""Types of the module sunder. Written by scenes/api/python/make_stubs.py."""
import os
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
'''
DTYPE = re.compile(r"numpy\.ndarray\[numpy\.(\w+)(?:\[[^\]]*\])?[^\]]*\]")
# Methods whose docstring does not say what they return.
RETURNS = {"__iter__": "Recording", "__enter__": "Recorder"}
ELEMENT = re.compile(r"\b(float32|float64|uint8|uint32|uint64|bool)\b")


def python_type(text, is_result):
    """Returns the type of a signature as a stub has it."""
    text = text.replace("sunder.", "")
    text = DTYPE.sub(lambda found: f"NDArray[np.{found[1]}]" if is_result else "ArrayLike", text)
    text = text.replace("numpy.ndarray", "NDArray[Any]").replace("os.PathLike", "Union[str, os.PathLike]")
    text = re.sub(r"\b(?:handle|object)\b", "Any", text)
    return re.sub(r"\bdict\b", "Dict[str, Any]", text)


def split_top(text):
    """Splits a list of parameters at the commas outside all brackets."""
    parts, depth, start = [], 0, 0
    for i, char in enumerate(text):
        depth += (char in "([{") - (char in ")]}")
        if char == "," and depth == 0:
            parts.append(text[start:i].strip())
            start = i + 1
    return [part for part in [*parts, text[start:].strip()] if part]


def parameter(text):
    """Returns one parameter of a stub; a default that is not a literal becomes `...`."""
    name, _, rest = text.partition(":")
    if not rest or name.startswith("*"):
        return name.strip()
    kind, equals, default = rest.partition(" = ")
    kind = python_type(kind.strip(), False)
    if not equals:
        return f"{name}: {kind}"
    if name in ("on_frame", "accepts"):
        kind = "Optional[Callable[..., Any]]"
    is_literal = re.fullmatch(r"""-?[\d.e+]+|None|True|False|'[^'"]*'|\(.*\)|1 / 60|\[\]""", default)
    return f"{name}: {kind} = {default if is_literal else '...'}"


def signature(doc):
    """Returns parameters and result of the first line of a docstring, and the text after it."""
    line, _, text = doc.partition("\n")
    start, arrow = line.index("("), line.rindex(" -> ")
    return split_top(line[start + 1:line.rindex(")", 0, arrow)]), line[arrow + 4:], text.strip()


def array_type(kind, doc):
    """Returns the type of an array with the type of its elements, which the docstring names."""
    element = ELEMENT.search(doc or "")
    if kind != "NDArray[Any]" or not element:
        return kind
    return f"NDArray[np.{element[1].replace('bool', 'bool_')}]"


def docstring(text, indent):
    if not text:
        return f"{indent}...\n"
    lines = [line for paragraph in text.replace("\\", "\\\\").splitlines()
             for line in textwrap.wrap(paragraph, 96 - len(indent)) or [""]]
    return f'{indent}"""' + f"\n{indent}".join(lines).replace(f"{indent}\n", "\n") + '"""\n'


def function_stub(name, doc, indent="", is_static=False):
    """Returns the stub of a function or method."""
    parameters, result, text = signature(doc)
    result = array_type(RETURNS.get(name, python_type(result, True)), text)
    if indent and not is_static:
        parameters = ["self", *parameters[1:]]
    listed = ", ".join(one if one == "self" else parameter(one) for one in parameters)
    static = f"{indent}@staticmethod\n" if is_static else ""
    return f"{static}{indent}def {name}({listed}) -> {result}:\n{docstring(text, indent + '    ')}"


def property_stub(name, member):
    """Returns the stub of a property, with a setter if it has one."""
    found = re.search(r"-> (.*)", member.fget.__doc__ or "")
    kind = array_type(python_type(found[1].strip(), True) if found else "Any", member.__doc__)
    stub = f"    @property\n    def {name}(self) -> {kind}:\n{docstring(member.__doc__, ' ' * 8)}"
    if member.fset:
        given = "ArrayLike" if kind.startswith("NDArray") else kind
        stub += f"    @{name}.setter\n    def {name}(self, value: {given}) -> None: ...\n"
    return stub


def class_stub(name, cls):
    """Returns the stub of a class."""
    bases = [base.__name__ for base in cls.__bases__ if base.__name__ not in ("pybind11_object", "object")]
    stub = f"class {name}" + (f"({', '.join(bases)})" if bases else "") + ":\n"
    stub += docstring(cls.__doc__ or "", "    ")
    if issubclass(cls, Exception):
        return stub
    for key, member in vars(cls).items():
        if isinstance(member, property):
            stub += property_stub(key, member)
        elif key in ("__init__", "__iter__", "__next__", "__len__", "__enter__", "__exit__",
                     "__contains__") or not key.startswith("_"):
            doc = getattr(cls, key).__doc__ or ""
            if " -> " in doc.partition("\n")[0]:
                stub += function_stub(key, doc, "    ", isinstance(member, staticmethod))
    return stub


def stubs():
    """Returns the text of sunder.pyi."""
    text = HEADER
    members = [(name, getattr(sunder, name)) for name in sunder.__all__]
    for name, member in members:
        if isinstance(member, type):
            text += "\n\n" + class_stub(name, member)
    for name, member in members:
        if not isinstance(member, type):
            text += "\n\n" + function_stub(name, member.__doc__)
    return text


def main():
    path = Path(sys.argv[1])
    if sys.argv[2:] == ["--check"]:
        if path.read_text(encoding="utf-8") == stubs():
            return 0
        print(f"{path}: out of date; run make_stubs.py {path}")
        return 1
    path.write_text(stubs(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
