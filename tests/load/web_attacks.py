"""Attacks on the page of affskel-client web and on the server's /metrics and /healthz, while honest people use both.

Usage: web_attacks.py SERVER CLIENT [--seconds N] [--attack NAME ...] [--strict] [--tls]

Starts a server that asks for tokens and the page before it, both on loopback, and attacks them in one way after the
other.  Prints for each: honest requests, how many of them failed, their median and 99th percentile in seconds, and the
most memory that page and server had, then and after the attack.  Exit code 1 when honest requests failed, or memory was
above 500 MB (page) or 1 GB (server) or did not come back within 100 MB in a minute; with --strict also when the 99th
percentile is above a second.  With --tls the page speaks HTTPS, and what attacks it does, too.
"""
import argparse
import asyncio
import http.client
import itertools
import json
import logging
import multiprocessing
import os
import signal
import ssl
import subprocess
import sys
import tempfile
import time
import urllib.parse
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
from event_log import EventLog  # noqa: E402

MEGABYTE = 1024.0  # of the kB in /proc
CONNECTIONS = 400  # more than there are places
GIVEN_UP = 10  # seconds
PAUSE = 0.1  # of honest people, after they have connected: what they say comes across a network
SMALL = "OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"


# Attacks: what one connection does over and over.  Each gets a stream and the host's name, until it is cancelled.

def head(host, method="GET", path="/", more=""):
    return f"{method} {path} HTTP/1.1\r\nHost: {host}\r\n{more}\r\n".encode()


def post(host, more):
    return head(host, "POST", "/api/session", f"Origin: {origin(host)}\r\n{more}")


CHUNKED = "Transfer-Encoding: chunked\r\n"


async def send(writer, piece):
    if writer.is_closing():
        raise ConnectionResetError
    writer.write(piece)
    await writer.drain()
    await asyncio.sleep(0)  # the others' turn: over TLS a connection that the peer has ended always has room for more


async def flood(writer, piece):
    while True:
        await send(writer, piece)


async def drip(writer, byte=b"x"):
    while True:
        await send(writer, byte)
        await asyncio.sleep(1)


async def drain(reader):
    while await reader.read(65536):
        pass


async def extension(reader, writer, host):
    writer.write(post(host, CHUNKED) + b"1;")
    await flood(writer, b"x" * 65536)


async def trailers(reader, writer, host):
    writer.write(post(host, CHUNKED) + b"0\r\n")
    await flood(writer, b"X: y\r\n" * 10000)


async def silent(reader, writer, host):
    await drain(reader)


async def slow_head(reader, writer, host):
    writer.write(b"GET / HTTP/1.1\r\nX: ")
    await drip(writer)


async def slow_body(reader, writer, host):
    writer.write(post(host, "Content-Length: 60000\r\n"))
    await drip(writer, b"x" * 1100)  # as fast as it must be


async def unread(reader, writer, host):
    reader._transport.pause_reading()
    writer.write(head(host, path="/page.js") * 1000)
    await asyncio.sleep(3600)


async def pipelined(reader, writer, host):
    reading = asyncio.ensure_future(drain(reader))
    try:
        await flood(writer, head(host) * 1000)
    finally:
        reading.cancel()


async def idle(reader, writer, host):
    writer.write(head(host, path="/icon.svg"))
    await drain(reader)


async def huge_header(reader, writer, host):
    writer.write(b"GET / HTTP/1.1\r\nX: ")
    await flood(writer, b"x" * 65536)


async def garbage(reader, writer, host):
    writer.write(os.urandom(100000))
    await drain(reader)


async def half_closed(reader, writer, host):
    writer.write(head(host, path="/page.js") * 10)
    if writer.can_write_eof():  # TLS has no such thing
        writer.write_eof()
    await asyncio.sleep(3600)


