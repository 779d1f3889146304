"""Runs the commands of the `sh` blocks of the README and of the pages that go on with it, in one shell and one folder.

Every command must exit 0.  Servers, workers and the web page stay until the end, as in terminals of their own: the next
command is typed once they are up.  What a command names with -o or > must be there and not empty afterwards.

With the programs of a build tree, lines of deploy/ and cmake are left out, for they build.  With a bare Debian root, into
which the checkout is copied, deploy/quickstart installs and builds in it first, and what it says that it leaves must be
there; deploy/run-tests, which runs this test, and cmake are left out.

Usage: readme_test.py SOURCES BINARY-FOLDER
       readme_test.py SOURCES --root ROOT-TARBALL FOLDER-OF-hosts.py
"""

import os
import pathlib
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading

STAY = re.compile(r"affskel-server --data-dir|affskel-worker --|affskel-client( --\S+( [^-]\S*)?)* web\b")
LEFT_OUT = re.compile(r"(deploy/|cmake |export PATH=)")
UP = re.compile(r"event=(listening|ready)|^https?://")  # of a server, a worker, the page
PAGES = ("README.md", "server/README.md")  # in their order
LIMIT = 120  # seconds for one command
BUILD_LIMIT = 7200  # for installing and building


def commands_of(page):
    """The command lines, without comments; a line that ends in \\ goes on in the next."""
    for block in re.findall(r"^```sh\n(.*?)^```$", page, re.M | re.S):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if words and not LEFT_OUT.match(line):
                yield line


def outputs_of(line):
    """The files and folders that a command is to leave."""
    words = shlex.split(line, comments=True)
    named = [after for word, after in zip(words, words[1:]) if word in ("-o", "--plot", ">", "-keyout", "-out")]
    return [name for name in named if name != "-"]


def free_port(wanted):
    """Fails where the README's port is taken on this machine, with the reason."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind(("127.0.0.1", wanted))


class Shell:
    """Runs commands in one folder; stops what stays.

    folder: where this process finds their files.  words_for(command): what runs a command of bash in that folder."""

    def __init__(self, folder, words_for):
        self.folder, self.words_for, self.staying = folder, words_for, []

    def run(self, line, limit=LIMIT):
        done = subprocess.run(self.words_for("set -euo pipefail\n" + line), stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=limit, check=False)
        if done.returncode != 0:
            raise SystemExit(f"exit {done.returncode}: {line}\n{done.stdout}{done.stderr}")
        for name in outputs_of(line):
            place = self.folder / name
            if not place.exists() or (place.is_file() and place.stat().st_size == 0):
                raise SystemExit(f"{name} is missing or empty after: {line}")
        return done.stdout

    def start(self, line):
        """Goes on once it says that it is up."""
        process = subprocess.Popen(self.words_for("exec " + line), text=True, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        limit = threading.Timer(LIMIT, process.kill)
        limit.start()
        said, up = [], False
        while not up and (text := process.stdout.readline()):
            said.append(text)
            up = bool(UP.search(text))
        limit.cancel()
        reader = threading.Thread(target=lambda: said.extend(process.stdout))
        reader.start()
        self.staying.append((line, process, reader, said))
        if not up:
            raise SystemExit(f"exit {process.wait(LIMIT)}: {line}\n{''.join(said)}")

    def stop(self):
        """What stayed ends cleanly on SIGTERM, the last one first."""
        for line, process, reader, said in reversed(self.staying):
            process.send_signal(signal.SIGTERM)
            code = process.wait(LIMIT)
            reader.join()
            if code != 0:
                raise SystemExit(f"exit {code} on SIGTERM: {line}\n{''.join(said)}")


def type_all(shell, lines):
    try:
        for line in lines:
            print(line, flush=True)
            (shell.start if STAY.match(line) else shell.run)(line)
    except BaseException:
        for _, process, _, _ in shell.staying:
            process.kill()
            process.wait()
        raise
    shell.stop()


def with_programs(lines, binaries):
    """In an empty folder, with the programs of a build tree."""
    for port in sorted({int(p) for line in lines for p in re.findall(r"(?:localhost|127\.0\.0\.1):(\d+)", line)}):
        free_port(port)
    with tempfile.TemporaryDirectory() as place:
        environment = {k: v for k, v in os.environ.items() if not k.startswith(("AFFSKEL_", "XDG_"))}
        environment |= {"PATH": f"{binaries}:{environment['PATH']}", "HOME": place, "BROWSER": "true"}
        settings = [f"{name}={value}" for name, value in environment.items()]
        type_all(Shell(pathlib.Path(place), lambda command: ["env", "-i", "-C", place, *settings, "bash", "-c", command]),
                 lines)


def in_bare_root(lines, checkout, tarball):
    """In the copy of the checkout in a bare root, with a network of its own once everything is installed."""
    from hosts import PATH, Host

    with tempfile.TemporaryDirectory() as place:
        host = Host(tarball, pathlib.Path(place) / "root")
        try:
            (host.root / "etc/hosts").write_text("127.0.0.1 localhost\n", encoding="ascii")
            shutil.copyfile("/etc/resolv.conf", host.root / "etc/resolv.conf")
            folder = host.root / "root/affskel"
            folder.mkdir()
            files = subprocess.run(["git", "-C", checkout, "ls-files", "-z"], capture_output=True, check=True).stdout
            packed = subprocess.run(["tar", "-C", checkout, "--null", "-T", "-", "-c"], input=files, capture_output=True,
                                    check=True).stdout
            subprocess.run(["tar", "-C", folder, "-x"], input=packed, check=True)

            def words_for(command, cabled=True):
                return host.command(["env", "-i", "-C", "/root/affskel", "HOME=/root", "BROWSER=true", "LC_ALL=C.UTF-8",
                                     f"PATH=/root/affskel/build/release/bin:{PATH}", "bash", "-c", command], cabled)

            print("deploy/quickstart", flush=True)
            said = Shell(folder, lambda command: words_for(command, False)).run("deploy/quickstart", BUILD_LIMIT)
            left = re.findall(r"^  (body\.\S+) ", said, re.M)
            if len(left) < 5 or any((folder / "quickstart-output" / name).stat().st_size == 0 for name in left):
                raise SystemExit(f"deploy/quickstart says that it leaves {left}:\n{said}")
            type_all(Shell(folder, words_for), lines)
        finally:
            host.close()


def main():
    sources = pathlib.Path(sys.argv[1])
    lines = []
    for page in PAGES:
        found = list(commands_of((sources / page).read_text(encoding="utf-8")))
        if not found:
            raise SystemExit(f"{page} has lost its commands")
        lines += found
    if sys.argv[2] == "--root":
        sys.path.insert(0, sys.argv[4])
        in_bare_root(lines, sources, sys.argv[3])
    else:
        with_programs(lines, sys.argv[2])
    print(f"{len(lines)} commands")


if __name__ == "__main__":
    main()
