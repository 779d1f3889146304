"""Tests that need a machine to themselves: networks, ports and processes that no other program sees."""
import os
import shutil
import subprocess
import sys


def enter(*tools):
    """Goes on, from the start of the script, in network, process and mount namespaces of the test's own.

    Whatever the test starts ends with it, also when it is killed.  Without root or one of the tools it is skipped."""
    if os.environ.pop("AFFSKEL_TEST_NAMESPACES", None):
        # The loopback device is down in a new network.
        subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
        return
    os.environ["PATH"] += ":/usr/sbin:/sbin"  # where daemons are, also for users that are not root
    missing = [tool for tool in ("ip", "unshare", *tools) if not shutil.which(tool)]
    if missing:
        skip(f"no {', '.join(missing)}; deploy/run-tests --all installs it")
    if os.geteuid() != 0:
        skip("namespaces of its own need root; run the tests as root")
    require_own_mounts()
    # The shell is there as process 1, to reap what loses its parent.
    os.environ["AFFSKEL_TEST_NAMESPACES"] = "entered"
    os.execvp("unshare", ["unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc",
                          "sh", "-c", '"$@"; exit $?', "sh", sys.executable, "-B", *sys.argv])


def require_own_mounts():
    """Skips the test where no mounts of its own can be made: in a plain chroot, or a container that forbids it."""
    tried = subprocess.run(["unshare", "--mount", "true"], check=False, capture_output=True, text=True)
    if tried.returncode != 0:
        skip(f"no mounts of its own can be made here ({tried.stderr.strip()}); where the root is a plain chroot, mount "
             "it on itself first (mount --bind ROOT ROOT)")


def skip(reason):
    """Ends the test as one that ctest shows as skipped."""
    print(f"SKIPPED: {reason}")
    sys.exit(77)
