"""Which server to talk to, and what to show it: arguments, environment, configuration file, in this order.

The rules are those of affskel-client, so that a notebook and a shell of one user meet the same server.
"""
from __future__ import annotations

import ipaddress
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, Mapping, Optional, Tuple, Union

from ._errors import UsageError

PathLike = Union[str, "os.PathLike[str]"]

MAX_SOCKET_PATH = 107  # bytes; sockaddr_un on Linux
_VARIABLES = {
    "token_file": "AFFSKEL_TOKEN_FILE",
    "tls_ca": "AFFSKEL_TLS_CA",
    "client_cert": "AFFSKEL_CLIENT_CERT",
    "client_key": "AFFSKEL_CLIENT_KEY",
}


@dataclass(frozen=True)
class Address:
    """Where a server listens."""

    target: str  # for gRPC: unix:PATH, HOST:PORT or [V6]:PORT
    host: str = ""  # without brackets; empty for a Unix socket

    @property
    def is_unix(self) -> bool:
        return not self.host

    @property
    def is_local(self) -> bool:
        """Whether other machines cannot reach it."""
        if self.is_unix or self.host == "localhost":
            return True
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:  # a name, which may mean any machine
            return False


@dataclass(frozen=True)
class Settings:
    """Which server, and the files for it.  Empty = none."""

    address: Optional[Address] = None  # None = the private server
    origin: str = ""  # where the address was read, for messages
    token_file: str = ""
    tls_ca: str = ""
    client_cert: str = ""
    client_key: str = ""


def path_of(value: object, what: str) -> Path:
    """Raises UsageError for what names no file."""
    if not isinstance(value, (str, os.PathLike)):
        raise UsageError(f"{what} is a path, not {value!r}")
    return Path(value)


def parse_address(text: str) -> Address:
    """Parses `unix:PATH`, `HOST:PORT` or `[V6]:PORT`.  Raises ValueError with a message for people."""

    def refuse(why: str) -> ValueError:
        return ValueError(f"address '{text}': {why}; expected unix:PATH or HOST:PORT")

    if text.startswith("unix:"):
        path = text[len("unix:"):]
        if path.startswith("//"):
            path = path[2:]
        if not path:
            raise refuse("the path is empty")
        if len(os.fsencode(path)) > MAX_SOCKET_PATH:
            raise refuse(f"a socket path has at most {MAX_SOCKET_PATH} bytes")
        return Address(f"unix:{path}")
    if "://" in text:
        raise refuse("that is a URL")
    host, colon, port = text.rpartition(":")
    if not colon:
        raise refuse("no port behind a host and a colon")
    bracketed = len(host) >= 2 and host[0] == "[" and host[-1] == "]"
    if bracketed:
        host = host[1:-1]
    elif ":" in host:
        raise refuse("an IPv6 address needs brackets")
    if not host:
        raise refuse("no host")
    if not (port.isascii() and port.isdigit() and int(port) <= 65535):
        raise refuse("the port must be 0 .. 65535")
    return Address(f"[{host}]:{int(port)}" if ":" in host else f"{host}:{int(port)}", host)


def config_file(environment: Mapping[str, str]) -> Path:
    """$XDG_CONFIG_HOME/affskel/config or ~/.config/affskel/config."""
    base = environment.get("XDG_CONFIG_HOME", "")
    return (Path(base) if os.path.isabs(base) else Path.home() / ".config") / "affskel" / "config"


def read_config(file: Path) -> Dict[str, Tuple[str, int]]:
    """The `KEY = VALUE` lines of a configuration, each with its line; relative files from its directory.

    A missing file is an empty one.  Raises UsageError with file and line for anything else.
    """
    try:
        text = file.read_text(encoding="utf-8", errors="surrogateescape")
    except (FileNotFoundError, NotADirectoryError):
        return {}
    except OSError as error:
        raise UsageError(f"cannot read the configuration: {error.strerror}", file=str(file)) from error
    known = ["server", *_VARIABLES]
    found: Dict[str, Tuple[str, int]] = {}
    for number, line in enumerate(text.split("\n"), start=1):
        line = line.strip(" \t\r")
        if not line or line.startswith("#"):
            continue
        key, equals, value = (part.strip(" \t\r") for part in line.partition("="))
        if not equals:
            raise UsageError(f"expected 'KEY = VALUE', found '{line}'", file=str(file), line=number)
        if key not in known:
            raise UsageError(f"unknown key '{key}'; the keys are {', '.join(known)}", file=str(file), line=number)
        if not value:
            wanted = "address" if key == "server" else "file"
            raise UsageError(f"no {wanted} after '='", file=str(file), line=number)
        found[key] = (value if key == "server" else str(file.parent / value), number)
    return found


def _address(text: str, origin: str, file: str = "", line: int = 0) -> Address:
    try:
        return parse_address(text)
    except ValueError as error:
        raise UsageError(str(error) if file else f"{origin}: {error}", file=file, line=line) from None


def choose(server: Optional[str], files: Mapping[str, Optional[PathLike]],
           environment: Optional[Mapping[str, str]] = None) -> Settings:
    """The settings that hold.

    Args:
        server: address; None or "" = $AFFSKEL_SERVER, else the configuration's, else the private server.
        files: `token_file`, `tls_ca`, `client_cert`, `client_key`; each likewise.  Those of the configuration
            go with its server only, lest a token be shown to another; the private server is shown none.
        environment: for tests; default the process's own.  A variable that is set but empty is not set.
    """
    environment = os.environ if environment is None else environment
    configured: Dict[str, Tuple[str, int]] = {}
    if server is not None and not isinstance(server, str):
        raise UsageError(f"server is unix:PATH or HOST:PORT, not {server!r}")
    if server:
        chosen = Settings(_address(server, "server"), "the argument server")
    elif environment.get("AFFSKEL_SERVER"):
        chosen = Settings(_address(environment["AFFSKEL_SERVER"], "$AFFSKEL_SERVER"), "$AFFSKEL_SERVER")
    else:
        file = config_file(environment)
        configured = read_config(file)
        if "server" not in configured:
            return Settings(origin="the private server")
        text, line = configured["server"]
        chosen = Settings(_address(text, str(file), str(file), line), str(file))
    said = {key: os.fspath(files.get(key) or "") or environment.get(variable, "") or configured.get(key, ("", 0))[0]
            for key, variable in _VARIABLES.items()}
    return replace(chosen, **said)
