"""Affine skeletons of closed triangle meshes: submit a mesh, get arrays.

    import affskel
    job = affskel.submit("body.off", spacing=200).wait()
    field = job.field()                        # points, E, normals, slope, direction: NumPy arrays
    sheet = job.skeleton()                     # vertices, faces, segments of curves, attributes; .plot(), .save("s.vtp")
    solid = job.eroded(fraction=.05)           # the solid where E is at least 5 % of the volume
    limbs = job.measures()                     # lengths, volumes, radii of its parts; .table(), .graph(), .thickness
    job.view()                                 # in a notebook: the body and its skeleton to turn

The functions of this module use one client, made by the first call with the server that affskel-client would take; a
`Client` of one's own names another.  All errors are AffskelError.  The messages of the service itself are in
`affskel.v1`.  The package computes nothing: all geometry is in the service's workers.
"""
from __future__ import annotations

import os
import threading
from importlib.metadata import PackageNotFoundError, version
from typing import Any, Callable, Dict, List, Optional, TypeVar, Union

from ._arrays import Field, Lattice, Points, Surface
from ._client import Client
from ._errors import (AffskelError, AffskelWarning, BadInputError, BadMeshError, InternalError, JobCancelledError,
                      JobFailedError, JobTooLargeError, LimitError, NotAllowedError, NotFoundError, TimedOutError,
                      UnreachableError, UsageError)
from ._job import Job
from ._measures import Measures
from ._meshes import MeshLike
from ._status import Note, Status
from ._view import View

__all__ = [
    "AffskelError", "AffskelWarning", "BadInputError", "BadMeshError", "Client", "Field", "InternalError", "Job",
    "JobCancelledError", "JobFailedError", "JobTooLargeError", "Lattice", "LimitError", "Measures", "NotAllowedError",
    "NotFoundError", "Note", "Points", "Status", "Surface", "TimedOutError", "UnreachableError", "UsageError", "View",
    "job", "jobs", "server_info", "submit",
]

try:
    __version__ = version("affskel")
except PackageNotFoundError:  # not installed
    __version__ = "unknown"

_Function = TypeVar("_Function", bound=Callable[..., Any])
_lock = threading.Lock()
_client: Optional[Client] = None


def _renew_lock() -> None:
    """A thread that is not in the child may have held it."""
    global _lock
    _lock = threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_renew_lock)


def _default_client() -> Client:
    global _client
    with _lock:
        if _client is None:
            _client = Client()
        return _client


def _as_in_client(method: Callable[..., Any]) -> Callable[[_Function], _Function]:
    """The function's documentation is the method's."""
    def document(function: _Function) -> _Function:
        function.__doc__ = method.__doc__
        return function
    return document


def __dir__() -> List[str]:
    return sorted([*__all__, "__doc__", "__version__"])


@_as_in_client(Client.submit)
def submit(mesh: MeshLike, *, spacing: Union[float, str, None] = None, points: Optional[int] = None,
           directions: str = "triangles", minimum: str = "set", frame: str = "axis",
           operator: str = "ridge", threshold: Optional[float] = None, name: Optional[str] = None, priority: int = 5, request_id: str = "",
           repair: str = "auto", isovalue: Optional[float] = None) -> Job:
    return _default_client().submit(mesh, spacing=spacing, points=points, directions=directions,
                                    minimum=minimum, frame=frame, operator=operator, threshold=threshold, name=name, priority=priority,
                                    request_id=request_id, repair=repair, isovalue=isovalue)


@_as_in_client(Client.job)
def job(job: str) -> Job:
    return _default_client().job(job)


@_as_in_client(Client.jobs)
def jobs(*, state: Optional[str] = None, owner: Optional[str] = None, limit: int = 50) -> List[Job]:
    return _default_client().jobs(state=state, owner=owner, limit=limit)


@_as_in_client(Client.server_info)
def server_info() -> Dict[str, Any]:
    return _default_client().server_info()
