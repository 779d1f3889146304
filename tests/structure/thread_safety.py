"""Checks with Clang's thread safety analysis that every member marked ABSL_GUARDED_BY is used with its mutex held.

Marked members are private, so the files that can touch them are those that mark some themselves, that include a
header which does, or that see one of their own folder.  These are looked at as compile_commands.json says they are
compiled, twenty at once, and fewer where these have faults; files with coroutines are left out.

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
MARK = "ABSL_GUARDED_BY("
BATCH = 20  # files


def included_files(project, path):
    with open(os.path.join(project, path), encoding="utf-8") as source:
        for include in INCLUDE.findall(source.read()):
            for place in (os.path.dirname(path),) + INCLUDE_DIRS:
                other = os.path.normpath(os.path.join(place, include))
                if os.path.isfile(os.path.join(project, other)):
                    yield other
                    break


def seen_files(project, path, known):
    """A file and all that it includes, however far down."""
    if path not in known:
        known[path] = {path}
        for other in included_files(project, path):
            known[path] |= seen_files(project, other, known)
    return known[path]


def is_marked(project, path):
    with open(os.path.join(project, path), encoding="utf-8") as source:
        return MARK in source.read()


def touches_marked(project, path, known):
    near = {path, *included_files(project, path)}
    near |= {other for other in seen_files(project, path, known) if os.path.dirname(other) == os.path.dirname(path)}
    return any(is_marked(project, other) for other in near)


def has_coroutines(project, path, known):
    """Clang 14 cannot read those of GCC's library."""
    for seen in seen_files(project, path, known):
        with open(os.path.join(project, seen), encoding="utf-8") as source:
            if "asio::awaitable" in source.read():
                return True
    return False


def sources_of(project, entry):
    """The sources of an entry: its file, or those that CMake had it include (AFFSKEL_UNITY)."""
    paths = [entry["file"]]
    if os.path.basename(os.path.dirname(entry["file"])) == "Unity":
        with open(entry["file"], encoding="utf-8") as batch:
            paths = INCLUDE.findall(batch.read())
    return [os.path.relpath(os.path.realpath(path), os.path.realpath(project)) for path in paths]


def analysis(entry, clang):
    """The command that looks at what is written to it as the entry is compiled, without writing anything."""
    words = shlex.split(entry["command"])
    kept = [word for before, word in zip([""] + words, words)
            if re.match(r"-(I|D|std=|isystem)", word) or before == "-isystem"]
    return [clang, "-fsyntax-only", "-Wno-everything", "-Wthread-safety", "-Werror", *kept, "-x", "c++", "-"]


def analyse(project, build, clang):
    """What Clang says of each file that it looks at, by path; nothing of a file without faults."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as commands:
        entries = json.load(commands)
    known = {}

    def is_chosen(path):
        return (path.startswith(TOPS) and touches_marked(project, path, known)
                and not has_coroutines(project, path, known))

    def words_about(entry, paths):
        text = "".join(f'#include "{os.path.join(os.path.realpath(project), path)}"\n' for path in paths)
        ended = subprocess.run(analysis(entry, clang), cwd=entry["directory"], input=text,
                               capture_output=True, text=True, check=False)
        return ended.stderr if ended.returncode != 0 else ""

    def words_by_path(entry, paths):
        words = words_about(entry, paths)
        if not words or len(paths) == 1:
            return dict.fromkeys(paths, words)
        half = len(paths) // 2  # faults, or names that two files have, each for itself
        return words_by_path(entry, paths[:half]) | words_by_path(entry, paths[half:])

    chosen = {}  # a source of several programs is looked at once
    for entry in entries:
        for path in sources_of(project, entry):
            if path not in chosen and is_chosen(path):
                chosen[path] = entry
    alike = {}  # those of a top-level folder that are compiled alike: what they include is read once for many
    for path, entry in sorted(chosen.items(), key=lambda one: one[0]):
        key = path.split("/")[0], entry["directory"], *analysis(entry, clang)
        alike.setdefault(key, (entry, []))[1].append(path)
    batches = [(entry, paths[first:first + BATCH])
               for entry, paths in alike.values() for first in range(0, len(paths), BATCH)]
    said = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for words in pool.map(words_by_path, *zip(*batches)):
            said.update(words)
    return said


def main():
    said = analyse(*sys.argv[1:4])
    faults = {path: words for path, words in said.items() if words}
    for path, words in faults.items():
        print(f"{path}:\n{words}")
    print(f"{len(said)} files, {len(faults)} with faults")
    return 1 if faults or not said else 0


if __name__ == "__main__":
    sys.exit(main())
