"""The files as VTK's own readers find them.

Usage: vtk_test.py DIRECTORY   (see make_files.py)
"""
import importlib.util
import json
import os
import sys

if importlib.util.find_spec("vtkmodules") is None:
    print("SKIPPED: no python3-vtk9; deploy/run-tests --all installs it")
    sys.exit(77)

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStaticPointLocator
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkImplicitPolyDataDistance, vtkMassProperties
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader, vtkXMLStructuredGridReader

from expected import (DIVERGENCE_ARRAYS, FIELD_ARRAYS, LEVEL, POINT_ARRAYS, POINTS_ALONE, RADIUS_OF_CURVES, Job,
                      ball_level_radius, check_facts, facts_of_comments)

DIRECTORY = sys.argv[1]
READERS = {".vti": vtkXMLImageDataReader, ".vts": vtkXMLStructuredGridReader, ".vtp": vtkXMLPolyDataReader,
           ".ply": vtkPLYReader, ".stl": vtkSTLReader, ".obj": vtkOBJReader}


def opened(path):
    reader = READERS[os.path.splitext(path)[1]]()
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


def arrays_of(data):
    return {data.GetPointData().GetArrayName(a) for a in range(data.GetPointData().GetNumberOfArrays())}


def values(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def places(data):
    return numpy.array([data.GetPoint(p) for p in range(data.GetNumberOfPoints())])


def contour(data, level):
    contours = vtkContourFilter()
    contours.SetInputData(data)
    contours.SetInputArrayToProcess(0, 0, 0, 0, "E")
    contours.SetValue(0, level)
    contours.Update()
    return contours.GetOutput()


def volume(surface):
    mass = vtkMassProperties()
    mass.SetInputData(surface)
    return mass.GetVolume()


def distances(surface, points):
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(surface)
    return numpy.abs([distance.EvaluateFunction(p) for p in points])


def distances_to_nearest(targets, points):
    data, locator = vtkPolyData(), vtkStaticPointLocator()
    data.SetPoints(vtkPoints())
    for target in targets:
        data.GetPoints().InsertNextPoint(target)
    locator.SetDataSet(data)
    locator.BuildLocator()
    return numpy.array([numpy.linalg.norm(targets[locator.FindClosestPoint(p)] - p) for p in points])


def field_facts(data):
    field, texts = data.GetFieldData(), {}
    for a in range(field.GetNumberOfArrays()):
        array = field.GetAbstractArray(a)
        texts[array.GetName()] = array.GetValue(0)
    return texts


def check_grid(job, extension):
    data = opened(job.path("field." + extension))
    assert arrays_of(data) == FIELD_ARRAYS, arrays_of(data)
    erosion, inside = values(data, "E"), values(data, "inside")
    for name in FIELD_ARRAYS:
        assert numpy.isfinite(values(data, name)).all(), name
    assert inside.sum() == job.points
    assert (erosion[inside == 1] > 0).all() and (erosion[inside == 0] <= 0).all()
    assert numpy.array_equal(values(data, "E_share"), erosion / job.v0)
    assert (values(data, "direction")[inside == 0] == -1).all()
    assert numpy.allclose(numpy.linalg.norm(values(data, "normal")[inside == 1], axis=1), 1)
    check_facts(job, field_facts(data))
    # The text of the same field, point by point.
    rows = numpy.loadtxt(job.path("field.csv"), delimiter=",", skiprows=1)
    found = numpy.column_stack([places(data)[inside == 1], erosion[inside == 1]])
    rows, found = (table[numpy.lexsort(numpy.round(table[:, 2::-1] / job.spacing, 3).T)] for table in (rows[:, :4], found))
    within = {"vti": 1e-9, "vts": 1e-3}[extension]  # steps: structured grids may list their places in single precision
    assert numpy.allclose(rows[:, :3], found[:, :3], rtol=0, atol=within * job.spacing), "places"
    assert numpy.array_equal(rows[:, 3], found[:, 3]), "E"
    return data


def check_contour(job, data):
    """The eroded solid's surface, by a contour that knows nothing of the solid."""
    eroded = opened(job.path("eroded.vtp"))
    found = contour(data, LEVEL * job.v0)
    ratio = volume(found) / job.eroded_volume
    points = places(found)[::5]
    far = distances(eroded, points) / job.step
    # No contour of an image can follow jumps of E: the solid's saddles and hollows, where E has a limit above the level.
    jumps = places(eroded)[numpy.abs(values(eroded, "E") / (LEVEL * job.v0) - 1) > 0.05]
    smooth = far[distances_to_nearest(jumps, points) > 2 * job.step]
    print(f"{job.frame}: contour at 5 % has {ratio:.4f} of the volume, lies within {far.max():.2f} steps, away from jumps of E "
          f"({len(smooth) / len(far):.2f} of its points) within {smooth.max():.2f}")
    assert abs(ratio - 1) < 0.01, ratio
    assert far.max() < 1, far.max()
    assert len(smooth) > len(far) / 4 and numpy.quantile(smooth, 0.999) < 0.25 and smooth.max() < 0.3, smooth.max()
    assert abs(volume(eroded) / job.eroded_volume - 1) < 1e-6


def check_divergence(job, extension):
    data = opened(job.path("divergence." + extension))
    assert arrays_of(data) == DIVERGENCE_ARRAYS, arrays_of(data)
    assert numpy.isfinite(values(data, "H")).all()
    assert values(data, "inside").sum() == job.points
    check_facts(job, field_facts(data))


def check_poly_data(job, kind, arrays):
    data = opened(job.path(kind + ".vtp"))
    curves = data.GetNumberOfLines()
    assert arrays_of(data) == arrays | (RADIUS_OF_CURVES if curves else set()), (kind, arrays_of(data))
    cells = data.GetNumberOfVerts() if kind in POINTS_ALONE else data.GetNumberOfPolys()
    assert cells > 0 and data.GetNumberOfCells() == cells + curves, kind
    assert curves == 0 or kind == "ridge", kind
    comments = data.GetFieldData().GetAbstractArray("comment")
    check_facts(job, facts_of_comments(comments.GetValue(n) for n in range(comments.GetNumberOfValues())))
    if "E" in arrays:
        erosion = values(data, "E")
        assert numpy.isfinite(erosion).all() and (erosion >= 0).all() and erosion.max() <= job.v0, kind
    if kind == "eroded":
        # The level, but where E has a limit above it at the solid's surface, or jumps.
        assert abs(numpy.median(values(data, "E")) / (LEVEL * job.v0) - 1) < 0.01
    if kind in ("alpha", "eroded"):
        assert (values(data, "area") > 0).all(), kind
    return data


def check_thickness(job):
    data = opened(job.path("thickness.vtp"))
    cells = data.GetCellData()
    thickness, part = (vtk_to_numpy(cells.GetArray(name)) for name in ("thickness", "part"))
    # Triangles are cut where parts meet, and stay where they are.
    assert len(thickness) == len(part) == data.GetNumberOfPolys() > job.triangles
    assert abs(volume(data) / job.v0 - 1) < 1e-6
    # Nowhere as thick as the body is deep; a body has two arms, two legs and a head.
    sizes = numpy.diff(numpy.array(data.GetBounds()).reshape(3, 2)).ravel()
    assert (thickness > 0).all() and thickness.max() < sizes.min(), (thickness.max(), sizes)
    assert part.min() == 1 and part.max() >= 5, part.max()


def check_same_shape(job, kind, data):
    # STL has no place for curves.
    extensions = (".ply",) if kind in POINTS_ALONE else (".ply", ".obj", ".stl")
    for extension in extensions[:2] if kind == "ridge" else extensions:
        other = opened(job.path(kind + extension))
        if extension == ".stl":  # whose reader joins corners and drops what single precision makes flat
            assert data.GetNumberOfPolys() >= other.GetNumberOfPolys() > 0.99 * data.GetNumberOfPolys(), kind
        else:
            assert other.GetNumberOfPoints() == data.GetNumberOfPoints(), (kind, extension)
            curves = extension == ".ply" and kind == "ridge"  # as faces
            assert (other.GetNumberOfPolys() > data.GetNumberOfPolys()) if curves else (
                other.GetNumberOfPolys() == data.GetNumberOfPolys()), (kind, extension)
        size = numpy.ptp(numpy.reshape(data.GetBounds(), (3, 2)), axis=1).max()
        assert numpy.allclose(other.GetBounds(), data.GetBounds(), rtol=0, atol=1e-6 * size), (kind, extension)
    if "E" in POINT_ARRAYS[kind]:
        colours = vtk_to_numpy(opened(job.path(kind + ".ply")).GetPointData().GetArray("RGB"))
        assert len(numpy.unique(colours, axis=0)) > 1, kind


def check_ball():
    """Levels of a ball are balls: E's closed form.  The lattice is so coarse that contours pass its last points."""
    with open(os.path.join(DIRECTORY, "ball.json"), encoding="utf-8") as told:
        v0 = json.load(told)["prepared"]["volume"]
    data = opened(os.path.join(DIRECTORY, "ball.vti"))
    for share in (0.03, 0.05, 0.1, 0.2):
        radii = numpy.linalg.norm(places(contour(data, share * v0)), axis=1)
        far = numpy.abs(radii - 3000 * ball_level_radius(share)).max() / 1000
        print(f"ball: contour at {share} within {far:.2f} steps")
        assert far < 0.25, (share, far)


for one in (Job(DIRECTORY, "axis"), Job(DIRECTORY, "affine")):
    for grid in one.grids(("vti", "vts")):
        check_contour(one, check_grid(one, grid))
        check_divergence(one, grid)
    for shape, wanted in POINT_ARRAYS.items():
        check_same_shape(one, shape, check_poly_data(one, shape, wanted))
    check_thickness(one)
assert Job(DIRECTORY, "affine").grids(("vti",)) == []
check_ball()
print("all kinds of files opened")
