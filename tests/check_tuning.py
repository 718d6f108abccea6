#!/usr/bin/env python3
"""Fails where a module has a tuned number outside its tuning.h, or one without a comment.

Usage: check_tuning.py [ROOT]. Read first: check_tree().
"""
import re
import sys
from pathlib import Path

# Module with a tuning.h -> file -> what else may have a name or stand as it is: mathematics, rounding,
# published formulas, shapes, limits of input, and room for work.
ALLOWED = {
    "engine/world": {
        "act/charge.cpp": {"kMinScaledDistance", "kMaxScaledDistance", "kGroundReflection", "kReflected",
                           "kIncidentNear", "kIncidentFar", "kIncidentFitSplit"},  # of the fits
        "act/cover.cpp": {"kDepthTolerance", "kOutside"},
        "actors/load_case.cpp": {"kInside"},  # from a face to the inside
        "actors/make_actor.cpp": {"kNever"},
        "break/cluster_probe.cpp": {"kAny"},
        "break/planned_break.cpp": {"kNever"},
    },
    "fracture": {
        "adjacency/compound_builder.cpp": {"kParallel"},
        "adjacency/flush_caps.cpp": {"kSameNormal"},
        "adjacency/plane_sweep.cpp": {"kSameMeshCorner"},
        "adjacency/plane_sweep.h": {"kMinContactArea"},
        "check/case_file.cpp": {"kMostSlices"},
        "cut/cutter.cpp": {"kVolumeError"},
        "cut/ghosts.cpp": {"kMinOverlapThickness"},
        "cut/weld.cpp": {"kRelativeTolerance", "kVolumeRounding", "kDistanceRounding"},
        "pattern/block_patterns.cpp": {"kMostExtent"},  # inside the box of a pattern
        "pattern/file_pattern.cpp": {"kSamePlane", "kSameVolume"},
        "pattern/pattern.h": {"kHalfExtent"},
        "plug.cpp": {"kMinPlugThickness"},  # where the formula of CEA-EDF holds
        "solids.cpp": {"kMostBoxes", "kMostCells", "kMostColumns", "kSpan", "kHeight", "kRadius", "kRoof",
                       "kReach"},
        "stress/multigrid.cpp": {"kDamping", "kLeast"},
        "stress/open_overlap.cpp": {"kMinRelativeThickness"},
        "stress/section.cpp": {"kCos60", "kCos30", "kCosParallel", "kMinProjectedShare"},
        "stress/spring_level.cpp": {"kLeastRotation"},
        "stress/strength.h": {"kNever"},
        "stress/stress_system.cpp": {"kForceRounding"},
        "stress/yielding.cpp": {"kGauge"},  # of ISO 6892-1
        "vacd/best_cut.cpp": {"kCos", "kSin", "kDiagonal"},
        "vacd/regions.cpp": {"kMargin", "kParallel", "kSameVolume", "kFlat"},
        "vacd/sweep_hull.cpp": {"kFlat", "kPerturbation"},
        "vacd/tree.cpp": {"kInfinity"},
        "vacd/vacd.cpp": {"kRounding", "kTouching"},
    },
    "solver/impact": {
        "complementarity.cpp": {"kPivotTolerance"},
        "linkage.cpp": {"kRegularization", "kMinInverseMass"},
    },
    "solver/particles": {
        "obstacle_grid.cpp": {"kPositionError_m", "kRelativePositionError"},
        "obstacle_sweep.cpp": {"kInfinity_m"},
        "swirl.cpp": {"kProfile"},
    },
    "solver/rigid": {
        "body/bodies.cpp": {"kMostSquarable", "3.2"},  # over pi
        "body/motion.cpp": {"kEnergyStep", "kMostTurn", "1.1"},
        "body/row_exchange.cpp": {"kKinematicRoot"},
        "collide/box_tree.cpp": {"1023.f"},  # ten bits a coordinate
        "collide/facet.cpp": {"kDirectionRounding"},
        "collide/box_tree.h": {"kRoundUp"},
        "collide/narrow_phase.cpp": {"kRounding", "kNoPoint"},
        "collide/query_tests.cpp": {"kQueryRounding"},
        "collide/separation.cpp": {"kTried"},  # less than any
        "contact/contact_solver.cpp": {"1.1"},
        "passages.cpp": {"kPartAngle", "1.1"},  # of an integration
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
    },
}
# Module in which numbers without a name are checked as well.
WITHOUT_NAMES = "solver/rigid"

NAMED = re.compile(r"\bconstexpr\s+(?:float|double)\s+(.*?);", re.DOTALL)
TUNED = re.compile(r"^(/// [^\n]*\n)?inline constexpr\s+[\w:]+\s+([^;]*);([^\n]*)",
                   re.MULTILINE)
NAME = re.compile(r"\b(k[A-Z]\w*)\b\s*(?:\[\d*\]\s*)?=")
LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d+)?f?|\d+e[-+]?\d+f?)(?![\w.])")


def plain(literal):
    """Quarters, small whole numbers, nothing, everything, and what is rounding."""
    value = float(literal.rstrip("f"))
    return value == 1e30 or value < 1e-5 or (4 * value == int(4 * value) and value <= 4)


def check_header(header, text):
    """Messages about a header: no numbers, or a number without a comment."""
    found, names = [], []
    for before, numbers, behind in TUNED.findall(text):
        names += NAME.findall(numbers)
        if not before and "///<" not in behind:
            found.append(f"{header}: nothing is said of {', '.join(NAME.findall(numbers))}")
    if not names:
        found.append(f"{header}: no tuned numbers found")
    return found


def check_source(module, path, text):
    """Messages about a source of a module: numbers that should be in its header."""
    allowed = ALLOWED[module].get(path, set())
    code = re.sub(r'//[^\n]*|"[^"\n]*"', "", text)
    numbers = [name for names in NAMED.findall(code) for name in NAME.findall(names)]
    if module == WITHOUT_NAMES:
        rest = LITERAL.findall(NAMED.sub("", code))
        numbers += [literal for literal in rest if not plain(literal)]
    return [f"{module}/{path}: {number} belongs in {module}/tuning.h, or is mathematics or rounding and "
            "belongs in the list of check_tuning.py"
            for number in numbers if number not in allowed]


def check_module(root, module):
    """Messages about a module: its header, and its other sources."""
    folder = Path(root) / module
    header = folder / "tuning.h"
    messages = check_header(f"{module}/tuning.h", header.read_text(encoding="utf-8"))
    for file in sorted(folder.rglob("*")):
        if file.suffix in (".h", ".cpp") and file != header:
            path = file.relative_to(folder).as_posix()
            messages += check_source(module, path, file.read_text(encoding="utf-8"))
    return messages


def check_tree(root):
    """Every message about the tree at `root`."""
    return [message for module in ALLOWED for message in check_module(root, module)]


def main():
    messages = check_tree(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent)
    print("\n".join(messages) or "every tuned number is in the header of its module")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
