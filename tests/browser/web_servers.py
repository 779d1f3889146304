"""Servers behind the page of affskel-client web: a private one, and one that asks for tokens."""
import json
import os
import signal
import subprocess
import tempfile
import threading

from web_page import Service


class Bench:
    """A private server's home, meshes, and the client beside the page."""

    def __init__(self, client):
        self.client = client
        self.directory = tempfile.TemporaryDirectory(prefix="affskel-web-", ignore_cleanup_errors=True)
        self.environment = dict(os.environ, AFFSKEL_HOME=self.path("home"), AFFSKEL_SERVER="",
                                XDG_CONFIG_HOME=self.path("config"))
        for name, triangles in [("body.off", "500"), ("large.off", "5000")]:
            self.run("make", "body", "--triangles", triangles, "-o", self.path(name))
        self.run("make", "box", "--size", "100,200,300", "-o", self.path("box.off"))
        with open(self.path("box.off"), encoding="ascii") as whole, \
             open(self.path("open.off"), "w", encoding="ascii") as broken:
            lines = whole.read().splitlines()
            lines[1] = lines[1].replace("12", "11", 1)
            broken.write("\n".join(lines[:-1]) + "\n")

    def path(self, name):
        return os.path.join(self.directory.name, name)

    def run(self, *arguments):
        return subprocess.run([self.client, "--quiet", *arguments], env=self.environment, check=True,
                              stdout=subprocess.PIPE, text=True).stdout

    def drop(self, job):
        """Cancels and deletes it, whatever became of it."""
        for command in ("cancel", "delete"):
            subprocess.run([self.client, "--quiet", command, job], env=self.environment, check=False,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def close(self):
        pid = json.loads(self.run("--json", "server-info"))["pid"]
        os.kill(pid, signal.SIGTERM)
        self.directory.cleanup()


class Away:
    """A server without workers that comes and goes, and the page beside it, which is its user's."""

    def __init__(self, client, server, environment):
        self.directory = tempfile.TemporaryDirectory(prefix="affskel-away-", ignore_cleanup_errors=True)
        address = "unix:" + os.path.join(self.directory.name, "s")
        self.command = [server, "--data-dir", os.path.join(self.directory.name, "data"), "--listen", address, "--workers", "0"]
        self.come()
        self.service = Service(client, environment, "--server", address)

    def come(self):
        self.server = subprocess.Popen(self.command, stderr=subprocess.PIPE, text=True)
        next(line for line in self.server.stderr if "event=listening" in line)

    def go(self):
        self.server.send_signal(signal.SIGTERM)
        self.server.communicate()

    def close(self):
        code = self.service.close()
        if self.server.returncode is None:
            self.go()
        self.directory.cleanup()
        return code


class Lab:
    """A server that asks for tokens, with a worker, and the page beside it."""

    def __init__(self, client, server, environment):
        self.program = server
        self.directory = tempfile.TemporaryDirectory(prefix="affskel-lab-", ignore_cleanup_errors=True)
        self.data = os.path.join(self.directory.name, "data")
        self.tokens = {"ada": self.token("add", "--owner", "ada"), "bob": self.token("add", "--owner", "bob"),
                       "root": self.token("add", "--owner", "root", "--role", "admin")}
        self.server = subprocess.Popen([server, "--data-dir", self.data, "--listen", "127.0.0.1:0", "--workers", "1",
                                        "--retention", "bob:results-age=1d"], stderr=subprocess.PIPE, text=True)
        described = os.path.join(self.data, "server.json")
        for _ in self.server.stderr:
            if os.path.exists(described):
                break
        # A full pipe would stop the server.
        self.drain = threading.Thread(target=self.server.stderr.read)
        self.drain.start()
        with open(described, encoding="utf-8") as file:
            address = next(a for a in json.load(file)["addresses"] if not a.startswith("unix:"))
        self.service = Service(client, dict(environment, AFFSKEL_TOKEN_FILE=""), "--server", address)

    def token(self, *arguments):
        return subprocess.run([self.program, "token", arguments[0], "--data-dir", self.data, *arguments[1:]], check=True,
                              stdout=subprocess.PIPE, text=True).stdout.strip()

    def close(self):
        code = self.service.close()
        self.server.send_signal(signal.SIGTERM)
        self.server.wait()
        self.drain.join()
        self.server.stderr.close()
        self.directory.cleanup()
        return code
