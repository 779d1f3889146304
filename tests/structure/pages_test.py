"""Every file and folder that a page names is there: relative links, and paths in backticks below a top-level folder.

Usage: pages_test.py SOURCES
"""

import pathlib
import re
import sys

TOP = ("proto", "server", "worker", "client", "tests", "deploy")
LINK = re.compile(r"\]\((?!https?:|#|mailto:)([^)#\s]+)")
PATH = re.compile(r"`((?:%s)/[\w./*-]*)`" % "|".join(TOP))
LEFT_OUT = {"CHANGELOG.md"}  # tells of what was there, too


def pages(sources):
    for page in sorted(sources.rglob("*.md")):
        parts = page.relative_to(sources).parts
        if parts[0] in (*TOP, page.name) and page.name not in LEFT_OUT:
            yield page


def missing(page, sources):
    """What the page names and is not there."""
    text = page.read_text(encoding="utf-8")
    for link in LINK.findall(text):
        if not (page.parent / link).exists():
            yield link
    for path in PATH.findall(text):
        if not any(sources.glob(path.rstrip("/"))) and not any(page.parent.glob(path.rstrip("/"))):
            yield path


def main():
    sources = pathlib.Path(sys.argv[1])
    faults = []
    count = 0
    for page in pages(sources):
        count += 1
        faults += [f"{page.relative_to(sources)} names {name}, which is not there" for name in missing(page, sources)]
    if count < 8:
        raise SystemExit(f"only {count} pages were found")
    if faults:
        raise SystemExit("\n".join(faults))
    print(f"{count} pages")


if __name__ == "__main__":
    main()
