"""What of a mesh is told before anything is sent: that it is open, and that a spacing is not one of its unit."""
from __future__ import annotations

import itertools
import numbers
import re
from typing import List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, Ints
from ._errors import BadInputError, LimitError, UsageError


BYTE_ORDER_MARK = b"\xef\xbb\xbf"


class Polygons(NamedTuple):
    """Vertices (n, 3), and faces as arrays (m, k), one for each number k of corners."""

    points: Floats
    faces: Sequence[Ints]


def polygons_of_off(text: bytes) -> Optional[Polygons]:
    """Of plain OFF text, all of whose faces have as many corners; None for any other, which the server reads."""
    words = (re.sub(rb"#[^\n]*", b"", text) if b"#" in text else text).split()
    if not words or words.pop(0) != b"OFF":
        return None
    try:
        vertices, faces = int(words[0]), int(words[1])
        numbers = np.array(words[3:], np.float64)
        corners = int(numbers[3 * vertices])
    except (ValueError, IndexError):
        return None
    table = numbers[3 * vertices:]
    if vertices < 1 or faces < 1 or len(table) != faces * (corners + 1) or corners < 3:
        return None
    rows = table.reshape(faces, corners + 1).astype(np.int64)
    if (rows[:, 0] != corners).any() or rows[:, 1:].min() < 0 or rows[:, 1:].max() >= vertices:
        return None
    return Polygons(numbers[:3 * vertices].reshape(-1, 3), [rows[:, 1:]])


_WORD = re.compile(rb"#[^\r\n]*|[^\s#]+")  # or a comment


def _first_words(text: bytes, most: int) -> List[bytes]:
    """Without comments.  Of a large text only its beginning is read."""
    begin = len(BYTE_ORDER_MARK) if text.startswith(BYTE_ORDER_MARK) else 0
    words = (found[0] for found in _WORD.finditer(text, begin) if not found[0].startswith(b"#"))
    return list(itertools.islice(words, most))


def _holds_numbers(text: bytes) -> bool:
    """Whether nothing else follows the first word."""
    try:
        np.array(_first_words(text, len(text))[1:], np.float64)
    except ValueError:
        return False
    return True


def require_off(text: bytes, file: str = "") -> None:
    """Raises BadInputError for bytes that do not begin as OFF text does, end before the counts, or have no points or
    faces by these and nothing else that is wrong, which the server tells with its line."""
    words = _first_words(text, 3)
    if not words or re.fullmatch(rb"(ST)?C?N?4?OFF", words[0]) is None:
        raise BadInputError(f"the mesh does not begin with OFF, but with {text[:20]!r}; as bytes, OFF text is taken, "
                            "and a path as a text", file=file)
    if len(words) < 3:
        raise BadInputError("the mesh ends before it tells how many points and faces it has", file=file)
    for word, what in zip(words[1:], ("points", "faces")):
        if word.isdigit() and int(word) == 0 and _holds_numbers(text):
            raise BadInputError(f"the mesh has no {what}", file=file)


