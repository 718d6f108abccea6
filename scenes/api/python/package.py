"""Sunder: a simulator of rigid bodies that break.

    import sunder

    world = sunder.World(sunder.load_scene("house"))
    world.run(2)
    print(world.bodies.positions)

Begin with load_scene() or Scene, then World. fracture() breaks a mesh without a world.

SI units, right-handed, Y up, radians. Vectors are arrays of three numbers, rotations quaternions in
the order x, y, z, w. A name ends in its unit where the unit is not obvious.
"""
from pathlib import Path as _Path

try:
    from . import _core
except ImportError as _error:
    if "CPU ISA level" not in str(_error):
        raise
    raise ImportError(
        "the module sunder is compiled for processors with more instructions than this one has "
        "(x86-64-v3: AVX2, BMI2 and FMA, unless SUNDER_ARCH named others); in a checkout run: "
        "CMAKE_ARGS=-DSUNDER_ARCH=x86-64-v2 pip install --no-build-isolation scenes/api/python"
    ) from _error
from ._core import *  # noqa: F401,F403

__all__ = sorted(name for name in vars(_core) if not name.startswith("_"))
__version__ = _core.__version__


def _scenes_folder():
    """Returns the folder of the scenes that come with Sunder: in the package, or as installed."""
    package = _Path(__file__).resolve().parent
    if (package / "scenes").is_dir():
        return package / "scenes"
    return package.parents[3] / "share" / "sunder" / "scenes"


_core._set_scenes_folder(_scenes_folder())
