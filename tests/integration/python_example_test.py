"""proto/examples/erode.py against the command line, across a restart of the server.

Usage: python_example_test.py PROJECT AFFSKEL-SERVER AFFSKEL-CLIENT PROTOC GRPC-PYTHON-PLUGIN"""
import importlib.util
import json
import os
import signal
import subprocess
import sys
import tempfile

if importlib.util.find_spec("grpc") is None:
    print("no python3-grpcio: skipped")
    sys.exit(77)

PROJECT, SERVER, CLIENT, PROTOC, PLUGIN = sys.argv[1:]


def path(name):
    return os.path.join(directory, name)


def start_server():
    """Its listening socket is there when it logs that it listens."""
    server = subprocess.Popen([SERVER, "--data-dir", path("data"), "--workers", "1"], stderr=subprocess.PIPE,
                              text=True)
    for line in server.stderr:
        if "event=listening" in line:
            return server
    raise RuntimeError("the server did not start")


def stop_server(server):
    server.send_signal(signal.SIGTERM)
    server.communicate()
    assert server.returncode == 0, server.returncode


def run(*command, **options):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def generate_stubs():
    protos = [os.path.join(PROJECT, "proto/affskel/v1", name) for name in ("types.proto", "client_service.proto")]
    run(PROTOC, "-I", os.path.join(PROJECT, "proto"), "--python_out", directory, "--grpc_python_out", directory,
        "--plugin=protoc-gen-grpc_python=" + PLUGIN, *protos)


def erode_across_a_restart():
    """The job's id; the server is stopped and started again once the first progress is out."""
    server = start_server()
    example = subprocess.Popen(
        [sys.executable, "-B", os.path.join(PROJECT, "proto/examples/erode.py"), address, path("body.off"),
         path("field.csv")],
        env=dict(os.environ, PYTHONPATH=directory), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    first = example.stderr.readline()
    assert "directions" in first, first
    stop_server(server)
    server = start_server()
    job, rest = example.communicate()
    assert example.returncode == 0, rest
    assert "500 of 500 directions" in rest, rest
    return server, job.strip()


with tempfile.TemporaryDirectory(prefix="affskel-python-") as directory:
    address = "unix:" + path("data/server.sock")
    generate_stubs()
    run(CLIENT, "--quiet", "make", "body", "--triangles", "500", "-o", path("body.off"))
    server, job = erode_across_a_restart()
    client = [CLIENT, "--quiet", "--server", address]
    state = json.loads(run(*client, "--json", "status", job))
    assert state["state"] == "done", state
    run(*client, "fetch", job, "field", "-o", path("fetched.csv"))
    with open(path("field.csv"), "rb") as ours, open(path("fetched.csv"), "rb") as theirs:
        assert ours.read() == theirs.read(), "the fields differ"
    stop_server(server)
