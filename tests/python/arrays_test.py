"""What needs no server: messages into arrays, meshes into OFF text, arrays into data sets.

Usage: arrays_test.py PROGRAMS PROJECT"""
import hashlib
import importlib.util
import struct
import sys
import types as modules
import unittest
from fractions import Fraction

import numpy as np

import affskel
from affskel import _arrays, _checks, _meshes, _messages, _session
from affskel.v1 import client_service_pb2 as service
from affskel.v1 import types_pb2 as types

# A lattice of 2 x 3 x 4 points with a shear, six of them inside in three runs.
SHEARED = types.Lattice(origin=[.1, .2, .3], axes=[1, .7, 0, 0, 1.1, .3, .9, 0, 1.3], dims=[2, 3, 4],
                        run_start=[1, 8, 19], run_length=[2, 3, 1])


def lattice_by_hand(lattice):
    """Indices and places by the contract's words, in exact arithmetic but for the roundings that it asks for."""
    for start, length in zip(lattice.run_start, lattice.run_length):
        for index in range(start, start + length):
            i, j, k = index // 12, index // 4 % 3, index % 4
            o, a, b, c = lattice.origin, lattice.axes[:3], lattice.axes[3:6], lattice.axes[6:]
            yield index, [o[n] + (i * a[n] + (j * b[n] + k * c[n])) for n in range(3)]


