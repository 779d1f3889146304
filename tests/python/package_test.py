"""The wheel and the source distribution, and a virtual environment with the wheel for the other tests.

Usage: package_test.py PROJECT VENV"""
import ast
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import unittest
import venv
import zipfile
from pathlib import Path

from requirements import require

require(grpc="python3-grpcio", numpy="python3-numpy", setuptools="python3-setuptools", wheel="python3-wheel",
        ensurepip="python3-venv")
PROJECT, VENV = (Path(argument) for argument in sys.argv[1:])
PACKAGE = PROJECT / "client/python"
PYTHON = VENV / "bin/python"
GENERATED = {f"affskel/v1/{name}" for name in ("types_pb2.py", "types_pb2.pyi", "client_service_pb2.py",
                                               "client_service_pb2.pyi", "client_service_pb2_grpc.py")}


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def setUpModule():
    global directory, wheel, sdist
    directory = Path(tempfile.mkdtemp(prefix="affskel-python-"))
    unittest.addModuleCleanup(shutil.rmtree, directory)
    before = sources()
    run(sys.executable, "-B", PACKAGE / "build_packages.py", PROJECT, directory / "made")
    assert sources() == before, "building left files in the project's tree"
    (wheel,) = (directory / "made").glob("*.whl")
    (sdist,) = (directory / "made").glob("*.tar.gz")
    venv.create(VENV, system_site_packages=True, clear=True)
    run(PYTHON, pip(), "install", "--no-index", "--no-build-isolation", wheel, cwd=directory)


def pip():
    """The pip that environments get, run from its archive: installing it into this one takes seven seconds."""
    folders = (sysconfig.get_config_var("WHEEL_PKG_DIR") or "/usr/share/python-wheels",
               Path(importlib.util.find_spec("ensurepip").origin).parent / "_bundled")
    return next(wheel for folder in folders for wheel in Path(folder).glob("pip-*.whl")) / "pip"


def sources():
    return {str(path.relative_to(PACKAGE)) for path in PACKAGE.rglob("*") if "__pycache__" not in path.parts}


def members(archive):
    """What a wheel installs, by name; the description of the wheel itself left out."""
    with zipfile.ZipFile(archive) as file:
        return {name: file.read(name) for name in file.namelist() if ".dist-info/" not in name}


class Packages(unittest.TestCase):
    def test_the_wheel_holds_the_package_its_stubs_and_its_licence(self):
        written = {name for name in sources() if name.startswith("affskel/") and "." in Path(name).name}
        self.assertEqual(set(members(wheel)), written | GENERATED)
        self.assertIn("affskel/py.typed", written)
        self.assertTrue(wheel.name.endswith("-py3-none-any.whl"), wheel.name)
        with zipfile.ZipFile(wheel) as file:
            (licence,) = (name for name in file.namelist() if name.endswith("/LICENSE"))
            self.assertEqual(file.read(licence), (PROJECT / "LICENSE").read_bytes())

    def test_it_requires_nothing_but_grpcio_numpy_and_protobuf(self):
        with zipfile.ZipFile(wheel) as file:
            (name,) = (name for name in file.namelist() if name.endswith("/METADATA"))
            metadata = file.read(name).decode()
        always = re.findall(r"^Requires-Dist: (\w+)[^;\n]*$", metadata, re.MULTILINE)
        self.assertEqual(sorted(always), ["grpcio", "numpy", "protobuf"])
        self.assertIn("\nRequires-Python: >=3.9\n", metadata)
        self.assertIn(f"\nVersion: {self.project_version()}\n", metadata)

    def test_the_source_distribution_needs_neither_protoc_nor_the_project(self):
        with tarfile.open(sdist) as file:
            file.extractall(directory)
        folder = directory / sdist.name[:-len(".tar.gz")]
        hook = "from setuptools import build_meta; build_meta.build_wheel('..')"
        (directory / "no-programs").mkdir()
        programs = ("PROTOC", "GRPC_PYTHON_PLUGIN")
        environment = {name: value for name, value in os.environ.items() if name not in programs}
        run(PYTHON, "-c", hook, cwd=folder, env=dict(environment, PATH=str(directory / "no-programs")))
        self.assertEqual(members(directory / wheel.name), members(wheel))

    def test_a_protoc_whose_stubs_are_bound_to_its_version_is_refused(self):
        fake = directory / "protoc"
        fake.write_text("#!/bin/sh\necho libprotoc 26.1\n")
        fake.chmod(0o755)
        with self.assertRaisesRegex(AssertionError, "take a protoc from 3.20 to 25"):
            run(sys.executable, "-B", PACKAGE / "build_packages.py", PROJECT, directory / "refused",
                env=dict(os.environ, PROTOC=str(fake)))

    def test_installed_it_works_with_both_implementations_of_protobuf(self):
        script = ("import json, affskel; from affskel.v1 import client_service_pb2 as s, types_pb2 as t\n"
                  "from google.protobuf.internal import api_implementation as a\n"
                  "job = t.Job(id='x', params=t.ErosionParams(directions='sphere:7'))\n"
                  "job = t.Job.FromString(job.SerializeToString())\n"
                  "print(json.dumps([a.Type(), affskel.__version__, affskel.__file__, job.params.directions]))")
        seen = set()
        for implementation in ("", "python"):
            environment = dict(os.environ, PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION=implementation)
            if not implementation:
                del environment["PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION"]
            kind, version, file, text = json.loads(run(PYTHON, "-c", script, cwd="/", env=environment))
            seen.add(kind)
            self.assertEqual((version, text), (self.project_version(), "sphere:7"))
            self.assertTrue(file.startswith(str(VENV)), file)
        self.assertIn("python", seen)

    def project_version(self):
        return re.search(r"^project\(affskel VERSION (\S+)", (PROJECT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]


class Types(unittest.TestCase):
    def setUp(self):
        if shutil.which("mypy") is None:
            self.skipTest("no mypy")

    def mypy(self, *arguments):
        return run("mypy", "--cache-dir", directory / "mypy", *arguments, cwd=directory)

    def test_the_package_is_strictly_typed_for_python_3_9(self):
        installed = run(PYTHON, "-c", "import affskel; print(affskel.__path__[0])", cwd="/").strip()
        self.assertIn("Success", self.mypy("--config-file", PACKAGE / "pyproject.toml", installed))

    def test_those_who_use_it_see_its_types(self):
        user = directory / "user.py"
        user.write_text("import affskel\nreveal_type(affskel.submit('x.off').wait().field().E)\n"
                        "affskel.submit('x.off', points='many')\n")
        with self.assertRaises(AssertionError) as failure:
            self.mypy("--python-executable", PYTHON, "--ignore-missing-imports", user)
        self.assertIn("ndarray[Any, numpy.dtype[numpy.floating[numpy._typing._64Bit]]]", str(failure.exception))
        self.assertIn('Argument "points" to "submit" has incompatible type "str"', str(failure.exception))
        self.assertIn("Found 1 error", str(failure.exception))

    def test_its_syntax_is_that_of_python_3_9(self):
        for file in PACKAGE.rglob("*.py"):
            ast.parse(file.read_text(), str(file), feature_version=(3, 9))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
