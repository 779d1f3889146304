"""The solid in parts and numbers."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Sequence

import numpy as np

from ._arrays import Floats, Ints, Surface, Table, surface_of
from ._errors import InternalError
from ._messages import word
from ._saving import Saveable
from .v1 import types_pb2 as types

# Columns of a table, and what the contract calls them.
NUMBERS = ("length", "straight_length", "volume", "volume_share", "surface_area", "mean_radius", "least_radius",
           "greatest_radius", "angle", "angle_to")


@dataclass(frozen=True, eq=False, repr=False)
class Measures(Saveable):
    """The solid, parted by the branches of its curve skeleton.  p parts, m triangles, R sample points.

    Parts count from 1: row 0 of every array is part 1.  The greatest volume comes first, but in a row of parts that have
    each at least 95 % of the one before they are in the order of their places.  Volumes and areas add up to the solid's.

    Attributes:
        kinds: of each part: "limb" (one end is free), "line" (both), "link" (none), "loop" (it closes), "point"
            (a ball, or a body that limbs hang on).
        numbers: (p,) each: length and straight_length of the branch, volume, volume_share, surface_area, mean_radius,
            least_radius, greatest_radius, angle (degrees, to the heaviest other branch at `starts`: 180 goes straight
            on; NaN without one), angle_to (the part that it is, from 1; NaN where it is
            none), straightness (straight_length / length; 1 of a point).
        starts, ends: (p, 3) where each branch hangs on, and its other end, of a limb the free one.
        branches: of each part the indices of its vertices in `curve`, from start to end.
        links: the same of lines between parts that lie within joints, whole: no part of the solid is theirs.
        curve: the curve skeleton, see Surface: its attribute "part" is each vertex's.
        surface: the solid's, its triangles cut where parts meet; no attributes.  Saved, .ply or .vtp, it has the part and
            the thickness of each triangle.
        triangle_part, thickness: (m,) per triangle of it: its part, and the way along its optimal normal to the skeleton
            of "ridge" or, where that is far away, how thick the solid is about there.
        point_part: (R,) per sample point, in the order of `Job.field`.
        whole: of the solid: volume, surface_area, curve_length, sheet_area (of the skeleton of "ridge"), greatest_E,
            greatest_E_place, and the pieces, tunnels and voids that its skeleton finds.
    """

    kinds: Sequence[str]
    numbers: Mapping[str, Floats]
    starts: Floats
    ends: Floats
    branches: Sequence[Ints]
    links: Sequence[Ints]
    curve: Surface
    surface: Surface
    triangle_part: Ints
    thickness: Floats
    point_part: Ints
    whole: Mapping[str, Any]

    def __len__(self) -> int:
        return len(self.kinds)

    def __repr__(self) -> str:
        return f"<affskel.Measures of {len(self)} parts, volume {self.whole['volume']:.6g}>"

    def table(self) -> Table:
        """A row for each part, for `pandas.DataFrame(measures.table())`."""
        columns: Table = {"part": np.arange(1, len(self) + 1), "kind": np.array(self.kinds, dtype=object)}
        columns.update(self.numbers)
        for name, places in (("from", self.starts), ("to", self.ends)):
            columns.update({f"{name}_{axis}": places[:, a] for a, axis in enumerate("xyz")})
        return columns

    def graph(self) -> Any:
        """A networkx.MultiGraph: nodes are vertices of `curve` where branches end or meet, with place, E and radius; edges
        are parts, with the numbers of `table` and the `polyline` (k, 3), and links, which are no part: with the polyline
        alone, and part None.  A part without a line is a node, with the numbers."""
        import networkx
        graph = networkx.MultiGraph()
        places = self.curve.vertices
        for branch in (*self.branches, *self.links):
            for vertex in (int(branch[0]), int(branch[-1])):
                graph.add_node(vertex, place=tuple(places[vertex]),
                               **{name: float(self.curve.attributes[name][vertex]) for name in ("E", "radius")})
        for row, branch in enumerate(self.branches):
            known = {"part": row + 1, "kind": self.kinds[row],
                     **{name: float(values[row]) for name, values in self.numbers.items()}}
            if len(branch) > 1:
                graph.add_edge(int(branch[0]), int(branch[-1]), polyline=places[branch], **known)
            else:
                graph.add_node(int(branch[0]), **known)
        for branch in self.links:
            graph.add_edge(int(branch[0]), int(branch[-1]), part=None, kind="link", polyline=places[branch])
        return graph


def _places(parts: Sequence[types.SolidPart], name: str) -> Floats:
    rows = [list(getattr(part, name)) for part in parts]
    if any(len(row) != 3 for row in rows):
        raise InternalError("the server sent damaged parts of the solid: a part without its ends")
    return np.array(rows, np.float64).reshape(-1, 3)


def _whole(message: types.SolidParts, numbers: Mapping[str, Floats]) -> Dict[str, Any]:
    links = sum(link.length for link in message.links)
    quality = message.curve.quality
    return {"volume": float(numbers["volume"].sum()), "surface_area": message.surface_area,
            "curve_length": float(numbers["length"].sum() + links), "sheet_area": message.sheet_area,
            "greatest_E": message.greatest_erosion, "greatest_E_place": tuple(message.greatest_place),
            "pieces": quality.components, "tunnels": quality.holes, "voids": quality.lattice.cavities}


def measures_of(message: types.SolidParts) -> Measures:
    """Raises InternalError when the message contradicts itself."""
    parts = message.parts
    numbers = {name: np.array([getattr(part, name) for part in parts], np.float64) for name in NUMBERS}
    length, straight = numbers["length"], numbers["straight_length"]
    numbers["straightness"] = np.divide(straight, length, out=np.ones(len(parts)), where=length > 0)
    for name in ("angle", "angle_to"):
        numbers[name][[not part.HasField(name) for part in parts]] = np.nan
    curve, surface = surface_of(message.curve), surface_of(message.surface)
    branches: List[Ints] = [np.array(part.vertices, np.int64) for part in parts]
    links: List[Ints] = [np.array(link.vertices, np.int64) for link in message.links]
    triangle_part, point_part = np.array(message.triangle_part, np.int64), np.array(message.point_part, np.int64)
    thickness = np.array(message.thickness, np.float64)
    if not len(triangle_part) == len(thickness) == len(surface.faces):
        raise InternalError("the server sent damaged parts of the solid: a triangle without its values")
    angle_to = numbers["angle_to"][~np.isnan(numbers["angle_to"])]
    for given in (triangle_part, point_part, angle_to):
        if len(given) and not 1 <= given.min() <= given.max() <= len(parts):
            raise InternalError("the server sent damaged parts of the solid: a part out of range")
    if any(len(branch) == 0 or branch.max() >= len(curve.vertices) for branch in branches + links):
        raise InternalError("the server sent damaged parts of the solid: a vertex out of range")
    kinds = [word(types.PartKind, part.kind) for part in parts]
    return Measures(kinds, numbers, _places(parts, "from"), _places(parts, "to"), branches, links, curve,
                    surface, triangle_part, thickness, point_part, _whole(message, numbers))
