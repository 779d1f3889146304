"""A lab's server as other machines see it: TLS, and a token for every user."""
import json
import os
import signal
import subprocess
import tempfile
from pathlib import Path

from event_log import HANG_S, EventLog


def new_place(add_cleanup):
    """An empty directory that other users may look into.  add_cleanup: a test's addCleanup or addClassCleanup."""
    place = tempfile.TemporaryDirectory(prefix="affskel-lab-", ignore_cleanup_errors=True)
    add_cleanup(place.cleanup)
    Path(place.name).chmod(0o755)
    return Path(place.name)


class LabService:
    """A server with its certificate, tokens and data under one directory; start() runs it."""

    def __init__(self, programs, directory, name, port):
        """name: of the server in its certificate and its address.  port: 0 = any free one."""
        self.programs, self.directory, self.name = programs, directory, name
        self.address = f"{name}:{port}"
        self.data = directory / "data"
        self.processors = os.sched_getaffinity(0)
        self.certificate = directory / "server.pem"
        # Nothing of the user that runs the test is configured.
        others = ("AFFSKEL_", "SLURM_", "SBATCH_")
        mine = {key: value for key, value in os.environ.items() if not key.startswith(others)}
        self.environment = dict(mine, HOME=str(directory), XDG_CONFIG_HOME=str(directory / "config"),
                                PATH=f"{programs}:{os.environ['PATH']}")
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                        "-days", "2", "-subj", f"/CN={name}", "-addext", f"subjectAltName=DNS:{name}",
                        "-keyout", directory / "server.key", "-out", self.certificate],
                       check=True, stderr=subprocess.DEVNULL)
        self.tokens = {role: self.add_token(role) for role in ("user", "worker", "admin")}

    def add_token(self, role):
        file = self.directory / f"{role}.token"
        with open(os.open(file, os.O_WRONLY | os.O_CREAT, 0o600), "w", encoding="ascii") as out:
            subprocess.run([self.programs / "affskel-server", "token", "add", "--data-dir", self.data, "--owner", role,
                            "--role", role], check=True, stdout=out, stderr=subprocess.DEVNULL)
        return file

    def start(self, *options, inside=()):
        """Runs the server, by a command such as nsenter when there is one before it; returns when it answers."""
        self.process = subprocess.Popen(
            [*inside, self.programs / "affskel-server", "--data-dir", self.data, "--listen", self.address,
             "--tls-cert", self.certificate, "--tls-key", self.directory / "server.key", *options],
            env=self.environment, stderr=subprocess.PIPE, text=True)
        self.log = EventLog(self.process.stderr)
        self.address = self.log.wait_for(rf"event=listening address=({self.name}:\S+)")[0][1]

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait()
        assert code == 0, code

    def access(self, role):
        """The options by which a caller of that role comes."""
        return ["--server", self.address, "--tls-ca", str(self.certificate), "--token-file", str(self.tokens[role])]

    def client(self, *arguments, inside=()):
        """What affskel-client prints to the user; it must succeed."""
        return subprocess.run([*inside, self.programs / "affskel-client", "--quiet", *self.access("user"), *arguments],
                              env=self.environment, check=True, stdout=subprocess.PIPE, text=True,
                              timeout=HANG_S).stdout

    def job(self, job, inside=()):
        return json.loads(self.client("--json", "status", job, inside=inside))

    def options_of_a_job(self, mesh, seconds):
        """Of one that takes a processor of this machine about so long; from now on everything is run by one.

        So a job outlasts what is done to its workers on a fast machine, too, and on one with many processors."""
        os.sched_setaffinity(0, {min(self.processors)})
        points, directions = ("--points", "60000"), 20000
        before = os.times()
        self.computed(mesh, *points, "--directions", f"sphere:{directions}")
        after = os.times()
        spent = after.children_user + after.children_system - before.children_user - before.children_system
        return *points, "--directions", f"sphere:{round(directions * seconds / spent)}"

    def computed(self, mesh, *options):
        """The field that this machine alone computes, by all its processors, as CSV: what no service has touched."""
        file = self.directory / "computed.csv"
        subprocess.run([self.programs / "affskel-worker", "compute", mesh, *options,
                        "--threads", str(len(self.processors)), "-o", file],
                       preexec_fn=lambda: os.sched_setaffinity(0, self.processors), env=self.environment, check=True,
                       stderr=subprocess.DEVNULL)
        return file.read_bytes()

    def fetched(self, job, inside=()):
        """The field of a job, as CSV."""
        file = self.directory / "fetched.csv"
        self.client("fetch", job, "field", "-o", file, inside=inside)
        return file.read_bytes()
