"""What a server says of a job."""
from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Optional, Tuple

from ._messages import word
from .v1 import types_pb2 as types


def _time(milliseconds: int) -> Optional[datetime]:
    return datetime.fromtimestamp(milliseconds / 1000, timezone.utc) if milliseconds else None


@dataclass(frozen=True)
class Note:
    """One thing that was found in a mesh: severity "repaired" or "warning", a stable code, a message for people."""

    severity: str
    code: str
    message: str


@dataclass(frozen=True)
class Status:
    """A job at one moment.  `pandas.DataFrame(affskel.jobs())` is a table of them.

    Attributes:
        id: 32 hexadecimal digits.
        state: "queued", "running", "done", "failed" or "cancelled".
        stage: "prepare", "erode", "derive" or "complete".
        directions_done, directions_total: progress; the total is 0 before the mesh is prepared.
        points: R, number of sample points; 0 before.
        spacing: of the lattice, mesh units; 0 before.
        volume: v0, mesh units cubed; 0 before.
        skeleton_points: of the job's own skeleton, when done.
        reason: why it failed, why it does not run, or why its skeleton is empty.
        notes: what was found in the mesh.
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
    points: int
    spacing: float
    volume: float
    skeleton_points: int
    reason: str
    notes: Tuple[Note, ...]
    created: Optional[datetime]
    started: Optional[datetime]
    finished: Optional[datetime]
    removed: Optional[datetime]
    pinned: bool
    mesh_sha256: str

    @property
    def is_final(self) -> bool:
        """Whether nothing more will happen by itself."""
        return self.state in ("done", "failed", "cancelled")

    @property
    def share_done(self) -> float:
        """Of the directions, 0 .. 1."""
        return self.directions_done / self.directions_total if self.directions_total else 0.0


def status_of(job: types.Job) -> Status:
    prepared = job.prepared
    reason = job.error.message or job.waiting_reason or job.quality.advice
    return Status(
        id=job.id, name=job.name, owner=job.owner, priority=job.priority,
        state=word(types.JobState, job.state), stage=word(types.JobStage, job.stage),
        directions_done=job.directions_done, directions_total=job.directions_total, points=prepared.points,
        spacing=prepared.spacing, volume=prepared.volume, skeleton_points=job.skeleton_points, reason=reason,
        notes=tuple(Note(note.severity, note.code, note.message) for note in prepared.notes),
        created=_time(job.created_ms), started=_time(job.started_ms), finished=_time(job.finished_ms),
        removed=_time(job.removed_ms), pinned=job.pinned, mesh_sha256=job.mesh_sha256)
