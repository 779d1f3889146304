"""Results as arrays.

Notation: R sample points, K directions, n points or vertices, m faces.  Lengths are in the units of the mesh, areas in
these squared, volumes cubed.  Sample points come in lattice order, x slowest, z fastest, as in every file of
affskel-client.
"""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Dict, Mapping, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from ._errors import InternalError
from ._messages import plain
from ._saving import Saveable
from .v1 import types_pb2 as types

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Table = Dict[str, npt.NDArray[Any]]

# ARTIFACT_KIND_FIELD: little-endian records without padding.
FIELD_RECORD = np.dtype([("E", "<f8"), ("area", "<f8"), ("direction", "<u4")])
# ARTIFACT_KIND_REFINED, likewise.
REFINED_RECORD = np.dtype([("E", "<f8"), ("slope", "<f8"), ("normal", "<f8", 3), ("saddles", "<u4", 2), ("round", "<u4")])
NO_SADDLE = 0xFFFFFFFF


def _doubles(values: Sequence[float], width: int = 1) -> Floats:
    """(n,) or, with a width, (n, width)."""
    array = np.fromiter(values, np.float64, len(values))
    if width == 1:
        return array
    if len(array) % width:
        raise InternalError(f"the server sent {len(array)} numbers where they come by {width}")
    return array.reshape(-1, width)


def _wholes(values: Sequence[int]) -> Ints:
    return np.fromiter(values, np.int64, len(values))


def _columns(points: Floats, names: str = "x y z") -> Table:
    return {name: points[:, axis] for axis, name in enumerate(names.split())}


@dataclass(frozen=True, eq=False, repr=False)
class Lattice:
    """The lattice whose points inside the solid are the R sample points.

    Attributes:
        dims: numbers of lattice points along the three axes.
        origin: (3,) place of lattice point (0, 0, 0).
        axes: (3, 3), row a is the step to the next point along axis a.
        inside: (R,) linear indices (i ny + j) nz + k of the sample points, ascending.
    """

    dims: Tuple[int, int, int]
    origin: Floats
    axes: Floats
    inside: Ints

    def __len__(self) -> int:
        return len(self.inside)

    def __repr__(self) -> str:
        return f"<affskel.Lattice {' x '.join(map(str, self.dims))}, {len(self)} points inside>"

    @property
    def is_axis_parallel(self) -> bool:
        """Whether its axes are x, y and z, in this order and direction."""
        steps = np.diag(self.axes)
        return bool((self.axes == np.diag(steps)).all() and (steps > 0).all())

    def _places(self, i: Ints, j: Ints, k: Ints) -> Floats:
        """In the order of additions that the contract asks for, to the last bit."""
        a, b, c = (index[:, np.newaxis].astype(np.float64) * axis for index, axis in zip((i, j, k), self.axes))
        return np.asarray(self.origin + (a + (b + c)))

    def points(self) -> Floats:
        """(R, 3) places of the sample points."""
        i, j, k = np.unravel_index(self.inside, self.dims)
        return self._places(i, j, k)

    def all_points(self) -> Floats:
        """(nx ny nz, 3) places of all lattice points, inside or not."""
        i, j, k = (index.ravel() for index in np.indices(self.dims))
        return self._places(i, j, k)

    def dense(self, values: npt.ArrayLike, fill: Any = None) -> npt.NDArray[Any]:
        """Values of the sample points, (R,) or (R, c), as an array (nx, ny, nz) or (nx, ny, nz, c).

        Args:
            fill: what the other lattice points get; None = NaN, of whole numbers -1, of whole numbers without sign 0, of
                truth values False.

        Raises:
            ValueError: not as many values as sample points, or values of their kind cannot be `fill`.
        """
        array = np.asarray(values)
        if array.ndim == 0 or len(array) != len(self):
            raise ValueError(f"{array.size} values for {len(self)} sample points")
        if fill is None:
            fill = {"b": False, "u": 0, "i": -1}.get(array.dtype.kind, np.nan)
        elif array.dtype.kind in "bui" and not float(fill).is_integer():
            raise ValueError(f"values of {array.dtype} cannot be {fill}")
        nx, ny, nz = self.dims
        grid = np.full((nx * ny * nz, *array.shape[1:]), fill, array.dtype)
        grid[self.inside] = array
        return grid.reshape(nx, ny, nz, *array.shape[1:])


