"""A job and its results."""
from __future__ import annotations

import numbers
import os
import warnings
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Union

import numpy as np

from ._arrays import (Field, Floats, Lattice, Points, Surface, directions_of, field_of, lattice_of, points_of,
                      refined_of, surface_of)
from ._checks import number_of, share_of
from ._errors import AffskelWarning, InternalError, JobCancelledError, UsageError, job_failed
from ._measures import Measures, measures_of
from ._messages import plain, value_of_word
from ._programs import page, run_program
from ._progress import ProgressBar
from ._saving import Result, with_origin
from ._session import Session
from ._settings import path_of
from ._status import Status, status_of
from ._view import View
from .v1 import client_service_pb2 as service
from .v1 import types_pb2 as types


def skeleton_params(operator: Optional[str], threshold: Optional[float]) -> types.SkeletonParams:
    """None = the server's default operator, the operator's default threshold."""
    params = types.SkeletonParams()
    if operator is not None:
        params.operator = value_of_word(types.Operator, operator, "operator")
    if threshold is not None:
        value = number_of(threshold, "threshold")
        if not 0 < value < float("inf"):
            raise UsageError(f"the threshold {threshold} is not above 0")
        params.threshold = value
    return params


def _skeleton_options(operator: Optional[str], threshold: Optional[float]) -> List[str]:
    """As affskel-client takes them."""
    options = [] if operator is None else ["--operator", operator]
    return options if threshold is None else [*options, "--threshold", repr(float(threshold))]


def _fraction(value: Union[float, str, None]) -> Optional[float]:
    if not isinstance(value, str):
        return value
    share = share_of(value)
    if share is None:
        raise UsageError(f"fraction is a number, or a share such as '5%', not {value!r}")
    return share


def _level_options(fraction: Optional[float], volume: Optional[float]) -> List[str]:
    return ["--volume", repr(volume)] if fraction is None else ["--fraction", repr(fraction)]


# What `Job.save` writes: by `fetch`, and by a command of its own.
_FETCHED = ("field", "divergence", "skeleton", "surface", "curve", "thickness", "eroded", "mesh", "source")
_DRAWN = {"picture": "render", "view": "view"}


def _argument(value: str) -> str:
    """A setting's value as Python writes it."""
    try:
        float(value)
    except ValueError:
        return repr(value)
    return value


