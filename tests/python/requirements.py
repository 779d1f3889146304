"""Exits with ctest's code for a skipped test, and the reason, where Debian's packages for it are missing."""
import importlib.util
import sys


def require(**packages):
    """Modules and the packages that have them."""
    missing = [package for module, package in packages.items() if importlib.util.find_spec(module) is None]
    if missing:
        print(f"no {' and no '.join(missing)}: skipped")
        sys.exit(77)
