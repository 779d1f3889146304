"""The calls, tried again when a server that was there goes away.

A server that was never reached is an error at once.  One that answered may go away and come back, or have too much
to do: calls that change nothing twice (all of them) are then repeated with growing pauses, and the private server is
started again.
"""
from __future__ import annotations

import hashlib
import logging
import threading
import time
from contextlib import ExitStack
from dataclasses import replace
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple, Type, TypeVar

import grpc

from ._channel import Token, token_of
from ._checks import number_of
from ._connection import Connection, check_process
from ._errors import (AffskelError, InternalError, LimitError, NotAllowedError, NotFoundError, TimedOutError,
                      UnreachableError, UsageError)
from ._programs import private_server
from ._settings import Settings
from .v1 import client_service_pb2 as service
from .v1 import types_pb2 as types

CHUNK_BYTES = 1 << 20  # largest piece of data in a message
UNARY_DEADLINE = 30.0  # seconds
LONGEST_TIMEOUT = 1e9  # seconds; longer ones are none
START_PATIENCE = 10.0  # for the first answer of a private server
FIRST_PAUSE, LONGEST_PAUSE = 0.1, 2.0
MAX_LISTED = 1000  # jobs in one answer
FINAL_STATES = (types.JOB_STATE_DONE, types.JOB_STATE_FAILED, types.JOB_STATE_CANCELLED)

Result = TypeVar("Result")
_log = logging.getLogger("affskel")
_Code = grpc.StatusCode
_ERRORS: Dict[Any, Type[AffskelError]] = {
    _Code.INVALID_ARGUMENT: UsageError,
    _Code.ALREADY_EXISTS: UsageError,
    _Code.OUT_OF_RANGE: UsageError,
    _Code.NOT_FOUND: NotFoundError,
    _Code.DATA_LOSS: NotFoundError,  # what was stored is damaged: there is nothing to be had
    _Code.UNAVAILABLE: UnreachableError,
    _Code.CANCELLED: UnreachableError,
    _Code.DEADLINE_EXCEEDED: TimedOutError,
    _Code.ABORTED: UnreachableError,
    _Code.PERMISSION_DENIED: NotAllowedError,
    _Code.UNAUTHENTICATED: NotAllowedError,
    _Code.RESOURCE_EXHAUSTED: LimitError,
}


def _is_away(error: Any) -> bool:
    """Whether the server is away or closing: it then cancels the calls that it no longer answers."""
    return error.code() in (_Code.UNAVAILABLE, _Code.CANCELLED)


def _has_answered(error: Any) -> bool:
    """Whether UNAVAILABLE was the server's own answer: gRPC's core then says so, and tells it by nothing else.

    To ask for the state of the channel takes a thread that polls it, beyond the end of the interpreter.
    """
    return "received from peer" in (error.debug_error_string() or "")


