"""Real programs under a test: a server in a directory of its own, and affskel-client as the other opinion."""
import contextlib
import csv
import json
import os
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import affskel

PROGRAMS, PROJECT = Path(sys.argv[1]), Path(sys.argv[2])
CLIENT, SERVER, WORKER = (str(PROGRAMS / f"affskel-{name}") for name in ("client", "server", "worker"))


def assert_same(ours, theirs, what=""):
    """Equal arrays, element by element.  assertEqual would look for what long lists have in common, for minutes."""
    np.testing.assert_array_equal(np.asarray(ours), np.asarray(theirs), what)


class Directory:
    """A directory for one test class, with an environment in which nothing of the user's is configured."""

    def __init__(self):
        self.path = Path(tempfile.mkdtemp(prefix="affskel-python-"))
        mine = {name: value for name, value in os.environ.items() if not name.startswith("AFFSKEL_")}
        self.environment = dict(mine, AFFSKEL_HOME=str(self.path / "home"), XDG_CONFIG_HOME=str(self.path / "config"),
                                PATH=f"{PROGRAMS}:{os.environ['PATH']}")

    def __truediv__(self, name):
        return self.path / name

    def remove(self):
        shutil.rmtree(self.path)

    def use_environment(self, add_cleanup):
        """This process has the environment until the cleanups of a test, a class or a module."""
        before = dict(os.environ)

        def back():
            os.environ.clear()
            os.environ.update(before)

        os.environ.clear()
        os.environ.update(self.environment)
        add_cleanup(back)

    def client(self, *arguments):
        """What affskel-client prints; it must succeed."""
        return subprocess.run([CLIENT, "--quiet", *map(str, arguments)], env=self.environment, check=True,
                              stdout=subprocess.PIPE, text=True).stdout

    def client_notes(self, *arguments):
        """What affskel-client, which must succeed, tells people."""
        return subprocess.run([CLIENT, *map(str, arguments)], env=self.environment, check=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True).stderr

    def client_error(self, *arguments):
        """The error of affskel-client, which must fail: exit code, and what it says as JSON."""
        done = subprocess.run([CLIENT, "--json", *map(str, arguments)], env=self.environment, check=False,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        assert done.returncode != 0, arguments
        return done.returncode, json.loads(done.stderr.splitlines()[-1])["error"]

    def make(self, shape, *options):
        """A mesh file, named after the shape."""
        file = self / f"{shape}.off"
        self.client("make", shape, *options, "-o", file)
        return file

    def rows(self, name):
        """A CSV file of affskel-client by columns of numbers."""
        with open(self / name, newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        return {name: [float(row[name]) for row in rows] for name in rows[0]}

    def stop_private_server(self):
        """Waits for its end, if one runs: it is no child of this process."""
        file = Path(self.environment["AFFSKEL_HOME"]) / "server.json"
        if not file.exists():
            return
        pid = json.loads(file.read_text())["pid"]
        with contextlib.closing(os.fdopen(os.pidfd_open(pid))) as process:
            os.kill(pid, signal.SIGTERM)
            select.select([process], [], [])


class Server:
    """affskel-server on a Unix socket, or at other addresses, in DIRECTORY/data."""

    def __init__(self, directory, *options, workers=1, listeners=1):
        """listeners: how many addresses it is going to have; a Unix socket of its own is among them with workers."""
        self.directory = directory
        self.command = [SERVER, "--data-dir", str(directory / "data"), "--workers", str(workers), "--idle-exit", "300",
                        *map(str, options)]
        self.listeners = listeners
        self.start()

    def start(self):
        """Its sockets are there when it logs that it listens."""
        self.process = subprocess.Popen(self.command, env=self.directory.environment, stderr=subprocess.PIPE, text=True)
        self.addresses, said = [], []
        while len(self.addresses) < self.listeners:
            said.append(self.process.stderr.readline())
            if not said[-1]:
                raise RuntimeError(f"the server ended with {self.process.wait()}: {''.join(said)}")
            self.addresses += re.findall(r"event=listening address=(\S+)", said[-1])
        # A full pipe would stop the server.
        self.drain = threading.Thread(target=self.process.stderr.read, daemon=True)
        self.drain.start()

    @property
    def address(self):
        return self.addresses[0]

    def end(self, with_signal=signal.SIGTERM):
        self.process.send_signal(with_signal)
        code = self.process.wait()
        self.drain.join()
        self.process.stderr.close()
        if with_signal == signal.SIGTERM:
            assert code == 0, code


def serve_module():
    """For setUpModule: a directory, a server that its environment names, and a client of it, until the module ends."""
    directory = Directory()
    unittest.addModuleCleanup(directory.remove)
    server = Server(directory)
    unittest.addModuleCleanup(server.end)
    directory.environment["AFFSKEL_SERVER"] = server.address
    directory.use_environment(unittest.addModuleCleanup)
    client = affskel.Client(server.address)
    unittest.addModuleCleanup(client.close)
    return directory, server, client
