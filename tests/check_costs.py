#!/usr/bin/env python3
"""Checks that every test that tests/costs.cmake names exists in a source of tests/."""
import pathlib
import re
import sys


def main(root):
    tests = set()
    for source in (root / "tests").rglob("*.cpp"):
        text = source.read_text(encoding="utf-8")
        tests |= set(re.findall(r"\bTEST(?:_F)?\(\s*(\w+),\s*(\w+)\s*\)", text))
    costs = (root / "tests/costs.cmake").read_text(encoding="utf-8")
    names = re.findall(r"set_tests_properties\((\w+)\.(\w+)", costs)
    missing = [".".join(name) for name in names if name not in tests]
    for name in missing:
        print(f"tests/costs.cmake: there is no test {name}: correct its name or remove the line")
    if not names:
        print("tests/costs.cmake: no test is named")
    return 1 if missing or not names else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
