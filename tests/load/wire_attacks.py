#!/usr/bin/env python3
"""Attacks a server of its own with frames written by hand, and says what became of it and of honest calls.

    wire_attacks.py PROGRAMS SOURCES [--attack NAME]... [--together] [--strict] [--seconds S] [--connections N]
                    [--over tcp|tls|unix]

PROGRAMS: where affskel-server is.  SOURCES: of the project, whose contract is compiled.  Exit code 0: the server's
memory stayed below the bound and went back within a minute, and no honest call failed; with --strict also that they
took a second at most (p99).  77: python3-grpcio or the compiler of contracts is not there."""
import argparse
import hashlib
import multiprocessing
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
try:
    import grpc
except ImportError:
    sys.exit(77)
from wire_attackers import ATTACKS, Attacker  # noqa: E402
from event_log import EventLog  # noqa: E402
from lab_service import LabService  # noqa: E402

MB = 1 << 20
PROBE_PAUSE_S = 0.05
CALL_LIMIT_S = 30
SETTLE_S = 60


def resident(pid):
    for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) * 1024
    raise ProcessLookupError(pid)


class Service:
    """The server that is attacked."""

    def __init__(self, programs, directory, over):
        self.over, self.token, self.tls_ca = over, None, None
        if over == "tls":
            lab = LabService(programs, directory, "localhost", 0)
            lab.start()
            self.process, self.target, self.log = lab.process, lab.address, lab.log
            self.token = lab.tokens["user"].read_text(encoding="ascii").strip()
            self.tls_ca = str(lab.certificate)
        else:
            listen = f"unix:{directory}/server.sock" if over == "unix" else "127.0.0.1:0"
            self.process = subprocess.Popen(
                [programs / "affskel-server", "--data-dir", directory / "data", "--listen", listen],
                stderr=subprocess.PIPE, text=True)
            self.log = EventLog(self.process.stderr)
            self.target = self.log.wait_for(r"event=listening address=(\S+)")[0][1]
        if over == "unix":
            self.address = f"{directory}/server.sock"
        else:
            self.address = ("127.0.0.1", int(self.target.rsplit(":", 1)[1]))

    def channel(self):
        options = [("grpc.use_local_subchannel_pool", 1)]
        if self.tls_ca is None:
            return grpc.insecure_channel(self.target, options)
        trust = grpc.ssl_channel_credentials(Path(self.tls_ca).read_bytes())
        own = grpc.access_token_call_credentials(self.token)
        return grpc.secure_channel(self.target, grpc.composite_channel_credentials(trust, own), options)


class Honest(threading.Thread):
    """A client that asks for the newest jobs again and again."""

    def __init__(self, service, call):
        super().__init__(daemon=True)
        self.call, self.channel = call, service.channel()
        self.waits, self.failures, self.ending = [], [], threading.Event()

    def run(self):
        while not self.ending.wait(PROBE_PAUSE_S):
            begin = time.monotonic()
            try:
                self.call(self.channel)
            except grpc.RpcError as error:
                self.failures.append(f"{error.code().name}: {error.details()}")
            self.waits.append(time.monotonic() - begin)

    def end(self):
        self.ending.set()
        self.join()
        self.channel.close()


def contract(sources, directory):
    """The modules of the client's service."""
    plugin = shutil.which("grpc_python_plugin")
    if plugin is None or shutil.which("protoc") is None:
        sys.exit(77)
    subprocess.run(["protoc", f"-I{sources}/proto", f"--python_out={directory}", f"--grpc_python_out={directory}",
                    f"--plugin=protoc-gen-grpc_python={plugin}",
                    *(f"{sources}/proto/affskel/v1/{name}.proto" for name in ("types", "client_service"))], check=True)
    sys.path.insert(0, str(directory))
    from affskel.v1 import client_service_pb2, client_service_pb2_grpc, types_pb2
    return client_service_pb2, client_service_pb2_grpc, types_pb2


def submit(service, modules, number):
    """So many jobs, each with a mesh of its own."""
    messages, rpc, types = modules
    stub = rpc.ErosionServiceStub(service.channel())
    params = types.ErosionParams(sampling=types.Sampling(target_points=10000), repair=True)

    def parts(mesh):
        yield messages.SubmitJobRequest(header=messages.SubmitJobHeader(
            name="body", priority=5, params=params, mesh_bytes=len(mesh), mesh_sha256=hashlib.sha256(mesh).hexdigest()))
        yield messages.SubmitJobRequest(data=mesh)
    for index in range(number):
        stub.SubmitJob(parts(b"OFF %d" % index), wait_for_ready=True)