class Decoding(unittest.TestCase):
    def test_sample_points_are_where_the_contract_says_to_the_last_bit(self):
        lattice = _arrays.lattice_of(SHEARED)
        indices, places = zip(*lattice_by_hand(SHEARED))
        self.assertEqual(lattice.inside.tolist(), list(indices))
        self.assertEqual(lattice.points().tolist(), list(places))
        self.assertEqual(lattice.all_points()[lattice.inside].tolist(), list(places))
        self.assertFalse(lattice.is_axis_parallel)

    def test_the_order_of_additions_matters_here(self):
        lattice = _arrays.lattice_of(SHEARED)
        i, j, k = (index.astype(float)[:, None] for index in np.unravel_index(lattice.inside, lattice.dims))
        a, b, c = lattice.axes
        self.assertFalse((((lattice.origin + i * a) + j * b) + k * c == lattice.points()).all())

    def test_dense_arrays_have_the_values_at_their_indices(self):
        lattice = _arrays.lattice_of(SHEARED)
        dense = lattice.dense(np.arange(6), fill=-1)
        self.assertEqual(dense.shape, (2, 3, 4))
        self.assertEqual(dense.ravel()[lattice.inside].tolist(), list(range(6)))
        self.assertEqual((dense == -1).sum(), 24 - 6)
        self.assertEqual(lattice.dense(lattice.points()).shape, (2, 3, 4, 3))
        # What the other points get is no value of the kind: a mask that is NaN there would be true.
        for values, outside in ((np.ones(6, bool), False), (np.arange(6), -1), (np.arange(6, dtype=np.uint8), 0)):
            grid = lattice.dense(values)
            self.assertEqual(grid.dtype, values.dtype)
            self.assertEqual((grid.ravel() == outside).sum(), 24 - 6 + (values == outside).sum())
        self.assertEqual(np.isnan(lattice.dense(np.ones(6))).sum(), 24 - 6)
        for wrong in (lambda: lattice.dense(np.arange(5)), lambda: lattice.dense(3.0), lambda: lattice.dense(np.arange(6), np.nan)):
            with self.assertRaises(ValueError):
                wrong()

    def test_lattices_that_contradict_themselves_are_refused(self):
        for change in (dict(run_length=[2, 3]), dict(run_length=[8, 3, 1]), dict(run_length=[2, 0, 1]),
                       dict(run_length=[2, 3, 9]), dict(dims=[2, 3]), dict(axes=[1.0]), dict(run_start=[1, 19, 8])):
            message = types.Lattice()
            message.CopyFrom(SHEARED)
            for name, values in change.items():
                message.ClearField(name)
                getattr(message, name).extend(values)
            with self.subTest(change), self.assertRaises(affskel.InternalError):
                _arrays.lattice_of(message)

    def records(self):
        return [(10.0 * p + .1, 3.0 * p, p % 3) for p in range(6)]

    def field(self, records):
        data = b"".join(struct.pack("<ddI", *record) for record in records)
        directions = _arrays.directions_of(types.Directions(xyz=[1, 0, 0, 0, 1, 0, 0, 0, 1]))
        return _arrays.field_of(_arrays.lattice_of(SHEARED), directions, data, 200.0)

    def test_fields_have_each_record_in_its_place(self):
        field = self.field(self.records())
        self.assertEqual(field.E.tolist(), [record[0] for record in self.records()])
        self.assertEqual(field.slope.tolist(), [record[1] for record in self.records()])
        self.assertEqual(field.direction.tolist(), [0, 1, 2, 0, 1, 2])
        self.assertEqual(field.normals.tolist(), np.eye(3)[[0, 1, 2, 0, 1, 2]].tolist())
        self.assertEqual(field.share.tolist(), [record[0] / 200 for record in self.records()])
        self.assertEqual(list(field.table()), ["x", "y", "z", "E", "nx", "ny", "nz", "direction", "slope"])

    def test_refined_fields_have_each_record_in_its_place(self):
        data = b"".join(struct.pack("<5d3I", 10.0 * p + 1, 2.0 * p, 0, 0, 1, p, 0xFFFFFFFF - p % 2, 7) for p in range(6))
        field = _arrays.refined_of(_arrays.lattice_of(SHEARED), data, 200.0)
        self.assertEqual(field.E.tolist(), [10.0 * p + 1 for p in range(6)])
        self.assertEqual(field.slope.tolist(), [2.0 * p for p in range(6)])
        self.assertEqual(field.normals.tolist(), [[0, 0, 1]] * 6)
        self.assertEqual(field.saddles.tolist(), [1, 2] * 3)
        self.assertEqual(list(field.table()), ["x", "y", "z", "E", "nx", "ny", "nz", "slope", "saddles"])
        with self.assertRaisesRegex(affskel.InternalError, "311 bytes for 6 sample points"):
            _arrays.refined_of(_arrays.lattice_of(SHEARED), data[:-1], 200.0)

    def test_fields_that_do_not_fit_are_refused(self):
        with self.assertRaisesRegex(affskel.InternalError, "100 bytes for 6 sample points"):
            self.field(self.records()[:5])
        with self.assertRaisesRegex(affskel.InternalError, "direction 3 of 3"):
            self.field(self.records()[:5] + [(1, 1, 3)])

    def test_points_and_surfaces_that_do_not_fit_are_refused(self):
        with self.assertRaises(affskel.InternalError):
            _arrays.points_of(types.SkeletonPoints(point=[1, 2], xyz=[0] * 6, erosion=[1], normal=[0] * 6,
                                                   direction=[0, 0]))
        for surface in (types.TriangleMesh(xyz=[0] * 9, corners=[0, 1, 3]), types.TriangleMesh(xyz=[0] * 8),
                        types.TriangleMesh(xyz=[0] * 9, corners=[0, 1, 2], erosion=[1, 2]),
                        types.TriangleMesh(xyz=[0] * 9, corners=[0, 1]),
                        types.TriangleMesh(xyz=[0] * 9, segments=[0, 3]), types.TriangleMesh(xyz=[0] * 9, segments=[0])):
            with self.assertRaises(affskel.InternalError):
                _arrays.surface_of(surface)

    def test_curves_are_pairs_of_vertices(self):
        surface = _arrays.surface_of(types.TriangleMesh(xyz=range(12), corners=[0, 1, 2], segments=[2, 3, 3, 0]))
        np.testing.assert_array_equal(surface.segments, [[2, 3], [3, 0]])
        np.testing.assert_array_equal(surface.faces, [[0, 1, 2]])
        self.assertEqual(_arrays.surface_of(types.TriangleMesh(xyz=range(9), corners=[0, 1, 2])).segments.shape, (0, 2))

    def test_messages_become_dictionaries_that_tell_what_is_absent(self):
        quality = _messages.plain(types.SkeletonQuality(points=3, hausdorff_there=0.0))
        self.assertEqual((quality["points"], quality["hausdorff_there"], quality["hausdorff_back"]), (3, 0.0, None))
        job = _messages.plain(types.Job(id="x", state=types.JOB_STATE_FAILED, error=types.JobError(line=7),
                                        done_positions=[types.PositionRange(begin=1, end=3)]))
        self.assertEqual((job["id"], job["state"], job["stage"], job["error"]["line"], job["quality"]),
                         ("x", "failed", "", 7, None))
        self.assertEqual(job["done_positions"], [dict(begin=1, end=3)])

    def test_words_are_those_of_the_command_line(self):
        self.assertEqual(_messages.word(types.JobState, types.JOB_STATE_DONE), "done")
        self.assertEqual(_messages.word(types.Operator, 1), "zucker-hummel")
        self.assertEqual(_messages.word(types.Operator, 0), "")
        self.assertEqual(_messages.value_of_word(types.Operator, "zucker-hummel", "operator"), 1)
        for wrong in ("unspecified", "Flux", "zucker_hummel", ""):
            with self.subTest(wrong), self.assertRaisesRegex(affskel.UsageError, "zucker-hummel, intermediate"):
                _messages.value_of_word(types.Operator, wrong, "operator")


