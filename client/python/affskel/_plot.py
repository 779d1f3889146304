"""Results as pictures, by pyvista where it is installed, else by matplotlib."""
from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import UsageError

if TYPE_CHECKING:
    from ._arrays import Field, Surface


def _axes(**options: Any) -> Any:
    if importlib.util.find_spec("matplotlib") is None:
        raise UsageError("plot() needs pyvista or matplotlib")
    from matplotlib import pyplot
    return pyplot.figure().add_subplot(**options)


def plot_surface(surface: "Surface", **options: Any) -> Any:
    """By pyvista its plotter's answer; by matplotlib the axes, triangles coloured by their mean E, curves in red."""
    if importlib.util.find_spec("pyvista") is not None:
        return surface.to_pyvista().plot(**options)
    axes = _axes(projection="3d")
    from mpl_toolkits.mplot3d.art3d import Line3DCollection
    places = surface.vertices
    if len(surface.faces):
        triangles = axes.plot_trisurf(*places.T, triangles=surface.faces, cmap="viridis", **options)
        if "E" in surface.attributes:
            triangles.set_array(surface.attributes["E"][surface.faces].mean(axis=1))
            axes.figure.colorbar(triangles, ax=axes, label="E, mesh units cubed", shrink=.7)
    if len(surface.segments):
        axes.add_collection3d(Line3DCollection(places[surface.segments], colors="tab:red"))
    if len(places):
        low, high = places.min(axis=0), places.max(axis=0)
        for set_limits, begin, end in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), low, high):
            set_limits(begin, end)
        axes.set_box_aspect(np.maximum(high - low, 1e-3 * np.ptp(places, axis=0).max()))
    return axes


def plot_field(field: "Field", **options: Any) -> Any:
    """By pyvista its plotter's answer; by matplotlib the axes, with the slice of the lattice across its shortest axis
    that has the greatest E."""
    if importlib.util.find_spec("pyvista") is not None:
        return field.to_pyvista().plot(**{"scalars": "E", **options})
    grid = field.lattice.dense(field.E)
    lattice = field.lattice
    steps = np.linalg.norm(lattice.axes, axis=1)
    directions = lattice.axes / steps[:, np.newaxis]
    across = int(np.argmin(lattice.dims * steps))
    at = int(np.unravel_index(lattice.inside[np.argmax(field.E)], lattice.dims)[across])
    shown = [axis for axis in range(3) if axis != across]
    begin = [float(directions[axis] @ lattice.origin - steps[axis] / 2) for axis in shown]
    end = [float(low + lattice.dims[axis] * steps[axis]) for low, axis in zip(begin, shown)]
    axes = _axes()
    image = axes.imshow(np.take(grid, at, axis=across).T, origin="lower",
                        **{"extent": (begin[0], end[0], begin[1], end[1]), **options})
    for set_label, axis in zip((axes.set_xlabel, axes.set_ylabel), shown):
        direction = "xyz"[axis] if lattice.is_axis_parallel else f"along ({', '.join(f'{d:.3g}' for d in directions[axis])})"
        set_label(f"{direction}, mesh units")
    axes.figure.colorbar(image, ax=axes, label="E, mesh units cubed")
    return axes