class Session:
    """Thread-safe.  All calls raise AffskelError."""

    def __init__(self, settings: Settings, patience: float) -> None:
        """patience: seconds without any success after which a server that went away is given up."""
        self._settings = settings
        self._patience = patience
        self._token: Optional[Token] = token_of(settings)
        self._lock = threading.Lock()
        self._connection: Optional[Connection] = None
        self._proven = False  # the server answered at least once

    def __reduce__(self) -> Tuple[Any, ...]:
        """Another process gets a connection of its own to the server in use."""
        return Session, (self.reached(), self._patience)

    @property
    def embedded(self) -> bool:
        return self._settings.address is None

    def reached(self) -> Settings:
        """The settings with the address in use; that of the private server once it is known."""
        return self._connect().settings

    def address(self) -> str:
        """Of the server in use, as `server=` takes it."""
        return self._connect().target

    def close(self) -> None:
        try:
            check_process()
        except AffskelError:  # forked: there is nothing to close
            return
        with self._lock:
            connection, self._connection = self._connection, None
        if connection is not None:
            connection.close()

    def _connect(self) -> Connection:
        check_process()
        with self._lock:
            if self._connection is None or not self._connection.is_usable:
                settings = self._settings
                if settings.address is None:
                    settings = replace(settings, address=private_server())
                self._connection = Connection(settings)
            return self._connection

    def _forget(self, connection: Connection) -> None:
        """Not closed: other threads may be using it."""
        with self._lock:
            if self._connection is connection:
                self._connection = None

    def _metadata(self) -> Tuple[Tuple[str, str], ...]:
        return (("authorization", "Bearer " + self._token.text()),) if self._token else ()

    def _error(self, error: Any, connection: Connection, not_yet: Type[AffskelError]) -> AffskelError:
        code, detail, target = error.code(), error.details() or "", connection.target
        if connection.is_closed:
            return UnreachableError(f"the connection to the server at {target} was closed while a call was under way")
        kind = not_yet if code == _Code.FAILED_PRECONDITION else _ERRORS.get(code, InternalError)
        if _is_away(error):
            where = "" if self.embedded else f" (address from {self._settings.origin})"
            address = self._settings.address
            if "Socket closed" in detail and address is not None and not address.is_unix and not self._settings.tls_ca:
                detail = "it closed the connection; if it speaks TLS, name who signed its certificate: tls_ca"
            return kind(f"cannot reach the server at {target}: {detail}{where}")
        if code == _Code.DEADLINE_EXCEEDED:
            return kind(f"the server at {target} did not answer in time")
        if code == _Code.UNIMPLEMENTED:
            return kind(f"the server at {target} does not offer this call (an older version?): {detail}")
        return kind(detail or f"the server answered with status {code.name}")

    def _run(self, attempt: Callable[[Connection], Result], not_yet: Type[AffskelError] = NotAllowedError,
             deadline: Optional[float] = None) -> Result:
        """Runs `attempt` until it succeeds or fails for good.

        Args:
            not_yet: the error when the job's state does not allow the call.
            deadline: of the clock `time.monotonic`.
        """
        tries = _Tries(self, not_yet, deadline)
        while True:
            connection = self._connect()
            try:
                result = attempt(connection)
            except grpc.RpcError as error:
                if tries.are_over(error, connection):
                    raise tries.take_error() from error
            else:
                self._proven = True
                return result

    def _unary(self, name: str, request: Any, timeout: Optional[float] = None) -> Any:
        """timeout: seconds for all tries; None = the patience."""
        deadline = _deadline(timeout)

        def call(at: Connection) -> Any:
            left = _left(deadline)
            longest = UNARY_DEADLINE if left is None else min(left, UNARY_DEADLINE)
            with at.call(name, request, longest, self._metadata()) as answer:
                return answer.result()

        return self._run(call, deadline=deadline)

    def submit(self, header: service.SubmitJobHeader, mesh: bytes) -> service.SubmitJobResponse:
        def messages() -> Iterator[service.SubmitJobRequest]:
            yield service.SubmitJobRequest(header=header)
            for begin in range(0, len(mesh), CHUNK_BYTES):
                yield service.SubmitJobRequest(data=mesh[begin:begin + CHUNK_BYTES])

        def call(at: Connection) -> service.SubmitJobResponse:
            timeout = 120 + len(mesh) / CHUNK_BYTES  # 1 MiB/s at least
            with at.call("SubmitJob", messages(), timeout, self._metadata()) as answer:
                response: service.SubmitJobResponse = answer.result()
            return response

        return self._run(call)

    def get_job(self, job: str, timeout: Optional[float] = None) -> types.Job:
        answer: types.Job = self._unary("GetJob", service.GetJobRequest(job=job), timeout)
        return answer

    def list_jobs(self, request: service.ListJobsRequest, limit: int) -> List[types.Job]:
        """The newest `limit` jobs that the request is about, from as many answers as needed."""
        jobs: List[types.Job] = []
        while len(jobs) < limit:
            request.limit = min(limit - len(jobs), MAX_LISTED)
            answer = self._unary("ListJobs", request)
            jobs.extend(answer.jobs)
            if not answer.next_page_token:
                break
            request.page_token = answer.next_page_token
        return jobs

    def cancel(self, job: str) -> types.Job:
        answer: types.Job = self._unary("CancelJob", service.CancelJobRequest(job=job))
        return answer

    def resume(self, job: str) -> types.Job:
        answer: types.Job = self._unary("ResumeJob", service.ResumeJobRequest(job=job))
        return answer

    def delete(self, job: str) -> None:
        self._unary("DeleteJob", service.DeleteJobRequest(job=job))

    def events(self, job: str) -> List[service.JobEvent]:
        answer = self._unary("ListJobEvents", service.ListJobEventsRequest(job=job))
        return list(answer.events)

    def server_info(self) -> service.ServerInfo:
        answer: service.ServerInfo = self._unary("GetServerInfo", service.GetServerInfoRequest())
        return answer

    def watch(self, job: str, timeout: Optional[float] = None) -> Iterator[types.Job]:
        """Every state of the job until a final one; attaches again when the stream breaks.

        Args:
            timeout: seconds for the whole, after which TimedOutError is raised; None = as long as it takes.
        """
        deadline = _deadline(timeout)
        if timeout is not None and timeout <= 0:  # no time for a stream, but a job at its end is
            now = self.get_job(job)
            yield now
            if now.state in FINAL_STATES:
                return
            raise TimedOutError("the job is not at its end; it goes on")

        while True:
            watch = self._run(lambda at: _Watch(at, service.WatchJobRequest(job=job), _left(deadline),
                                                self._metadata()), deadline=deadline)
            with watch:
                try:
                    for now in watch:
                        job = now.id  # "@last" may mean another job by now
                        yield now
                        if now.state in FINAL_STATES:
                            return
                except grpc.RpcError as error:
                    if timeout is not None and error.code() == _Code.DEADLINE_EXCEEDED:
                        raise TimedOutError(f"the job was not at its end after {timeout:g} s; it goes on") from None
                    if watch.connection.is_closed or not _is_away(error):
                        raise self._error(error, watch.connection, NotAllowedError) from error.with_traceback(None)
            _log.info("the server went away; trying to reach it again")
            self._forget(watch.connection)
            time.sleep(FIRST_PAUSE)

    def fetch(self, request: service.FetchArtifactRequest,
              timeout: Optional[float] = None) -> Tuple[service.ArtifactHeader, bytes]:
        """One artefact, its size and SHA-256 checked.

        Args:
            timeout: seconds, also for a worker to compute it first; None = as long as it takes.
        """
        deadline = _deadline(timeout)

        def call(at: Connection) -> Tuple[service.ArtifactHeader, bytes]:
            with at.call("FetchArtifact", request, _left(deadline), self._metadata()) as answers:
                return _received(answers)

        return self._run(call, NotFoundError, deadline)


