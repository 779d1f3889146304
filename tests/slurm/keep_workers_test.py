"""keep-workers as cron calls it, on a real Slurm of one node and before a real server: how many allocations there are
after each call.  The partition takes jobs and starts none, except where workers are to run.

Usage: keep_workers_test.py PROGRAMS DEPLOY-FOLDER"""
import fcntl
import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

import own_namespaces
from cluster import Cluster
from lab_service import LabService, new_place

own_namespaces.enter("openssl", "sbatch", "slurmctld", "slurmd", "munged")
PROGRAMS, DEPLOY = (Path(argument).resolve() for argument in sys.argv[1:3])
del sys.argv[1:]

USAGE, SERVER_AWAY, NOT_ALLOWED, SLURM_REFUSES, ALREADY_RUNS = 2, 5, 7, 9, 10
KEEP_WORKERS = DEPLOY / "slurm/keep-workers"


class KeepWorkers(unittest.TestCase):
    points = 1000  # so that no job is another's, done at once

    @classmethod
    def setUpClass(cls):
        cls.place = new_place(cls.addClassCleanup)
        cls.lab = LabService(PROGRAMS, cls.place, "localhost", 0)
        cls.lab.start()
        (cls.place / "slurm").mkdir()
        cls.slurm = Cluster(cls.place / "slurm", cls.lab.environment)
        cls.addClassCleanup(cls.slurm.close)
        cls.conf = cls.place / "workers.conf"
        cls.mesh = cls.place / "box.off"
        cls.lab.client("make", "box", "-o", cls.mesh)

    def setUp(self):
        self.configure()
        self.hold()
        # Cron gives no more than this.
        self.cron = {"HOME": str(self.place), "PATH": os.environ["PATH"],
                     "SLURM_CONF": self.slurm.environment["SLURM_CONF"]}
        self.addCleanup(self.clear)

    def configure(self, **changes):
        settings = {"AFFSKEL_SERVER": self.lab.address, "AFFSKEL_TLS_CA": self.lab.certificate,
                    "AFFSKEL_TOKEN_FILE": self.lab.tokens["worker"], "AFFSKEL_IDLE_EXIT": 1,
                    "AFFSKEL_QUEUE_TOKEN_FILE": self.lab.tokens["admin"],
                    "AFFSKEL_CLIENT": PROGRAMS / "affskel-client", "AFFSKEL_WORKER": PROGRAMS / "affskel-worker",
                    **changes}
        self.conf.write_text("".join(f"{name}={value}\n" for name, value in settings.items()))

    def hold(self, state="DOWN"):
        self.slurm.run("scontrol", "update", "PartitionName=low", f"State={state}")

    def clear(self):
        """No jobs at the server and no allocations in Slurm."""
        self.cancel_jobs()
        self.slurm.run("scancel", "--user=root")

    def cancel_jobs(self):
        for job in json.loads(self.lab.client("--json", "list", "--state", "queued"))["jobs"]:
            self.lab.client("cancel", job["id"])

    def start(self, *arguments):
        return subprocess.Popen([KEEP_WORKERS, "--conf", self.conf, *arguments], cwd=self.slurm.place, env=self.cron,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def keep(self, *arguments, code=0):
        """What a call says; its exit code must be this."""
        process = self.start(*arguments)
        out, error = process.communicate()
        self.assertEqual(process.returncode, code, out + error)
        self.assertEqual(bool(error), code != 0, error)
        return out + error

    def submit_jobs(self, number):
        for _ in range(number):
            KeepWorkers.points += 1
            self.lab.client("submit", self.mesh, "--points", str(self.points))

    def pending(self):
        states = self.slurm.queue()
        self.assertLessEqual(set(states.values()), {"PENDING"})
        return len(states)

    def test_empty_queue_submits_nothing(self):
        self.assertEqual(self.keep("2", "4"), "")
        self.assertIn("nothing to do", self.keep("2", "4", "--verbose"))
        self.assertEqual(self.pending(), 0)

    def test_follows_the_queue_between_min_and_max(self):
        for jobs, expected in ((1, 2), (0, 2), (2, 3), (3, 4), (0, 4)):
            self.submit_jobs(jobs)
            self.keep("2", "4")
            self.assertEqual(self.pending(), expected)

    def test_submits_an_array_with_the_options_that_it_is_given(self):
        self.submit_jobs(1)
        self.assertIn("3 submitted as", self.keep("3", "3", "--", "--cpus-per-task=2", "--array=1-50"))
        task = next(iter(self.slurm.queue()))
        self.assertEqual(self.slurm.fact(task, "CPUs/Task"), "2")
        self.assertEqual(self.slurm.fact(task, "Comment"), "affskel-worker")
        self.assertEqual(self.pending(), 3)

    def test_cancels_pending_ones_beyond_max_the_newest_first(self):
        self.submit_jobs(1)
        self.keep("2", "2")
        first = set(self.slurm.queue())
        self.keep("4", "4")
        self.assertEqual(self.pending(), 4)
        self.assertIn("cancelled", self.keep("1", "2"))
        self.assertEqual(set(self.slurm.queue()), first)

    def test_cancels_pending_ones_when_there_is_nothing_to_do(self):
        self.submit_jobs(1)
        self.keep("2", "2")
        self.cancel_jobs()
        self.keep("2", "2")
        self.assertEqual(self.pending(), 0)

    def test_dry_run_changes_nothing(self):
        self.submit_jobs(1)
        self.assertIn("2 would be submitted", self.keep("2", "4", "--dry-run"))
        self.assertEqual(self.pending(), 0)
        self.keep("3", "4")
        self.assertIn("would be cancelled", self.keep("1", "1", "--dry-run"))
        self.assertEqual(self.pending(), 3)

    def test_leaves_allocations_of_other_names_alone(self):
        self.submit_jobs(1)
        self.keep("2", "2", "--name", "other-server")
        self.assertEqual(self.pending(), 0)
        self.keep("1", "1")
        self.assertEqual(self.pending(), 1)
        self.assertEqual(len(self.slurm.queue("other-server")), 2)

    def test_running_ones_are_counted_and_leave_by_themselves(self):
        self.submit_jobs(1)
        since = self.slurm.log.mark()
        self.hold("UP")
        job = self.slurm.submit("--array=1", "--cpus-per-task=1", "--mem-per-cpu=500M", "--job-name=affskel-workers",
                                "--output=blocked.log", "--wrap", f"read line < {self.gate()}")
        self.slurm.allocated(job, since)
        self.hold()
        self.keep("2", "2")
        self.assertEqual(sorted(self.slurm.queue().values()), ["PENDING", "RUNNING"])
        self.keep("1", "1")
        self.assertEqual(self.slurm.queue(), {f"{job}_1": "RUNNING"})
        self.gate().write_text("go\n")
        self.slurm.completed(job, since)

    def gate(self):
        """A pipe without a writer: its reader waits."""
        pipe = self.place / "gate"
        if not pipe.exists():
            os.mkfifo(pipe)
        return pipe

    def test_workers_that_it_submits_finish_the_job_and_leave(self):
        since = self.slurm.log.mark()
        self.submit_jobs(1)
        self.hold("UP")
        said = self.keep("1", "2", "--", "--cpus-per-task=1", "--mem-per-cpu=500M")
        array = said.split()[-1]
        self.assertEqual(self.slurm.completed(array, since), {1: 0})
        self.assertEqual(self.lab.job("@last")["state"], "done")
        self.assertEqual(self.keep("1", "2"), "")

    def test_changes_nothing_when_the_server_does_not_answer(self):
        self.submit_jobs(1)
        self.keep("2", "4")
        self.configure(AFFSKEL_SERVER="localhost:1")
        self.assertIn("affskel-client", self.keep("3", "4", code=SERVER_AWAY))
        self.configure(AFFSKEL_CLIENT=self.script("client", f"read line < {self.gate()}"))
        self.assertIn("has not answered in 1 s", self.keep("3", "4", "--timeout", "1", code=SERVER_AWAY))
        self.assertEqual(self.pending(), 2)

    def test_changes_nothing_when_the_token_is_refused(self):
        self.submit_jobs(1)
        self.configure(AFFSKEL_QUEUE_TOKEN_FILE=self.lab.tokens["worker"])
        self.assertIn("worker", self.keep("2", "4", code=NOT_ALLOWED))
        self.assertEqual(self.pending(), 0)

    def test_counts_what_the_token_shows(self):
        self.submit_jobs(2)
        other = self.place / "other.token"
        other.write_text(subprocess.run([PROGRAMS / "affskel-server", "token", "add", "--data-dir", self.lab.data,
                                         "--owner", "other"], check=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True).stdout)
        self.configure(AFFSKEL_QUEUE_TOKEN_FILE=other)
        self.assertIn("0 jobs to do", self.keep("1", "4", "--verbose"))
        self.configure(AFFSKEL_QUEUE_TOKEN_FILE=self.lab.tokens["user"])
        self.assertIn("2 jobs to do", self.keep("1", "4"))

    def script(self, name, line):
        file = self.place / name
        file.write_text(f"#!/bin/sh\n{line}\n")
        file.chmod(0o755)
        return file

    def test_changes_nothing_when_slurm_does_not_answer(self):
        self.submit_jobs(1)
        conf = self.place / "elsewhere.conf"
        conf.write_text(Path(self.cron["SLURM_CONF"]).read_text().replace("16817", "1") + "MessageTimeout=1\n")
        self.cron["SLURM_CONF"] = str(conf)
        self.assertIn("squeue", self.keep("2", "4", "--timeout", "2", code=SLURM_REFUSES))
        self.assertEqual(self.pending(), 0)

    def test_refusal_of_sbatch_is_told(self):
        self.submit_jobs(1)
        self.assertIn("nowhere", self.keep("2", "4", "--", "--partition=nowhere", code=SLURM_REFUSES))

    def test_one_run_at_a_time(self):
        self.submit_jobs(1)
        (self.place / ".cache/affskel").mkdir(parents=True, exist_ok=True)
        with open(self.place / ".cache/affskel/keep-workers.affskel-workers.lock", "w", encoding="ascii") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.assertIn("another run holds", self.keep("2", "4", code=ALREADY_RUNS))
            self.assertEqual(self.pending(), 0)
        runs = [self.start("3", "4") for _ in range(6)]
        for run in runs:
            run.communicate()
        codes = {run.returncode for run in runs}
        self.assertIn(0, codes)
        self.assertLessEqual(codes, {0, ALREADY_RUNS})
        self.assertEqual(self.pending(), 3)

    def test_usage_errors_say_what_is_wrong(self):
        for arguments, words in ((("3", "2"), "MIN 3 and MAX 2"), (("0", "0"), "MAX at least 1"),
                                 (("1", "2", "--script", "/nowhere"), "/nowhere cannot be read"),
                                 (("1", "2", "--name", "a,b"), "'a,b'")):
            self.assertIn(words, self.keep(*arguments, code=USAGE))
        self.configure(AFFSKEL_SERVER="")
        self.assertIn("AFFSKEL_SERVER=HOST:PORT", self.keep("1", "2", code=USAGE))


if __name__ == "__main__":
    unittest.main()