def _places(points: npt.NDArray[np.float64]) -> Tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """The different points, and which of them each is.

    As np.unique(axis=0), which compares rows as structures: an interrupt in the midst of that is a TypeError.
    """
    order = np.lexsort(points.T)
    ordered = points[order]
    first = np.ones(len(points), bool)
    first[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    which = np.empty(len(points), np.int64)
    which[order] = np.cumsum(first) - 1
    return ordered[first], which


def number_of(value: object, what: str, more: str = "") -> float:
    """Raises UsageError, which says what a number is and `more`, for what is none, or none that a double can be."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise UsageError(f"{what} is a number{more}, not {value!r}")
    try:
        return float(value)
    except OverflowError as error:
        raise UsageError(f"{what} is too large a number") from error


def text_of(value: object, what: str) -> str:
    """Raises UsageError for what is no text, or none that can be sent."""
    if not isinstance(value, str):
        raise UsageError(f"{what} is a text, not {value!r}")
    try:
        value.encode()
    except UnicodeEncodeError as error:
        raise UsageError(f"{what} is no text: {error}") from error
    return value


_SHARE = re.compile(r"\+?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?%")  # as affskel-client takes them


def share_of(text: object) -> Optional[float]:
    """"5%" as 0.05; None for what is no share between 0 and 1."""
    if not isinstance(text, str) or not _SHARE.fullmatch(text):
        return None
    share = float(text[:-1]) / 100
    return share if 0 < share < 1 else None


def longest_side(mesh: Polygons) -> float:
    """Of the box about the vertices that faces use."""
    used = np.unique(np.concatenate([group.ravel() for group in mesh.faces]))
    return float(np.ptp(mesh.points[used], axis=0).max())


def require_finite(mesh: Polygons, file: str = "") -> None:
    """Raises BadInputError when a vertex has a coordinate that is no finite number."""
    bad = ~np.isfinite(mesh.points).all(axis=1)
    if bad.any():
        raise BadInputError(f"vertex {int(np.argmax(bad))} is not finite", file=file)


class Edges(NamedTuple):
    """The different points of a mesh, a code of each edge between them, and how many faces each edge has."""

    places: npt.NDArray[np.float64]
    codes: npt.NDArray[np.int64]
    faces: npt.NDArray[np.int64]

    @property
    def are_crowded(self) -> bool:
        """Whether one has more than two faces: a face is there twice, say, or solids touch."""
        return bool((self.faces > 2).any())


def edges_of(mesh: Polygons) -> Edges:
    """Vertices at one place are one, as they are for the server."""
    places, which = _places(mesh.points)
    edges: List[npt.NDArray[np.int64]] = []
    for group in mesh.faces:
        corners = which[group]
        sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
        low, high = np.sort(sides[sides[:, 0] != sides[:, 1]], axis=1).T
        edges.append(low * len(places) + high)
    return Edges(places, *np.unique(np.concatenate(edges), return_counts=True))


def require_closed(edges: Edges, file: str = "") -> None:
    """Every edge needs two faces.

    Raises:
        BadInputError: with the number of open edges and a place.
    """
    places, codes, faces = edges
    alone = np.stack(np.divmod(codes[faces == 1], len(places)), axis=1)
    if len(alone):
        a, b = (tuple(float(x) for x in places[vertex]) for vertex in alone[0])
        raise BadInputError(f"the mesh does not bound a solid: {len(alone)} open edges (one face only), for example "
                            f"from {a} to {b}; fill its holes by repair='fill=LENGTH' or 'wrap', by affskel-client "
                            "repair, MeshLab's Close Holes or Blender's Fill Holes", file=file)


_UNITS = ((1.0, "metres"), (100.0, "centimetres"), (1000.0, "millimetres"))
MAX_POINTS = 1 << 31
LEAST_POINTS = 8  # a skeleton of fewer tells nothing: the spacing is meant in another unit


def _volume(mesh: Polygons) -> float:
    """Of a closed mesh whose faces agree."""
    points = mesh.points - mesh.points.mean(axis=0)
    six = 0.0
    for group in mesh.faces:
        for k in range(1, group.shape[1] - 1):
            a, b, c = points[group[:, 0]], points[group[:, k]], points[group[:, k + 1]]
            six += float(np.einsum("ij,ij->", a, np.cross(b, c)))
    return abs(six) / 6


def require_points(mesh: Polygons, spacing: float, file: str = "") -> None:
    """A lattice needs a few points, and at most 2^31.

    Raises:
        LimitError: it would have more.
        BadInputError: with the size of the mesh, the unit that it looks like, and a spacing that would do.
    """
    size, volume = np.ptp(mesh.points, axis=0), _volume(mesh)
    longest = float(size.max())
    count = volume / spacing / spacing / spacing  # infinite where spacing^3 would be 0
    if count > MAX_POINTS:
        raise LimitError(f"the spacing {spacing:.6g} gives about {count:.3g} sample points, and at most "
                         f"{MAX_POINTS} are taken; {(volume / MAX_POINTS) ** (1 / 3):.3g} is within that", file=file)
    if spacing <= longest / 2 and count >= LEAST_POINTS:
        return
    unit = "".join(f", the size of a person in {name}" for length, name in _UNITS
                   if 0.5 * length <= longest <= 2.5 * length)
    better = f"; a spacing of {(volume / 1e5) ** (1 / 3):.2g} gives 100000 points" if volume > 0 else ""
    raise BadInputError(f"the spacing {spacing:.6g} leaves no room for sample points: the mesh measures "
                        + " x ".join(f"{side:.3g}" for side in size) + f" units{unit}{better}", file=file)
