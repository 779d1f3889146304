"""What the tests of the page of affskel-client web share: a bench with a server, browsers, and a visit.

Scripts are called with the paths of AFFSKEL-CLIENT and AFFSKEL-SERVER and, if not all shall run, the tests' names.
"""
import os
import sys
import unittest

if not all(os.path.isfile(os.environ.get(program, "")) for program in ["CHROMIUM", "CHROMEDRIVER"]):
    print("no chromium or chromedriver: skipped")
    sys.exit(77)

from web_page import Browsers, Service
from web_servers import Bench

DESKTOP = dict(width=1200, height=900)
PHONE = dict(width=390, height=780, phone=True)


class OnABench(unittest.TestCase):
    client, server = sys.argv[1:3]
    bench: Bench
    browsers: Browsers


def setUpModule():
    """For the module that imports it."""
    OnABench.bench = Bench(OnABench.client)
    unittest.addModuleCleanup(OnABench.bench.close)
    OnABench.browsers = Browsers()
    unittest.addModuleCleanup(OnABench.browsers.running.close)


def main():
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)


class OnThePage(OnABench):
    window = DESKTOP

    def setUp(self):
        self.service = Service(self.client, self.bench.environment)
        self.addCleanup(self.stop)
        self.page = self.enterContext(self.browsers.visitor(**self.window))
        self.page.open(self.service.address)
        self.page.heading("Jobs")

    def stop(self):
        self.assertEqual(self.service.close(), 0)

    def tearDown(self):
        self.assertEqual(self.page.errors(), [])
        asked = self.page.asked()
        self.assertTrue(asked)
        self.assertEqual([url for url in asked if not url.startswith(self.service.origin + "/")], [])

    def choose(self, name):
        self.page.wait(lambda: self.page.all("#file"))[0].send_keys(self.bench.path(name))

    def submit_endless(self, name, points=3000000):
        """A job that no worker gets to the end of, however slow the browser is; it does not outlive the test."""
        job = self.bench.run("submit", self.bench.path("large.off"), "--points", str(points), "--directions",
                             "sphere:1000000", "--name", name).strip()
        self.addCleanup(self.bench.drop, job)
        return job

    def submit_uneven(self):
        """Jobs of which the list says little and much, done and running."""
        jobs = [self.bench.run("submit", self.bench.path("box.off"), "--points", str(400 + len(name)), "--name", name,
                               "--wait").strip() for name in ("a", "many words " * 9, "no_word_ends_" * 9)]
        jobs.append(self.submit_endless("endless"))
        self.page.wait(lambda: all(self.page.all(f"#job-{job}") for job in jobs))
        self.page.wait(lambda: "directions" in self.page.find(f"#job-{jobs[-1]} .numbers").text)

    def submit_body(self, points, name):
        """From the list of jobs to the finished skeleton."""
        self.page.submit(self.bench.path("body.off"), points, name)
        self.page.skeleton_is_drawn()
