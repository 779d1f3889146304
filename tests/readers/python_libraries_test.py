"""The files as the Python libraries of other fields find them: meshio, Open3D and h5py.

Usage: python_libraries_test.py DIRECTORY   (see make_files.py)
"""
import importlib.util
import sys

from expected import FACTS, FIELD_ARRAYS, POINT_ARRAYS, POINTS_ALONE, Job, check_facts

DIRECTORY = sys.argv[1]
JOBS = (Job(DIRECTORY, "axis"), Job(DIRECTORY, "affine"))
SURFACES = [kind for kind in POINT_ARRAYS if kind not in POINTS_ALONE]


def table_of(path):
    import numpy

    return numpy.genfromtxt(path, delimiter=",", names=True)


def triangles_of(faces):
    """The curves of ridge are faces in a PLY file, with their second end twice."""
    return (faces[:, 1] != faces[:, 2]).sum()


def check_meshio():
    import meshio
    import numpy

    for job in JOBS:
        for kind, arrays in POINT_ARRAYS.items():
            if "E" not in arrays:
                continue
            found = meshio.read(job.path(kind + ".ply"))
            erosion = found.point_data["E"]
            assert numpy.array_equal(found.point_data["quality"], erosion.astype(numpy.float32)), kind
            assert erosion.max() > erosion.min() and {"red", "green", "blue"} <= found.point_data.keys(), kind
        for kind in SURFACES:
            shapes = [meshio.read(job.path(kind + extension)) for extension in (".ply", ".obj", ".off")]
            counts = {triangles_of(shape.cells_dict["triangle"]) for shape in shapes}
            assert len(counts) == 1, (kind, counts)
            triangles, stl = counts.pop(), meshio.read(job.path(kind + ".stl")).cells_dict["triangle"]
            assert triangles >= len(stl) > 0.99 * triangles > 0, (kind, triangles, len(stl))
        rows, skeleton = table_of(job.path("skeleton.csv")), meshio.read(job.path("skeleton.ply"))
        assert numpy.array_equal(rows["E"], skeleton.point_data["E"])
        assert numpy.array_equal(rows["x"], skeleton.points[:, 0])


def check_open3d():
    import numpy
    import open3d

    for job in JOBS:
        for kind in POINTS_ALONE:
            cloud = open3d.io.read_point_cloud(job.path(kind + ".ply"))
            assert cloud.has_colors() and cloud.has_normals(), kind
            assert len(numpy.unique(numpy.asarray(cloud.colors), axis=0)) > 1, kind
        for kind in SURFACES:
            mesh = open3d.io.read_triangle_mesh(job.path(kind + ".ply"))
            assert len(mesh.triangles) > 0 and mesh.has_vertex_colors() == ("E" in POINT_ARRAYS[kind]), kind
            triangles = triangles_of(numpy.asarray(mesh.triangles))
            for extension in (".obj", ".off"):
                assert len(open3d.io.read_triangle_mesh(job.path(kind + extension)).triangles) == triangles, kind


def check_h5py():
    import h5py
    import numpy

    for job in JOBS:
        with h5py.File(job.path("field.hdf")) as file, h5py.File(job.path("field.vtkhdf")) as other:
            group = file["VTKHDF"]
            assert set(group["PointData"]) == FIELD_ARRAYS
            erosion, inside = group["PointData/E"][:], group["PointData/inside"][:]
            assert numpy.isfinite(erosion).all() and inside.sum() == job.points
            assert numpy.array_equal(erosion, other["VTKHDF/PointData/E"][:])
            rows = table_of(job.path("field.csv"))
            assert numpy.array_equal(numpy.sort(erosion[inside == 1]), numpy.sort(rows["E"]))
            texts = {}
            for key in FACTS:
                value = group.attrs[key]
                texts[key] = value.decode() if isinstance(value, bytes) else numpy.ravel(value)[0]
            check_facts(job, texts)


missing = []
for library, run in (("meshio", check_meshio), ("open3d", check_open3d), ("h5py", check_h5py)):
    if importlib.util.find_spec(library) is None:
        missing.append(library)
    else:
        run()
        print(library + ": all kinds of files opened")
if missing:
    print("SKIPPED: no " + ", ".join("python3-" + one for one in missing) + "; deploy/run-tests --all installs them")
    sys.exit(77)
