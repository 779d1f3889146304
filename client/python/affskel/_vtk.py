"""Results as data sets of VTK, which pyvista's are."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Mapping, Tuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._arrays import Field, Lattice


def _modules() -> Any:
    try:
        from vtkmodules import vtkCommonCore, vtkCommonDataModel
        from vtkmodules.util import numpy_support
    except ImportError as error:
        raise ImportError("to_pyvista needs pyvista, or VTK at least (Debian: python3-vtk9)") from error
    return vtkCommonCore, vtkCommonDataModel, numpy_support


def _wrapped(dataset: Any) -> Any:
    """pyvista's object for it where pyvista is installed."""
    try:
        import pyvista
    except ImportError:
        return dataset
    return pyvista.wrap(dataset)


def _add_array(dataset: Any, name: str, values: npt.NDArray[Any]) -> None:
    _, _, numpy_support = _modules()
    array = numpy_support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    dataset.GetPointData().AddArray(array)


def _add_attributes(dataset: Any, attributes: Mapping[str, npt.NDArray[Any]]) -> None:
    for name, values in attributes.items():
        _add_array(dataset, name, values)
    if "E" in attributes:
        dataset.GetPointData().SetActiveScalars("E")


def _points(places: npt.NDArray[Any]) -> Any:
    core, _, numpy_support = _modules()
    points = core.vtkPoints()
    points.SetData(numpy_support.numpy_to_vtk(np.ascontiguousarray(places), deep=True))
    return points


def _cells(faces: npt.NDArray[Any]) -> Any:
    """Faces (m, k) as a vtkCellArray."""
    _, model, numpy_support = _modules()
    count, corners = faces.shape
    as_ids = numpy_support.numpy_to_vtkIdTypeArray
    cells = model.vtkCellArray()
    cells.SetData(as_ids(np.arange(0, corners * count + 1, corners, dtype=np.int64), deep=True),
                  as_ids(np.ascontiguousarray(faces, np.int64).ravel(), deep=True))
    return cells


def points_dataset(places: npt.NDArray[Any], attributes: Mapping[str, npt.NDArray[Any]]) -> Any:
    """One vertex cell for each of the places (n, 3)."""
    _, model, _ = _modules()
    dataset = model.vtkPolyData()
    dataset.SetPoints(_points(places))
    dataset.SetVerts(_cells(np.arange(len(places)).reshape(-1, 1)))
    _add_attributes(dataset, attributes)
    return _wrapped(dataset)


def surface_dataset(vertices: npt.NDArray[Any], faces: npt.NDArray[Any], segments: npt.NDArray[Any],
                    attributes: Mapping[str, npt.NDArray[Any]]) -> Any:
    """Vertices (n, 3), triangles (m, 3) and segments (k, 2), as lines."""
    _, model, _ = _modules()
    dataset = model.vtkPolyData()
    dataset.SetPoints(_points(vertices))
    dataset.SetPolys(_cells(faces))
    dataset.SetLines(_cells(segments))
    _add_attributes(dataset, attributes)
    return _wrapped(dataset)


def _grid(lattice: Lattice) -> Any:
    """Without arrays.  ImageData where the axes are those of space: readers ignore its direction matrix."""
    _, model, _ = _modules()
    if lattice.is_axis_parallel:
        image = model.vtkImageData()
        image.SetDimensions(*lattice.dims)
        image.SetOrigin(*lattice.origin.tolist())
        image.SetSpacing(*np.diag(lattice.axes).tolist())
        return image
    grid = model.vtkStructuredGrid()
    grid.SetDimensions(*lattice.dims)
    places = lattice.all_points().reshape(*lattice.dims, 3)
    grid.SetPoints(_points(places.transpose(2, 1, 0, 3).reshape(-1, 3)))
    return grid


def field_dataset(field: Field) -> Any:
    """See Field.to_pyvista."""
    dims = field.lattice.dims
    # VTK counts points with x fastest.
    places = np.ravel_multi_index(np.unravel_index(field.lattice.inside, dims)[::-1], dims[::-1])
    arrays: Dict[str, Tuple[npt.NDArray[Any], float]] = {
        "E": (field.E, 0), "E_share": (field.share, 0), "slope": (field.slope, 0), "normal": (field.normals, 0),
        "inside": (np.ones(len(field), np.uint8), 0)}
    if field.is_infimum:
        arrays["saddles"] = (field.saddles.astype(np.int32), -1)
    else:
        arrays["direction"] = (field.direction.astype(np.int32), -1)
    dataset = _grid(field.lattice)
    for name, (values, outside) in arrays.items():
        whole = np.full((dims[0] * dims[1] * dims[2], *values.shape[1:]), outside, values.dtype)
        whole[places] = values
        _add_array(dataset, name, whole)
    dataset.GetPointData().SetActiveScalars("E")
    return _wrapped(dataset)