@dataclass(frozen=True, eq=False, repr=False)
class Field(Saveable):
    """The erosion level E at the sample points.

    Attributes:
        points: (R, 3) their places.
        E: (R,) erosion level, the least volume that a plane through the point cuts off, counting only the piece
            connected with it.
        normals: (R, 3) the optimal normals, unit: E grows along them.
        slope: (R,) |grad E|, the area of the optimal section, and more at saddles; grad E = slope[:, None] * normals.
        direction: (R,) index of the optimal direction; empty for the infimum over all directions.
        directions: (K, 3) the direction set, unit vectors; zeros for triangles without area.  Empty for the infimum.
        volume: v0, volume of the solid.
        lattice: where the points are.
        saddles: (R,) of the infimum: how many saddles of the solid the optimal plane touches, 0, 1 or 2; else empty.
    """

    points: Floats
    E: Floats
    normals: Floats
    slope: Floats
    direction: Ints
    directions: Floats
    volume: float
    lattice: Lattice
    saddles: Ints = field(default_factory=lambda: np.zeros(0, np.int64))

    def __len__(self) -> int:
        return len(self.E)

    def __repr__(self) -> str:
        over = "all" if self.is_infimum else str(len(self.directions))
        return f"<affskel.Field of {len(self)} points, {over} directions, E up to {self.E.max(initial=0):.6g}>"

    @property
    def is_infimum(self) -> bool:
        """Whether E is the infimum over all directions, not the minimum over a set."""
        return len(self.saddles) > 0

    @property
    def share(self) -> Floats:
        """(R,) E as a share of v0."""
        return np.asarray(self.E / self.volume)

    def table(self) -> Table:
        """Columns as in the CSV of affskel-client, and the slope: for `pandas.DataFrame(field.table())`."""
        columns: Table = {**_columns(self.points), "E": self.E, **_columns(self.normals, "nx ny nz")}
        if self.is_infimum:
            return {**columns, "slope": self.slope, "saddles": self.saddles}
        return {**columns, "direction": self.direction, "slope": self.slope}

    def plot(self, **options: Any) -> Any:
        """Shows E, by pyvista where that is installed, else by matplotlib, whose axes it returns: the slice across the
        shortest axis with the greatest E.

        Args:
            options: for pyvista's `plot`, or matplotlib's `imshow`.
        """
        from ._plot import plot_field
        return plot_field(self, **options)

    def to_pyvista(self) -> Any:
        """The whole lattice with the arrays E, E_share, slope, normal, direction (of the infimum saddles) and inside.

        Outside the solid E and the slope are 0, as on its surface, and direction and saddles are -1.

        Returns:
            pyvista's ImageData, of a turned or sheared lattice its StructuredGrid; without pyvista the object of VTK
            that these are.
        """
        from ._vtk import field_dataset
        return field_dataset(self)


