"""A gRPC channel as affskel-client makes one, and the token that its calls carry."""
from __future__ import annotations

import os
import ssl
import threading
from pathlib import Path
from typing import Any, List, Optional, Tuple

import grpc

from ._errors import UsageError
from ._settings import Settings

MAX_MESSAGE_BYTES = 64 << 20  # long lists of jobs; pieces of streams are far smaller
MAX_FILE_BYTES = 1 << 20  # far above any certificate chain and any token
KEEPALIVE_MS = 330 * 1000  # servers refuse pings more often than every five minutes


def _read(path: str, what: str) -> bytes:
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise UsageError(f"cannot read the {what}: {error.strerror}", file=path) from error
    if len(data) > MAX_FILE_BYTES:
        raise UsageError(f"too large for a {what}", file=path)
    return data


def _read_pem(path: str, what: str) -> bytes:
    data = _read(path, what)
    if b"-----BEGIN " not in data:
        raise UsageError(f"no {what} in PEM form", file=path)
    return data


def _read_certificate(path: str) -> bytes:
    data = _read_pem(path, "certificate")
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT).load_verify_locations(cadata=data.decode("ascii", "ignore"))
    except ssl.SSLError as error:
        raise UsageError("holds no certificate that can be read", file=path) from error
    return data


def _read_token(path: str) -> str:
    """The first line.  Metadata of gRPC are printable ASCII; the message quotes nothing of it."""
    line = _read(path, "token").replace(b"\r", b"\n").partition(b"\n")[0]
    if not line or not all(0x20 < byte < 0x7F for byte in line):
        raise UsageError("its first line is no token", file=path)
    return line.decode("ascii")


class Token:
    """The token of a file, as the file is now; one that is gone or broken leaves the token that was there."""

    def __init__(self, path: str) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._text = _read_token(path)
        self._seen = self._look()

    def _look(self) -> Optional[Tuple[int, int]]:
        try:
            status = os.stat(self._path)
        except OSError:
            return None
        return status.st_ino, status.st_mtime_ns

    def text(self) -> str:
        with self._lock:
            now = self._look()
            if now != self._seen:
                self._seen = now
                try:
                    self._text = _read_token(self._path)
                except UsageError:
                    pass
            return self._text


def token_of(settings: Settings) -> Optional[Token]:
    """Raises UsageError when the token would leave this machine in the clear."""
    if not settings.token_file or settings.address is None:
        return None
    if not settings.tls_ca and not settings.address.is_local:
        raise UsageError(f"the token of {settings.token_file} would go to {settings.address.target} in the clear: "
                         "say by tls_ca how its server is known")
    return Token(settings.token_file)


def _credentials(settings: Settings) -> Any:
    """None without TLS.  The files of TLS are for TCP."""
    if bool(settings.client_cert) != bool(settings.client_key):
        raise UsageError("a certificate and its key go together: this one is alone",
                         file=settings.client_cert or settings.client_key)
    if settings.address is None or settings.address.is_unix or not settings.tls_ca:
        return None
    chain = _read_certificate(settings.client_cert) if settings.client_cert else None
    key = _read_pem(settings.client_key, "key") if settings.client_key else None
    return grpc.ssl_channel_credentials(_read_certificate(settings.tls_ca), key, chain)


def open_channel(settings: Settings) -> Any:
    """A channel to `settings.address`, which must be set."""
    address = settings.address
    assert address is not None
    options: List[Tuple[str, int]] = [
        ("grpc.max_receive_message_length", MAX_MESSAGE_BYTES),
        # A fresh channel must not inherit the connection back-off of the one that it replaces.
        ("grpc.use_local_subchannel_pool", 1),
    ]
    if address.is_local:
        options.append(("grpc.enable_http_proxy", 0))
    if not address.is_unix:
        options += [("grpc.keepalive_time_ms", KEEPALIVE_MS), ("grpc.keepalive_timeout_ms", 20000)]
    credentials = _credentials(settings)
    if credentials is None:
        return grpc.insecure_channel(address.target, options)
    return grpc.secure_channel(address.target, credentials, options)
