"""The operations guide, typed as written: packages into bare Debian roots, a server with TLS and tokens, a host that
computes, a person's machine, each with an address of its own; upgrade, remove and purge.

Usage: lab_server_test.py ROOT-TARBALL GUIDE PACKAGES"""
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from hosts import Host
from own_namespaces import require_own_mounts

TARBALL, GUIDE, PACKAGES = (Path(argument).resolve() for argument in sys.argv[1:4])
del sys.argv[1:]

if os.geteuid() != 0 or not TARBALL.exists():
    print("SKIPPED: roots with services of their own need root and a bare Debian root; run the tests as root")
    sys.exit(77)
require_own_mounts()

SERVER, WORKER = "affskel-server", "affskel-worker@lab"


def blocks(heading):
    """The commands of a section of the guide, a block each."""
    section = re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", GUIDE.read_text(), re.M | re.S)[1]
    return re.findall(r"^```sh\n(.*?)^```", section, re.M | re.S)


class LabServer(unittest.TestCase):
    """In the order of the guide: each step needs those before it."""

    @classmethod
    def setUpClass(cls):
        place = Path(tempfile.mkdtemp(prefix="affskel-lab-"))
        cls.addClassCleanup(shutil.rmtree, place)
        cls.hosts = {}
        for name in ("server", "worker", "client"):
            host = cls.hosts[name] = Host(TARBALL, place / name)
            cls.addClassCleanup(host.close)
            shutil.copyfile("/etc/resolv.conf", host.root / "etc/resolv.conf")  # for apt-get
            for package in PACKAGES.glob("*.deb"):
                shutil.copy(package, host.root / "root")
        cls.server, cls.worker, cls.client = cls.hosts.values()
        for number, host in enumerate((cls.worker, cls.client), 1):
            cls.server.join(host, f"10.77.{number}.1", f"10.77.{number}.2")
            with open(host.root / "etc/hosts", "a", encoding="ascii") as hosts:
                hosts.write(f"10.77.{number}.1 lab.example.org\n")
        cls.client.run("useradd --create-home --shell /bin/sh ada")

    def type(self, host, block, user="root"):
        """What a block says; what talks to systemd, ssh or the world is done for it."""
        words = shlex.split(block)
        if words[0] == "scp":
            source = self.server.root / words[1].partition(":/")[2]
            home = f"/home/{user}" if user != "root" else "/root"
            target = host.root / words[2].replace("~", home).lstrip("/")
            shutil.copyfile(source, target)
            shutil.chown(target, *host.ids(user))
            return ""
        if words[0] == "systemctl" and words[1] == "daemon-reload":
            return self.type(host, block.partition("\n")[2])
        if words[0] == "systemctl":
            if words[-1] in host.services:
                host.stop(words[-1])
            if words[1] != "stop":
                host.start(words[-1])
            return ""
        return host.run(block, user, cabled="apt-get install" not in block)

    def test_1_server(self):
        install, *rest = blocks("The server")
        self.type(self.server, install)
        self.assertIn("affskel", (self.server.root / "etc/passwd").read_text())
        # As postinst does where systemd runs: it serves this machine before anybody has configured it.
        self.server.start(SERVER)
        self.assertIn("address=unix:/run/affskel/server.sock", self.server.log(SERVER))
        for block in rest:
            self.type(self.server, block)
        log = self.server.log(SERVER)
        self.assertIn("address=0.0.0.0:7060", log)
        state = self.server.root / "var/lib/affskel"
        self.assertEqual((state.stat().st_mode & 0o777, state.stat().st_uid), (0o700, self.server.ids("affskel")[0]))

    def test_2_worker_of_another_host(self):
        for block in blocks("A host that computes"):
            self.type(self.worker, block)
        self.assertIn("event=ready", self.worker.log(WORKER))

    def test_3_person_on_a_third_host(self):
        install, *rest = blocks("People")
        self.type(self.client, install)
        for block in rest:
            said = self.type(self.client, block, "ada")
        self.assertTrue((self.client.root / "home/ada/skeleton.ply").read_bytes().startswith(b"ply\n"), said)
        self.assert_flat()
        status = self.client.run("affskel-client status @last", "ada")
        self.assertRegex(status, r"(?m)^owner: +ada$")
        self.assertRegex(status, r"(?m)^state: +done$")

    def assert_flat(self):
        """The skeleton of a torus lies in its plane, z = 0, to the lattice's spacing; the torus is 2000 thick there."""
        said = self.client.run("affskel-client --quiet fetch @last skeleton -o skeleton.csv; cat skeleton.csv;"
                               "affskel-client status @last | sed -n 's/^spacing: *//p'", "ada").splitlines()
        names, *rows, spacing = said
        self.assertTrue(names.startswith("x,y,z,"))
        self.assertGreater(len(rows), 300)  # a line once round has as many
        for row in rows:
            self.assertLessEqual(abs(float(row.split(",")[2])), float(spacing))

    def test_4_host_that_computes_does_so_alone(self):
        self.server.run("sed -i 's|^workers = .*|workers = 0|' /etc/affskel/server.conf")
        self.type(self.server, f"systemctl restart {SERVER}")
        self.client.run("affskel-client submit torus.off --points 21000 --wait",
                        "ada")
        self.assert_flat()

    def test_5_strangers_get_nothing(self):
        call = "affskel-client --server lab.example.org:7060 --tls-ca ~/away/ca.pem"
        said = self.client.run(f"mv ~/.config/affskel ~/away; c=0; {call} list || c=$?; "
                               "mv ~/away ~/.config/affskel; echo code=$c", "ada")
        self.assertIn("code=7", said)
        said = self.client.run("affskel-client --server lab.example.org:7060 --tls-ca /etc/ssl/nothing.pem list; echo",
                               "ada", check=False)
        self.assertIn("/etc/ssl/nothing.pem", said)

    def test_6_upgrade_keeps_configuration_and_jobs(self):
        (upgrade,) = blocks("Upgrade")
        configuration = self.server.root / "etc/affskel/server.conf"
        before = configuration.read_text()
        for version in ("9.1", "9.2"):
            self.newer_packages(version)
            self.server.run(upgrade, cabled=False)
            self.assertEqual(configuration.read_text(), before)
            self.assertIn(f"## Of {version}.", configuration.with_name("server.conf.dpkg-dist").read_text())
            self.assertIn(version, self.server.run("dpkg-query -W affskel-server affskel-worker"))
        self.type(self.server, f"systemctl restart {SERVER}")
        self.assertRegex(self.client.run("affskel-client status @last", "ada"), r"(?m)^state: +done$")

    def newer_packages(self, version):
        """Packages of this version in the place of those that are there; the server's has an option more."""
        for package in (self.server.root / "root").glob("affskel-*.deb"):
            package.unlink()
        for package in PACKAGES.glob("*.deb"):
            with tempfile.TemporaryDirectory() as place:
                subprocess.run(["dpkg-deb", "-R", package, f"{place}/tree"], check=True)
                control = Path(place) / "tree/DEBIAN/control"
                control.write_text(re.sub(r"(?m)^Version: .*", f"Version: {version}", control.read_text()))
                configuration = Path(place) / "tree/etc/affskel/server.conf"
                if configuration.exists():
                    configuration.write_text(f"{configuration.read_text()}\n## Of {version}.\n")
                subprocess.run(["dpkg-deb", "-b", f"{place}/tree", self.server.root / "root"], check=True,
                               stdout=subprocess.DEVNULL)

    def test_7_backup_comes_back(self):
        backup, stop, *restore = blocks("Backup and restore")
        self.server.run(backup)
        self.client.run("affskel-client submit torus.off --points 21500 --wait", "ada")
        self.server.run(backup)  # the next day's, in its place
        self.client.run("affskel-client submit torus.off --points 22000 --wait", "ada")
        for block in (stop, *restore):
            self.type(self.server, block)
        jobs = self.client.run("affskel-client list", "ada")
        self.assertEqual(jobs.count("done"), 3, jobs)  # without the one after the second backup
        self.client.run("affskel-client submit torus.off --points 22000 --wait", "ada")
        self.server.run("rm -r /var/lib/affskel.away /var/backups/affskel.db")

    def test_8_a_new_certificate_cuts_nobody_off(self):
        _, make, give, take, _, _ = blocks("Tokens and certificates")
        self.type(self.server, make)
        self.type(self.worker, give)
        self.type(self.client, give.replace("/etc/affskel/ca.pem", "~/.config/affskel/ca.pem"), "ada")
        self.type(self.server, take)
        # A client that knows the new one alone gets in once the server has taken it.
        self.client.run("sed '1,/END/d' ~/.config/affskel/ca.pem > next.pem", "ada")
        self.client.run("until affskel-client --tls-ca next.pem health; do :; done", "ada")
        self.client.run("affskel-client submit torus.off --points 23000 --wait", "ada")
        # The running worker comes back to a server that has a certificate that it did not know when it started.
        self.type(self.server, f"systemctl restart {SERVER}")
        self.client.run("affskel-client submit torus.off --points 24000 --wait", "ada")

    def test_8_host_that_computes_shows_a_certificate(self):
        *_, install, restart = blocks("Tokens and certificates")
        self.server.run("openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=lab "
                        "-keyout lab.key -out /etc/affskel/tls/clients.pem")
        for host, place, user in ((self.worker, "etc/affskel/workers", "root"), (self.client, "home/ada", "ada")):
            for source, name in (("root/lab.key", "lab.key"), ("etc/affskel/tls/clients.pem", "lab.pem")):
                shutil.copyfile(self.server.root / source, host.root / place / name)
                (host.root / place / name).chmod(0o600)
                shutil.chown(host.root / place / name, *host.ids(user))
        self.worker.stop(WORKER)  # else it would leave when it is refused
        self.server.run("sed -i 's|^#tls-client-ca = |tls-client-ca = |' /etc/affskel/server.conf")
        self.type(self.server, f"systemctl restart {SERVER}")
        for block in (install, restart):
            self.type(self.worker, block)
        self.assertIn("code=7", self.client.run("c=0; affskel-client list || c=$?; echo code=$c", "ada"))
        self.client.run("affskel-client --client-cert lab.pem --client-key lab.key submit torus.off --points 25000 --wait",
                        "ada")
        self.server.run("sed -i 's|^tls-client-ca = |#tls-client-ca = |' /etc/affskel/server.conf")
        self.type(self.server, f"systemctl restart {SERVER}")

    def test_8_revoked_token_is_worthless(self):
        self.type(self.server, blocks("Tokens and certificates")[0])
        self.assertIn("code=7", self.client.run("c=0; affskel-client list || c=$?; echo code=$c", "ada"))

    def test_9_stop_drains(self):
        self.assertEqual(self.worker.stop(WORKER), 0, self.worker.log(WORKER))
        self.assertEqual(self.server.stop(SERVER), 0, self.server.log(SERVER))
        self.assertIn("event=stopped", self.server.log(SERVER))

    def test_A_purge_leaves_what_it_says(self):
        remove, purge = blocks("Remove")[0].splitlines()
        # As systemctl enable affskel-worker@lab has it.
        self.server.run("cd /etc/systemd/system/multi-user.target.wants; "
                        "ln -s /lib/systemd/system/affskel-worker@.service affskel-worker@lab.service")
        self.server.run(remove)
        self.assertTrue((self.server.root / "etc/affskel/server.conf").exists())
        self.assertFalse((self.server.root / "usr/bin/affskel-server").exists())
        said = self.server.run(purge)
        self.assertIn("/var/lib/affskel, the database", said)
        left = self.server.run("find / -xdev '(' -name '*affskel*' -o -user affskel ')' "
                               "-not -path '/root/*' -not -path '/proc/*' -not -path '/var/log/*'").split()
        left = {path for path in left if not path.startswith(("/var/lib/affskel", "/run/"))}
        self.assertEqual(left, {"/etc/affskel", "/var/backups/affskel-before-upgrade.db"})
        self.assertEqual({path.name for path in (self.server.root / "etc/affskel").iterdir()}, {"tls"})
        self.assertTrue((self.server.root / "var/lib/affskel/affskel.db").exists())


if __name__ == "__main__":
    unittest.main(failfast=True)
