"""The operations guide's section on containers, typed as written: a server with TLS and tokens, two workers and the page,
by podman-compose; a person beside them.  Containers are killed and replaced while a job is half done.

Usage: compose_test.py CONTAINERS-SOURCES GUIDE PROGRAMS STORAGE"""
import json
import os
import re
import shutil
import signal
import ssl
import subprocess
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

import engine
import jobs

engine.enter()
SOURCES, GUIDE, PROGRAMS, STORAGE = engine.paths(4)

NAME = "lab.example.org"
# Of its own, for containers that call it by its name, one of both kinds, as a DNS would give: where one lacks, containers
# ask a name server for it, and none answers here.
ADDRESSES = ("192.0.2.7", "2001:db8::7")
SERVER, WORKERS = "affskel_server_1", ("affskel_worker_1", "affskel_worker_2")
LONG = ("--points", "300000", *jobs.DIRECTIONS)


def blocks(heading):
    """The commands of a part of the guide's section on containers, a block each."""
    section = re.search(r"^## Containers\n(.*?)(?=^## )", GUIDE.read_text(), re.M | re.S)[1]
    part = re.search(rf"^### {heading}\n(.*?)(?=^### |\Z)", section, re.M | re.S)[1]
    return re.findall(r"^```sh\n(.*?)^```", part, re.M | re.S)


