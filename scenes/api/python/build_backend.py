"""Builds a wheel of the Python module for pip: runs CMake, and packs the package with its scenes.

Builds in build-python/ of the source tree, with the arguments for CMake that the environment variable
CMAKE_ARGS has, or in the configured build folder that SUNDER_BUILD names. Read first: build_wheel().
"""
import base64
import hashlib
import os
import re
import shlex
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
NOT_SCENES = {"api", "app", "report", "structures", "timing", "trade"}


def version():
    """Returns the version of the project, which CMakeLists.txt has."""
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(sunder VERSION ([\d.]+)", text)[1]


def build_module():
    """Builds the module. Returns the folder of the package."""
    given = os.environ.get("SUNDER_BUILD")
    build = Path(given) if given else ROOT / "build-python"
    if not given:
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        "-DSUNDER_QUICK_BUILD=ON", "-DSUNDER_TESTS=OFF", "-DSUNDER_BENCH=OFF",
                        f"-DSUNDER_PYTHON={sys.executable}",
                        *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
                       check=True)
    subprocess.run(["cmake", "--build", build, "--target", "sunder_python"], check=True)
    return build / "python" / "sunder"


def packed_files(package):
    """Returns the files of the wheel: path in it -> file."""
    files = {f"sunder/{file.name}": file for file in package.iterdir() if file.is_file()}
    for file in (ROOT / "scenes").rglob("*"):
        inside = file.relative_to(ROOT / "scenes")
        if file.suffix in (".toml", ".obj", ".nodes") and inside.parts[0] not in NOT_SCENES:
            files[f"sunder/scenes/{inside}"] = file
    return files


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Writes the wheel. Returns its name."""
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    name = f"sunder-{version()}-{tag}-{tag}-{platform}.whl"
    info = f"sunder-{version()}.dist-info"
    contents = {path: file.read_bytes() for path, file in packed_files(build_module()).items()}
    contents[f"{info}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: sunder\nVersion: {version()}\n"
        "Summary: Rigid-body destruction simulator\nRequires-Python: >=3.9\n"
        "Requires-Dist: numpy\n").encode()
    contents[f"{info}/WHEEL"] = (
        "Wheel-Version: 1.0\nGenerator: sunder\nRoot-Is-Purelib: false\n"
        f"Tag: {tag}-{tag}-{platform}\n").encode()
    record = ""
    for path, data in contents.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{path},sha256={digest},{len(data)}\n"
    contents[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in contents.items():
            wheel.writestr(path, data)
    return name


def get_requires_for_build_wheel(config_settings=None):
    """Returns the Python packages that a build needs: none."""
    return []
