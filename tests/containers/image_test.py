"""The image, made by buildah from the packages of this build: what it holds and how it may be run.  It is left for the
tests that start services of it, in two versions.

Usage: image_test.py CONTAINERS-SOURCES BUILD ROOT-TARBALL STORAGE"""
import os
import re
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import engine

engine.enter()
SOURCES, BUILD, TARBALL, STORAGE = engine.paths(4)

BASE, IMAGE, NEWER = "localhost/affskel-base:bookworm", "localhost/affskel:1", "localhost/affskel:2"
BOUND_MB = 200
# No network, nothing to write to but the volumes, nothing that root may do.
CONFINED = ("--network", "none", "--read-only", "--read-only-tmpfs=false", "--cap-drop", "all",
            "--security-opt", "no-new-privileges")
SOCKET = "unix:/var/lib/affskel/server.sock"


class Image(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.engine = engine.Engine(STORAGE)
        cls.addClassCleanup(cls.engine.close)
        engine.import_base(cls.engine, TARBALL, BASE)
        # The stage that compiles is replaced by the packages that are there.
        for name, version in ((IMAGE, "1"), (NEWER, "2")):
            cls.engine.build(SOURCES / "Containerfile", SOURCES.parent.parent, name, "--build-arg", f"BASE={BASE}",
                             "--build-context", f"build={BUILD}", "--label", f"version={version}")

    def program(self, *words, **settings):
        return self.engine.podman("run", "--rm", *CONFINED, IMAGE, *words, **settings)

    def start_server(self, *options):
        """A server with a worker, confined; its container's name."""
        name = self.id().rpartition(".")[2]
        # In the foreground: its first lines tell when it listens.
        server = subprocess.Popen(["podman", "run", "--name", name, *CONFINED, "--volume", f"{name}:/var/lib/affskel",
                                   *options, IMAGE, "affskel-server", "--data-dir", "/var/lib/affskel", "--workers", "1"],
                                  env=self.engine.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.wait)
        self.addCleanup(self.engine.podman, "rm", "--force", "--time", "0", "--volumes", name)
        said = []
        for line in server.stdout:
            said.append(line)
            if "event=listening" in line:
                return name
        raise AssertionError("".join(said))

    def test_small_beyond_the_base(self):
        size, base = (self.engine.inspect(name, "image")["Size"] for name in (IMAGE, BASE))
        print(f"image: {size / 1e6:.1f} MB unpacked, {(size - base) / 1e6:.1f} MB beyond its base", flush=True)
        self.assertLess(size - base, BOUND_MB * 1e6)

    def test_programs_run_as_an_unprivileged_user(self):
        for name in ("affskel-server", "affskel-worker", "affskel-client"):
            self.assertRegex(self.program(name, "--version"), r"\d+\.\d+\.\d+")
        self.assertEqual(self.program("id", "-u").strip(), "760")
        status = self.program("cat", "/proc/self/status")
        for what in ("CapEff", "CapPrm", "CapBnd"):
            self.assertRegex(status, rf"(?m)^{what}:\t0+$")

    def test_nothing_of_building_is_left(self):
        for missing in ("gcc", "cmake", "git"):
            self.assertEqual(self.program("sh", "-c", f"command -v {missing}", check=False), ("", 127))
        self.assertEqual(self.program("sh", "-c", "ls /var/lib/apt/lists /packages /source 2>/dev/null; true").strip(),
                         "/var/lib/apt/lists:")

    def test_image_names_user_port_and_health_check(self):
        configuration = self.engine.inspect(IMAGE, "image")
        self.assertEqual(configuration["User"], "760:760")
        self.assertEqual(configuration["Config"]["ExposedPorts"], {"7060/tcp": {}})
        self.assertEqual(configuration["Healthcheck"]["Test"], ["CMD", "affskel-client", "--server", SOCKET, "health"])

    def test_server_writes_to_its_volume_alone(self):
        name = self.start_server()
        self.assertEqual(self.engine.podman("exec", name, "sh", "-c", "for d in / /tmp /run /var/tmp /etc /usr/bin; do "
                                            "touch $d/written 2>/dev/null && echo $d; done; true"), "")
        # A whole job, derived artefacts included: the mesh and results go through the data directory, for want of others.
        said = self.engine.podman("exec", "--env", f"AFFSKEL_SERVER={SOCKET}", name, "sh", "-ec",
                                  "cd /var/lib/affskel; affskel-client make body -o body.off; "
                                  "affskel-client submit body.off --points 5000 --wait; "
                                  "affskel-client fetch @last skeleton -o s.ply; head -c 3 s.ply")
        self.assertTrue(said.endswith("ply"), said)
        # Mount points are made by the engine, before the program runs; programs have changed nothing.
        changed = self.engine.podman("diff", name).split("\n")
        self.assertEqual([line for line in changed if line.startswith(("A", "D"))
                          and not re.match(r"A /(etc|run|dev|proc|sys)\b", line)], [])

    def test_health_check_tells_whether_the_server_answers(self):
        name = self.start_server()
        self.assertTrue(self.engine.health(name))
        process = self.engine.process(name)
        os.kill(process, signal.SIGSTOP)  # there, with its socket, but without answers
        try:
            self.assertFalse(self.engine.health(name))
        finally:
            os.kill(process, signal.SIGCONT)
        self.assertTrue(self.engine.health(name))
        self.assertEqual(self.engine.podman("exec", name, "affskel-client", "--server", SOCKET, "health"), "serving\n")

    def test_stop_drains(self):
        name = self.start_server()
        self.engine.podman("stop", "--time", "20", name)
        self.assertEqual(self.engine.inspect(name)["State"]["ExitCode"], 0)
        self.assertIn("event=stopped", self.engine.log(name))

    def test_first_start_makes_what_is_missing_and_touches_nothing_else(self):
        with tempfile.TemporaryDirectory(prefix="affskel-first-") as place:
            os.chown(place, 760, 760)
            certificate = ("affskel-first-start", "certificate", "/var/lib/affskel", "DNS:lab.example.org", "IP:192.0.2.7")
            token = ("affskel-first-start", "token", "/var/lib/affskel/token")
            here = ("--volume", f"{place}:/var/lib/affskel")
            made = {}
            for name in ("server.pem.new", "server.key.new", "token.new"):  # of a start that was killed
                (Path(place) / name).touch()
                os.chown(Path(place) / name, 760, 760)
                (Path(place) / name).chmod(0o600)
            for _ in range(2):
                for words in (certificate, token):
                    self.engine.podman("run", "--rm", *CONFINED, *here, IMAGE, *words)
                files = {name: (Path(place) / name).read_bytes() for name in ("server.pem", "server.key", "token")}
                made = made or files
                self.assertEqual(files, made)
            self.assertEqual(list(Path(place).glob("*.new")), [])
            self.assertEqual({path.stat().st_mode & 0o77 for path in Path(place).iterdir() if path.is_file()}, {0})
            names = self.engine.run("openssl", "x509", "-in", f"{place}/server.pem", "-noout", "-ext", "subjectAltName")
            self.assertIn("DNS:lab.example.org, IP Address:192.0.2.7", names)
            roles = self.engine.podman("run", "--rm", *CONFINED, *here, IMAGE, "affskel-server", "token", "list",
                                       "--data-dir", "/var/lib/affskel")
            self.assertEqual(len(re.findall(r"\bworkers\b", roles)), 1, roles)
        self.assertEqual(self.program("affskel-first-start", "certificate", "/tmp", check=False)[1], 2)


if __name__ == "__main__":
    unittest.main()
