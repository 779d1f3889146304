"""HTTP/2 frames by hand (RFC 9113): what no well-behaved library would send."""
import socket
import ssl
import struct

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
DATA, HEADERS, PRIORITY, RST_STREAM, SETTINGS, PING, GOAWAY, WINDOW_UPDATE, CONTINUATION = 0, 1, 2, 3, 4, 6, 7, 8, 9
END_STREAM, ACK, END_HEADERS = 1, 1, 4
INITIAL_WINDOW_SIZE = 4


def frame(kind, flags, stream, payload=b""):
    return struct.pack(">I", len(payload))[1:] + struct.pack(">BBI", kind, flags, stream) + payload


def settings(values=()):
    return frame(SETTINGS, 0, 0, b"".join(struct.pack(">HI", key, value) for key, value in values))


def text(value):
    """A string of a header block (RFC 7541, section 5.2), not compressed."""
    assert len(value) < 127 + 128
    if len(value) < 127:
        return bytes([len(value)]) + value
    return bytes([127, len(value) - 127]) + value


def long_text(size):
    """A string of so many bytes."""
    head, rest = bytearray([127]), size - 127
    while rest >= 128:
        head.append(rest % 128 + 128)
        rest //= 128
    head.append(rest)
    return bytes(head) + b"x" * size


def field(name, value):
    """A header that is not put into the table."""
    return b"\x00" + text(name) + text(value)


def call_headers(path, authority=b"localhost", more=()):
    """The header block of a call of gRPC."""
    fields = [(b":method", b"POST"), (b":scheme", b"http"), (b":path", path), (b":authority", authority),
              (b"te", b"trailers"), (b"content-type", b"application/grpc"), *more]
    return b"".join(field(name, value) for name, value in fields)


def message(payload):
    """A message of gRPC, not compressed."""
    return b"\0" + struct.pack(">I", len(payload)) + payload


class Connection:
    """One to a server; sends what it is told, and by itself nothing but the first words."""

    def __init__(self, address, first=None, tls_ca=None):
        """address: a path, or (host, port).  first: the client's settings."""
        if isinstance(address, tuple):
            self.socket = socket.create_connection(address)
        else:
            self.socket = socket.socket(socket.AF_UNIX)
            self.socket.connect(address)
        if tls_ca is not None:
            context = ssl.create_default_context(cafile=tls_ca)
            context.set_alpn_protocols(["h2"])
            self.socket = context.wrap_socket(self.socket, server_hostname="localhost")
        self.socket.settimeout(30)
        self.socket.sendall(PREFACE + (settings() if first is None else first))

    def send(self, data):
        self.socket.sendall(data)

    def close(self):
        self.socket.close()
