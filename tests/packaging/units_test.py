"""The systemd units, as systemd-analyze reads them, and the configuration that comes with the server.

Usage: units_test.py PROGRAMS PACKAGING-SOURCES"""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAMS, SOURCES = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
del sys.argv[1:]

UNITS = [SOURCES / "server/affskel-server.service", SOURCES / "worker/affskel-worker@.service"]
CONFIGURATION = SOURCES / "server/server.conf"

# Tenths, as systemd counts exposure: 100 is everything allowed; a unit without any of these settings has 96.
EXPOSURE = 16

need_analyze = unittest.skipUnless(shutil.which("systemd-analyze"), "SKIPPED: no systemd-analyze (package systemd)")


class Units(unittest.TestCase):
    @need_analyze
    def test_systemd_understands_them(self):
        with tempfile.TemporaryDirectory() as place:
            copies = [Path(place) / unit.name.replace("@.", "@lab.") for unit in UNITS]
            for unit, copy in zip(UNITS, copies):
                # The programs may not be installed here.
                copy.write_text(unit.read_text().replace("/usr/bin/affskel-", f"{PROGRAMS}/affskel-"))
            done = subprocess.run(["systemd-analyze", "verify", "--man=no", *copies], check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            ours = [line for line in done.stdout.splitlines() if "affskel" in line]
            self.assertEqual((done.returncode, ours), (0, []), done.stdout)

    @need_analyze
    def test_they_allow_little(self):
        for unit in UNITS:
            done = subprocess.run(["systemd-analyze", "security", "--no-pager", "--offline=true",
                                   f"--threshold={EXPOSURE}", unit],
                                  check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(done.returncode, 0, done.stdout)

    def test_they_wait_for_the_programs_to_end_by_themselves(self):
        # The server's two stages take 10 s; a worker finishes the direction in hand.
        for unit, least in zip(UNITS, (11, 30)):
            self.assertGreaterEqual(int(re.search(r"^TimeoutStopSec=(\d+)$", unit.read_text(), re.M)[1]), least)


class Configuration(unittest.TestCase):
    def test_every_option_of_the_server_stands_in_it(self):
        told = subprocess.run([PROGRAMS / "affskel-server", "--help"], check=True, stdout=subprocess.PIPE,
                              text=True).stdout
        options = set(re.findall(r"^ +(?:-h,)?--([a-z-]+)", told, re.M)) - {"help", "version", "config", "data-dir"}
        written = set(re.findall(r"^#?([a-z-]+) = ", CONFIGURATION.read_text(), re.M))
        self.assertGreater(len(options), 15)
        self.assertEqual(written, options)

    def serve(self, text, place):
        """Exit code and log of a server with this configuration that leaves at once."""
        file = place / "server.conf"
        file.write_text(text.replace("/run/affskel", str(place)))
        done = subprocess.run([PROGRAMS / "affskel-server", "--data-dir", place / "data", "--config", file,
                               "--idle-exit", "0"], check=False, stderr=subprocess.PIPE, text=True, timeout=60)
        return done.returncode, done.stderr

    def test_it_starts_a_server_as_it_stands(self):
        with tempfile.TemporaryDirectory(prefix="affskel-units-") as place:
            code, log = self.serve(CONFIGURATION.read_text(), Path(place))
            self.assertEqual(code, 0, log)
            self.assertIn(f"event=listening address=unix:{place}/server.sock", log)

    def test_every_line_is_one_that_the_server_takes(self):
        lines = re.findall(r"^#?([a-z-]+ = .*)$", CONFIGURATION.read_text(), re.M)
        # Files that are not here, and an address of all machines; that they are read is tests' of access.
        for skipped in ("tls-", "listen = [\"unix:/run/affskel/server.sock\", ", "worker-binary", "idle-exit"):
            self.assertTrue([line for line in lines if line.startswith(skipped)], skipped)
            lines = [line for line in lines if not line.startswith(skipped)]
        text = "\n".join(lines).replace("127.0.0.1:9464", "127.0.0.1:0")
        with tempfile.TemporaryDirectory(prefix="affskel-units-") as place:
            code, log = self.serve(text, Path(place))
            self.assertEqual(code, 0, log)
            self.assertIn("event=metrics", log)

    def test_misspelt_line_is_refused_with_its_name_and_the_files(self):
        with tempfile.TemporaryDirectory(prefix="affskel-units-") as place:
            code, log = self.serve('qota = ["queued-jobs=1"]\n', Path(place))
            self.assertEqual(code, 2)
            self.assertRegex(log, rf"(?m)^{place}/server.conf: .*qota")


if __name__ == "__main__":
    unittest.main()