@dataclass(frozen=True, eq=False, repr=False)
class Points(Saveable):
    """Points of a skeleton, or of an eroded solid.

    Attributes:
        points: (n, 3).  Of "ridge" and "curve" the vertices of `Job.skeleton`, of "chords" the shocks on lattice edges,
            not the vertices; otherwise sample points.
        E: (n,) erosion level.
        normals: (n, 3) optimal normals, unit, of sheets and curves those of a sample point beside the place.
        direction: (n,) index of the optimal direction; empty for the infimum over all directions.
        H: (n,) the operator's divergence of the normals, for "ridge", "curve" and "chords" the strength; empty for an
            eroded solid.
        quality: what the skeleton is like, by the names of SkeletonQuality in the contract; empty for an eroded solid.
    """

    points: Floats
    E: Floats
    normals: Floats
    direction: Ints
    H: Floats
    quality: Mapping[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        return f"<affskel.Points, {len(self)} with {', '.join(self.attributes())}>"

    def attributes(self) -> Table:
        """Arrays by point."""
        arrays = {"E": self.E, "normal": self.normals, "direction": self.direction, "H": self.H}
        return {name: array for name, array in arrays.items() if len(array) == len(self)}

    def table(self) -> Table:
        """Columns as in the CSV of affskel-client: for `pandas.DataFrame(points.table())`."""
        columns: Table = {**_columns(self.points), "E": self.E, **_columns(self.normals, "nx ny nz")}
        if len(self.direction) == len(self):
            columns["direction"] = self.direction
        if len(self.H) == len(self):
            columns["H"] = self.H
        return columns

    def to_pyvista(self) -> Any:
        """pyvista's PolyData of the points with their attributes; without pyvista a vtkPolyData."""
        from ._vtk import points_dataset
        return points_dataset(self.points, self.attributes())


@dataclass(frozen=True, eq=False, repr=False)
class Surface(Saveable):
    """A triangulated skeleton, or the surface of an eroded solid.  Its len is that of its triangles; of lines alone, which
    "curve" has, that of its segments.

    Attributes:
        vertices: (n, 3).
        faces: (m, 3) indices of vertices.
        attributes: arrays by vertex.  Sheets of "chords" and "ridge" have E, strength (0 .. 1; of "ridge" radians per
            depth), area of the optimal sections, normal_a and normal_b (n, 3) of the two sides, that of "ridge" also
            the ratio of its two curvatures, the kind (0 ridge surface, 1 ridge curve, 2 membrane, 3 way) and the part of
            the solid (see Measures); both have the barrier where it was asked for.  "curve" has what "ridge" has and
            distance (to the solid's surface), share (of the volume, what is nearest to the vertex), beyond (what a cut
            there parts from the rest) and radius (of the limb).  Eroded solids and alpha shapes have E and area.
        quality: of a sheet, by the names of SkeletonQuality in the contract; otherwise empty.
        volume: enclosed by the surface of an eroded solid; otherwise 0.
        segments: (k, 2) indices of vertices: all of "curve", of "ridge" in the middle of limbs and between its parts;
            sqrt(area / pi) is the radius of a circle as large as the section of the optimal plane.
    """

    vertices: Floats
    faces: Ints
    attributes: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    quality: Mapping[str, Any] = field(default_factory=dict)
    volume: float = 0.0
    segments: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))

    def __len__(self) -> int:
        return len(self.faces) or len(self.segments)

    def __repr__(self) -> str:
        return (f"<affskel.Surface of {len(self.vertices)} vertices, {len(self.faces)} triangles, {len(self.segments)} segments"
                + (f" with {', '.join(self.attributes)}>" if self.attributes else ">"))

    def plot(self, **options: Any) -> Any:
        """Shows it, by pyvista where that is installed, else by matplotlib, whose axes it returns.

        Args:
            options: for pyvista's `plot`, or matplotlib's `plot_trisurf`.

        Example:
            >>> job.skeleton().plot().figure.savefig("skeleton.png")
        """
        from ._plot import plot_surface
        return plot_surface(self, **options)

    def table(self) -> Table:
        """The vertices, columns as in the files of affskel-client: for `pandas.DataFrame(surface.table())`."""
        columns = _columns(self.vertices)
        for name, array in self.attributes.items():
            if array.ndim == 1:
                columns[name] = array
            else:
                side = name[-1]
                columns.update(_columns(array, f"nx_{side} ny_{side} nz_{side}"))
        return columns

    def to_pyvista(self) -> Any:
        """pyvista's PolyData with the attributes as point data; without pyvista a vtkPolyData."""
        from ._vtk import surface_dataset
        return surface_dataset(self.vertices, self.faces, self.segments, self.attributes)

    def to_trimesh(self) -> Any:
        """A trimesh.Trimesh with the attributes as `vertex_attributes`; vertices and faces stay as they are, curves
        are left out."""
        import trimesh
        return trimesh.Trimesh(vertices=self.vertices, faces=self.faces, process=False,
                               vertex_attributes=dict(self.attributes))


