"""Runs a test by the Python of the virtual environment that package_test.py made.

Usage: in_venv.py VENV TEST ARGUMENTS..."""
import os
import sys

from requirements import require

require(grpc="python3-grpcio", numpy="python3-numpy")
PYTHON = os.path.join(sys.argv[1], "bin/python")
os.execv(PYTHON, [PYTHON, "-B", *sys.argv[2:]])
