"""A bare Debian 12 root as a tar file, made once for each build directory.

Usage: bare_root.py MMDEBSTRAP TARBALL"""
import os
import subprocess
import sys
from pathlib import Path

PROGRAM, TARBALL = sys.argv[1], Path(sys.argv[2])

if os.geteuid() != 0:
    print("SKIPPED: roots with services of their own need root; run the tests as root")
    sys.exit(77)
if not TARBALL.exists():
    new = TARBALL.with_suffix(".new.tar")
    subprocess.run([PROGRAM, "--variant=minbase", "bookworm", new], check=True)
    new.rename(TARBALL)
