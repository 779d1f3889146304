"""The README's example in Python, as written, against the CSV of affskel-client.

Usage: readme_test.py PROGRAMS PROJECT"""
import os
import re
import sys
import unittest

import numpy as np

import affskel

from lab import PROJECT, Directory, assert_same


def example(file):
    """The first block of Python in a page, in the words of its author."""
    page = (PROJECT / file).read_text(encoding="utf-8")
    return re.search(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)[1]


class Readme(unittest.TestCase):
    def setUp(self):
        self.directory = Directory()
        self.addCleanup(self.directory.remove)
        self.addCleanup(self.directory.stop_private_server)
        self.directory.use_environment(self.addCleanup)
        self.directory.make("body", "--triangles", 500)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.directory.path)

    def assert_results(self, names):
        self.directory.client("fetch", "@last", "field", "-o", "field.csv")
        field = names["field"]
        self.assertIsInstance(field.E, np.ndarray)
        assert_same(field.E, self.directory.rows("field.csv")["E"])
        self.assertEqual(len(field.E), len(field.slope))
        self.assertEqual(names["sheet"].faces.shape[1], 3)
        self.assertGreater(names["sheet"].attributes["E"].min(), 0)
        self.assertGreater(names["solid"].volume, 0)

    def test_the_example_runs_as_written(self):
        for page in ("README.md", "client/python/README.md"):
            with self.subTest(page):
                text = example(page)
                self.assertIn('affskel.submit("body.off", spacing="1%")', text)
                names = {}
                exec(compile(text, page, "exec"), names)  # pylint: disable=exec-used
                self.assert_results(names)

    def test_so_does_the_one_of_the_package(self):
        text = "\n".join(line[4:] for line in affskel.__doc__.split("\n") if line.startswith("    "))
        names = {}
        exec(compile(text, "affskel", "exec"), names)  # pylint: disable=exec-used
        self.assert_results(names)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