def lattice_of(message: types.Lattice) -> Lattice:
    """Raises InternalError when the message contradicts itself."""
    if len(message.origin) != 3 or len(message.axes) != 9 or len(message.dims) != 3:
        raise InternalError("the server sent a damaged lattice: wrong number of values")
    starts, lengths = _wholes(message.run_start), _wholes(message.run_length)
    if len(starts) != len(lengths):
        raise InternalError("the server sent a damaged lattice: runs without length")
    dims = (int(message.dims[0]), int(message.dims[1]), int(message.dims[2]))
    ends = starts + lengths
    if len(starts) and ((lengths < 1).any() or (starts[1:] < ends[:-1]).any() or starts[0] < 0
                        or ends[-1] > dims[0] * dims[1] * dims[2]):
        raise InternalError("the server sent a damaged lattice: runs out of order")
    # Point p of run r has the index starts[r] + (p - what the runs before it hold).
    before = np.cumsum(lengths) - lengths
    inside = np.arange(lengths.sum()) + np.repeat(starts - before, lengths)
    return Lattice(dims, _doubles(message.origin), _doubles(message.axes, 3), inside)


def field_of(lattice: Lattice, directions: Floats, data: bytes, volume: float) -> Field:
    """Raises InternalError when the three do not fit each other."""
    if len(data) != len(lattice) * FIELD_RECORD.itemsize:
        raise InternalError(f"the field has {len(data)} bytes for {len(lattice)} sample points")
    records = np.frombuffer(data, FIELD_RECORD)
    direction = records["direction"].astype(np.int64)
    if len(direction) and direction.max() >= len(directions):
        raise InternalError(f"the field names direction {direction.max()} of {len(directions)}")
    return Field(lattice.points(), records["E"].astype(np.float64), directions[direction],
                 records["area"].astype(np.float64), direction, directions, volume, lattice)


def refined_of(lattice: Lattice, data: bytes, volume: float) -> Field:
    """Raises InternalError when the two do not fit each other."""
    if len(data) != len(lattice) * REFINED_RECORD.itemsize:
        raise InternalError(f"the refined field has {len(data)} bytes for {len(lattice)} sample points")
    records = np.frombuffer(data, REFINED_RECORD)
    return Field(lattice.points(), records["E"].astype(np.float64), records["normal"].astype(np.float64),
                 records["slope"].astype(np.float64), np.zeros(0, np.int64), np.zeros((0, 3)), volume, lattice,
                 (records["saddles"] != NO_SADDLE).sum(axis=1).astype(np.int64))


def directions_of(message: types.Directions) -> Floats:
    return _doubles(message.xyz, 3)


def points_of(message: types.SkeletonPoints) -> Points:
    n = len(message.point)
    points, normals = _doubles(message.xyz, 3), _doubles(message.normal, 3)
    quality = plain(message.quality) if message.HasField("quality") else {}
    result = Points(points, _doubles(message.erosion), normals, _wholes(message.direction),
                    _doubles(message.divergence), quality)
    whole = all(len(array) == n for array in (points, normals, result.E))
    if not whole or len(result.H) not in (0, n) or len(result.direction) not in (0, n):
        raise InternalError("the server sent damaged points: their arrays differ in length")
    return result


def surface_of(message: types.TriangleMesh, always: Sequence[str] = ()) -> Surface:
    """always: attributes that it has though it be empty."""
    vertices = _doubles(message.xyz, 3)
    corners = _wholes(message.corners)
    if len(corners) % 3 or (len(corners) and corners.max() >= len(vertices)):
        raise InternalError("the server sent a damaged surface: corners out of range")
    segments = _wholes(message.segments)
    if len(segments) % 2 or (len(segments) and segments.max() >= len(vertices)):
        raise InternalError("the server sent a damaged surface: segments out of range")
    arrays = {"E": _doubles(message.erosion), "strength": _doubles(message.strength), "ratio": _doubles(message.ratio),
              "kind": _wholes(message.kind), "barrier": _doubles(message.barrier),
              "area": _doubles(message.area), "distance": _doubles(message.distance), "share": _doubles(message.share),
              "beyond": _doubles(message.beyond), "radius": _doubles(message.radius),
              "normal_a": _doubles(message.normal_a, 3),
              "normal_b": _doubles(message.normal_b, 3), "part": _wholes(message.part)}
    attributes = {name: array for name, array in arrays.items() if len(array) or (name in always and not len(vertices))}
    if any(len(array) != len(vertices) for array in attributes.values()):
        raise InternalError("the server sent a damaged surface: a vertex without its attributes")
    quality: Optional[Dict[str, Any]] = plain(message.quality) if message.HasField("quality") else None
    return Surface(vertices, corners.reshape(-1, 3), attributes, quality or {}, message.volume,
                   segments.reshape(-1, 2))
