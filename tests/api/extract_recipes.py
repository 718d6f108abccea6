#!/usr/bin/env python3
"""Writes the recipes of a page as a C++ program that runs each of them.

Usage: extract_recipes.py PAGE.md OUTPUT.cpp
"""
import re
import sys


def main(page, output):
    text = open(page, encoding="utf-8").read()
    recipes = re.findall(r"^```cpp\n(.*?)^```$", text, re.M | re.S)
    if len(recipes) < 10:
        sys.exit(f"{page}: {len(recipes)} recipes; expected at least 10")
    with open(output, "w", encoding="utf-8") as out:
        out.write("#include <sunder/sunder.h>\n\n#include <cstdio>\n#include <stdexcept>\n"
                  "#include <thread>\n\n"
                  "template <class... Arguments> void use(const Arguments&...) {}\n")
        for number, recipe in enumerate(recipes):
            out.write(f"\nvoid recipe_{number}() {{\n{recipe}}}\n")
        calls = "".join(f"  recipe_{number}();\n" for number in range(len(recipes)))
        out.write(f"\nint main() {{\n{calls}}}\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
