"""The rules and the dashboard of deploy/monitoring ask for metrics and labels that a real server has, at any time, and the
rules are tried with series that it has.

Usage: names_test.py MONITORING-FOLDER BINARY-FOLDER
"""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import urllib.request

FOLDER, BINARIES = map(pathlib.Path, sys.argv[1:3])
# Prometheus' own, and those of its scraping.
FOREIGN = {"instance", "job", "severity"}


def exposition(address):
    with urllib.request.urlopen(f"http://{address}/metrics", timeout=30) as answer:
        return answer.read().decode()


def samples(text):
    """Names of metrics that have a value and, of each, its series: their labels."""
    found = {}
    for name, labels in re.findall(r"^(affskel_\w+)(?:\{(.*)\})? ", text, re.M):
        found.setdefault(name, []).append(dict(re.findall(r"(\w+)=\"([^\"]*)\"", labels)))
    return found


def tried():
    """Series that promtool gives to the rules."""
    text = pathlib.Path(__file__).with_name("affskel.rules.test.yml").read_text(encoding="utf-8")
    for name, labels in re.findall(r"series: '(affskel_\w+)\{(.*)\}'", text):
        yield name, {key: value for key, value in re.findall(r"(\w+)=\"([^\"]*)\"", labels) if key not in FOREIGN}


def expressions():
    """Of each file, what it asks Prometheus."""
    rules = (FOLDER / "affskel.rules.yml").read_text(encoding="utf-8")
    yield from re.findall(r"expr:(?: >-)?\s+(.*(?:\n {10,}.*)*?)(?=\n\s+(?:for|labels):)", rules)
    dashboard = json.loads((FOLDER / "dashboard.json").read_text(encoding="utf-8"))
    for panel in dashboard["panels"]:
        for target in panel["targets"]:
            yield target["expr"]


def labels_of(expression):
    """Labels that an expression filters or groups by."""
    filtered = re.findall(r"(\w+)\s*(?:=~|!~|!=|=)\s*\"", expression)
    grouped = re.findall(r"by \(([^)]*)\)", expression)
    return {*filtered, *(label.strip() for group in grouped for label in group.split(","))} - FOREIGN


def main():
    environment = {k: v for k, v in os.environ.items() if not k.startswith("AFFSKEL_")}
    with tempfile.TemporaryDirectory() as place:
        data = pathlib.Path(place) / "data"
        server = subprocess.Popen([BINARIES / "affskel-server", "--data-dir", data, "--listen", f"unix:{place}/socket",
                                   "--workers", "1", "--metrics", "127.0.0.1:0"],
                                  stderr=subprocess.PIPE, text=True, env=environment)
        try:
            for line in server.stderr:
                if "event=ready" in line:
                    break
            address = json.loads((data / "server.json").read_text(encoding="utf-8"))["metrics"]
            client = [BINARIES / "affskel-client", "--server", f"unix:{place}/socket", "--quiet"]
            mesh = f"{place}/box.off"
            subprocess.run([*client, "make", "box", "-o", mesh], check=True, env=environment)
            subprocess.run([*client, "submit", mesh, "--points", "500", "--wait"], check=True, env=environment,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            known = samples(exposition(address))
        finally:
            server.send_signal(signal.SIGTERM)
            server.communicate()
    asked = list(expressions())
    missing = []
    for expression in asked:
        names = set(re.findall(r"affskel_\w+", expression))
        missing += [f"{name} in: {expression}" for name in names - known.keys()]
        there = set().union(*(series for name in names for series in known.get(name, [])))
        missing += [f"label {label} in: {expression}" for label in labels_of(expression) - there]
    missing += [f"{name} {labels} in the rules' test" for name, labels in tried() if labels not in known.get(name, [])]
    if missing or len(asked) < 30:
        raise SystemExit("\n".join([*missing, f"{len(asked)} expressions read"]))
    print(f"{len(asked)} expressions, {len(known)} metrics")


if __name__ == "__main__":
    main()