async def upgrade(reader, writer, host):
    writer.write(head(host, more="Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                                 "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"))
    await flood(writer, b"\x82\x7e\xff\xff" + b"x" * 65535)


async def http09(reader, writer, host):
    writer.write(b"GET /\r\n")
    await drain(reader)


async def tls(reader, writer, host):
    writer.write(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03")
    await drain(reader)


async def guesses(reader, writer, host):
    for number in range(1000000):
        body = json.dumps({"token": f"guess-{id(writer)}-{number}"}).encode()
        writer.write(post(host, f"Content-Length: {len(body)}\r\n") + body)
        await read_answer(reader)


async def heavy(reader, writer, host):
    """Large meshes to be looked at, by a user that is signed in; every second one is not waited for."""
    await upload(reader, writer, host)
    writer.transport.abort()
    reader, writer = await connect(host)
    try:
        await asyncio.wait_for(upload(reader, writer, host), 1)
    except asyncio.TimeoutError:
        pass
    finally:
        writer.transport.abort()


async def upload(reader, writer, host):
    with open(os.environ["ATTACK_MESH"], "rb") as file:
        mesh = file.read()
    writer.write(head(host, "POST", "/api/meshes?name=large.off", f"Origin: {origin(host)}\r\n"
                      f"Cookie: {os.environ['ATTACK_COOKIE']}\r\nContent-Length: {len(mesh)}\r\n") + mesh)
    await writer.drain()
    await read_answer(reader)


async def unfinished(reader, writer, host):
    writer.write(b"GET /metrics HTTP/1.1\r\n")
    await drain(reader)


async def unread_metrics(reader, writer, host):
    reader._transport.pause_reading()
    writer.write(head(host, path="/metrics") * 1000)
    await asyncio.sleep(3600)


# Name -> what, by how many connections.  Those of the page, then those of the metrics.
PAGE = {"extension": (extension, 4), "trailers": (trailers, 4), "silent": (silent, CONNECTIONS),
        "slow_head": (slow_head, CONNECTIONS), "slow_body": (slow_body, CONNECTIONS), "unread": (unread, CONNECTIONS),
        "pipelined": (pipelined, 4), "idle": (idle, CONNECTIONS), "huge_header": (huge_header, 4),
        "garbage": (garbage, 16), "half_closed": (half_closed, CONNECTIONS), "upgrade": (upgrade, 4),
        "http09": (http09, 16), "tls": (tls, CONNECTIONS), "guesses": (guesses, 8), "heavy": (heavy, 8)}
METRICS = {"metrics_unfinished": (unfinished, CONNECTIONS), "metrics_silent": (silent, CONNECTIONS),
           "metrics_unread": (unread_metrics, CONNECTIONS), "metrics_extension": (extension, 4),
           "metrics_pipelined": (pipelined, 4)}


async def read_answer(reader):
    text = await reader.readuntil(b"\r\n\r\n")
    length = next((int(line[15:]) for line in text.split(b"\r\n") if line.lower().startswith(b"content-length:")), 0)
    await reader.readexactly(length)


def trust(host):
    """How it is spoken to: by TLS, if it is the page and has a certificate; else None."""
    if host != os.environ.get("ATTACK_TLS_HOST"):
        return None
    return ssl.create_default_context(cafile=os.environ["ATTACK_CERTIFICATE"])


async def connect(host):
    name, port = host.rsplit(":", 1)
    return await asyncio.open_connection(name, int(port), ssl=trust(host))


async def attacker(what, host, come):
    while True:
        writer = None
        try:
            try:
                reader, writer = await connect(host)
            finally:
                come()
            await what(reader, writer, host)
        except (OSError, asyncio.IncompleteReadError):
            pass
        finally:
            if writer is not None:
                writer.transport.abort()
        await asyncio.sleep(0.05)  # a closed one comes again


async def attack_forever(what, connections, host, begun):
    tries = itertools.count(1)

    def come():
        if next(tries) == connections:
            begun.set()

    await asyncio.gather(*(attacker(what, host, come) for _ in range(connections)))


def attack(name, host, begun):
    """Sets `begun` when as many connections as it holds were opened, or refused."""
    what, connections = {**PAGE, **METRICS}[name]
    logging.getLogger("asyncio").setLevel(logging.CRITICAL)  # over TLS it tells of each piece that cannot be sent
    asyncio.run(attack_forever(what, connections, host, begun))


def origin(host):
    return f"{'http' if trust(host) is None else 'https'}://{host}"


def connection_to(host):
    tls = trust(host)
    if tls is None:
        return http.client.HTTPConnection(host, timeout=GIVEN_UP)
    return http.client.HTTPSConnection(host, timeout=GIVEN_UP, context=tls)


class Honest:
    """One after the other, each by a connection of its own, until the time is over."""

    def __init__(self):
        self.times, self.failed, self.why = [], 0, set()

    def ask(self, host, path, headers, body=None):
        connection = connection_to(host)
        begin = time.monotonic()
        try:
            connection.connect()
            time.sleep(PAUSE)
            connection.request("POST" if body else "GET", path, body, headers)
            answer = connection.getresponse()
            answer.read()
            if answer.status != 200:
                self.fail(f"{path}: {answer.status}")
        except (OSError, http.client.HTTPException) as error:
            self.fail(f"{path}: {error!r}")
        finally:
            connection.close()
        self.times.append(time.monotonic() - begin)

    def fail(self, why):
        self.failed += 1
        self.why.add(why)

    def share(self, of):
        return sorted(self.times)[min(len(self.times) - 1, int(of * len(self.times)))]


class Scene:
    """A server that asks for tokens, with metrics, and the page before it."""

    def __init__(self, server, client, tls):
        self.directory = tempfile.TemporaryDirectory(prefix="affskel-attacks-", ignore_cleanup_errors=True)
        data = os.path.join(self.directory.name, "data")
        self.tokens = [subprocess.run([server, "token", "add", "--owner", owner, "--data-dir", data], check=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout.strip()
                       for owner in ("ada", "eve")]
        self.server = subprocess.Popen([server, "--data-dir", data, "--listen", "127.0.0.1:0", "--workers", "0",
                                        "--metrics", "127.0.0.1:0"], stderr=subprocess.PIPE, text=True)
        log = EventLog(self.server.stderr)
        address = log.wait_for(r"event=listening address=(127\S+)")[0][1]
        self.metrics = log.wait_for(r"event=metrics address=(\S+)")[0][1]
        environment = dict(os.environ, AFFSKEL_HOME=os.path.join(self.directory.name, "home"), AFFSKEL_TOKEN_FILE="",
                           AFFSKEL_SERVER="")
        self.large = os.path.join(self.directory.name, "large.off")
        subprocess.run([client, "--quiet", "make", "body", "--triangles", "100000", "-o", self.large], check=True,
                       env=environment)
        options = self.certify() if tls else []
        self.page = subprocess.Popen([client, "--json", "--server", address, "web", "--no-open", *options],
                                     env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.host = urllib.parse.urlsplit(json.loads(self.page.stdout.readline())["address"]).netloc
        if tls:
            os.environ["ATTACK_TLS_HOST"] = self.host

    def certify(self):
        """The options by which the page speaks TLS, with a certificate that all here trust from now on."""
        certificate, key = (os.path.join(self.directory.name, name) for name in ("page.pem", "page.key"))
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                        "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost",
                        "-keyout", key, "-out", certificate], check=True, stderr=subprocess.DEVNULL)
        os.environ["ATTACK_CERTIFICATE"] = certificate
        return ["--http", "localhost:0", "--tls-cert", certificate, "--tls-key", key]

    def sign_in(self, token):
        """As the page's script does.  The cookie, None after a minute, and how long it took."""
        begin = time.monotonic()
        while True:
            again = 1
            connection = connection_to(self.host)
            try:
                connection.request("POST", "/api/session", json.dumps({"token": token}),
                                   {"Origin": origin(self.host), "Content-Type": "application/json"})
                answer = connection.getresponse()
                answer.read()
                if answer.status == 200:
                    return answer.getheader("Set-Cookie").split(";")[0], time.monotonic() - begin
                again = int(answer.getheader("Retry-After") or again)
            except (OSError, http.client.HTTPException):
                pass
            finally:
                connection.close()
            if time.monotonic() - begin > 60:
                return None, time.monotonic() - begin
            time.sleep(again)  # as long as the service asks for: how long a sign-in takes is what is measured

    def memory(self):
        return [resident(process.pid) for process in (self.page, self.server)]

    def close(self):
        for process in (self.page, self.server):
            process.send_signal(signal.SIGTERM)
            process.wait()
        self.page.stdout.close()
        self.directory.cleanup()


def resident(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:")) / MEGABYTE


def attacked(scene, name, seconds):
    """What honest people saw, the memory before, at most, and after."""
    before, most = scene.memory(), scene.memory()
    host = scene.host if name in PAGE else scene.metrics
    if name == "heavy":
        os.environ.update(ATTACK_MESH=scene.large, ATTACK_COOKIE=scene.sign_in(scene.tokens[1])[0])
    begun = multiprocessing.Event()
    process = multiprocessing.Process(target=attack, args=(name, host, begun), daemon=True)
    process.start()
    honest, sign_in = Honest(), None
    try:
        if not begun.wait(60):
            raise TimeoutError(f"{name} never began")
        cookie = {}
        if name in PAGE:
            secret, sign_in = scene.sign_in(scene.tokens[0])
            if secret is None:
                honest.fail("the sign-in")
            cookie = {"Cookie": secret or ""}
        paths = ["/", "/page.js", "/api/jobs"] if name in PAGE else ["/healthz", "/metrics"]
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for path in paths:
                honest.ask(host, path, cookie)
            if name == "heavy":
                honest.ask(host, "/api/meshes?name=small.off", {**cookie, "Origin": origin(host)}, SMALL)
            most = [max(pair) for pair in zip(most, scene.memory())]
    finally:
        process.kill()
        process.join()
    end = time.monotonic() + 60
    while any(now > then + 100 for now, then in zip(scene.memory(), before)) and time.monotonic() < end:
        time.sleep(0.5)
    return honest, sign_in, before, most, scene.memory()


def faults(honest, before, most, after, strict):
    if honest.failed:
        yield f"{honest.failed} honest requests failed ({', '.join(sorted(honest.why))})"
    if most[0] > 500 or most[1] > 1024:
        yield "too much memory"
    if any(now > then + 100 for now, then in zip(after, before)):
        yield "memory was kept"
    if strict and honest.share(.99) > 1:
        yield "honest requests were slow"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("server")
    parser.add_argument("client")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--attack", nargs="+", choices=[*PAGE, *METRICS], default=[*PAGE, *METRICS])
    parser.add_argument("--strict", action="store_true")
    parser.add_argument("--tls", action="store_true")
    options = parser.parse_args()
    failed = False
    print("attack              honest failed  median     p99  sign-in    page MB      server MB")
    scene = Scene(options.server, options.client, options.tls)
    try:
        for name in options.attack:
            honest, sign_in, before, most, after = attacked(scene, name, options.seconds)
            found = list(faults(honest, before, most, after, options.strict))
            failed = failed or bool(found)
            print(f"{name:18} {len(honest.times):7} {honest.failed:6} {honest.share(.5):7.3f} {honest.share(.99):7.3f} "
                  f"{sign_in or 0:8.2f}  {most[0]:4.0f} -> {after[0]:4.0f}  {most[1]:4.0f} -> {after[1]:4.0f}  "
                  + "; ".join(found), flush=True)
    finally:
        scene.close()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
