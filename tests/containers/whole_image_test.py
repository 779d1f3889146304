"""The image as its Containerfile makes it from the sources, and that its programs compute what those of this build do.

Usage: whole_image_test.py CONTAINERS-SOURCES ROOT-TARBALL PROGRAMS STORAGE"""
import subprocess
import tempfile
import unittest
from pathlib import Path

import engine

engine.enter()
SOURCES, TARBALL, PROGRAMS, STORAGE = engine.paths(4)

BASE, IMAGE = "localhost/affskel-base:bookworm", "localhost/affskel:whole"
OPTIONS = ("--points", "20000", "--directions", "triangles+sphere:1000")


class WholeImage(unittest.TestCase):
    def test_same_field_as_the_programs_of_this_build(self):
        containers = engine.Engine(STORAGE)
        self.addCleanup(containers.close)
        engine.import_base(containers, TARBALL, BASE)
        containers.build(SOURCES / "Containerfile", SOURCES.parent.parent, IMAGE, "--build-arg", f"BASE={BASE}")
        with tempfile.TemporaryDirectory(prefix="affskel-whole-") as name:
            place = Path(name)
            place.chmod(0o777)
            environment = engine.bare_environment()
            subprocess.run([PROGRAMS / "affskel-client", "--quiet", "make", "body", "-o", place / "body.off"], check=True,
                           env=environment)
            subprocess.run([PROGRAMS / "affskel-worker", "compute", place / "body.off", *OPTIONS, "-o", place / "ours.csv"],
                           check=True, env=environment, stderr=subprocess.DEVNULL)
            containers.podman("run", "--rm", "--network", "none", "--read-only", "--volume", f"{place}:/place", IMAGE,
                              "affskel-worker", "compute", "/place/body.off", *OPTIONS, "-o", "/place/theirs.csv")
            self.assertGreater((place / "ours.csv").stat().st_size, 1 << 20)
            self.assertTrue((place / "ours.csv").read_bytes() == (place / "theirs.csv").read_bytes())


if __name__ == "__main__":
    unittest.main()
