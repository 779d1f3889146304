#!/usr/bin/env python3
"""Ends of the server and of the worker at limits of threads, memory and descriptors, over TLS and under load.

Each end starts a program under a limit drawn from the seed, so that it serves a little, or cannot start at all, loads
it, and tells it to leave.  Counted is how it ended and after how long: none may take longer than LONGEST_S, need
SIGKILL, or leave a worker behind.  The programs run as a user of their own, since limits of processes do not bind root.

Usage: ends.py PROGRAMS [--seed N] [--ends N] [--kinds KIND...] [--keep DIR]
"""
import argparse
import collections
import contextlib
import os
import random
import resource
import select
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
from event_log import EventLog  # noqa: E402
from lab_service import LabService  # noqa: E402

LONGEST_S = 70
# Between a signal and the next, which finds the program at its end.
AGAIN_S = 0.05
# No account's, and each run's own: processes count by user.  The server of a worker's end is another's.
USER = 61_000 + os.getpid() % 1000
OTHER_USER = USER + 1000
PROGRAMS = ("affskel-server", "affskel-worker", "affskel-client")
LISTENING = r"event=listening address=localhost:(\d+)"
PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + bytes([0, 0, 0, 4, 0, 0, 0, 0, 0])

RESOURCES = {"threads": resource.RLIMIT_NPROC, "memory": resource.RLIMIT_AS, "descriptors": resource.RLIMIT_NOFILE}

# What is drawn: around what each has when nothing is to be done, 36 threads, 520 MB and 20 descriptors of a server,
# 8 threads, 500 MB and 10 descriptors of a worker.
BOUNDS = {
    "server-threads": (20, 60), "server-memory": (250 << 20, 900 << 20), "server-descriptors": (8, 60),
    "worker-threads": (1, 20), "worker-memory": (150 << 20, 900 << 20), "worker-descriptors": (5, 30),
    "server-none": (0, 0),
}
KINDS = list(BOUNDS)


def as_user(user, limit, value):
    """What a child does before it becomes the program."""
    def become():
        os.setgroups([])
        os.setgid(user)
        if limit:
            resource.setrlimit(RESOURCES[limit], (value, value))
        os.setuid(user)
    return become


