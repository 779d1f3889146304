"""Hosts for tests: a bare Debian root each, with a network namespace of its own, and no systemd.

What systemctl would do with the units of the packages, a Host does by their words: it makes the directories that they
name, and runs ExecStart as the unit's user without capabilities, with a socket for the readiness that Type=notify asks
for.  The sandbox of the units is not set up."""
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess

from network_namespace import NetworkNamespace

# What DynamicUser=yes takes its users from.
DYNAMIC_USER = "61184"
PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"


class Unit:
    """A unit file: settings by name, specifiers filled in."""

    def __init__(self, root, name):
        base, _, self.instance = name.removesuffix(".service").partition("@")
        self.file = root / "lib/systemd/system" / (f"{base}@.service" if self.instance else f"{base}.service")
        self.credentials = f"/run/credentials/{name}.service"
        self.settings = {}
        drop_ins = sorted((root / f"etc/systemd/system/{name}.service.d").glob("*.conf"))
        for line in "".join(file.read_text() for file in (self.file, *drop_ins)).splitlines():
            if match := re.match(r"(\w+)=(.*)", line):
                value = match[2].replace("%i", self.instance).replace("%d", self.credentials)
                self.settings.setdefault(match[1], []).append(value)

    def one(self, name, default=None):
        return self.settings.get(name, [default])[-1]


class Host:
    """A root directory and a network namespace; everything of it ends with close()."""

    def __init__(self, tarball, root):
        self.root = root
        root.mkdir()
        subprocess.run(["tar", "--extract", "--file", tarball, "--directory", root, "--numeric-owner"], check=True)
        (root / "usr/sbin/policy-rc.d").write_text("#!/bin/sh\nexit 101\n")
        (root / "usr/sbin/policy-rc.d").chmod(0o755)
        self.network = NetworkNamespace()
        self.services = {}

    def close(self):
        for name in list(self.services):
            self.stop(name, signal.SIGKILL)
        self.network.close()
        shutil.rmtree(self.root)

    def join(self, other, own_address, other_address):
        """A cable to another host."""
        name = f"to{other.network.pid}"
        self.network.run("ip", "link", "add", name, "type", "veth", "peer", "name", "eth0",
                         "netns", str(other.network.pid))
        for host, device, address in ((self, name, own_address), (other, "eth0", other_address)):
            host.network.run("ip", "address", "add", f"{address}/24", "dev", device)
            host.network.run("ip", "link", "set", device, "up")

    def command(self, words, cabled=True):
        """How words are run in here; with the network of this machine when not cabled, to install packages."""
        inside = ["unshare", "--mount", "--propagation", "private", "sh", "-c",
                  'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"', str(self.root), *words]
        return [*self.network.inside, *inside] if cabled else inside

    def run(self, script, user="root", cabled=True, check=True):
        """Types lines of a shell, as a user in the user's home directory; what they say, stdout and stderr."""
        home = "/root" if user == "root" else f"/home/{user}"
        words = ["setpriv", "--reuid", user, "--regid", user, "--init-groups", "env", "-i", f"HOME={home}",
                 f"PATH={PATH}", "DEBIAN_FRONTEND=noninteractive", "LC_ALL=C.UTF-8",
                 "sh", "-ec", f"cd {home}\n{script}"]
        done = subprocess.run(self.command(words, cabled), check=False, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if check and done.returncode != 0:
            raise AssertionError(f"{script}\nended with {done.returncode}:\n{done.stdout}")
        return done.stdout

    def start(self, name):
        """systemctl start NAME: returns when the service is ready."""
        unit = Unit(self.root, name)
        user = DYNAMIC_USER if unit.one("DynamicUser") == "yes" else unit.one("User")
        uid, gid = self.ids(user)
        for place, where in ((unit.one("StateDirectory"), "var/lib"), (unit.one("RuntimeDirectory"), "run")):
            if place:
                mode = unit.one("StateDirectoryMode") if where == "var/lib" else "0755"
                self.directory(f"{where}/{place}", uid, gid, int(mode, 8))
        environment = self.environment(unit)
        self.load_credentials(unit, uid, gid)
        words = self.expand(unit.one("ExecStart"), environment)
        run = ["setpriv", "--reuid", str(uid), "--regid", str(gid), "--clear-groups", "--no-new-privs",
               "--bounding-set=-all", "env", "-i", *(f"{key}={value}" for key, value in environment.items()),
               "NOTIFY_SOCKET=/run/manager", *words]
        manager = self.manager_socket()
        with open(self.root / f"var/log/{name}.log", "ab") as log:
            process = subprocess.Popen(self.command(run), stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        self.services[name] = process, manager
        self.expect(name, b"READY=1")

    def stop(self, name, with_signal=signal.SIGTERM):
        """systemctl stop NAME; the exit code.  nsenter, unshare and chroot have become the program."""
        process, manager = self.services[name]
        process.send_signal(with_signal)
        if with_signal == signal.SIGTERM:
            self.expect(name, b"STOPPING=1")
        del self.services[name]
        manager.close()
        return process.wait()

    def expect(self, name, wanted):
        try:
            state = self.services[name][1].recv(4096)
        except TimeoutError:
            state = None
        assert state == wanted, (name, state, self.log(name))

    def log(self, name):
        return (self.root / f"var/log/{name}.log").read_text()

    def ids(self, user):
        if user.isdigit():
            return int(user), int(user)
        fields = next(line.split(":") for line in (self.root / "etc/passwd").read_text().splitlines()
                      if line.startswith(f"{user}:"))
        return int(fields[2]), int(fields[3])

    def directory(self, path, uid, gid, mode):
        place = self.root / path
        place.mkdir(parents=True, exist_ok=True)
        place.chmod(mode)
        os.chown(place, uid, gid)

    def environment(self, unit):
        environment = {"PATH": PATH}
        lines = list(unit.settings.get("Environment", []))
        if file := unit.one("EnvironmentFile"):
            lines += (self.root / file.lstrip("/")).read_text().splitlines()
        for line in lines:
            if match := re.match(r"(\w+)=(.*)", line):
                environment[match[1]] = match[2]
        return environment

    def load_credentials(self, unit, uid, gid):
        for setting in unit.settings.get("LoadCredential", []):
            name, _, source = setting.partition(":")
            self.directory(unit.credentials.lstrip("/"), uid, gid, 0o500)
            copy = self.root / unit.credentials.lstrip("/") / name
            shutil.copyfile(self.root / source.lstrip("/"), copy)
            copy.chmod(0o400)
            os.chown(copy, uid, gid)

    @staticmethod
    def expand(line, environment):
        """As systemd does: ${NAME} within a word, $NAME alone as any number of words."""
        words = []
        for word in shlex.split(line):
            if match := re.fullmatch(r"\$(\w+)", word):
                words += environment.get(match[1], "").split()
            else:
                words.append(re.sub(r"\$\{(\w+)\}", lambda name: environment.get(name[1], ""), word))
        return words

    def manager_socket(self):
        """The end of $NOTIFY_SOCKET that systemd would have."""
        inside = self.root / "run/manager"
        inside.unlink(missing_ok=True)
        manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        manager.bind(str(inside))
        inside.chmod(0o666)
        manager.settimeout(60)  # of a service that never becomes ready
        return manager