class _Watch:
    """The states of a job, as one stream tells them.  To be left by its context, whose end cancels the stream."""

    def __init__(self, connection: Connection, request: service.WatchJobRequest, timeout: Optional[float],
                 metadata: Any) -> None:
        self.connection = connection
        with ExitStack() as stack:
            self._call = stack.enter_context(connection.call("WatchJob", request, timeout, metadata))
            first: Optional[types.Job] = next(self._call, None)  # with it the server is known to answer
            if first is None:
                raise InternalError("the server ended the watch without a state")
            self._first: types.Job = first
            self._stack = stack.pop_all()

    def __enter__(self) -> "_Watch":
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def __iter__(self) -> Iterator[types.Job]:
        yield self._first
        while True:
            check_process()  # the caller may have forked since the last state: no other would ever come
            now: Optional[types.Job] = next(self._call, None)
            if now is None:
                return
            yield now


class _Tries:
    """What one call has gone through so far."""

    def __init__(self, session: Session, not_yet: Type[AffskelError], deadline: Optional[float]) -> None:
        self._session = session
        self._not_yet = not_yet
        self._deadline = deadline
        self._pause = FIRST_PAUSE
        self._error: Optional[AffskelError] = None
        self._failing: Optional[float] = None  # since the first error: a call itself may take long

    def are_over(self, error: Any, connection: Connection) -> bool:
        """Waits for the next try; or there is none, and `take_error` tells what the error means."""
        session = self._session
        self._error = session._error(error, connection, self._not_yet)
        # Its traceback leads back to itself: it would hold the connection until garbage is collected.
        error.with_traceback(None)
        if connection.is_closed or not _is_away(error):
            return True
        if _has_answered(error):
            session._proven = True
        # An idle private server may leave at this very moment: another is started.
        if not session._proven and not session.embedded:
            return True
        session._forget(connection)
        return self._is_given_up()

    def take_error(self) -> AffskelError:
        """To be raised at once: kept in a variable it would be in its own traceback."""
        error, self._error = self._error, None
        assert error is not None
        return error

    def _is_given_up(self) -> bool:
        now = time.monotonic()
        if self._failing is None:
            self._failing = now
            _log.info("trying again: %s", self._error)
        patience = self._session._patience if self._session._proven else START_PATIENCE
        if now >= self._failing + patience:
            return True
        left = _left(self._deadline)
        time.sleep(self._pause if left is None else min(self._pause, left))
        self._pause = min(2 * self._pause, LONGEST_PAUSE)
        return False


def _deadline(timeout: Optional[float]) -> Optional[float]:
    """Of the clock `time.monotonic`.  gRPC takes a time beyond its own clock for one that is over."""
    if timeout is None or number_of(timeout, "the timeout", " of seconds") > LONGEST_TIMEOUT:
        return None
    if timeout != timeout:
        raise UsageError("the timeout is not a number")
    return time.monotonic() + timeout


def _left(deadline: Optional[float]) -> Optional[float]:
    """Seconds until the deadline."""
    if deadline is None:
        return None
    left = deadline - time.monotonic()
    if left <= 0:
        raise TimedOutError("the time is over; the job goes on")
    return left


def _received(call: Any) -> Tuple[service.ArtifactHeader, bytes]:
    """All of a stream of FetchArtifactResponse."""
    header: Optional[service.ArtifactHeader] = None
    pieces: List[bytes] = []
    received = 0
    digest = hashlib.sha256()
    for answer in call:
        if answer.HasField("header") != (header is None):
            raise InternalError("the server sent the parts of the artefact out of order")
        if header is None:
            header = answer.header
            continue
        received += len(answer.data)
        if received > header.bytes:
            raise InternalError(f"the artefact has more than its {header.bytes} bytes")
        digest.update(answer.data)
        pieces.append(answer.data)
    if header is None:
        raise InternalError("the server sent no artefact")
    if received != header.bytes:
        raise InternalError(f"the artefact was cut short: {received} of {header.bytes} bytes arrived")
    if digest.hexdigest() != header.sha256:
        raise InternalError("the artefact was damaged on its way: its SHA-256 is another")
    return header, b"".join(pieces)