def attack(names, address, tls_ca, token, connections, until):
    """In a process of its own: every attack over so many connections, until the pipe says that it is over."""
    stop = threading.Event()
    threads = [threading.Thread(target=ATTACKS[name], args=(Attacker(address, tls_ca, token), stop), daemon=True)
               for name in names for _ in range(connections)]
    for thread in threads:
        thread.start()
    until.poll(None)
    os._exit(0)


def withstand(service, names, arguments, call):
    """One attack, or several together.  True when all is as it should be."""
    people = [Honest(service, call) for _ in range(4)]
    before = peak = resident(service.process.pid)
    fresh = multiprocessing.get_context("spawn")  # gRPC's threads do not survive a fork
    until, over = fresh.Pipe(duplex=False)
    processes = [fresh.Process(
        target=attack, args=(names, service.address, service.tls_ca, service.token,
                             max(1, arguments.connections // 2), until)) for _ in range(2)]
    for one in [*people, *processes]:
        one.start()
    end = time.monotonic() + arguments.seconds
    while time.monotonic() < end:
        peak = max(peak, resident(service.process.pid))
        if peak > arguments.most_memory * 6 * MB:
            break  # no other program of this machine needs to suffer
        time.sleep(0.1)
    over.close()
    until.close()
    for one in processes:
        one.join()
    for one in people:
        one.end()
    begin = time.monotonic()
    while resident(service.process.pid) > before + 100 * MB and time.monotonic() - begin < SETTLE_S:
        time.sleep(0.2)
    after, settled = resident(service.process.pid), time.monotonic() - begin
    waits = sorted(wait for one in people for wait in one.waits)
    failures = [text for one in people for text in one.failures]
    p99 = waits[int(len(waits) * .99)] if waits else float("inf")
    good = (peak < arguments.most_memory * MB and not failures and (p99 < 1 or not arguments.strict)
            and after <= before + 100 * MB)
    print(f"{'+'.join(names):<18} {arguments.over:<5} memory {before / MB:.0f} -> {peak / MB:.0f} -> {after / MB:.0f} MB"
          f" (back after {settled:.0f} s)  honest calls {len(waits)}, failed {len(failures)},"
          f" p50 {1000 * waits[len(waits) // 2]:.0f} ms, p99 {1000 * p99:.0f} ms, longest {1000 * waits[-1]:.0f} ms"
          f"  {'well' if good else 'NOT WELL'}", flush=True)
    for text in sorted(set(failures))[:5]:
        print("   ", text)
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=Path)
    parser.add_argument("sources", type=Path)
    parser.add_argument("--attack", action="append", choices=[*ATTACKS], help="may be repeated; default: each")
    parser.add_argument("--together", action="store_true", help="all at once instead of one after the other")
    parser.add_argument("--strict", action="store_true", help="judge the time of honest calls, too")
    parser.add_argument("--seconds", type=float, default=10, help="of each")
    parser.add_argument("--connections", type=int, default=20, help="of each attack at once")
    parser.add_argument("--over", choices=["tcp", "tls", "unix"], default="tcp")
    parser.add_argument("--jobs", type=int, default=1000, help="that lists tell of")
    parser.add_argument("--most-memory", type=int, default=1000, help="of the server, in MB")
    arguments = parser.parse_args()
    names = arguments.attack or [*ATTACKS]
    good = True
    with tempfile.TemporaryDirectory(prefix="affskel-wire-") as place:
        directory = Path(place)
        modules = contract(arguments.sources, directory)
        service = Service(arguments.programs, directory, arguments.over)
        submit(service, modules, arguments.jobs)
        messages, rpc, _ = modules

        def call(channel):
            stub = rpc.ErosionServiceStub(channel)
            stub.ListJobs(messages.ListJobsRequest(limit=1), timeout=CALL_LIMIT_S)
        try:
            for group in [names] if arguments.together else [[name] for name in names]:
                good = withstand(service, group, arguments, call) and good
        except ProcessLookupError:
            good = False
        finally:
            service.process.terminate()
            code = service.process.wait(timeout=100)
        if code != 0:
            print(f"the server ended with exit code {code}", *service.log.lines[-10:], sep="\n  ")
    return 0 if good and code == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