class Stream(list):
    """A stream of FetchArtifactResponse, as gRPC gives it, and whether it was cancelled."""

    cancelled = False

    def cancel(self):
        self.cancelled = True


class Receiving(unittest.TestCase):
    """An artefact is whole and undamaged, or an error."""

    def stream(self, pieces, **changes):
        whole = b"".join(pieces)
        header = dict(bytes=len(whole), sha256=hashlib.sha256(whole).hexdigest())
        first = service.FetchArtifactResponse(header=service.ArtifactHeader(**dict(header, **changes)))
        return Stream([first, *(service.FetchArtifactResponse(data=piece) for piece in pieces)])

    def test_its_pieces_are_joined(self):
        for pieces in ([b"abc", b"", b"de"], []):
            self.assertEqual(_session._received(self.stream(pieces))[1], b"".join(pieces))

    def test_anything_else_is_refused(self):
        good = self.stream([b"abc", b"de"])
        for stream, words in (
            (self.stream([b"abc"], bytes=4), "cut short: 3 of 4 bytes"),
            (self.stream([b"abc", b"d"], bytes=3), "more than its 3 bytes"),
            (self.stream([b"abc"], sha256="0" * 64), "damaged on its way"),
            (Stream(good[1:]), "out of order"),
            (Stream([good[0], good[0]]), "out of order"),
            (Stream(), "sent no artefact"),
        ):
            with self.subTest(words), self.assertRaisesRegex(affskel.InternalError, words):
                _session._received(stream)


VERTICES = [[0, 0, 0], [1 / 3, 0, 0], [0, 1e-300, 0], [0, 0, 1e300]]
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def parse_off(text):
    """OFF text as exact numbers and tuples."""
    lines = text.decode().split("\n")
    assert lines[0] == "OFF" and lines[-1] == ""
    n, m, _ = map(int, lines[1].split())
    vertices = [tuple(Fraction(float(number)) for number in line.split()) for line in lines[2:2 + n]]
    faces = [tuple(map(int, line.split())) for line in lines[2 + n:-1]]
    assert len(faces) == m and all(face[0] == len(face) - 1 for face in faces)
    return vertices, [face[1:] for face in faces]


