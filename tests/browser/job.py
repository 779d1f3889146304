"""A finished job on a private server of its own, and the numbers that its page must show."""
import csv
import json
import os
import signal
import subprocess
import tempfile

NAME = "Body <b>7</b> \"x\" </script> ü"


class Job:
    def __init__(self, client):
        self.client = client
        self.directory = tempfile.TemporaryDirectory(prefix="affskel-browser-", ignore_cleanup_errors=True)
        self.environment = dict(os.environ, AFFSKEL_HOME=self.path("home"), AFFSKEL_SERVER="",
                                XDG_CONFIG_HOME=self.path("config"))
        self.run("make", "body", "--triangles", "500", "-o", self.path("body.off"))
        mesh = self.path("body.off")
        self.id = self.run("submit", mesh, "--points", "12000", "--name", NAME, "--wait").strip()
        self.volume = json.loads(self.run("--json", "status", self.id))["prepared"]["volume"]
        self.page = self.path("page.html")
        self.run("view", self.id, "--operator", "zucker-hummel", "-o", self.page)

    def path(self, name):
        return os.path.join(self.directory.name, name)

    def rows(self, name):
        with open(self.path(name), newline="") as file:
            return list(csv.DictReader(file))

    def run(self, *arguments):
        return subprocess.run([self.client, "--quiet", *arguments], env=self.environment, check=True,
                              stdout=subprocess.PIPE, text=True).stdout

    def skeleton_points(self, threshold):
        """As the skeleton command counts them."""
        return len(self.skeleton_rows(threshold))

    def skeleton_rows(self, threshold):
        self.run("skeleton", self.id, "--operator", "zucker-hummel", "--threshold", str(threshold), "-o", self.path("s.csv"))
        return self.rows("s.csv")

    def eroded(self, share):
        """Triangles and volume, as the erode command tells them."""
        told = json.loads(self.run("--json", "erode", self.id, "--fraction", repr(share), "-o", self.path("e.stl")))
        return told["triangles"], told["volume"]

    def close(self):
        pid = json.loads(self.run("--json", "server-info"))["pid"]
        os.kill(pid, signal.SIGTERM)
        self.directory.cleanup()
