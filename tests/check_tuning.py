#!/usr/bin/env python3
"""Fails where the rigid solver has a tuned number outside its header, or one without a
comment.

Usage: check_tuning.py [ROOT]. Read first: check_tree().
"""
import re
import sys
from pathlib import Path

HEADER = "solver/rigid/tuning.h"

# What else may have a name or stand as it is: mathematics, rounding, and room for work.
MATHEMATICS = {
    "body/bodies.cpp": {"1e9", "3.2"},  # faster is not finite; over pi
    "body/motion.cpp": {"kEnergyStep", "kMostTurn", "1.1"},
    "body/row_exchange.cpp": {"kKinematicRoot"},
    "collide/box_tree.cpp": {"1023.f"},  # ten bits a coordinate
    "collide/facet.cpp": {"kDirectionRounding"},
    "collide/narrow_phase.cpp": {"kRounding", "kNoPoint"},
    "collide/separation.cpp": {"kTried"},  # less than any
    "contact/contact_solver.cpp": {"1.1"},
    "contact/energy_guard.cpp": {"kEnergyRounding", "kShareRounding"},
    "contact/impact_pass.cpp": {"kOverRelaxed"},  # of successive over-relaxation in a row
    "contact/load_path.cpp": {"1e-3f"},
    "contact/prepare.cpp": {"0.999f"},
    "contact/kernels/impact_kernels.h": {"kPropagatedChange"},  # where a sweep stops: of its threshold
    "contact/kernels/sweep.h": {"kNegligible"},
    "contact/kernels/sweep_kernels.h": {"kFrictionSlack"},  # of a limit: room for rounding
    "contact/static_warm_start.cpp": {"kMaxWork", "kNearlyConverged", "kConverged",
                                     "kNoRebound"},
    "joint/joint_group.cpp": {"kSoftness"},
    "joint/joint_rows.cpp": {"0.7"},
    "joint/pinned_rows.cpp": {"kBoundRounding"},
    "joint/plastic.cpp": {"kMinDirectedImpulse", "kSurfaceDistance"},  # of an iteration
    "rigid_physics.cpp": {"1.00001f"},
    "rigid_physics.h": {"9.81"},
}

NAMED = re.compile(r"\bconstexpr\s+(?:float|double)\s+(.*?);", re.DOTALL)
TUNED = re.compile(r"^(/// [^\n]*\n)?inline constexpr\s+[\w:]+\s+([^;]*);([^\n]*)",
                   re.MULTILINE)
NAME = re.compile(r"\b(k[A-Z]\w*)\b\s*(?:\[\d*\]\s*)?=")
LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d+)?f?|\d+e[-+]?\d+f?)(?![\w.])")


def plain(literal):
    """Quarters, small whole numbers, nothing, everything, and what is rounding."""
    value = float(literal.rstrip("f"))
    return value == 1e30 or value < 1e-5 or (4 * value == int(4 * value) and value <= 4)


def check_header(text):
    """Messages about the header: no numbers, or a number without a comment."""
    found, names = [], []
    for before, numbers, behind in TUNED.findall(text):
        names += NAME.findall(numbers)
        if not before and "///<" not in behind:
            found.append(f"{HEADER}: nothing is said of {', '.join(NAME.findall(numbers))}")
    if not names:
        found.append(f"{HEADER}: no tuned numbers found")
    return found


def check_source(path, text):
    """Messages about a source: numbers that should be in the header."""
    allowed = MATHEMATICS.get(path, set())
    code = re.sub(r'//[^\n]*|"[^"\n]*"', "", text)
    named = [name for names in NAMED.findall(code) for name in NAME.findall(names)]
    rest = LITERAL.findall(NAMED.sub("", code))
    return [f"solver/rigid/{path}: {number} belongs in {HEADER}, or is mathematics or rounding and "
            "belongs in the list of check_tuning.py"
            for number in named + [literal for literal in rest if not plain(literal)]
            if number not in allowed]


def check_tree(root):
    """Every message about the tree at `root`."""
    folder = Path(root) / "solver/rigid"
    messages = check_header((Path(root) / HEADER).read_text(encoding="utf-8"))
    for file in sorted(folder.rglob("*")):
        path = file.relative_to(folder).as_posix()
        if file.suffix in (".h", ".cpp") and path != "tuning.h":
            messages += check_source(path, file.read_text(encoding="utf-8"))
    return messages


def main():
    messages = check_tree(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent)
    print("\n".join(messages) or "every tuned number is in the header")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
