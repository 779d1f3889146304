"""A server, three hosts that compute and a person's machine on one network, over TLS and with tokens.  One host is cut
off and comes back, one vanishes, one has a slow link, then the server is cut off; the job ends as if nothing had been.

Usage: hosts_test.py PROGRAMS"""
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import own_namespaces
from event_log import HANG_S, EventLog
from lab_service import LabService
from lan import lay

own_namespaces.enter("curl", "iptables", "nsenter", "openssl", "tc")
PROGRAMS = Path(sys.argv.pop(1)).resolve()

SERVER, PERSON, HOSTS = "lab.example.org", "desk", ("parted", "vanishing", "remote")
JOB_S = 12  # of one processor


class Worker:
    """affskel-worker on a machine."""

    def __init__(self, lab, machine):
        self.machine = machine
        self.process = subprocess.Popen(
            [*machine.network.inside, PROGRAMS / "affskel-worker", *lab.access("worker")],
            env=lab.environment, stderr=subprocess.PIPE, text=True)
        self.log = EventLog(self.process.stderr)
        self.id = self.log.wait_for(r"event=ready worker=(\w+)")[0][1]


class Hosts(unittest.TestCase):
    """In this order: each step needs those before it."""

    @classmethod
    def setUpClass(cls):
        place = tempfile.TemporaryDirectory(prefix="affskel-hosts-", ignore_cleanup_errors=True)
        cls.addClassCleanup(place.cleanup)
        directory = Path(place.name)
        cls.machines = lay((SERVER, PERSON, *HOSTS), directory / "hosts")
        cls.server = cls.machines[SERVER]
        cls.lab = LabService(PROGRAMS, directory, SERVER, 7060)
        cls.mesh = directory / "body.off"
        cls.client("make", "body", "--triangles", "1000", "-o", cls.mesh)
        cls.size = cls.lab.options_of_a_job(cls.mesh, JOB_S)
        cls.lab.start("--lease-ms", "1500", "--report-interval-ms", "300", "--metrics", "localhost:9464",
                      inside=cls.server.network.inside)
        cls.workers, cls.acknowledged = {}, set()

    @classmethod
    def client(cls, *arguments):
        """What the person types."""
        return cls.lab.client(*arguments, inside=cls.machines[PERSON].network.inside)

    def told(self, event, host, since=0):
        """Waits until the server has told of this event of a block of a host's worker."""
        self.lab.log.wait_for(rf"event={event} job={self.job} .*kind=erode worker={self.workers[host].id}", since)

    def answered(self, pattern, *arguments):
        """Asks as the person until the answer matches."""
        end = time.monotonic() + HANG_S
        while not re.search(pattern, answer := self.client(*arguments)):
            self.assertLess(time.monotonic(), end, answer)

    def metric(self, name):
        text = self.server.network.run("curl", "--silent", "--show-error", "--fail", "http://localhost:9464/metrics")
        return float(re.search(rf"^{name} (\S+)$", text, re.M)[1])

    def check_acknowledged(self, state="running"):
        """No direction that was done is not done now."""
        job = self.lab.job(self.job, inside=self.machines[PERSON].network.inside)
        self.assertEqual(job["state"], state, "the job is too small for this machine")
        done = {position for span in job["done_positions"] for position in range(span["begin"], span["end"])}
        self.assertLessEqual(self.acknowledged, done)
        type(self).acknowledged = done

    def test_1_all_hosts_compute_for_the_person(self):
        for host in HOSTS:
            self.workers[host] = Worker(self.lab, self.machines[host])
        type(self).job = self.client("submit", self.mesh, *self.size).strip()
        for host in HOSTS:
            self.told("leased", host)
        self.check_acknowledged()

    def test_2_server_is_known_by_its_name_and_strangers_are_refused(self):
        def code(server, *access):
            done = subprocess.run([*self.machines[PERSON].network.inside, PROGRAMS / "affskel-client", "--quiet",
                                   "--server", server, *access, "list"], env=self.lab.environment, check=False,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            return done.returncode

        server, ca, certificate, *token = self.lab.access("user")[1:]
        self.assertEqual(code(server, ca, certificate, *token), 0)
        self.assertEqual(code(f"{self.server.address}:7060", ca, certificate, *token), 5, "not the certificate's name")
        self.assertEqual(code(server, ca, certificate), 7, "no token")

    def test_3_partition_that_heals(self):
        machine, since = self.machines["parted"], self.lab.log.mark()
        fenced = self.metric("affskel_leases_fenced_total")
        machine.part(self.server)
        own = self.workers["parted"].id
        lost = self.lab.log.wait_for(rf"event=lease_lost job={self.job} .*(task=\d+) kind=erode worker={own}", since)[0]
        # Until then it would go on with its block.
        self.lab.log.wait_for(rf"event=leased job={self.job} .*{lost[1]} kind=erode worker=(?!{own})", since)
        self.check_acknowledged()
        healed = self.lab.log.mark()
        machine.join(self.server)
        # What it computed meanwhile comes late, and is refused.
        self.workers["parted"].log.wait_for(f"event=lease_lost job={self.job}")
        self.assertGreater(self.metric("affskel_leases_fenced_total"), fenced)
        self.told("leased", "parted", healed)
        self.check_acknowledged()

    def test_4_host_that_vanishes(self):
        since = self.lab.log.mark()
        self.machines["vanishing"].unplug()
        self.workers["vanishing"].process.kill()
        self.told("lease_lost", "vanishing", since)
        # A lease that the worker had taken ahead may end before its silence counts.
        self.answered(r"(?m)^workers: +2 and 1 silent$", "server-info")
        self.check_acknowledged()

    def test_5_slow_link(self):
        machine = self.machines["remote"]
        if machine.slow_down() is None:
            self.skipTest("SKIPPED: this kernel has neither netem nor tbf")
        since, sent = self.lab.log.mark(), machine.sent_bytes()
        self.told("finished", "remote", since)
        self.assertGreater(machine.sent_bytes(), sent)
        self.check_acknowledged()

    def test_6_server_itself_cut_off(self):
        watch = subprocess.Popen([*self.machines[PERSON].network.inside, PROGRAMS / "affskel-client", "--quiet",
                                  *self.lab.access("user"), "watch", self.job], env=self.lab.environment,
                                 stdout=subprocess.PIPE, text=True)
        since = self.lab.log.mark()
        for host in ("parted", "remote", PERSON):
            self.machines[host].part(self.server)
        for host in ("parted", "remote"):
            self.told("lease_lost", host, since)
        for host in ("parted", "remote", PERSON):
            self.machines[host].join(self.server)
        final, _ = watch.communicate(timeout=HANG_S)
        self.assertEqual((watch.returncode, final.strip()), (0, "done"))

    def test_7_result_is_that_of_one_machine(self):
        self.check_acknowledged("done")
        inside = self.machines[PERSON].network.inside
        self.assertEqual(len(self.acknowledged), self.lab.job(self.job, inside)["directions_total"])
        self.assertEqual(self.lab.fetched(self.job, inside), self.lab.computed(self.mesh, *self.size))

    def test_8_stops_cleanly_and_is_sound(self):
        self.lab.stop()
        subprocess.run([PROGRAMS / "affskel-server", "check", "--data-dir", self.lab.data], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


if __name__ == "__main__":
    unittest.main(failfast=True)
