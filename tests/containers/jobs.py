"""A client beside the containers: submits jobs, follows them, and compares their fields with those of one process."""
import json
import os
import subprocess

# Some twenty seconds of one core: half done is long enough to be met.
DIRECTIONS = ("--directions", "triangles+sphere:5000")


class Person:
    """Works in a folder, by the client's settings that the environment has."""

    def __init__(self, test, engine, programs, place, settings):
        self.test, self.engine, self.programs, self.place, self.settings = test, engine, programs, place, settings

    def client(self, *words, **settings):
        return self.engine.run(self.programs / "affskel-client", *words, cwd=self.place, env=self.settings, **settings)

    def half_done(self, *options):
        """Submits the body; the job, of which some directions are done, not all, and a client that follows it."""
        job = self.client("--quiet", "submit", "body.off", *options).strip()
        watch = subprocess.Popen([self.programs / "affskel-client", "--quiet", "--json", "watch", job], env=self.settings,
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.test.addCleanup(watch.wait)
        self.test.addCleanup(watch.stdout.close)
        self.test.addCleanup(watch.kill)
        for line in watch.stdout:
            state = json.loads(line)
            if state["directions_done"] > 0:
                break
        self.test.assertEqual(state["state"], "running", state)
        return job, watch

    def assert_undisturbed(self, job, watch, options):
        """Its follower sees the job end well, in the very bytes that one process without any server computes."""
        states = [json.loads(line)["state"] for line in watch.stdout]
        self.test.assertEqual((states[-1], watch.wait()), ("done", 0))
        self.client("--quiet", "fetch", job, "field", "-o", "field.csv")
        self.engine.run(self.programs / "affskel-worker", "compute", "body.off", *options, "--threads", str(os.cpu_count()),
                        "-o", "plain.csv", cwd=self.place, env=self.settings)
        field, plain = ((self.place / name).read_bytes() for name in ("field.csv", "plain.csv"))
        self.test.assertGreater(len(field), 1 << 20)
        self.test.assertTrue(field == plain)
