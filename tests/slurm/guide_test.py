"""The section Slurm of the operations guide, typed as written on a login node: its workers compute a job.

Usage: guide_test.py PROGRAMS DEPLOY-FOLDER"""
import re
import shlex
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import own_namespaces
from cluster import Cluster
from event_log import HANG_S
from lab_service import LabService, new_place

own_namespaces.enter("openssl", "sbatch", "slurmctld", "slurmd", "munged")
PROGRAMS, DEPLOY = (Path(argument).resolve() for argument in sys.argv[1:3])
del sys.argv[1:]

SCRIPTS, GUIDE = DEPLOY / "slurm", DEPLOY / "README.md"
EXAMPLES = Path("/usr/share/doc/affskel-worker/examples/slurm")


class Guide(unittest.TestCase):
    def setUp(self):
        self.place = new_place(self.addCleanup)
        self.install()
        self.lab = LabService(PROGRAMS, self.place, "lab.example.org", 7060)
        self.lab.start()
        self.addCleanup(self.lab.stop)
        (self.place / "slurm").mkdir()
        self.slurm = Cluster(self.place / "slurm", self.lab.environment)
        self.addCleanup(self.slurm.close)

    def install(self):
        """The package's files and the server's name, where the mount namespace of the test alone has them."""
        subprocess.run(["mount", "-t", "tmpfs", "none", "/usr/share/doc"], check=True)
        EXAMPLES.mkdir(parents=True)
        for file in SCRIPTS.iterdir():
            (EXAMPLES / file.name).write_bytes(file.read_bytes())  # without the permission to run
        hosts = self.place / "hosts"
        hosts.write_text("127.0.0.1 localhost lab.example.org\n")
        subprocess.run(["mount", "--bind", hosts, "/etc/hosts"], check=True)

    def type(self, block):
        """What a block says; copies from the server are made without ssh."""
        words = shlex.split(block)
        if words[0] == "scp":
            source = {"server.pem": self.lab.certificate, "worker.token": self.lab.tokens["worker"]}
            shutil.copyfile(source[Path(words[1]).name], words[2].replace("~", str(self.place)))
            return ""
        return subprocess.run(["sh", "-ec", block], env=self.slurm.environment, cwd=self.place, check=True,
                              stdout=subprocess.PIPE, text=True, timeout=HANG_S).stdout

    def test_slurm_section(self):
        section = re.search(r"^## Slurm\n(.*?)^## ", GUIDE.read_text(), re.M | re.S)[1]
        *setting_up, by_hand, kept = re.findall(r"^```sh\n(.*?)^```", section, re.M | re.S)
        for block in setting_up:
            self.type(block)
        shutil.copyfile(self.lab.tokens["user"], self.place / ".config/affskel/token")

        mesh = self.place / "box.off"
        self.lab.client("make", "box", "-o", mesh)
        job = self.lab.client("submit", mesh, "--points", "1000").strip()
        array = self.type(by_hand).split()[-1]
        self.slurm.allocated(array, times=2)
        self.assertEqual(self.lab.client("watch", job).strip(), "done")
        self.assertIn(f"event=done job={job}", "\n".join(self.lab.log.lines))
        self.slurm.run("scancel", array)

        self.lab.client("submit", mesh, "--points", "2000")
        would, does = self.type(kept).splitlines()
        self.assertIn("would be submitted", would)
        array = does.split()[-1]
        self.slurm.allocated(array)
        self.assertEqual(self.lab.client("watch", "@last").strip(), "done")
        self.assertRegex((self.place / f"affskel/affskel-worker-{array}_1.log").read_text(), "event=ready worker=")


if __name__ == "__main__":
    unittest.main()
