"""The files as ParaView opens them by their names, run by its modules for Python.

Usage: paraview_test.py DIRECTORY   (see make_files.py)
"""
import os
import sys

from paraview import servermanager, simple
from vtkmodules.vtkFiltersCore import vtkMassProperties

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from expected import DIVERGENCE_ARRAYS, FIELD_ARRAYS, LEVEL, POINT_ARRAYS, RADIUS_OF_CURVES, Job  # noqa: E402

DIRECTORY = sys.argv[1]


def opened(job, name):
    reader = simple.OpenDataFile(job.path(name))
    assert reader is not None, name
    reader.UpdatePipeline()
    return reader


def arrays_of(source):
    return {array.Name for array in source.PointData}


def volume(source):
    mass = vtkMassProperties()
    mass.SetInputData(servermanager.Fetch(source))
    return mass.GetVolume()


def check_field(job, extension):
    field = opened(job, "field." + extension)
    assert arrays_of(field) == FIELD_ARRAYS, arrays_of(field)
    # VTKHDF says where it lies by a matrix that ParaView 5.11 passes over: in place only where that is no matrix.
    low, high = field.PointData["E_share"].GetRange()
    assert low <= 0 < high < 1, (low, high)
    surface = simple.Contour(Input=field, ContourBy=["POINTS", "E"], Isosurfaces=[LEVEL * job.v0])
    surface.UpdatePipeline()
    if extension == "hdf" and job.frame != "axis":
        return
    ratio = volume(surface) / job.eroded_volume
    print(f"{job.frame} .{extension}: contour at 5 % has {ratio:.4f} of the volume of erode")
    assert abs(ratio - 1) < 0.01, ratio
    check_bounds(surface, opened(job, "eroded.vtp"), job)


def check_bounds(found, wanted, job):
    for a, b in zip(found.GetDataInformation().GetBounds(), wanted.GetDataInformation().GetBounds()):
        assert abs(a - b) < job.step, (found.GetDataInformation().GetBounds(), wanted.GetDataInformation().GetBounds())


def check(job):
    for extension in job.grids(("vti", "vts", "hdf")):
        check_field(job, extension)
        assert arrays_of(opened(job, "divergence." + extension)) == DIVERGENCE_ARRAYS
    for kind, arrays in POINT_ARRAYS.items():
        shape = opened(job, kind + ".vtp")
        assert arrays_of(shape) - RADIUS_OF_CURVES == arrays, (kind, arrays_of(shape))
        assert shape.GetDataInformation().GetNumberOfCells() > 0, kind
        ply = opened(job, kind + ".ply")
        assert ply.GetDataInformation().GetNumberOfPoints() == shape.GetDataInformation().GetNumberOfPoints(), kind
        assert "E" not in arrays or "RGB" in arrays_of(ply), kind
    assert abs(volume(opened(job, "eroded.vtp")) / job.eroded_volume - 1) < 1e-6
    assert abs(volume(opened(job, "mesh.stl")) / job.v0 - 1) < 1e-4
    assert opened(job, "sheet.obj").GetDataInformation().GetNumberOfCells() > 0


check(Job(DIRECTORY, "axis"))
check(Job(DIRECTORY, "affine"))
print("all kinds of files opened")
