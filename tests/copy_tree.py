"""Copies of the source tree, for programs that change lines and build (mutation/, planted/)."""
import shutil
import subprocess


def read_sources(root):
    """Returns name -> content of the files that belong to the tree, tracked by git or not ignored."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=root, check=True,
                            capture_output=True, text=True).stdout.splitlines()
    return {name: (root / name).read_bytes() for name in listed if (root / name).is_file()}


def write_sources(root, texts, target):
    """Writes the files of `target` that differ, with the modes of those of `root`. The others keep
    their times, so that a build compiles only what differs."""
    for name, text in texts.items():
        file = target / name
        if not file.exists() or file.read_bytes() != text:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(text)
            shutil.copymode(root / name, file)
