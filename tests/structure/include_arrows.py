"""Checks that include arrows between the rooms of the sources run one way.

A room is a folder with sources.  rooms.txt lists all of them, each with the rooms that it may include, which must stand
above it: so there is no circle.  What is listed must be there and be used.

Usage: include_arrows.py PROJECT [ROOMS.TXT]   Exit code 1, and a line for each fault, when there are any.
"""
import os
import re
import sys

TOPS = ("proto", "worker", "server", "client")
# Where the compiler looks for "room/file.h", besides the including file's own folder.
INCLUDE_DIRS = ("proto", "worker", "server", ".")
GENERATED = re.compile(r"^affskel/v1/\w+\.(grpc\.)?pb\.h$|^wire/version\.h$")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def read_rooms(path):
    """Room -> the rooms that it may include, in the order of the file."""
    rooms = {}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            line = line.split("#")[0].strip()
            if line:
                room, _, may = line.partition(":")
                rooms[room.strip()] = may.split()
    return rooms


def sources(project):
    for top in TOPS:
        for folder, _, names in os.walk(os.path.join(project, top)):
            for name in sorted(names):
                if name.endswith((".h", ".cc", ".h.in")):
                    yield os.path.relpath(os.path.join(folder, name), project)


def included_room(project, folder, include):
    """Room of an included file, None when there is no such file."""
    for place in (folder,) + INCLUDE_DIRS:
        path = os.path.normpath(os.path.join(place, include))
        if os.path.isfile(os.path.join(project, path)):
            return os.path.dirname(path)
    return None


def order_faults(rooms):
    above = set()
    for room, may in rooms.items():
        for other in may:
            if other not in above:
                yield f"{room}: may include {other}, which does not stand above it"
        above.add(room)


def faults_of(project, rooms):
    yield from order_faults(rooms)
    found, used = set(), set()
    for path in sources(project):
        room = os.path.dirname(path)
        found.add(room)
        if room not in rooms:
            yield f"{path}: its room is not listed"
            continue
        with open(os.path.join(project, path), encoding="utf-8") as source:
            for include in INCLUDE.findall(source.read()):
                if GENERATED.match(include):
                    continue
                other = included_room(project, room, include)
                if other is None:
                    yield f'{path}: includes "{include}", which is nowhere'
                elif other != room:
                    used.add((room, other))
                    if other not in rooms[room]:
                        yield f'{path}: includes "{include}", but {room} may not include {other}'
    for room, may in rooms.items():
        if room not in found:
            yield f"{room}: listed, but there is no source in it"
        for other in may:
            if (room, other) not in used:
                yield f"{room}: may include {other}, but does not"


def main():
    project = sys.argv[1]
    listed = sys.argv[2] if len(sys.argv) > 2 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "rooms.txt")
    faults = list(faults_of(project, read_rooms(listed)))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
