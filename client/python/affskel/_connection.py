"""A connection to a server that never keeps its process from ending.

gRPC closes what is left of a channel while the interpreter is taken down, and waits there for its own threads, which
run no more: for ever.  So every channel is closed while they still run: when nobody holds its connection, and at exit.
A forked child has none of these threads: there channels and calls are neither used, closed nor freed.
"""
from __future__ import annotations

import atexit
import ctypes
import os
import sys
import threading
import weakref
from contextlib import contextmanager
from typing import Any, Iterator, Optional, Set

from ._channel import open_channel
from ._errors import LimitError, UnreachableError, UsageError
from ._settings import Settings
from .v1 import client_service_pb2_grpc as rpc


class _Channel:
    """A channel and its calls under way; closed or abandoned once, by the first that asks.

    Garbage is collected in the midst of anything: nothing here takes a lock of ours.
    """

    def __init__(self, channel: Any) -> None:
        self.channel = channel
        self.calls: Set[Any] = set()
        self.is_closed = False

    def _take(self) -> bool:
        try:
            _process.channels.remove(self)
        except KeyError:
            return False
        return True

    def close(self) -> None:
        """Calls under way end as cancelled."""
        if self._take():
            self.is_closed = True
            self.channel.close()

    def abandon(self) -> None:
        """Keeps all from being freed, even by the end of the interpreter: gRPC would wait for threads that are none."""
        if self._take():
            for one in (self.channel, *self.calls):
                ctypes.pythonapi.Py_IncRef(ctypes.py_object(one))


class _Process:
    """What this process has opened, and whether it may open more."""

    def __init__(self) -> None:
        self.channels: Set[_Channel] = set()
        self._was_used = False  # gRPC's threads may be there
        self.is_forked = False  # and are there no more
        self._leaver: Optional[int] = None  # the thread that ends the interpreter
        atexit.register(self._leave)
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._after_fork)

    def check(self) -> None:
        """Raises where a call could never end."""
        if self.is_forked:
            raise UsageError("this process was forked from one that had used affskel, and gRPC does not outlive that: "
                             "start it by multiprocessing's \"spawn\", or use affskel only after the fork")
        # From 3.12 on no thread starts any more, and gRPC needs one for each call.
        is_late = sys.version_info >= (3, 12) and not threading.main_thread().is_alive()
        if is_late or self._leaver not in (None, threading.get_ident()):
            raise UnreachableError("the interpreter is ending: no call is begun any more")
        self._was_used = True

    def _leave(self) -> None:
        """Threads that go on are refused; exit handlers that were registered before this one may still call."""
        self._leaver = threading.get_ident()
        for one in list(self.channels):
            one.close()

    def _after_fork(self) -> None:
        self.is_forked = self.is_forked or self._was_used
        self._leaver = None
        for one in list(self.channels):
            one.abandon()


_process = _Process()


def check_process() -> None:
    """Raises UsageError in a process that was forked from one with connections, UnreachableError at its end.

    To be asked before any lock is taken: in a forked child it may be held by a thread that is not there.
    """
    _process.check()


class Connection:
    """A channel, its stub, and what it was made for.  Closed at the latest with its last reference."""

    def __init__(self, settings: Settings) -> None:
        assert settings.address is not None
        self.settings = settings
        self.target = settings.address.target
        self._held = _Channel(open_channel(settings))
        _process.channels.add(self._held)
        weakref.finalize(self, self._held.close).atexit = False  # _Process does it, when threads are refused
        self.stub: Any = rpc.ErosionServiceStub(self._held.channel)  # type: ignore[no-untyped-call]
        try:
            check_process()  # the end may have begun since
        except UnreachableError:
            self.close()
            raise

    @property
    def is_closed(self) -> bool:
        """By this side."""
        return self._held.is_closed

    @property
    def is_usable(self) -> bool:
        """For further calls."""
        return self._held in _process.channels

    def close(self) -> None:
        """Ends the calls under way."""
        self._held.close()

    @contextmanager
    def call(self, method: str, request: Any, timeout: Optional[float], metadata: Any) -> Iterator[Any]:
        """A call, cancelled when it is left before its end.

        A unary call, too, is run by gRPC's thread and not by the caller's, so that all calls end in one way: left by an
        exception of a signal's handler, closed by another thread, inherited by a forked child.

        Raises:
            UnreachableError: the connection was closed.
            LimitError: the call could have no thread.
        """
        call = self._begin(method, request, timeout, metadata)
        try:
            yield call
        finally:
            self._held.calls.discard(call)
            if not self.is_closed and not _process.is_forked:
                call.cancel()  # nothing when it has ended

    def _begin(self, method: str, request: Any, timeout: Optional[float], metadata: Any) -> Any:
        rpc_method = getattr(self.stub, method)
        begin = getattr(rpc_method, "future", rpc_method)
        try:
            call = begin(request, timeout=timeout, metadata=metadata)
        except BaseException as error:
            if self.is_closed:
                raise UnreachableError(f"the connection to the server at {self.target} was closed") from error
            # The call may have begun and have no thread: closing would wait for its end for ever.
            self._held.abandon()
            if isinstance(error, RuntimeError):
                raise LimitError(f"no thread for a call: {error}") from error
            raise
        self._held.calls.add(call)
        return call
