#!/usr/bin/env python3
"""Fails unless a shared library exports exactly the functions of the C header, with a version.

Usage: check_symbols.py LIBRARY HEADER. Needs nm.
"""
import re
import subprocess
import sys
from pathlib import Path


def exported(library):
    """Returns the names that a library defines for others, as nm shows them with their version."""
    table = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True,
                           text=True).stdout
    return {line.split()[-1] for line in table.splitlines()}


def main():
    library, header = sys.argv[1:]
    declared = set(re.findall(r"^SUNDER_API\b[^;(]*?\b(\w+)\(", Path(header).read_text("utf-8"),
                              re.MULTILINE))
    names = exported(library)
    versions = {name for name in names if re.fullmatch(r"SUNDER_[0-9.]+", name)}
    functions = names - versions
    wrong = [f"{name}: exported, but no function of the header with a version"
             for name in sorted(functions) if not re.fullmatch(r"sunder_\w+@@SUNDER_[0-9.]+", name)]
    plain = {name.split("@")[0] for name in functions}
    wrong += [f"{name}: exported, but not in the header" for name in sorted(plain - declared)]
    wrong += [f"{name}: in the header, but not exported" for name in sorted(declared - plain)]
    if not versions or not declared:
        wrong.append(f"{library} has {len(versions)} versions, the header {len(declared)} functions")
    print("\n".join(wrong) or f"{len(plain)} functions, all of the header")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
