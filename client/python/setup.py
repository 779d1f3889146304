"""Generates the stubs of the service from its contract when a wheel or a source distribution is built.

In the project's tree contract and version stand outside this folder; a source distribution has the stubs inside.
"""
import os
import re
import shutil
import subprocess
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parent.parent
CONTRACT = PROJECT / "proto"
PROTOS = ("types", "client_service")
# From 26 on protoc writes stubs that only work with a protobuf as new as itself.
OLDEST_PROTOC, FIRST_TOO_NEW = (3, 20), (26,)


def in_project():
    return (CONTRACT / "affskel" / "v1" / "types.proto").is_file()


def read_version():
    if in_project():
        text = (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")
        return re.search(r"^project\(affskel VERSION (\S+)", text, re.MULTILINE).group(1)
    text = (HERE / "PKG-INFO").read_text(encoding="utf-8")
    return re.search(r"^Version: (\S+)$", text, re.MULTILINE).group(1)


def find_program(name):
    path = os.environ.get(name.upper()) or shutil.which(name)
    if not path:
        raise SystemExit(f"affskel: {name} is needed to build from the project's tree "
                         "(Debian: protobuf-compiler, protobuf-compiler-grpc)")
    return path


def check_protoc(protoc):
    said = subprocess.run([protoc, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout
    number = tuple(int(part) for part in re.search(r"(\d+)\.(\d+)", said).groups())
    if not OLDEST_PROTOC <= number < FIRST_TOO_NEW:
        raise SystemExit(f"affskel: {said.strip()} at {protoc} makes stubs that other versions of protobuf refuse; "
                         "take a protoc from 3.20 to 25")


def generate(package):
    """The stubs of the client's side, into the folder of the package `affskel`."""
    protoc, plugin = find_program("protoc"), find_program("grpc_python_plugin")
    check_protoc(protoc)
    out = Path(package).parent
    names = [f"affskel/v1/{name}.proto" for name in PROTOS]
    subprocess.run([protoc, "-I", CONTRACT, f"--python_out={out}", f"--pyi_out={out}", *names], check=True)
    subprocess.run([protoc, "-I", CONTRACT, f"--grpc_python_out={out}", f"--plugin=protoc-gen-grpc_python={plugin}",
                    "affskel/v1/client_service.proto"], check=True)


class BuildPy(build_py):
    def run(self):
        super().run()
        if in_project():
            generate(Path(self.build_lib) / "affskel")


class Sdist(sdist):
    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        if in_project():
            generate(Path(base_dir) / "affskel")


setup(version=read_version(), cmdclass={"build_py": BuildPy, "sdist": Sdist})
