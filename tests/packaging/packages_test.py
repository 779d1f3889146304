"""What the Debian packages hold, read by dpkg-deb, and what lintian thinks of them.

Usage: packages_test.py BUILD CPACK VERSION

Makes the packages from the programs as they are built; leaves them in BUILD/packages."""
import functools
import io
import re
import shutil
import subprocess
import sys
import tarfile
import unittest
from pathlib import Path

BUILD, CPACK, VERSION = Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3]
del sys.argv[1:]

# Not for Debian's archive: no bug asks for the package.  Manual pages: --help has everything; the client brings its own.
TOLERATED = "initial-upload-closes-no-bugs,no-manual-page"

DOCUMENTS = {"changelog.gz", "changelog.Debian.gz", "copyright", "README.md"}
NEEDED = {  # libraries that the programs cannot do without, by what they do
    "affskel-server": {"adduser", "libgrpc++1.51", "libsqlite3-0", "libssl3", "libsystemd0", "libprometheus-cpp-core1.0"},
    "affskel-worker": {"libgrpc++1.51", "libgmp10", "libhdf5-103-1", "libsystemd0"},
    "affskel-client": {"libgrpc++1.51", "libpng16-16", "libssl3"},
}
UNWANTED = {"affskel-server": {"libgmp10", "libhdf5-103-1"}, "affskel-worker": {"libsqlite3-0"},
            "affskel-client": {"libsqlite3-0", "libsystemd0"}}


def setUpModule():
    # xz, as which packages are given out, takes longer than all else of making them.
    subprocess.run([CPACK, "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-D",
                    "CPACK_DEBIAN_COMPRESSION_TYPE=gzip"], cwd=BUILD, check=True, stdout=subprocess.DEVNULL)


def package(name):
    (file,) = (BUILD / "packages").glob(f"{name}_{VERSION}-1_*.deb")
    return file


@functools.cache  # unpacked once for all tests
def members(name, part="--fsys-tarfile"):
    """What a package installs, or its control files, by path: tarfile's entries, and the contents of files."""
    data = subprocess.run(["dpkg-deb", part, package(name)], check=True, stdout=subprocess.PIPE).stdout
    with tarfile.open(fileobj=io.BytesIO(data)) as tar:
        return {entry.name.removeprefix("./"): (entry, tar.extractfile(entry).read() if entry.isfile() else None)
                for entry in tar}


def field(name, which):
    return subprocess.run(["dpkg-deb", "-f", package(name), which], check=True, stdout=subprocess.PIPE,
                          text=True).stdout.strip()


class Packages(unittest.TestCase):
    def files(self, name):
        return {path for path, (entry, _) in members(name).items() if entry.isfile()}

    def documents(self, name):
        return {f"usr/share/doc/{name}/{document}" for document in DOCUMENTS}

    def test_server_holds_program_unit_and_configuration(self):
        self.assertEqual(self.files("affskel-server"), self.documents("affskel-server") | {
            "usr/bin/affskel-server", "lib/systemd/system/affskel-server.service", "etc/affskel/server.conf",
            *(f"usr/share/doc/affskel-server/examples/monitoring/{file}" for file in
              ("affskel.rules.yml", "dashboard.json"))})

    def test_worker_holds_program_unit_and_examples(self):
        self.assertEqual(self.files("affskel-worker"), self.documents("affskel-worker") | {
            "usr/bin/affskel-worker", "lib/systemd/system/affskel-worker@.service",
            *(f"usr/share/doc/affskel-worker/examples/{file}" for file in
              ("worker.conf", "client-certificate.conf", "slurm/workers.sbatch", "slurm/workers.conf", "slurm/keep-workers"))})
        self.assertIn("etc/affskel/workers", members("affskel-worker"))

    def test_client_holds_program_and_what_helps_to_use_it(self):
        rest = self.files("affskel-client") - self.documents("affskel-client") - {"usr/bin/affskel-client"}
        for path in rest:
            self.assertRegex(path, r"^usr/share/(man/man1|bash-completion|zsh|fish)/")

    def test_everything_belongs_to_root_and_nobody_else_writes(self):
        for name in NEEDED:
            for path, (entry, _) in members(name).items():
                self.assertEqual((entry.uid, entry.gid), (0, 0), path)
                if entry.isdir() or path.startswith("usr/bin/"):
                    self.assertEqual(entry.mode, 0o755, path)
                else:
                    self.assertEqual(entry.mode, 0o644, path)

    def test_dependencies_are_those_of_the_programs(self):
        for name, needed in NEEDED.items():
            depends = set(re.findall(r"([a-z0-9.+-]+)(?: \([^)]*\))?(?:, |$)", field(name, "Depends")))
            self.assertLessEqual(needed, depends, name)
            self.assertFalse(depends & UNWANTED[name], name)

    def test_configuration_of_the_server_is_a_conffile(self):
        _, conffiles = members("affskel-server", "--ctrl-tarfile")["conffiles"]
        self.assertEqual(conffiles.decode().split(), ["/etc/affskel/server.conf"])

    def test_programs_are_stripped(self):
        for name in NEEDED:
            _, program = members(name)[f"usr/bin/{name}"]
            self.assertNotIn(b".symtab\0", program)

    def test_same_build_makes_same_documents(self):
        # gzip would write the time into the header: bytes 4 to 7.
        for name in NEEDED:
            for document in ("changelog.gz", "changelog.Debian.gz"):
                _, text = members(name)[f"usr/share/doc/{name}/{document}"]
                self.assertEqual(text[4:8], bytes(4))

    @unittest.skipUnless(shutil.which("lintian"), "SKIPPED: no lintian; deploy/run-tests --all installs it")
    def test_lintian_finds_nothing(self):
        done = subprocess.run(["lintian", "--allow-root", "--fail-on", "error,warning", "--suppress-tags", TOLERATED,
                               *map(package, NEEDED)], check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main()