class Job:
    """A job on a server.  It holds nothing of the results: each call fetches what it returns.  Pickled for another
    process, it is the same job there, by a connection of its own.

    Results that are not stored yet are computed by a worker first, from the finished field.  Calls for results raise
    NotFoundError before the job is done, and all calls raise AffskelError when the server says no.

    Attributes:
        id: 32 hexadecimal digits.
        existed: of a job just submitted, whether the same was submitted before, so that this is that job.
        seen: the last status that this object has met; None = none yet.
    """

    def __init__(self, session: Session, job: str, existed: bool = False, file: str = "",
                 seen: Optional[Status] = None) -> None:
        self._session = session
        self._file = file  # that its mesh comes from, for messages
        self.id = job
        self.existed = existed
        self.seen = seen

    def __repr__(self) -> str:
        if self.seen is None:
            return f"<affskel.Job {self.id[:12]}>"
        state = self.seen.state if self.seen.state != "running" else f"running, {self.seen.share_done:.0%}"
        return f"<affskel.Job {self.id[:12]} {self.seen.name!r}, {state}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Job) and self.id == other.id

    def __hash__(self) -> int:
        return hash(self.id)

    # ---- Its life.

    def status(self) -> Status:
        """The job as it is now: state, progress, time left, report and warnings."""
        return self._see(self._session.get_job(self.id))

    def progress(self, *, timeout: Optional[float] = None) -> Iterator[Status]:
        """Its status now and after every change, until a final one; goes on across restarts of the server.

        Args:
            timeout: seconds for the whole; then TimedOutError.
        """
        for job in self._session.watch(self.id, timeout):
            yield self._see(job)

    def wait(self, *, timeout: Optional[float] = None, progress: Optional[bool] = None) -> "Job":
        """Follows the job to its end.

        Args:
            timeout: seconds; None = as long as it takes.
            progress: whether to show a bar, if tqdm is there; None = at a terminal and in a notebook.

        Returns:
            The job itself, done.

        Raises:
            JobFailedError: with the reason; BadMeshError when it is the mesh.
            JobCancelledError: somebody cancelled it.
            TimedOutError: the time is over, and the job goes on.
        """
        last: Optional[types.Job] = None
        with ProgressBar(progress) as bar:
            for last in self._session.watch(self.id, timeout):
                bar.show(self._see(last))
        if last is None:
            raise InternalError("the server told no state of the job")
        if last.state == types.JOB_STATE_FAILED:
            raise job_failed(last.id, last.error.code, last.error.message, self._file, last.error.line)
        if last.state == types.JOB_STATE_CANCELLED:
            raise JobCancelledError(f"job {last.id} was cancelled; go on with it by resume()")
        return self

    def cancel(self) -> Status:
        """Stops it, its progress kept; workers stop at their next report."""
        return self._see(self._session.cancel(self.id))

    def resume(self) -> Status:
        """Goes on with a job that was cancelled or failed; computes results anew that retention has removed."""
        return self._see(self._session.resume(self.id))

    def delete(self) -> None:
        """Removes a job that is done, failed or cancelled, with all that belongs to it."""
        self._session.delete(self.id)

    def events(self) -> List[Dict[str, Any]]:
        """What happened to it, oldest first: a row each, as `affskel-client --json log` prints them."""
        return [plain(event) for event in self._session.events(self.id)]

    # ---- Its results.

    def field(self, *, timeout: Optional[float] = None) -> Field:
        """E at the sample points.

        Args:
            timeout: seconds for each of its parts, as everywhere below: the call may wait for a worker.
        """
        job = self._session.get_job(self.id)
        if job.params.minimum == types.MINIMUM_INFIMUM:
            data = self._bytes(service.ARTIFACT_KIND_REFINED, timeout)
            refined = refined_of(self.lattice(timeout=timeout), data, job.prepared.volume)
            return self._saveable(refined, "fetch", self.id, "field")
        data = self._bytes(service.ARTIFACT_KIND_FIELD, timeout)
        field = field_of(self.lattice(timeout=timeout), self.directions(timeout=timeout), data, job.prepared.volume)
        return self._saveable(field, "fetch", self.id, "field")

    def lattice(self, *, timeout: Optional[float] = None) -> Lattice:
        """The sample points alone; there as soon as the mesh is prepared."""
        return lattice_of(types.Lattice.FromString(self._bytes(service.ARTIFACT_KIND_LATTICE, timeout)))

    def directions(self, *, timeout: Optional[float] = None) -> Floats:
        """(K, 3) the direction set; there as soon as the mesh is prepared."""
        return directions_of(types.Directions.FromString(self._bytes(service.ARTIFACT_KIND_DIRECTIONS, timeout)))

    def skeleton(self, operator: Optional[str] = None, threshold: Optional[float] = None, *,
                 alpha: Optional[float] = None, barrier: bool = False, min_barrier: Optional[float] = None,
                 timeout: Optional[float] = None) -> Surface:
        """The skeleton as a triangulated surface, with the curves of "ridge"; the lines of "curve".

        Args:
            operator: "ridge", "curve", "chords", "zucker-hummel", "sobel", "central", "intermediate" or "flux"; None =
                the job's.
            threshold: in the operator's unit; None = the operator's default, without an operator the job's.
            alpha: squared radius of the alpha shape through the points, mesh units squared; None = by the spacing.
                Not for "ridge", "chords" and "curve", which have triangles or lines themselves.
            barrier: for "chords" and "ridge", the attribute "barrier": by what share of E the chord grows on the way
                from one side's direction to the other's; 0: the normals only turn fast, large: they jump.
            min_barrier: leave out triangles with a vertex of a lower barrier; implies `barrier`.
        """
        request = service.FetchArtifactRequest(job=self.id, kind=service.ARTIFACT_KIND_SURFACE)
        chosen = self._chosen(operator, threshold)
        if chosen is not None:
            request.surface.skeleton.CopyFrom(chosen)
        if not isinstance(barrier, (bool, np.bool_)):
            raise UsageError(f"barrier is True or False, not {barrier!r}")
        request.surface.alpha = 0.0 if alpha is None else number_of(alpha, "alpha")
        request.surface.barrier = bool(barrier) or min_barrier is not None
        request.surface.min_barrier = 0.0 if min_barrier is None else number_of(min_barrier, "min_barrier")
        message = types.TriangleMesh.FromString(self._fetched(request, timeout))
        surface = surface_of(message)
        self._warn_of_skeleton("surface of the skeleton", len(surface.vertices), message.quality)
        options = _skeleton_options(operator, threshold)
        for option, value in (("--alpha", alpha), ("--min-barrier", min_barrier)):
            options += [] if value is None else [option, repr(float(value))]
        if len(surface.faces) == 0 and "beyond" in surface.attributes:  # lines, in every format that holds a curve
            return self._saveable(surface, "fetch", self.id, "curve", *_skeleton_options(None, threshold))
        return self._saveable(surface, "skeleton", self.id, *options, *(["--barrier"] if barrier else []))

    def skeleton_points(self, operator: Optional[str] = None, threshold: Optional[float] = None, *,
                        timeout: Optional[float] = None) -> Points:
        """The points of a published operator, with E, normals and H, or of a sheet or curve those that Points tells;
        arguments as for `skeleton`."""
        request = service.FetchArtifactRequest(job=self.id, kind=service.ARTIFACT_KIND_SKELETON)
        chosen = self._chosen(operator, threshold)
        if chosen is not None:
            request.skeleton.CopyFrom(chosen)
        message = types.SkeletonPoints.FromString(self._fetched(request, timeout))
        points = points_of(message)
        self._warn_of_skeleton("skeleton", len(points), message.quality)
        return self._saveable(points, "skeleton", self.id, "--as", "points", *_skeleton_options(operator, threshold))

    def divergence(self, operator: Optional[str] = None, *, timeout: Optional[float] = None) -> Floats:
        """(R,) the operator's H at every sample point, of which the threshold keeps some.

        Args:
            operator: one of the published ones; None = the job's, or "zucker-hummel" where the job's gives a sheet.
        """
        request = service.FetchArtifactRequest(job=self.id, kind=service.ARTIFACT_KIND_DIVERGENCE)
        chosen = self._chosen(operator, None)
        if chosen is not None:
            request.skeleton.CopyFrom(chosen)
        return np.frombuffer(self._fetched(request, timeout), "<f8").astype(np.float64)

    def eroded(self, fraction: Union[float, str, None] = None, volume: Optional[float] = None, *,
               timeout: Optional[float] = None) -> Surface:
        """The closed surface of the eroded solid, the places where E is at least a level.

        Args:
            fraction: the level as a share of v0, between 0 and 1, or "5%".
            volume: the level itself, mesh units cubed, below v0.  One of the two is needed.
        """
        level = _fraction(fraction)
        request = self._eroded_request(service.ARTIFACT_KIND_ERODED_SURFACE, level, volume)
        message = types.TriangleMesh.FromString(self._fetched(request, timeout))
        self._warn_if_empty("eroded solid", len(message.corners), message.quality)
        surface = surface_of(message, ("E", "area"))
        return self._saveable(surface, "erode", self.id, "--as", "surface", *_level_options(level, volume))

    def eroded_points(self, fraction: Union[float, str, None] = None, volume: Optional[float] = None, *,
                      timeout: Optional[float] = None) -> Points:
        """The sample points in the eroded solid; arguments as for `eroded`."""
        level = _fraction(fraction)
        request = self._eroded_request(service.ARTIFACT_KIND_ERODED_POINTS, level, volume)
        message = types.SkeletonPoints.FromString(self._fetched(request, timeout))
        self._warn_if_empty("eroded solid", len(message.point), message.quality)
        return self._saveable(points_of(message), "erode", self.id, "--as", "points", *_level_options(level, volume))

    def measures(self, threshold: Optional[float] = None, *, timeout: Optional[float] = None) -> Measures:
        """The solid in its limbs: lengths, volumes, radii, angles, and which part each triangle and sample point is of.

        Args:
            threshold: the length of the shortest limb with a branch, in its own radii; None = 0.9.

        Example:
            >>> pandas.DataFrame(job.measures().table())
        """
        request = service.FetchArtifactRequest(job=self.id, kind=service.ARTIFACT_KIND_PARTS,
                                               skeleton=skeleton_params("curve", threshold))
        message = types.SolidParts.FromString(self._fetched(request, timeout))
        measures = measures_of(message)
        self._warn_of_skeleton("skeleton", len(measures.curve.vertices), message.curve.quality)
        options = _skeleton_options(None, threshold)
        self._saveable(measures.curve, "fetch", self.id, "curve", *options)
        self._saveable(measures.surface, "fetch", self.id, "thickness", *options)
        return self._saveable(measures, "measure", self.id, *options)

    def mesh(self, *, timeout: Optional[float] = None) -> bytes:
        """The OFF text that was submitted, unchanged."""
        return self._bytes(service.ARTIFACT_KIND_MESH, timeout)

    def source(self, *, timeout: Optional[float] = None) -> bytes:
        """The OFF text of the mesh before it was repaired to be submitted; NotFound where it was not."""
        return self._bytes(service.ARTIFACT_KIND_SOURCE, timeout)

    def save(self, what: str, file: Union[str, "os.PathLike[str]"], *options: str) -> Path:
        """Writes what `affskel-client fetch`, or `render` and `view`, do, by the installed affskel-client, and returns
        where.

        Args:
            what: "field", "divergence", "skeleton", "surface", "curve", "thickness", "eroded", "mesh", "source",
                "picture" (.png) or "view" (.html).
            file: the format is that of its extension; of a curve also .json, .graphml, .swc, .glb, .csv and .xyz.
            options: more of the command's, such as "--operator=sobel".

        Raises:
            UsageError: one of these is wrong, or affskel-client is not there.

        Example:
            >>> job.save("divergence", "H.csv", "--operator=sobel")
        """
        if what not in (*_FETCHED, *_DRAWN):
            raise UsageError(f"{what!r} is not written to files: expected one of {', '.join((*_FETCHED, *_DRAWN))}")
        path = path_of(file, "file")
        command, subject = (_DRAWN[what], [self.id]) if what in _DRAWN else ("fetch", [self.id, what])
        run_program(self._session.reached(), [command, *options, "-o", str(path.absolute()), "--", *subject],
                    "files are written by affskel-client")
        return path

    def view(self, operator: Optional[str] = None, threshold: Optional[float] = None, *, up: Optional[str] = None,
             height: int = 640) -> View:
        """The body and its skeleton to turn, in a frame of the notebook; made by the installed affskel-client.

        Args:
            operator, threshold: as for `skeleton`.
            up: what points up and what it faces, such as "z,-y", kept with the job; "shape" = as its shape tells.
            height: of the frame, CSS pixels.
        """
        self._chosen(operator, threshold)  # the same errors as elsewhere
        stance = [] if up is None else [f"--up={up}"]
        return View(page(self._session.reached(), self.id, [*_skeleton_options(operator, threshold), *stance]), height)

    def _see(self, job: types.Job) -> Status:
        self.seen = status_of(job)
        return self.seen

    def _saveable(self, result: Result, *command: str) -> Result:
        return with_origin(result, self._session.reached(), *command)

    def _chosen(self, operator: Optional[str], threshold: Optional[float]) -> Optional[types.SkeletonParams]:
        """None = the job's own skeleton.  A threshold alone is for the job's operator."""
        if operator is None and threshold is None:
            return None
        params = skeleton_params(operator, threshold)
        if operator is None:
            params.operator = self._session.get_job(self.id).skeleton.operator
        return params

    def _eroded_request(self, kind: "service.ArtifactKind", fraction: Optional[float],
                        volume: Optional[float]) -> service.FetchArtifactRequest:
        if (fraction is None) == (volume is None):
            raise UsageError("say the level of the eroded solid by fraction or by volume")
        for value, what in ((fraction, "fraction"), (volume, "volume")):
            if value is not None and (isinstance(value, bool) or not isinstance(value, numbers.Real)):
                raise UsageError(f"{what} is a number, not {value!r}")
        level = types.ErodedParams(volume=volume) if fraction is None else types.ErodedParams(fraction=fraction)
        return service.FetchArtifactRequest(job=self.id, kind=kind, eroded=level)

    def _bytes(self, kind: "service.ArtifactKind", timeout: Optional[float]) -> bytes:
        return self._fetched(service.FetchArtifactRequest(job=self.id, kind=kind), timeout)

    def _fetched(self, request: service.FetchArtifactRequest, timeout: Optional[float]) -> bytes:
        return self._session.fetch(request, timeout)[1]

    def _warn_of_skeleton(self, what: str, count: int, quality: types.SkeletonQuality) -> None:
        if count == 0:
            self._warn(f"the {what} of job {self.id} is empty", quality)
        elif quality.advice:
            self._warn(f"the skeleton of job {self.id}", quality)

    def _warn_if_empty(self, what: str, count: int, quality: types.SkeletonQuality) -> None:
        if count == 0:
            self._warn(f"the {what} of job {self.id} is empty", quality)

    def _warn(self, message: str, quality: types.SkeletonQuality) -> None:
        message += f": {quality.advice}" if quality.advice else ""
        to_try = " or ".join(f"{setting.name}={_argument(setting.value)}" for setting in quality.to_try)
        warnings.warn(message + (f" Try {to_try}" if to_try else ""), AffskelWarning, stacklevel=4)