class Compose(unittest.TestCase):
    """In the order of the guide: each step needs those before it."""

    @classmethod
    def setUpClass(cls):
        cls.engine = engine.Engine(STORAGE)
        cls.addClassCleanup(cls.engine.close)
        place = Path(tempfile.mkdtemp(prefix="affskel-compose-"))
        cls.addClassCleanup(shutil.rmtree, place)
        cls.place = place / "containers"
        shutil.copytree(SOURCES, cls.place)
        # In this mount namespace alone.
        hosts = place / "hosts"
        hosts.write_text(f"127.0.0.1 localhost {NAME}\n")
        subprocess.run(["mount", "--bind", hosts, "/etc/hosts"], check=True)
        cls.settings = cls.engine.environment | engine.bare_environment(
            PATH=f"{PROGRAMS}:{os.environ['PATH']}", HOME=str(place), CONTAINERS_CONF=cls.engine.environment["CONTAINERS_CONF"],
            CONTAINERS_STORAGE_CONF=cls.engine.environment["CONTAINERS_STORAGE_CONF"])

    def type(self, block):
        """A block of the guide; what it exports stays, as in a terminal."""
        said = self.engine.run("sh", "-ec", f"{block}\nenv -0 >{self.place}/environment", cwd=self.place,
                               env=self.settings)
        entries = (self.place / "environment").read_text().split("\0")
        type(self).settings = dict(entry.split("=", 1) for entry in entries if entry)
        return said

    def person(self):
        return jobs.Person(self, self.engine, PROGRAMS, self.place, self.settings)

    def client(self, *words):
        return self.person().client(*words)

    def until_healthy(self, name):
        """Checks until it passes; each check takes its time, and a container that never does fails the test."""
        for _ in range(100):
            if self.engine.health(name):
                return
        self.fail(self.engine.log(name))

    def directions_done(self, job):
        return json.loads(self.client("--json", "status", job))["directions_done"]

    def test_1_start(self):
        (start,) = blocks("Start")
        lines = start.splitlines()
        # The image is there: image_test.py has made it.
        (build,) = [line for line in lines if line.startswith("podman build ")]
        self.assertIn(" -t affskel:1 ", build)
        self.type("\n".join(line for line in lines if line not in (build, "cd deploy/containers")))
        self.assertIn(" -f deploy/containers/Containerfile .", build)

    def test_2_every_container_is_confined(self):
        for name in (SERVER, *WORKERS, "affskel_web_1"):
            facts = self.engine.inspect(name)
            self.assertTrue(facts["HostConfig"]["ReadonlyRootfs"], name)
            status = Path(f"/proc/{facts['State']['Pid']}/status").read_text()
            self.assertRegex(status, r"(?m)^Uid:\t760\t760\t760\t760$")
            self.assertRegex(status, r"(?m)^CapBnd:\t0+$")
            self.assertRegex(status, r"(?m)^NoNewPrivs:\t1$")
            mounted = {mount["Destination"]: mount["RW"] for mount in facts["Mounts"]}
            self.assertEqual([place for place, writable in mounted.items() if writable],
                             ["/var/lib/affskel"] if name == SERVER else [], name)

    def test_3_people(self):
        token, use = blocks("People")
        self.type(token)
        self.assertIn("done", self.type(use + "affskel-client status @last"))
        self.assertTrue((self.place / "skeleton.ply").read_bytes().startswith(b"ply\n"))
        # No client without a token, none without the certificate.
        for missing in ("AFFSKEL_TOKEN_FILE", "AFFSKEL_TLS_CA"):
            less = {key: value for key, value in self.settings.items() if key != missing}
            _, code = self.engine.run(PROGRAMS / "affskel-client", "list", env=less, check=False)
            self.assertIn(code, (2, 5, 7), missing)

    def test_4_page(self):
        trust = ssl.create_default_context(cafile=self.place / "ca.pem")
        with urllib.request.urlopen(f"https://{NAME}:8443/", context=trust, timeout=60) as answer:
            self.assertIn("affskel", answer.read().decode())

    def test_5_health(self):
        for name in (SERVER, *WORKERS, "affskel_web_1"):
            self.assertTrue(self.engine.health(name), name)
        server = self.engine.process(SERVER)
        os.kill(server, signal.SIGSTOP)
        try:
            for name in (SERVER, WORKERS[0]):
                self.assertFalse(self.engine.health(name), name)
        finally:
            os.kill(server, signal.SIGCONT)
        self.assertTrue(self.engine.health(SERVER))

    def test_5_start_to_first_lease(self):
        self.engine.podman("stop", "--time", "60", *WORKERS)
        job = self.client("--quiet", "submit", "torus.off", "--points", "3000").strip()
        self.engine.podman("stop", "--time", "20", SERVER)
        begun = time.time()
        self.engine.podman("start", SERVER)
        between = time.time()
        self.engine.podman("start", WORKERS[0])
        self.until_healthy(SERVER)
        self.assertEqual(self.client("--quiet", "watch", job).split()[-1], "done")
        events = [json.loads(line) for line in self.client("--json", "log", job).splitlines()]
        leased = next(event["time_ms"] for event in events if event["event"] == "leased") / 1000
        print(f"from the start of a worker's container to its first lease: {leased - between:.2f} s; with that of the "
              f"server's container before it: {leased - begun:.2f} s", flush=True)
        self.assertGreater(leased, between)
        self.engine.podman("start", WORKERS[1])

    def test_6_killed_containers_come_back_and_the_field_is_the_same(self):
        self.client("--quiet", "make", "body", "--triangles", "5000", "-o", "body.off")
        job, watch = self.person().half_done(*LONG)
        before = {}
        for name in (WORKERS[0], SERVER):
            before[name] = self.engine.process(name)
            os.kill(before[name], signal.SIGKILL)  # as the kernel does when memory runs out
        self.person().assert_undisturbed(job, watch, LONG)
        for name, process in before.items():
            self.assertNotIn(self.engine.process(name), (0, process), name)

    def test_7_container_that_is_removed_is_no_loss(self):
        options = ("--points", "310000", *jobs.DIRECTIONS)
        job, watch = self.person().half_done(*options)
        for name in (SERVER, WORKERS[1]):
            self.engine.podman("rm", "--force", "--time", "0", name)
        self.type("podman-compose -p affskel up -d")
        self.person().assert_undisturbed(job, watch, options)

    def test_8_backup_and_restore(self):
        options = ("--points", "330000", *jobs.DIRECTIONS)
        job, watch = self.person().half_done(*options)
        backup, restore = blocks("Backup and restore")
        (self.place / "affskel-backup.db").write_text("yesterday's")
        self.type(backup)
        done = self.directions_done(job)
        self.type(restore)
        self.until_healthy(SERVER)
        # What was done after the backup is done once more.
        self.assertIn(job, self.client("--json", "list"))
        self.assertGreater(done, 0)
        self.person().assert_undisturbed(job, watch, options)

    def test_9_upgrade_with_a_job_half_done(self):
        certificate = self.engine.podman("exec", SERVER, "cat", "/etc/affskel/tls/server.pem")
        options = ("--points", "320000", *jobs.DIRECTIONS)
        job, watch = self.person().half_done(*options)
        (upgrade,) = blocks("Upgrade")
        self.type(upgrade)
        self.until_healthy(SERVER)
        for name in (SERVER, *WORKERS):
            self.assertEqual(self.engine.inspect(name)["ImageName"], "localhost/affskel:2")
        self.assertEqual(self.engine.podman("exec", SERVER, "cat", "/etc/affskel/tls/server.pem"), certificate)
        self.assertGreater(self.directions_done(job), 0)
        self.person().assert_undisturbed(job, watch, options)

    def test_A_more_and_fewer_workers(self):
        more, fewer = blocks("More and fewer workers")
        self.type(more)
        self.assertEqual(self.workers(), 4)
        stop, remove = fewer.splitlines()
        self.type(stop)
        self.assertEqual(self.engine.inspect("affskel_worker_4")["State"]["ExitCode"], 0)
        self.type(remove)
        self.assertEqual(self.engine.podman("container", "exists", "affskel_worker_4", check=False)[1], 1)

    def test_B_certificates(self):
        renew, own = blocks("Certificates")
        trust = blocks("People")[0].splitlines()[2]
        self.assertIn("> ca.pem", trust)
        old = (self.place / "ca.pem").read_bytes()
        processes = [self.engine.process(name) for name in (SERVER, *WORKERS, "affskel_web_1")]
        self.type(renew)
        self.type(trust)
        self.assertNotEqual((self.place / "ca.pem").read_bytes(), old)
        self.assertEqual([self.engine.process(name) for name in (SERVER, *WORKERS, "affskel_web_1")], processes)
        self.do_a_job("5000")
        # One that an authority has signed, for the name alone by which people know the server.
        request = ("openssl", "req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes")
        for words in ((*request, "-x509", "-subj", "/CN=authority", "-keyout", "authority.key", "-out", "ca.pem"),
                      (*request, "-subj", "/CN=lab", "-addext", f"subjectAltName=DNS:{NAME}", "-keyout", "server.key",
                       "-out", "request.pem"),
                      ("openssl", "x509", "-req", "-in", "request.pem", "-copy_extensions", "copy", "-CA", "ca.pem",
                       "-CAkey", "authority.key", "-days", "2", "-out", "server.pem")):
            self.engine.run(*words, cwd=self.place)
        for address in ADDRESSES:
            subprocess.run(["ip", "address", "add", address, "dev", "lo"], check=True)
        Path("/etc/hosts").write_text("\n".join(("127.0.0.1 localhost", *(f"{address} {NAME}" for address in ADDRESSES), "")))
        self.type(own)
        self.do_a_job("6000")
        self.until_healthy("affskel_web_1")
        self.test_4_page()

    def do_a_job(self, points):
        """By workers that have to connect anew."""
        self.engine.podman("restart", "--time", "20", SERVER)
        self.until_healthy(SERVER)
        self.client("submit", "torus.off", "--points", points, "--wait")

    def workers(self):
        admin = self.engine.podman("exec", SERVER, "affskel-client", "--json", "--server",
                                   "unix:/var/lib/affskel/server.sock", "server-info")
        return sum(not worker.get("silent") for worker in json.loads(admin)["workers"])


if __name__ == "__main__":
    unittest.main(failfast=True)
