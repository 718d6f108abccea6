"""Sunder: a simulator of rigid bodies that break.

    import sunder

    world = sunder.World(sunder.load_scene("house"))
    world.run(2)
    print(world.bodies.positions)

Begin with load_scene() or Scene, then World. fracture() breaks a mesh without a world.

SI units, right-handed, Y up, radians. Vectors are arrays of three numbers, rotations quaternions in
the order x, y, z, w. A name ends in its unit where the unit is not obvious.
"""
import difflib as _difflib
import functools as _functools
import re as _re
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


def _with_named_keywords(function):
    """Returns a function whose TypeError for an unknown keyword names the keyword."""
    line = (function.__doc__ or "").partition("\n")[0]
    known = [name for name in _re.findall(r"[(,] ?(\w+): ", line) if name != "self"]

    @_functools.wraps(function)
    def call(*arguments, **keywords):
        try:
            return function(*arguments, **keywords)
        except TypeError:
            for unknown in keywords:
                if unknown in known:
                    continue
                near = _difflib.get_close_matches(unknown, known, 1)
                hint = f"did you mean {near[0]!r}? " if near else ""
                raise TypeError(
                    f"{function.__name__}() has no keyword {unknown!r}; {hint}"
                    f"keywords: {', '.join(known) or 'none'}") from None
            raise

    return call


def _name_keywords():
    """Wraps the functions and methods of the compiled part that have keywords."""
    for owner in [_core, *(cls for cls in vars(_core).values() if isinstance(cls, type))]:
        for name, member in list(vars(owner).items()):
            if name.startswith("_") and name != "__init__":
                continue
            function = member.__func__ if isinstance(member, staticmethod) else member
            doc = getattr(function, "__doc__", None) or ""
            if isinstance(function, (type, property)) or not doc.startswith(f"{name}("):
                continue
            wrapped = _with_named_keywords(function)
            setattr(owner, name, staticmethod(wrapped) if function is not member else wrapped)


_name_keywords()
from ._core import *  # noqa: E402,F401,F403

__all__ = sorted(name for name in vars(_core) if not name.startswith("_"))
__version__ = _core.__version__


def _scenes_folder():
    """Returns the folder of the scenes that come with Sunder: in the package, or as installed."""
    package = _Path(__file__).resolve().parent
    if (package / "scenes").is_dir():
        return package / "scenes"
    return package.parents[3] / "share" / "sunder" / "scenes"


_core._set_scenes_folder(_scenes_folder())
