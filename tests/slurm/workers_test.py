"""workers.sbatch on a real Slurm of one node: one job is computed by array workers that are preempted, requeued,
killed, cancelled and submitted again, and its field is byte by byte the one that this machine computes alone.

Usage: workers_test.py PROGRAMS DEPLOY-FOLDER"""
import re
import sys
import unittest
from pathlib import Path

import own_namespaces
from cluster import Cluster
from lab_service import LabService, new_place

own_namespaces.enter("openssl", "sbatch", "slurmctld", "slurmd", "munged")
PROGRAMS, DEPLOY = (Path(argument).resolve() for argument in sys.argv[1:3])
del sys.argv[1:]

SCRIPTS = DEPLOY / "slurm"
IDLE_EXIT_S = 2
JOB_S = 15  # of one processor


class Workers(unittest.TestCase):
    """In this order: each step needs those before it."""

    @classmethod
    def setUpClass(cls):
        cls.place = new_place(cls.addClassCleanup)
        cls.lab = LabService(PROGRAMS, cls.place, "localhost", 0)
        cls.mesh = cls.place / "body.off"
        cls.lab.client("make", "body", "--triangles", "1000", "-o", cls.mesh)
        cls.size = cls.lab.options_of_a_job(cls.mesh, JOB_S)
        cls.lab.start("--lease-ms", "2000", "--report-interval-ms", "300")
        (cls.place / "slurm").mkdir()
        cls.slurm = Cluster(cls.place / "slurm", cls.lab.environment)
        cls.addClassCleanup(cls.slurm.close)
        cls.conf = cls.place / "workers.conf"
        cls.conf.write_text(f"AFFSKEL_SERVER={cls.lab.address}\nAFFSKEL_TLS_CA={cls.lab.certificate}\n"
                            f"AFFSKEL_TOKEN_FILE={cls.lab.tokens['worker']}\nAFFSKEL_IDLE_EXIT={IDLE_EXIT_S}\n")

    @classmethod
    def submit_workers(cls, *options):
        """An array of two workers of one thread each; the job's id."""
        return cls.slurm.submit("--array=1-2", "--cpus-per-task=1", "--mem-per-cpu=1000M", "--output=worker-%A_%a.log",
                                *options, SCRIPTS / "workers.sbatch", cls.conf)

    def said(self, task, job=None):
        return (self.slurm.place / f"worker-{job or self.array}_{task}.log").read_text()

    def workers(self, job=None):
        """The ids by which the server knows the workers of the array now, by task."""
        return {task: re.findall(r"event=ready worker=(\w+)", self.said(task, job))[-1] for task in (1, 2)}

    def leased(self, since, workers=2):
        """Waits until so many different workers have leased blocks of the job since then; their ids."""
        seen = set()
        while len(seen) < workers:
            others = f"(?!{'|'.join(seen)})" if seen else ""
            leased = self.lab.log.wait_for(rf"event=leased job={self.job} .*kind=erode worker={others}(\w+)", since)
            seen.add(leased[0][1])
        return seen

    def each(self, workers, event, since):
        """Waits until the server has told of this event of each of the workers since then."""
        for worker in workers:
            self.lab.log.wait_for(rf"event={event} job={self.job} .*worker={worker}", since)

    def events(self, event, since=0):
        """The workers of the events of the job that the server has told of since then."""
        return {match[1] for match in self.lab.log.find(rf"event={event} job={self.job} .*worker=(\w+)", since)}

    def progress(self):
        """Directions done; the job must not be finished, or nothing is tried any more."""
        job = self.lab.job(self.job)
        self.assertEqual(job["state"], "running", "the job is too small for this machine")
        return job["directions_done"]

    def test_1_array_computes(self):
        type(self).job = self.lab.client("submit", self.mesh, *self.size).strip()
        type(self).array = self.submit_workers()
        self.slurm.allocated(self.array, times=2)
        leased = self.leased(0)
        self.assertEqual(leased, set(self.workers().values()))
        for task in (1, 2):
            # What Slurm gave: 1 processor, 1000 MiB, of which the worker takes nine tenths.
            self.assertRegex(self.said(task), rf"event=ready .* threads=1 memory={900 << 20}\b")
        self.assertEqual(self.slurm.fact(self.array, "Requeue"), "1")

    def test_2_preempted_workers_give_back_and_come_again(self):
        since, scheduled = self.lab.log.mark(), self.slurm.log.mark()
        workers = set(self.workers().values())
        done = self.progress()
        self.slurm.submit("--partition=high", "--cpus-per-task=4", "--mem=15000M", "--output=/dev/null", "--wrap=true")
        self.slurm.log.wait_for(rf"Requeuing JobId={self.array}_", scheduled, times=2)
        self.each(workers, "returned", since)
        self.slurm.allocated(self.array, scheduled, times=2)
        again = self.lab.log.mark()
        self.assertFalse(self.leased(again) & workers)
        self.assertGreaterEqual(self.progress(), done)
        for task in (1, 2):
            self.assertIn("restarted 1 times", self.said(task))
            self.assertNotIn("worker ended with", self.said(task))

    def test_3_killed_step_is_started_again_in_its_allocation(self):
        since = self.lab.log.mark()
        victim, other = (self.workers()[task] for task in (1, 2))
        type(self).victim = victim
        self.lab.log.wait_for(rf"event=leased job={self.job} .*worker={victim}", since)
        # Requeued tasks number their steps from 0 again.
        step = self.slurm.run("squeue", "--steps", "--noheader", "--format=%i").split()
        self.slurm.run("scancel", "--signal=KILL", next(name for name in step if name.startswith(f"{self.array}_1.")))
        self.lab.log.wait_for(rf"event=lease_lost job={self.job} .*worker={victim}", since)
        self.lab.log.wait_for(rf"event=leased job={self.job} .*worker=(?!{victim}|{other})", since)
        self.assertIn("workers.sbatch: worker ended with 137 at attempt 1 of 4", self.said(1))
        self.assertEqual(self.slurm.fact(f"{self.array}_1", "JobState"), "RUNNING")

    def test_4_cancelled_array_gives_back(self):
        since = self.lab.log.mark()
        workers = set(self.workers().values())
        done = self.progress()
        self.leased(since)
        self.slurm.run("scancel", self.array)
        self.each(workers, "returned", since)
        self.assertGreaterEqual(self.progress(), done)

    def test_5_another_array_finishes_it_and_ends_idle(self):
        scheduled = self.slurm.log.mark()
        type(self).array = self.submit_workers()
        self.lab.client("watch", self.job)
        self.assertEqual(self.lab.fetched(self.job), self.lab.computed(self.mesh, *self.size))
        self.assertEqual(self.slurm.completed(self.array, scheduled, times=2), {1: 0, 2: 0})
        for task in (1, 2):
            self.assertRegex(self.said(task), "event=leaving .*reason=idle")
        self.assertEqual(self.events("lease_lost"), {self.victim}, "all others gave theirs back")

    def test_6_bad_configuration_ends_at_once_and_says_why(self):
        self.conf.write_text("AFFSKEL_IDLE_EXIT=1\n")
        job = self.slurm.submit("--array=1", "--output=bad.log", SCRIPTS / "workers.sbatch", self.conf)
        self.assertEqual(self.slurm.completed(job), {1: 2})
        self.assertIn(f"workers.sbatch: no server: {self.conf} should say AFFSKEL_SERVER",
                      (self.slurm.place / "bad.log").read_text())

    def test_7_server_ends_cleanly(self):
        self.lab.stop()


if __name__ == "__main__":
    unittest.main(failfast=True)
