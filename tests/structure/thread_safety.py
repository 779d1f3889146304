"""Checks with Clang's thread safety analysis that every member marked ABSL_GUARDED_BY is used with its mutex held.

Looks at the source files that see base/mutex.h, as compile_commands.json of the build says they are compiled.

Usage: thread_safety.py PROJECT BUILD CLANG++    Exit code 1, and Clang's words, for each that breaks a rule.
"""
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from include_arrows import INCLUDE, INCLUDE_DIRS  # noqa: E402

TOPS = ("proto/", "server/", "worker/", "client/")
MUTEX = "proto/base/mutex.h"


def included_files(project, path):
    with open(os.path.join(project, path), encoding="utf-8") as source:
        for include in INCLUDE.findall(source.read()):
            for place in (os.path.dirname(path),) + INCLUDE_DIRS:
                other = os.path.normpath(os.path.join(place, include))
                if os.path.isfile(os.path.join(project, other)):
                    yield other
                    break


def sees_mutex(project, path, known):
    """Whether a file is mutex.h or includes it, however far down."""
    if path not in known:
        known[path] = path == MUTEX
        known[path] = known[path] or any([sees_mutex(project, other, known) for other in included_files(project, path)])
    return known[path]


def analysis(entry, clang):
    """The command that looks at a file as it is compiled, without writing anything."""
    words = shlex.split(entry["command"])
    kept = [word for word in words if re.match(r"-(I|D|std=|isystem)", word) or words[words.index(word) - 1] == "-isystem"]
    return [clang, "-fsyntax-only", "-Wno-everything", "-Wthread-safety", "-Werror", *kept, entry["file"]]


def main():
    project, build, clang = sys.argv[1:4]
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as commands:
        entries = {os.path.relpath(os.path.realpath(entry["file"]), os.path.realpath(project)): entry
                   for entry in json.load(commands)}
    known = {}
    chosen = [path for path in sorted(entries) if path.startswith(TOPS) and sees_mutex(project, path, known)]
    if not chosen:
        print("no source file sees " + MUTEX)
        return 1

    def run(path):
        return path, subprocess.run(analysis(entries[path], clang), cwd=entries[path]["directory"],
                                    capture_output=True, text=True, check=False)

    bad = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for path, result in pool.map(run, chosen):
            if result.returncode != 0:
                bad += 1
                print(f"{path}:\n{result.stderr}")
    print(f"{len(chosen)} files, {bad} with faults")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