class Meshes(unittest.TestCase):
    def off(self, mesh):
        given = _meshes.mesh_of(mesh)
        self.assertEqual((given.name, given.file), ("mesh", ""))
        return parse_off(given.text)

    def test_all_kinds_of_meshes_give_the_same_text(self):
        wanted = ([tuple(map(Fraction, vertex)) for vertex in VERTICES], [tuple(face) for face in FACES])
        v, f = np.array(VERTICES), np.array(FACES)
        padded = np.hstack([np.full((4, 1), 3), f]).ravel()
        for mesh in ((VERTICES, FACES), (v, f), [v, f.astype(np.uint32)], (v, [np.array(face) for face in FACES]),
                     modules.SimpleNamespace(vertices=v, faces=f), modules.SimpleNamespace(points=v, faces=padded)):
            self.assertEqual(self.off(mesh), wanted)

    def test_polygons_keep_their_order_and_corners(self):
        points = np.arange(18.0).reshape(6, 3)
        polygons = [(0, 1, 2), (0, 1, 2, 3), (5, 4, 3, 2), (0, 4, 5), (0, 1, 2, 3, 4)]
        padded = np.concatenate([[len(face), *face] for face in polygons])
        for mesh in ((points, polygons), modules.SimpleNamespace(points=points, faces=padded)):
            self.assertEqual(self.off(mesh)[1], polygons)

    def test_polygons_of_vtk_keep_their_order_and_corners(self):
        data = self.vtk_mesh([(0, 1, 2), (0, 1, 2, 3), (0, 4, 5)])
        vertices, faces = self.off(data)
        self.assertEqual((len(vertices), faces), (6, [(0, 1, 2), (0, 1, 2, 3), (0, 4, 5)]))
        data.SetLines(data.GetPolys())
        with self.assertRaisesRegex(affskel.BadInputError, "3 lines beside its polygons"):
            _meshes.mesh_of(data)

    def vtk_mesh(self, polygons):
        try:
            from vtkmodules.vtkCommonCore import vtkPoints
            from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
        except ImportError:
            self.skipTest("no python3-vtk9")
        data, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
        for number in range(6):
            points.InsertNextPoint(number, number * number, 1)
        for polygon in polygons:
            cells.InsertNextCell(len(polygon))
            for corner in polygon:
                cells.InsertCellPoint(corner)
        data.SetPoints(points)
        data.SetPolys(cells)
        return data

    def test_what_is_no_mesh_is_refused_with_the_place(self):
        good = np.array(VERTICES)
        bad = good.copy()
        bad[2, 1] = np.inf
        for mesh, words in (
            ((bad, FACES), "vertex 2 is not finite"),
            ((good[:, :2], FACES), r"vertices have the shape \(4, 2\)"),
            ((good, [[0, 1, 2], [0, 1, 4]]), r"face 1 has the vertices \[0, 1, 4\]; there are 4, counted from 0"),
            ((good, np.array([[0, 1, 2], [0, 1, -1]])), "face 1 has the vertices"),
            ((good, [[0, 1, 2], [0, 1]]), "face 1 has the shape"),
            ((good, np.array(FACES, float)), "faces must be whole numbers, not float64"),
            ((good, np.array([0, 1, 2])), r"faces have the shape \(3,\)"),
            ((["a", "b"], FACES), "vertices are no numbers"),
            (modules.SimpleNamespace(points=good, faces=np.array([3, 0, 1, 2, 4, 0])), r"faces\[4\] = 4 is no number"),
            (modules.SimpleNamespace(points=good, faces=np.array([2, 0, 1])), r"faces\[0\] = 2 is no number"),
            (7, "^int is no mesh"),
            ((good, np.zeros((0, 3), dtype=int)), "has no faces"),
        ):
            with self.subTest(words), self.assertRaisesRegex(affskel.BadInputError, words):
                _meshes.mesh_of(mesh)

    def test_complex_vertices_and_bytes_that_are_no_off_are_refused(self):
        with self.assertRaisesRegex(affskel.BadInputError, "complex"):
            _meshes.mesh_of(([[0, 0, 0], [1, 0, 0], [0, 1j, 0]], [[0, 1, 2]]))
        for wrong in (b"/tmp/body.off", b"ply\nformat ascii 1.0\n", b"nOFF\n3 8 6 0", b"4nOFF\n8 6 0"):
            with self.assertRaisesRegex(affskel.BadInputError, "does not begin with OFF"):
                _checks.require_off(wrong)
        with self.assertRaisesRegex(affskel.BadInputError, "ends before"):
            _checks.require_off(b"OFF\n")
        for empty, what in ((b"OFF\n0 6 0", "no points"), (b"COFF # 8\r\n8 # 6\n0 0", "no faces")):
            with self.assertRaisesRegex(affskel.BadInputError, what):
                _checks.require_off(empty)
        for right in (b"OFF\n1 2 3", b"# a cube\nOFF 8 6 0", b"COFF\n8 6 0", b"STCN4OFF BINARY\n\0\1",
                      b"\xef\xbb\xbfOFF\n8 6 0", b"OFF\r# a cube\r8 6 0\r", b"OFF # a cube\r\n8 6 0\r\n"):
            _checks.require_off(right)

    def test_an_empty_eroded_surface_has_its_attributes(self):
        empty = _arrays.surface_of(types.TriangleMesh(), ("E", "area"))
        self.assertEqual({name: len(array) for name, array in empty.attributes.items()}, {"E": 0, "area": 0})
        self.assertEqual(_arrays.surface_of(types.TriangleMesh()).attributes, {})

    def test_a_file_that_is_not_there_is_pythons_own_error(self):
        for name in ("/nowhere/body.off", "/nowhere/body.ply"):
            with self.assertRaises(FileNotFoundError):
                _meshes.mesh_of(name)


