"""What a server says of a job."""
from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime, timezone
from typing import Any, Iterator, Mapping, Optional, Tuple

from ._messages import plain, word
from .v1 import types_pb2 as types


def _time(milliseconds: int) -> Optional[datetime]:
    return datetime.fromtimestamp(milliseconds / 1000, timezone.utc) if milliseconds else None


@dataclass(frozen=True)
class Note:
    """One thing that was found in a mesh: severity "repaired" or "warning", a stable code, a message for people."""

    severity: str
    code: str
    message: str


@dataclass(frozen=True, repr=False)
class Status:
    """A job at one moment.  `pandas.DataFrame(job.seen for job in affskel.jobs())` is a table of them.

    Attributes:
        id: 32 hexadecimal digits.
        state: "queued", "running", "done", "failed" or "cancelled".
        stage: "prepare", "erode", "refine" (of the infimum), "derive" or "complete".
        directions_done, directions_total: progress; the total is 0 before the mesh is prepared.
        refine_round, refined_points: progress of the stage "refine": points done of this round.
        points: R, number of sample points; 0 before.
        spacing: of the lattice, mesh units; 0 before.
        volume: v0, mesh units cubed; 0 before.
        skeleton_points: of the job's own skeleton, when done.
        reason: why it failed, why it does not run, or why its skeleton is empty.
        notes: what was found in the mesh, what was repaired before it was submitted first.
        warnings: what to know of a job that is done, in the words of affskel-client: of its mesh and its repair, its
            lattice and its skeleton.
        quality: the report of its skeleton, when done, by the names of SkeletonQuality in the contract; else empty.
        remaining: seconds until all directions are done, an estimate; None = not known, or done.
        created, started, finished: UTC; None = not yet.
        removed: when retention removed the results; None = they are there.
    """

    id: str
    name: str
    owner: str
    priority: int
    state: str
    stage: str
    directions_done: int
    directions_total: int
    refine_round: int
    refined_points: int
    points: int
    spacing: float
    volume: float
    skeleton_points: int
    reason: str
    notes: Tuple[Note, ...]
    warnings: Tuple[str, ...]
    quality: Mapping[str, Any] = field(repr=False)
    remaining: Optional[float]
    created: Optional[datetime]
    started: Optional[datetime]
    finished: Optional[datetime]
    removed: Optional[datetime]
    pinned: bool
    mesh_sha256: str

    def __repr__(self) -> str:
        done = "" if self.is_final else f", {self.share_done:.0%}"
        skeleton = f", skeleton of {self.skeleton_points}" if self.state == "done" else ""
        reason = f": {self.reason}" if self.reason else ""
        return (f"<affskel.Status of {self.id[:12]} {self.name!r}, {self.state}{done}, {self.points} points"
                f"{skeleton}{reason}>")

    @property
    def is_final(self) -> bool:
        """Whether nothing more will happen by itself."""
        return self.state in ("done", "failed", "cancelled")

    @property
    def share_done(self) -> float:
        """Of the directions, in the stage "refine" of the points of a round, 0 .. 1."""
        if self.stage == "refine":
            return self.refined_points / self.points if self.points else 0.0
        return self.directions_done / self.directions_total if self.directions_total else 0.0


COARSE_LATTICE = 2000  # sample points, below which a skeleton is told to be coarse


def _warnings(job: types.Job) -> Iterator[str]:
    if job.state != types.JOB_STATE_DONE:
        return
    quality, prepared = job.quality, job.prepared
    if quality.advice:
        yield f"the skeleton: {quality.advice}"
    yield from (note.message for note in (*job.repair.steps, *prepared.notes) if note.severity == "warning")
    if job.skeleton_points == 0:
        return
    if prepared.points < COARSE_LATTICE:
        yield (f"the lattice is coarse, {prepared.points} points in the solid; take a smaller spacing, such as "
               f"{(prepared.volume / 1e5) ** (1 / 3):.2g} for 100000 points")
    if quality.components > quality.solid_components:
        yield (f"the skeleton is in {quality.components} pieces, the solid in {quality.solid_components}; a smaller spacing or "
               "threshold may join them")


def status_of(job: types.Job) -> Status:
    prepared = job.prepared
    reason = job.error.message or job.waiting_reason or job.quality.advice
    return Status(
        id=job.id, name=job.name, owner=job.owner, priority=job.priority,
        state=word(types.JobState, job.state), stage=word(types.JobStage, job.stage),
        directions_done=job.directions_done, directions_total=job.directions_total,
        refine_round=job.refine_round, refined_points=job.refined_points, points=prepared.points,
        spacing=prepared.spacing, volume=prepared.volume, skeleton_points=job.skeleton_points, reason=reason,
        notes=(*(Note(step.severity or "repaired", step.code, step.message) for step in job.repair.steps),
               *(Note(note.severity, note.code, note.message) for note in prepared.notes)),
        warnings=tuple(_warnings(job)), quality=plain(job.quality) if job.HasField("quality") else {},
        remaining=job.remaining_ms / 1000 if job.HasField("remaining_ms") else None,
        created=_time(job.created_ms), started=_time(job.started_ms), finished=_time(job.finished_ms),
        removed=_time(job.removed_ms), pinned=job.pinned, mesh_sha256=job.mesh_sha256)
