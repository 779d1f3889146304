"""Machines with addresses of their own on one switch, a bridge in the network of the test."""
import subprocess

from network_namespace import NetworkNamespace

SWITCH = "lan"
# What a link at the edge is like; the kernel may not have netem, which delays, too.
SLOW = (("netem", "delay", "60ms", "rate", "4mbit"), ("tbf", "rate", "4mbit", "burst", "16kb", "latency", "400ms"))


def ip(*words):
    subprocess.run(["ip", *words], check=True)


def lay(names, hosts_file):
    """Machines of these names, by name: 10.78.0.1, .2, ..., which they all know each other by.

    hosts_file: a file for the names, which takes the place of /etc/hosts in the mount namespace of the test."""
    ip("link", "add", "name", SWITCH, "type", "bridge")
    ip("link", "set", SWITCH, "up")
    machines = {name: Machine(number, name) for number, name in enumerate(names, 1)}
    hosts_file.write_text("127.0.0.1 localhost\n" + "".join(f"{m.address} {m.name}\n" for m in machines.values()))
    subprocess.run(["mount", "--bind", hosts_file, "/etc/hosts"], check=True)
    return machines


class Machine:
    """A host: a network with one device, eth0, and a plug at the switch."""

    def __init__(self, number, name):
        self.name, self.plug, self.address = name, f"plug{number}", f"10.78.0.{number}"
        self.network = NetworkNamespace()
        ip("link", "add", "name", self.plug, "type", "veth", "peer", "name", "eth0", "netns", str(self.network.pid))
        ip("link", "set", self.plug, "master", SWITCH, "up")
        self.network.run("ip", "address", "add", f"{self.address}/24", "dev", "eth0")
        self.network.run("ip", "link", "set", "eth0", "up")

    def unplug(self):
        """For good: no peer hears of its connections again."""
        ip("link", "set", self.plug, "down")

    def part(self, other):
        """Nothing passes between the two, and neither is told."""
        for one, another in ((self, other), (other, self)):
            one.network.run("iptables", "--wait", "-A", "INPUT", "-s", another.address, "-j", "DROP")

    def join(self, other):
        """Undoes part()."""
        for one, another in ((self, other), (other, self)):
            one.network.run("iptables", "--wait", "-D", "INPUT", "-s", another.address, "-j", "DROP")

    def slow_down(self):
        """Makes the link slow both ways; the discipline that does it, None when the kernel has none."""
        ends = ([], self.plug), (self.network.inside, "eth0")
        for discipline in SLOW:
            done = [subprocess.run([*inside, "tc", "qdisc", "replace", "dev", device, "root", *discipline], check=False,
                                   stderr=subprocess.DEVNULL).returncode for inside, device in ends]
            if not any(done):
                return discipline[0]
        return None

    def sent_bytes(self):
        """Bytes that have left through the slow link."""
        return int(self.network.run("tc", "-s", "qdisc", "show", "dev", "eth0").split(" Sent ")[1].split()[0])