class Load:
    """Callers that come and stay, half a handshake, and clients, until it is stopped."""

    def __init__(self, lab, port):
        self.port, self.stopped = port, threading.Event()
        self.client = ["prlimit", "--core=0", lab.programs / "affskel-client", *lab.access(port, "user")]
        self.context = ssl.create_default_context(cafile=lab.certificate)
        self.context.set_alpn_protocols(["h2"])
        self.threads = [threading.Thread(target=self.connect, args=(whole,)) for whole in (True, True, True, False)]
        self.threads += [threading.Thread(target=self.call, args=(arguments,)) for arguments in (
            ("submit", lab.mesh, "--points", "3000"), ("list",), ("list", "--json"))]
        for thread in self.threads:
            thread.start()

    def stop(self):
        self.stopped.set()
        for thread in self.threads:
            thread.join()

    def connect(self, whole):
        held = collections.deque(maxlen=12)
        while not self.stopped.wait(0.01):
            try:
                connection = socket.create_connection(("127.0.0.1", self.port), timeout=0.5)
                if whole:
                    connection = self.context.wrap_socket(connection, server_hostname="localhost")
                    connection.sendall(PREFACE)
                else:
                    connection.sendall(b"\x16\x03\x01")
                held.append(connection)
            except OSError:
                pass
        for connection in held:
            connection.close()

    def call(self, arguments):
        while not self.stopped.wait(0.01):
            process = subprocess.Popen([*self.client, *arguments], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            while process.poll() is None and not self.stopped.wait(0.02):
                pass
            process.kill()
            process.wait()


class Lab(LabService):
    """What all ends share: programs that the user may run, a certificate, tokens, a mesh, a database to copy."""

    def __init__(self, programs, place):
        place.chmod(0o755)
        shutil.copytree(programs, place / "bin", ignore=lambda _, names: set(names) - set(PROGRAMS))
        super().__init__(place / "bin", place, "localhost", 0)
        self.mesh = place / "torus.off"
        subprocess.run([self.programs / "affskel-client", "--quiet", "make", "torus", "--triangles", "400", "-o",
                        self.mesh], check=True, env=self.environment)
        for file in (place / "server.key", self.tokens["worker"]):
            file.chmod(0o644)

    def access(self, port, role):
        return ["--server", f"localhost:{port}", "--tls-ca", self.certificate, "--token-file", self.tokens[role]]

    def server(self, name, user, options=(), limit=None, value=0):
        """One with a data directory of that user's own."""
        data = self.directory / name / "data"
        shutil.copytree(self.data, data)
        for path in (data.parent, data, *data.iterdir()):
            os.chown(path, user, user)
        return Program([self.programs / "affskel-server", "--data-dir", data, "--listen", "localhost:0", "--tls-cert",
                        self.certificate, "--tls-key", self.directory / "server.key", *options],
                       data.parent / "server.log", self.environment, as_user(user, limit, value))

    def worker(self, name, port, limit, value):
        return Program([self.programs / "affskel-worker", *self.access(port, "worker"), "--threads", "2"],
                       self.directory / name / "worker.log", self.environment, as_user(USER, limit, value))


class Program:
    """A process, and its log, which becomes a file at the end."""

    def __init__(self, command, file, environment, become):
        self.file = file
        self.process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True, errors="replace", preexec_fn=become)
        self.log = EventLog(self.process.stderr)

    def wait_for(self, pattern):
        """What matches in its log; nothing when it ends without having said it."""
        try:
            return self.log.wait_for(pattern)[0]
        except AssertionError:
            return None

    def serve(self, seconds):
        """Lets it run so long, unless it ends before."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(seconds)

    def end(self, signals):
        """Tells it, waits: how it ended and after how many seconds."""
        begin = time.monotonic()
        for number in signals:
            self.process.send_signal(number)
            self.serve(AGAIN_S)
        try:
            code = self.process.wait(LONGEST_S)
        except subprocess.TimeoutExpired:
            code = None
            self.process.kill()
            self.process.wait()
        seconds = time.monotonic() - begin
        self.file.write_text("\n".join(self.log.lines) + "\n", encoding="utf-8")
        how = "HANGS" if code is None else f"exit {code}" if code >= 0 else signal.Signals(-code).name
        return how, seconds


def left_behind():
    """Processes of the user that are still there when their time has passed, too; they are ended."""
    def alive():
        return [int(entry.name) for entry in Path("/proc").iterdir()
                if entry.name.isdigit() and entry.exists() and entry.stat().st_uid == USER
                and (entry / "stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()[0] != "Z"]

    def look():
        try:
            return alive()
        except OSError:  # it left meanwhile
            return look()

    give_up = time.monotonic() + LONGEST_S
    while (pids := look()) and time.monotonic() < give_up:
        wait_for_end(pids[0], give_up - time.monotonic())
    for pid in pids:
        os.kill(pid, signal.SIGKILL)
    return len(pids)


def wait_for_end(pid, seconds):
    """Of a process that is no child, for so long at most."""
    try:
        process = os.pidfd_open(pid)
    except ProcessLookupError:
        return
    try:
        select.select([process], [], [], seconds)
    finally:
        os.close(process)


def make_an_end(lab, name, kind, draw):
    """One end: how, after how long, whether it served before, and what it left behind."""
    program, limit = kind.split("-")
    limit = limit if limit in RESOURCES else None
    value = draw.randint(*BOUNDS[kind])
    signals = draw.choice([[signal.SIGTERM]] * 3 + [[signal.SIGINT], [signal.SIGTERM] * 2])
    in_start, serving_s = draw.random() < 0.2, draw.uniform(0.2, 2.5)
    workers = draw.choice([[], ["--workers", "1"]])
    subject = None
    if program == "worker":
        server = lab.server(name, OTHER_USER)
        port = int(server.wait_for(LISTENING)[1])
        subject = lab.worker(name, port, limit, value)
    else:
        server = subject = lab.server(name, USER, workers, limit, value)
    load = None
    if in_start:
        subject.serve(draw.uniform(0, 0.3))
    elif ready := subject.wait_for(LISTENING if program == "server" else "event=ready"):
        if program == "server":
            port = int(ready[1])
        load = Load(lab, port)
        subject.serve(serving_s)
    served = load is not None and subject.process.poll() is None
    how, seconds = subject.end(signals)
    if load:
        load.stop()
    if server is not subject:
        server.end([signal.SIGTERM] * 2)
    return how, seconds, value, served, left_behind()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--ends", type=int, default=100)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--keep", type=Path, help="where the logs of ends that failed go")
    options = parser.parse_args()
    if os.geteuid() != 0:
        print("SKIPPED: limits of processes bind a user of one's own alone, whom only root can become")
        return 77
    table = collections.defaultdict(list)
    bad = 0
    with tempfile.TemporaryDirectory(prefix="affskel-ends-", ignore_cleanup_errors=True) as place:
        lab = Lab(options.programs, Path(place))
        for number in range(options.ends):
            kind = options.kinds[number % len(options.kinds)]
            how, seconds, value, served, left = make_an_end(lab, str(number), kind,
                                                            random.Random(f"{options.seed} {number}"))
            # Libraries abort, or trip over what they did not get, when memory is short: an end, too.
            crashed = how in ("SIGSEGV", "SIGBUS") and not kind.endswith("-memory")
            failed = how in ("HANGS", "SIGKILL") or crashed or seconds > LONGEST_S or left
            bad += bool(failed)
            table[kind].append((how, seconds, served))
            print(f"{number:4} {kind:20} limit {value:>10} {'served' if served else 'did not':8}"
                  f" {how:8} {seconds:6.2f} s" + (f" LEFT {left} processes" if left else ""), flush=True)
            if failed and options.keep:
                shutil.copytree(lab.directory / str(number), options.keep / str(number), dirs_exist_ok=True)
            shutil.rmtree(lab.directory / str(number))
    print(f"\n{'kind':20} {'ends':>5} {'served':>6} {'longest/s':>9}  how")
    for kind, ends in table.items():
        ways = collections.Counter(how for how, _, _ in ends)
        print(f"{kind:20} {len(ends):5} {sum(served for _, _, served in ends):6}"
              f" {max(seconds for _, seconds, _ in ends):9.2f}  "
              + ", ".join(f"{count} {how}" for how, count in sorted(ways.items())))
    print(f"{bad} of {options.ends} ends took longer than {LONGEST_S} s, crashed or left processes behind")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
