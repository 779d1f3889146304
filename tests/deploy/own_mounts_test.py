"""Where no mounts can be made, as in a plain chroot, tests that need some are skipped, and say what to do.

Usage: own_mounts_test.py FOLDER-OF-TOOLS"""
import os
import subprocess
import sys
import tempfile
import unittest

TOOLS = sys.argv.pop()


class PlainChroot(unittest.TestCase):
    def test_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "unshare")
            with open(program, "w", encoding="ascii") as file:
                file.write("#!/bin/sh\necho 'unshare: cannot change root filesystem propagation: Invalid argument' >&2\nexit 1\n")
            os.chmod(program, 0o755)
            done = subprocess.run([sys.executable, "-B", "-c", "import own_namespaces; own_namespaces.require_own_mounts()"],
                                  env=dict(os.environ, PYTHONPATH=TOOLS, PATH=f"{folder}:{os.environ['PATH']}"), check=False,
                                  stdout=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 77)
        self.assertRegex(done.stdout, "^SKIPPED: no mounts of its own .*mount --bind ROOT ROOT")


if __name__ == "__main__":
    unittest.main()
