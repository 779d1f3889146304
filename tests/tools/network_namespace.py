"""Networks between hosts that are only networks: each a namespace in which processes are run."""
import subprocess


class NetworkNamespace:
    """A network of its own, its loopback device up, from the start until close(); needs root."""

    def __init__(self):
        # Holds the namespace until its stdin closes.
        self.holder = subprocess.Popen(["unshare", "--net", "sh", "-c", "ip link set lo up; echo there; read _"],
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self.holder.stdout.readline() == b"there\n"

    @property
    def pid(self):
        """Of a process inside, by which ip names the namespace."""
        return self.holder.pid

    @property
    def inside(self):
        """The words that run a command in here; the process becomes the command."""
        return ["nsenter", f"--net=/proc/{self.pid}/ns/net"]

    def run(self, *command):
        """What a command prints; it must succeed."""
        return subprocess.run([*self.inside, *command], check=True, stdout=subprocess.PIPE, text=True).stdout

    def close(self):
        self.holder.stdin.close()
        self.holder.wait()
        self.holder.stdout.close()
