"""Meshes as OFF text, which is what a server takes."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Iterable, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._checks import Polygons, polygons_of_off
from ._errors import BadInputError

# Read by affskel-client, which knows more formats by the year; everything else is OFF text.
OFF_SUFFIXES = (".off", "", ".txt")

MeshLike = Union[str, "os.PathLike[str]", bytes, Tuple[Any, Any], Any]


class Mesh(NamedTuple):
    """A mesh to submit."""

    name: str  # for people
    text: Optional[bytes]  # OFF; None = affskel-client must read the file
    file: str = ""  # where it comes from, if from a file
    polygons: Optional[Polygons] = None  # of the text, as far as they could be read here


def mesh_of(mesh: MeshLike) -> Mesh:
    """The mesh of whatever `affskel.submit` takes.

    Args:
        mesh: a path; OFF text as bytes; a pair of vertices (n, 3) and faces, an array (m, k) or m sequences of vertex
            indices from 0 on; an object with `vertices` and `faces` as trimesh has them; a vtkPolyData, which those of
            pyvista are; an object with `points` and `faces` as pyvista's, each face after its number of corners.

    Raises:
        BadInputError: it is nothing of that kind, or the arrays do not fit.
        OSError: the file cannot be read.
    """
    if isinstance(mesh, bytes):
        return Mesh("mesh", mesh, "", polygons_of_off(mesh))
    if isinstance(mesh, (str, os.PathLike)):
        path = Path(mesh)
        if path.suffix.lower() in OFF_SUFFIXES:
            text = path.read_bytes()
            return Mesh(path.stem, text, str(path), polygons_of_off(text))
        with path.open("rb"):  # the same error as for OFF when it is not there
            return Mesh(path.stem, None, str(path.absolute()))
    points, faces = _arrays_of(mesh)
    text = off_text(points, faces)
    return Mesh("mesh", text, "", Polygons(np.asarray(points, np.float64), faces) if any(map(len, faces)) else None)


def _arrays_of(mesh: Any) -> Tuple[Any, List[npt.NDArray[np.int64]]]:
    """Vertices, and faces as arrays (m, k) of indices, one for each number k of corners in a row of faces."""
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return mesh[0], _face_rows(mesh[1])
    if hasattr(mesh, "GetPolys"):
        return _vtk_arrays(mesh)
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return mesh.vertices, _face_rows(mesh.faces)
    if hasattr(mesh, "points") and hasattr(mesh, "faces"):
        return mesh.points, _padded_faces(mesh.faces)
    raise BadInputError(f"{type(mesh).__name__} is no mesh: expected a path, (vertices, faces), or a mesh of "
                        "trimesh, pyvista or VTK")


def _whole(values: Any, what: str) -> npt.NDArray[np.int64]:
    array = np.asarray(values)
    if array.size == 0:
        return np.zeros(array.shape, np.int64)
    if array.dtype.kind not in "iu":
        raise BadInputError(f"{what} must be whole numbers, not {array.dtype}")
    return array.astype(np.int64)


def _face_rows(faces: Any) -> List[npt.NDArray[np.int64]]:
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        if faces.ndim != 2 or faces.shape[1] < 3:
            raise BadInputError(f"faces have the shape {faces.shape}; expected (m, 3), or (m, k) with k > 3")
        return [_whole(faces, "faces")]
    if not isinstance(faces, Iterable):
        raise BadInputError(f"faces are rows of indices, not {faces!r}")
    rows = [_whole(face, "faces") for face in faces]
    for number, row in enumerate(rows):
        if row.ndim != 1 or len(row) < 3:
            raise BadInputError(f"face {number} has the shape {row.shape}; expected at least three vertices")
    return _grouped(rows)


def _grouped(rows: Sequence[npt.NDArray[np.int64]]) -> List[npt.NDArray[np.int64]]:
    """Neighbours with as many corners as one array.  The order stays: it numbers the directions."""
    groups: List[List[npt.NDArray[np.int64]]] = []
    for row in rows:
        if groups and len(groups[-1][0]) == len(row):
            groups[-1].append(row)
        else:
            groups.append([row])
    return [np.stack(group) for group in groups]


def _split(flat: npt.NDArray[np.int64], offsets: npt.NDArray[np.int64]) -> List[npt.NDArray[np.int64]]:
    """Face i is flat[offsets[i]:offsets[i + 1]]."""
    corners = np.diff(offsets)
    if len(corners) and (corners < 3).any():
        raise BadInputError(f"face {int(np.argmax(corners < 3))} has fewer than three vertices")
    if len(corners) and (corners == corners[0]).all():
        return [flat.reshape(-1, int(corners[0]))]
    return _grouped([flat[begin:end] for begin, end in zip(offsets[:-1], offsets[1:])])


def _padded_faces(faces: Any) -> List[npt.NDArray[np.int64]]:
    """Faces as pyvista has them: 3, a, b, c, 4, d, e, f, g, ..."""
    flat = _whole(faces, "faces")
    if flat.ndim != 1:
        return _face_rows(flat)
    if len(flat) % 4 == 0 and (flat[::4] == 3).all():  # triangles alone
        return [flat.reshape(-1, 4)[:, 1:]]
    starts: List[int] = []
    at = 0
    while at < len(flat):
        if flat[at] < 3 or at + flat[at] >= len(flat):
            raise BadInputError(f"faces[{at}] = {flat[at]} is no number of corners of a face")
        starts.append(at)
        at += int(flat[at]) + 1
    inside = np.delete(flat, starts)
    return _split(inside, np.array([*starts, len(flat)]) - np.arange(len(starts) + 1))


def _vtk_arrays(mesh: Any) -> Tuple[Any, List[npt.NDArray[np.int64]]]:
    from vtkmodules.util.numpy_support import vtk_to_numpy  # there, as the mesh is one of VTK's

    for what, cells in (("strips", mesh.GetStrips()), ("lines", mesh.GetLines())):
        if cells is not None and cells.GetNumberOfCells() > 0:
            raise BadInputError(f"the mesh has {cells.GetNumberOfCells()} {what} beside its polygons; "
                                "triangulate it, or leave them out")
    points, polygons = mesh.GetPoints(), mesh.GetPolys()
    if points is None or polygons.GetNumberOfCells() == 0:
        raise BadInputError("the mesh has no polygons")
    flat = vtk_to_numpy(polygons.GetConnectivityArray()).astype(np.int64)
    return vtk_to_numpy(points.GetData()), _split(flat, vtk_to_numpy(polygons.GetOffsetsArray()).astype(np.int64))


def off_text(vertices: Any, faces: Sequence[npt.NDArray[np.int64]]) -> bytes:
    """OFF text that reads back as the same doubles.

    Args:
        vertices: (n, 3), finite.
        faces: arrays (m, k) of indices into them.
    """
    try:
        if np.asarray(vertices).dtype.kind == "c":
            raise BadInputError("vertices are complex numbers; real ones are needed")
        points = np.asarray(vertices, dtype=np.float64)
    except BadInputError:
        raise
    except (TypeError, ValueError) as error:
        raise BadInputError(f"vertices are no numbers: {error}") from error
    if points.ndim != 2 or points.shape[1] != 3:
        raise BadInputError(f"vertices have the shape {points.shape}; expected (n, 3)")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise BadInputError(f"vertex {int(np.argmax(bad))} is not finite")
    first = 0
    for group in faces:
        outside = ((group < 0) | (group >= len(points))).any(axis=1)
        if outside.any():
            row = int(np.argmax(outside))
            raise BadInputError(f"face {first + row} has the vertices {group[row].tolist()}; there are {len(points)}, "
                                "counted from 0")
        first += len(group)
    if first == 0:
        raise BadInputError("the mesh has no faces")
    lines = ["OFF", f"{len(points)} {first} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    for group in faces:
        row_format = " ".join(["%d"] * (group.shape[1] + 1))
        lines += [row_format % (group.shape[1], *row) for row in group.tolist()]
    return ("\n".join(lines) + "\n").encode("ascii")
