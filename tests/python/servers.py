"""Tests that each have a directory and servers of their own, and the mesh that most of them submit."""
import unittest

import affskel

from lab import Directory, Server

CUBE = ("OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n")
OPEN_CUBE = CUBE.replace("8 6 0", "8 5 0", 1).replace("4 3 0 4 7\n", "")


class WithDirectory(unittest.TestCase):
    def setUp(self):
        self.directory = Directory()
        self.addCleanup(self.directory.remove)
        self.directory.use_environment(self.addCleanup)

    def server(self, *options, workers=1):
        server = Server(self.directory, *options, workers=workers)
        self.addCleanup(lambda: server.process.poll() is None and server.end())
        return server

    def client(self, server, **options):
        return self.enterContext(affskel.Client(server.address, **options))
