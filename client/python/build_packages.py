"""Makes the wheel and the source distribution.  Usage: build_packages.py PROJECT OUT

They are made in a copy, since setuptools leaves files beside what it packs.  Nothing is fetched.
"""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# In processes of their own: a hook of the build backend runs once.
HOOK = "import sys; from setuptools import build_meta; getattr(build_meta, sys.argv[1])(sys.argv[2])"
INPUTS = ("CMakeLists.txt", "LICENSE", "client/python", "proto/affskel")


def copy_inputs(project, copy):
    for name in INPUTS:
        source, target = project / name, copy / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
        else:
            shutil.copy(source, target)


def main(project, out):
    out = Path(out).absolute()
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="affskel-python-") as directory:
        copy_inputs(Path(project), Path(directory))
        for hook in ("build_wheel", "build_sdist"):
            subprocess.run([sys.executable, "-c", HOOK, hook, str(out)], cwd=os.path.join(directory, "client/python"),
                           check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main(*sys.argv[1:])
