"""What the installed affskel-client does for this package: the private server, mesh files other than OFF, pages.

Doing these here again would make a second implementation of each.  Everything else needs no program.
"""
from __future__ import annotations

import json
import logging
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Type

from ._errors import BY_CODE, AffskelError, InternalError, UnreachableError, UsageError
from ._settings import Address, Settings, parse_address

PROGRAM = "affskel-client"
_log = logging.getLogger("affskel")


def find_program() -> Optional[str]:
    """affskel-client in $PATH."""
    return shutil.which(PROGRAM)


def _arguments(settings: Settings) -> List[str]:
    """The global options that stand for these settings."""
    if settings.address is None:
        return []
    arguments = ["--server", settings.address.target]
    for option, value in (("--token-file", settings.token_file), ("--tls-ca", settings.tls_ca),
                          ("--client-cert", settings.client_cert), ("--client-key", settings.client_key)):
        if value:
            arguments += [option, value]
    return arguments


def _error_in(lines: Sequence[str], exit_code: int, settings: Settings) -> AffskelError:
    """The error that affskel-client told on stderr as JSON; of an address, where it was given to this package."""
    for line in reversed(lines):
        try:
            error = json.loads(line)["error"]
            kind = BY_CODE.get(error["code"], InternalError)
            message = error["message"].replace("address from --server", f"address from {settings.origin}")
            return kind(message, file=error.get("file", ""), line=error.get("line", 0))
        except (ValueError, KeyError, TypeError):
            continue
    return InternalError(f"{PROGRAM} ended with code {exit_code}: " + "\n".join(lines[-8:]))


def run_program(settings: Settings, arguments: Sequence[str], why: str,
                otherwise: Type[AffskelError] = UsageError) -> Dict[str, Any]:
    """Runs affskel-client, and returns the JSON document that it prints.

    Args:
        why: what it is needed for, for the message when it is not installed.
        otherwise: the error that this is then.
    """
    program = find_program()
    if program is None:
        raise otherwise(f"{why}; {PROGRAM} is not in $PATH")
    command = [program, "--json", *_arguments(settings), *arguments]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          check=False)
    lines = done.stderr.decode("utf-8", "replace").splitlines()
    if done.returncode != 0:
        raise _error_in(lines, done.returncode, settings)
    for line in lines:
        _log.log(logging.WARNING if line.startswith("warning:") else logging.INFO, "%s", line)
    document = json.loads(done.stdout)
    if not isinstance(document, dict):
        raise InternalError(f"{PROGRAM} printed no JSON object")
    return document


def private_server() -> Address:
    """The address of the caller's private server, which affskel-client starts when none answers."""
    info = run_program(Settings(), ["server-info"],
                       "no server is configured: name one with server=..., or let affskel-client start a private one",
                       UnreachableError)
    if "address" not in info:
        raise UnreachableError(f"{PROGRAM} is older than this package: update it, or name a server with server=...")
    return parse_address(info["address"])


def page(settings: Settings, job: str, options: Sequence[str]) -> str:
    """The page of `affskel-client view`, which needs nothing else."""
    with tempfile.TemporaryDirectory(prefix="affskel-") as directory:
        file = os.path.join(directory, "page.html")
        run_program(settings, ["view", job, "-o", file, *options], "the page is made by affskel-client view")
        return Path(file).read_text(encoding="utf-8")
