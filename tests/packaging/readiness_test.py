"""What server and worker tell their service manager, and when.  The test is the manager: it owns $NOTIFY_SOCKET.

Usage: readiness_test.py PROGRAMS"""
import os
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAMS = Path(sys.argv.pop(1))


class Manager:
    """A socket for the states of one service at a time."""

    def __init__(self, directory):
        self.path = str(directory / "notify")
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.path)
        self.socket.settimeout(60)  # a service that says nothing at all fails the test, not ctest

    def next_state(self):
        return self.socket.recv(4096).decode()

    def states_so_far(self):
        """What has been told and not been taken yet."""
        states = []
        self.socket.setblocking(False)
        try:
            while True:
                states.append(self.next_state())
        except BlockingIOError:
            return states


class Readiness(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="affskel-ready-")
        self.addCleanup(place.cleanup)
        self.directory = Path(place.name)
        self.data_dir = self.directory / "data"
        self.address = f"unix:{self.data_dir}/server.sock"
        self.manager = Manager(self.directory)
        self.addCleanup(self.manager.socket.close)

    def start(self, program, *options, notify_socket=None, stderr=None):
        environment = dict(os.environ)
        environment.pop("NOTIFY_SOCKET", None)
        if notify_socket:
            environment["NOTIFY_SOCKET"] = notify_socket
        with open(self.directory / f"{program}.log", "ab") as log:
            process = subprocess.Popen([PROGRAMS / program, *options], env=environment, stderr=stderr or log)

        def end():
            process.kill()
            process.wait()

        self.addCleanup(end)
        return process

    def start_server(self, *options, **settings):
        return self.start("affskel-server", "--data-dir", self.data_dir, *options, **settings)

    def server_info(self):
        return subprocess.run([PROGRAMS / "affskel-client", "--server", self.address, "server-info"],
                              stdout=subprocess.DEVNULL, check=False).returncode

    def log_of(self, program):
        return (self.directory / f"{program}.log").read_text()

    def test_server_is_ready_when_its_address_answers_and_says_that_it_stops(self):
        server = self.start_server(notify_socket=self.manager.path)
        self.assertEqual(self.manager.next_state(), "READY=1")
        self.assertEqual(self.server_info(), 0)
        server.send_signal(signal.SIGTERM)
        self.assertEqual(self.manager.next_state(), "STOPPING=1")
        self.assertEqual(server.wait(), 0)
        self.assertEqual(self.manager.states_so_far(), [])

    def test_worker_says_that_it_stops_while_its_server_is_away(self):
        worker = self.start("affskel-worker", "--server", self.address, notify_socket=self.manager.path,
                            stderr=subprocess.PIPE)
        self.addCleanup(worker.stderr.close)
        self.assertEqual(self.manager.next_state(), "READY=1")
        while b"event=server_away" not in worker.stderr.readline():
            self.assertIsNone(worker.poll())
        worker.send_signal(signal.SIGTERM)
        self.assertEqual(self.manager.next_state(), "STOPPING=1")
        self.assertEqual(worker.wait(), 0)
        self.assertEqual(self.manager.states_so_far(), [])

    def test_server_that_cannot_start_is_never_ready(self):
        server = self.start_server("--listen", "192.0.2.1:1", "--insecure", notify_socket=self.manager.path)
        self.assertEqual(server.wait(), 2)
        self.assertEqual(self.manager.states_so_far(), [])

    def test_worker_is_ready_and_says_that_it_stops(self):
        self.start_server()
        worker = self.start("affskel-worker", "--server", self.address, notify_socket=self.manager.path)
        self.assertEqual(self.manager.next_state(), "READY=1")
        self.assertIn("event=ready", self.log_of("affskel-worker"))
        worker.send_signal(signal.SIGTERM)
        self.assertEqual(self.manager.next_state(), "STOPPING=1")
        self.assertEqual(worker.wait(), 0)

    def test_workers_of_a_server_do_not_speak_for_it(self):
        server = self.start_server("--workers", "1", notify_socket=self.manager.path)
        self.assertEqual(self.manager.next_state(), "READY=1")
        # A job needs the worker, so after it the worker has long been ready.
        mesh = self.directory / "cube.off"
        client = [PROGRAMS / "affskel-client", "--quiet", "--server", self.address]
        subprocess.run([*client, "make", "box", "-o", mesh], check=True)
        subprocess.run([*client, "submit", mesh, "--points", "1000", "--wait"], check=True, stdout=subprocess.DEVNULL)
        server.send_signal(signal.SIGTERM)
        self.assertEqual(server.wait(), 0)
        self.assertEqual(self.manager.states_so_far(), ["STOPPING=1"])

    def test_manager_that_is_gone_is_named_in_the_log(self):
        self.manager.socket.close()
        server = self.start_server("--idle-exit", "0", notify_socket=self.manager.path)
        self.assertEqual(server.wait(), 0)
        self.assertIn("event=service_manager_not_told state=\"READY=1\" message=\"Connection refused\"",
                      self.log_of("affskel-server"))


if __name__ == "__main__":
    unittest.main()