class Errors(unittest.TestCase):
    def test_they_name_place_and_code(self):
        error = affskel.BadInputError("no face", file="a.off", line=7)
        self.assertEqual((str(error), error.code, error.exit_code), ("a.off:7: no face", "BAD_INPUT", 3))
        self.assertIsInstance(error, ValueError)
        self.assertEqual(str(affskel.TimedOutError("late")), "late")
        self.assertIsInstance(affskel.TimedOutError("late"), TimeoutError)
        self.assertIsInstance(affskel.TimedOutError("late"), affskel.UnreachableError)


class FakeTrimesh(modules.ModuleType):
    """A stand-in: trimesh is no package of Debian 12.  It takes what Trimesh's constructor does, and copies nothing."""

    class Trimesh:
        def __init__(self, vertices=None, faces=None, *, process=True, vertex_attributes=None):
            self.vertices, self.faces = vertices, faces
            self.process, self.vertex_attributes = process, vertex_attributes


class Trimesh(unittest.TestCase):
    def setUp(self):
        try:
            importlib.import_module("trimesh")  # the real one where it is installed
        except ImportError:
            sys.modules["trimesh"] = FakeTrimesh("trimesh")
            self.addCleanup(sys.modules.pop, "trimesh")

    def test_vertices_faces_and_attributes_are_kept_and_come_back_as_a_mesh(self):
        vertices, faces = np.array(VERTICES), np.array(FACES)
        surface = _arrays.Surface(vertices, faces, {"E": np.arange(4.0)})
        mesh = surface.to_trimesh()
        self.assertTrue((np.asarray(mesh.vertices) == vertices).all())
        self.assertTrue((np.asarray(mesh.faces) == faces).all())
        self.assertEqual(np.asarray(mesh.vertex_attributes["E"]).tolist(), [0, 1, 2, 3])
        self.assertEqual(_meshes.mesh_of(mesh).text, _meshes.mesh_of((vertices, faces)).text)


class Pyvista(unittest.TestCase):
    """Where pyvista is installed, its `wrap` makes its objects of VTK's.  A stand-in: Debian 12 has no pyvista."""

    def setUp(self):
        if importlib.util.find_spec("vtkmodules") is None:
            self.skipTest("no python3-vtk9")
        pyvista = modules.ModuleType("pyvista")
        pyvista.wrap = lambda dataset: ("wrapped", dataset)
        self.addCleanup(sys.modules.pop, "pyvista")
        sys.modules["pyvista"] = pyvista

    def test_data_sets_are_wrapped(self):
        word, dataset = _arrays.Surface(np.array(VERTICES), np.array(FACES)).to_pyvista()
        self.assertEqual((word, dataset.GetNumberOfPolys()), ("wrapped", 4))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
