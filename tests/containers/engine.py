"""Podman and buildah for tests: images and containers of their own, in a network of their own.

enter() must come first: it goes on in a new network and mount namespace, in which nothing but loopback is there yet, so
that ports and networks of containers are not those of this machine.  Builds alone use this machine's network, for apt-get.
"""
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from own_namespaces import require_own_mounts

INSIDE = "AFFSKEL_TEST_NAMESPACE"

# Lower than what is usual, since not every root may raise its limits.  The files of events and networks are apart from
# the machine's, too.
CONTAINERS_CONF = """
[containers]
default_ulimits = ["nofile=4096:4096", "nproc=4096:4096"]
log_driver = "k8s-file"
[engine]
runtime = "crun"
cgroup_manager = "cgroupfs"
events_logger = "file"
tmp_dir = "{run}/engine"
[network]
network_backend = "netavark"
network_config_dir = "{place}/networks"
"""
STORAGE_CONF = """
[storage]
driver = "overlay"
graphroot = "{place}/images"
runroot = "{run}/run"
"""
# Podman 4.3 as root expects cgroups of one version; a second hierarchy, where it is mounted, is taken away.  In the folder
# the server of names has its process id: one of another network would be taken for ours.
SETUP = ("umount /sys/fs/cgroup/unified 2>/dev/null; mkdir -p /run/containers/networks && "
         "mount -t tmpfs tmpfs /run/containers/networks && ip link set lo up && exec \"$@\"")
# Neither systemd nor syslog is needed; podman misses them aloud.
NOISE = re.compile(r"systemd connection|failed to connect to syslog|Error validating CNI config file")


def enter():
    """Goes on in namespaces of its own; without root the test is skipped."""
    if os.geteuid() != 0:
        print("SKIPPED: containers with networks of their own need root; run the tests as root")
        sys.exit(77)
    if INSIDE in os.environ:
        return
    require_own_mounts()
    environment = {k: v for k, v in os.environ.items() if not k.startswith("AFFSKEL_")}
    # Of this machine, for builds: see Engine.build.
    environment[INSIDE] = f"/proc/{os.getppid()}/ns/net"
    os.execvpe("unshare", ["unshare", "--mount", "--net", "--propagation", "private", "sh", "-c", SETUP, "sh",
                           sys.executable, "-B", *sys.argv], environment)


class Engine:
    """The images in a folder, and the containers that are made of them, which end with close()."""

    def __init__(self, place):
        place.mkdir(parents=True, exist_ok=True)
        # Podman allows 50 characters, and finds out that the machine was started again by what is gone from there.
        run = f"/run/affskel-test-{hashlib.sha256(bytes(place)).hexdigest()[:12]}"
        for name, text in (("containers.conf", CONTAINERS_CONF), ("storage.conf", STORAGE_CONF)):
            (place / name).write_text(text.format(place=place, run=run))
        self.environment = dict(os.environ, CONTAINERS_CONF=f"{place}/containers.conf",
                                CONTAINERS_STORAGE_CONF=f"{place}/storage.conf")
        try:
            self.remove_containers()
        except AssertionError:
            # A test was killed, and its network went with it, without which podman does not let go of containers.
            for folder in (place / "images", place / "networks", Path(run)):
                shutil.rmtree(folder, ignore_errors=True)
            self.remove_containers()

    def close(self):
        self.remove_containers()

    def remove_containers(self):
        self.podman("pod", "rm", "--force", "--all", "--time", "0")
        self.podman("rm", "--force", "--all", "--time", "0")
        self.podman("volume", "prune", "--force")
        self.podman("network", "prune", "--force")

    def run(self, *words, check=True, **settings):
        """A command among these containers; stdout, and the code when nothing is checked."""
        settings.setdefault("env", self.environment)
        done = subprocess.run(words, check=False, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, **settings)
        if not check:
            return done.stdout, done.returncode
        if done.returncode != 0:
            said = "\n".join(line for line in done.stderr.splitlines() if not NOISE.search(line))
            raise AssertionError(f"{' '.join(map(str, words))}\nended with {done.returncode}:\n{done.stdout}{said}")
        return done.stdout

    def podman(self, *words, **settings):
        return self.run("podman", *words, **settings)

    def build(self, containerfile, context, name, *options):
        """An image, by buildah; apt-get in it has the network of this machine."""
        return self.run("nsenter", f"--net={os.environ[INSIDE]}", "buildah", "build", "--isolation", "chroot",
                        "--network", "host", "--layers", "--format", "docker", "--tag", name,
                        "--file", containerfile, *options, context)

    def has_image(self, name):
        return self.podman("image", "exists", name, check=False)[1] == 0

    def inspect(self, name, kind="container"):
        return json.loads(self.podman(kind, "inspect", name))[0]

    def process(self, container):
        """The first process of a running container."""
        return self.inspect(container)["State"]["Pid"]

    def health(self, container):
        """Whether the container's own health check passes now."""
        return self.podman("healthcheck", "run", container, check=False)[1] == 0

    def log(self, container):
        """What the container's program has written, of all its starts."""
        return self.run("sh", "-c", 'podman logs "$0" 2>&1', container)


def import_base(engine, tarball, name):
    """A bare Debian root as an image, under that name."""
    if not engine.has_image(name):
        engine.podman("import", tarball, name)


def bare_environment(**settings):
    """For programs that run beside the containers: nothing of the caller's configuration."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith("AFFSKEL_")}
    return kept | {"HOME": "/nonexistent", "XDG_CONFIG_HOME": "/nonexistent"} | settings


def paths(count):
    """The first arguments of a test, as paths; the rest is for unittest."""
    given = [Path(argument).resolve() for argument in sys.argv[1:count + 1]]
    del sys.argv[1:count + 1]
    return given
