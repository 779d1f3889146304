"""What can go wrong: one class per exit code of affskel-client, so that both are documented once."""
from __future__ import annotations

from typing import ClassVar, Dict, Tuple, Type


class AffskelError(Exception):
    """Any failure of this package.

    Attributes:
        code: stable name, as in `affskel-client --json`.
        exit_code: what affskel-client exits with for the same failure.
        file, line: what it is about, as far as known; otherwise "" and 0.  Lines count from 1.
    """

    code: ClassVar[str] = "INTERNAL"
    exit_code: ClassVar[int] = 70

    def __init__(self, message: str, *, file: str = "", line: int = 0) -> None:
        super().__init__(message)
        self.message = message
        self.file = file
        self.line = line

    def __str__(self) -> str:
        place = self.file
        if self.line:
            place += f":{self.line}" if place else f"line {self.line}"
        return f"{place}: {self.message}" if place else self.message


class JobFailedError(AffskelError):
    """The job failed.

    Attributes:
        job: its id.
        reason: the server's word for the cause: "BAD_INPUT", "LIMIT", "WORKER_LOST", "DAMAGED", "INTERNAL".
    """

    code = "JOB_FAILED"
    exit_code = 1

    def __init__(self, message: str, *, job: str = "", reason: str = "", file: str = "", line: int = 0) -> None:
        super().__init__(message, file=file, line=line)
        self.job = job
        self.reason = reason


class UsageError(AffskelError, ValueError):
    """An argument, a setting or the configuration file is wrong, or a program that is needed is missing."""

    code = "USAGE"
    exit_code = 2


class BadInputError(AffskelError, ValueError):
    """The mesh cannot be used, or not with this spacing."""

    code = "BAD_INPUT"
    exit_code = 3


class NotFoundError(AffskelError, LookupError):
    """No such job or artefact, or the job is not finished yet."""

    code = "NOT_FOUND"
    exit_code = 4


class UnreachableError(AffskelError):
    """The server cannot be reached."""

    code = "UNREACHABLE"
    exit_code = 5


class TimedOutError(UnreachableError, TimeoutError):
    """The time that the caller gave is over.  The job goes on."""


class JobCancelledError(AffskelError):
    """The job was cancelled; `Job.resume` goes on with it."""

    code = "CANCELLED"
    exit_code = 6


class NotAllowedError(AffskelError):
    """The caller may not do this, or not in the job's state."""

    code = "NOT_ALLOWED"
    exit_code = 7


class LimitError(AffskelError):
    """A quota, a size or a full disk."""

    code = "LIMIT"
    exit_code = 8


class InternalError(AffskelError):
    """A bug, here or in the server."""


class BadMeshError(JobFailedError, BadInputError):
    """The job failed because its mesh cannot be used."""

    code = "BAD_INPUT"
    exit_code = 3


class JobTooLargeError(JobFailedError, LimitError):
    """The job failed because it exceeds a limit."""

    code = "LIMIT"
    exit_code = 8


class AffskelWarning(UserWarning):
    """Results that are there, but hardly what was wanted: an empty skeleton, say."""


_KINDS: Tuple[Type[AffskelError], ...] = (JobFailedError, UsageError, BadInputError, NotFoundError, UnreachableError,
                                          JobCancelledError, NotAllowedError, LimitError, InternalError)
BY_CODE = {kind.code: kind for kind in _KINDS}


def job_failed(job: str, reason: str, message: str, file: str, line: int) -> JobFailedError:
    """The error for a job that failed, by the server's word for the cause; `file` and `line` are of its mesh."""
    kinds: Dict[str, Type[JobFailedError]] = {"BAD_INPUT": BadMeshError, "LIMIT": JobTooLargeError}
    if reason != "BAD_INPUT":
        file, line = "", 0
    kind = kinds.get(reason, JobFailedError)
    return kind(f"job {job} failed: {message}", job=job, reason=reason, file=file, line=line)
