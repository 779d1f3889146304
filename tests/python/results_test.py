"""Every result as arrays, against the files of affskel-client, closed forms and VTK.

Usage: results_test.py PROGRAMS PROJECT"""
import importlib.util
import json
import sys
import unittest
import warnings

import numpy as np

import affskel

from lab import assert_same, serve_module

try:
    import vtkmodules
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError:
    vtkmodules = None


def setUpModule():
    global directory, client, body, sheared, box
    directory, _, client = serve_module()
    # The body, in its own axes and in a sheared lattice; a bar whose field is known.
    body = client.submit(directory.make("body", "--triangles", 500), spacing=300).wait()
    sheared = client.submit(directory / "body.off", points=2000, frame="affine", operator="chords").wait()
    box = client.submit(directory.make("box", "--size", "40,6,4"), spacing=.5).wait()


KINDS = {"double": "<f8", "int": "<i4", "uint": "<u4", "float": "<f4", "uchar": "u1"}
# What PLY repeats for people, and what it derives of curves.
SHOWN = ("quality", "red", "green", "blue", "radius")


def read_ply(file):
    """Vertices by property, triangles, and segments, of a binary PLY of affskel-client: the last faces, each with its
    second end twice."""
    header, _, rest = file.read_bytes().partition(b"end_header\n")
    elements, curves = {}, 0
    for words in (line.split() for line in header.decode().split("\n")):
        if words[:1] == ["element"]:
            count, properties = int(words[2]), []
            elements[words[1]] = (count, properties)
        elif words[:2] == ["comment", "curves"]:
            curves = int(words[2])
        elif words[:1] == ["property"]:
            properties.extend([("corners", "u1"), (words[-1], "<i4", 3)] if words[1] == "list"
                              else [(words[2], KINDS[words[1]])])
    arrays = {}
    for name, (count, properties) in elements.items():
        arrays[name] = np.frombuffer(rest, np.dtype(properties), count)
        rest = rest[arrays[name].nbytes:]
    assert not rest and (arrays["face"]["corners"] == 3).all()
    faces = arrays["face"]["vertex_indices"]
    segments = faces[len(faces) - curves:]
    assert (segments[:, 1] == segments[:, 2]).all()
    return arrays["vertex"], faces[:len(faces) - curves], segments[:, :2]


def columns_of(vertices):
    return [name for name in vertices.dtype.names if name not in SHOWN]


def enclosed_volume(surface):
    """By the divergence theorem."""
    a, b, c = (surface.vertices[surface.faces[:, corner]] for corner in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


class AgainstTheFiles(unittest.TestCase):
    def assert_same_columns(self, table, columns):
        self.assertEqual(set(columns) - set(table), set())
        for name, values in columns.items():
            assert_same(table[name], values, name)

    def test_the_field_is_that_of_the_csv_to_the_last_bit(self):
        for job in (body, sheared):
            directory.client("fetch", job.id, "field", "-o", directory / "field.csv")
            field = job.field()
            self.assert_same_columns(field.table(), directory.rows("field.csv"))
            self.assertGreater(len(field), 1000)
            assert_same(field.normals, field.directions[field.direction])
            self.assertEqual(job.status().points, len(field))
            self.assertEqual(job.status().volume, field.volume)

    def test_the_infimum_is_that_of_the_csv_and_not_above_the_set(self):
        job = client.submit(directory / "body.off", spacing=600, minimum="infimum").wait()
        directory.client("fetch", job.id, "field", "-o", directory / "field.csv")
        field = job.field()
        self.assertTrue(field.is_infimum)
        self.assert_same_columns(field.table(), directory.rows("field.csv"))
        self.assertIn("saddles", field.table())
        least = client.submit(directory / "body.off", spacing=600).wait().field()
        self.assertTrue((field.E <= least.E * (1 + 1e-9)).all())
        self.assertLess(np.median(field.E / least.E), .999)
        np.testing.assert_allclose(np.linalg.norm(field.normals, axis=1), 1, rtol=1e-12)
        self.assertEqual(set(field.saddles.tolist()), {0, 1, 2})
        self.assertEqual(len(job.skeleton_points().direction), 0)
        self.assertGreater(len(job.skeleton()), 10)
        barrier = job.skeleton("chords", barrier=True).attributes["barrier"]
        self.assertEqual((np.sum(barrier == 0) > 9, np.sum(barrier > .05) > 9, np.sum(barrier < 0)), (True, True, 0))
        self.assertGreater(job.status().refine_round, 1)

    def test_skeleton_points_are_those_of_the_csv(self):
        for job, options in ((body, {}), (body, dict(threshold=9)), (body, dict(operator="zucker-hummel")),
                             (body, dict(operator="sobel", threshold=20)),
                             (body, dict(operator="chords", threshold=.01)), (sheared, {})):
            with self.subTest(options):
                arguments = [part for name, value in options.items() for part in (f"--{name}", value)]
                directory.client("skeleton", job.id, *arguments, "-o", directory / "skeleton.csv")
                points = job.skeleton_points(**options)
                self.assert_same_columns(points.table(), directory.rows("skeleton.csv"))
                self.assertEqual(points.quality["points"], len(points))

    def test_the_sheet_of_chords_is_that_of_the_ply_with_its_attributes(self):
        for job in (body, sheared):
            directory.client("surface", job.id, "--operator", "chords", "-o", directory / "sheet.ply")
            vertices, faces, _ = read_ply(directory / "sheet.ply")
            sheet = job.skeleton(operator="chords")
            assert_same(sheet.faces, faces)
            self.assertEqual(list(sheet.table()), columns_of(vertices))
            for name, values in sheet.table().items():
                assert_same(values, vertices[name], name)
            self.assertGreater(len(sheet), 100)
            self.assertEqual(sheet.quality["points"], len(sheet.vertices))

    def test_barriers_are_those_of_the_ply_and_cut_the_sheet(self):
        directory.client("surface", body.id, "--operator", "ridge", "--barrier", "-o", directory / "sheet.ply")
        vertices, _, _ = read_ply(directory / "sheet.ply")
        sheet = body.skeleton("ridge", barrier=True)
        self.assertEqual(list(sheet.table()), columns_of(vertices))
        assert_same(sheet.attributes["barrier"], vertices["barrier"])
        least = float(np.quantile(sheet.attributes["barrier"], .9))
        cut = body.skeleton("ridge", min_barrier=least)
        self.assertTrue((cut.attributes["barrier"] >= least).all())
        kept = (sheet.attributes["barrier"][sheet.faces] >= least).all(axis=1)
        self.assertEqual(len(cut), kept.sum())
        self.assertGreater(len(cut), 0)

    def test_other_surfaces_are_those_of_the_ply(self):
        published = dict(operator="zucker-hummel")
        for options in ({}, dict(operator="sobel", threshold=20), dict(published, threshold=9, alpha=1e6),
                        dict(published, alpha=2e5)):
            with self.subTest(options):
                arguments = [part for name, value in options.items() for part in (f"--{name}", value)]
                directory.client("surface", body.id, *arguments, "-o", directory / "surface.ply")
                vertices, faces, segments = read_ply(directory / "surface.ply")
                surface = body.skeleton(**options)
                assert_same(surface.faces, faces)
                assert_same(surface.segments, segments)
                assert_same(surface.vertices, np.column_stack([vertices[name] for name in "xyz"]))
                self.assertEqual(len(segments) > 0, not options, "the ridge has curves")

    def test_measures_are_those_of_the_command_line(self):
        for job, threshold in ((body, None), (body, 3), (sheared, None)):
            options = [] if threshold is None else ["--threshold", threshold]
            directory.client("measure", job.id, *options, "-o", directory / "limbs.json")
            file = json.loads((directory / "limbs.json").read_text())
            measures = job.measures(threshold)
            table = measures.table()
            self.assertEqual([part["kind"] for part in file["parts"]], list(table["kind"]))
            for name, column in (("length_units", "length"), ("volume_units3", "volume"), ("angle_degrees", "angle"),
                                 ("angle_to_part", "angle_to"),
                                 ("surface_area_units2", "surface_area"), ("mean_radius_units", "mean_radius"),
                                 ("to_x", "to_x"), ("from_z", "from_z"),
                                 ("straightness", "straightness")):
                expected = [np.nan if part[name] is None else part[name] for part in file["parts"]]
                np.testing.assert_array_equal(table[column], expected, name)
            whole = measures.whole
            self.assertAlmostEqual(whole["volume"] / file["whole"]["volume_units3"], 1, 12)
            self.assertAlmostEqual(measures.numbers["surface_area"].sum() / whole["surface_area"], 1, 12)
            self.assertEqual(whole["greatest_E"], file["whole"]["greatest_E_units3"])
            self.assertEqual([whole[name] for name in ("pieces", "tunnels", "voids")], [1, 0, 0])
            self.assertEqual([file["whole"][name] for name in ("pieces", "tunnels", "voids")], [1, 0, 0])

    def test_parts_are_those_of_the_files(self):
        measures = body.measures()
        directory.client("fetch", body.id, "field", "--parts", "-o", directory / "field.csv")
        assert_same(measures.point_part, np.array(directory.rows("field.csv")["part"], np.int64))
        field = body.field()
        self.assertEqual(field.E.max(), measures.whole["greatest_E"])
        # As many sample points as its vertices have, and as its share of the volume, but for half the slice of one vertex
        # wherever it begins.
        counted = np.bincount(measures.point_part, minlength=len(measures) + 1)[1:] / len(field)
        part, share = (measures.curve.attributes[name] for name in ("part", "share"))
        np.testing.assert_allclose(np.bincount(part, share, len(measures) + 1)[1:], counted, rtol=0, atol=1e-9)
        slices = np.zeros(len(measures) + 1)
        for ends in measures.curve.segments:
            if part[ends[0]] != part[ends[1]]:
                slices[part[ends]] += share[ends].max() / 2
        self.assertTrue((np.abs(counted - measures.numbers["volume_share"]) <= slices[1:] + 1e-9).all())
        self.assertAlmostEqual(measures.numbers["volume_share"].sum(), 1, 12)
        self.assertEqual(len(measures.triangle_part), len(measures.surface))
        self.assertTrue((measures.thickness > 0).all())
        sheet = body.skeleton("ridge")
        self.assertEqual(set(sheet.attributes["part"]) - set(range(1, len(measures) + 1)), set())
        # A body has two legs, and each hangs on where the trunk ends.
        legs = np.flatnonzero(measures.ends[:, 2] < np.ptp(field.points[:, 2]) / 8)
        self.assertEqual(len(legs), 2)
        for leg in legs:
            self.assertAlmostEqual(measures.numbers["volume_share"][leg], .16, delta=.04)
            np.testing.assert_array_equal(measures.curve.vertices[measures.branches[leg][-1]], measures.ends[leg])

    def test_measures_are_a_graph_of_networkx(self):
        measures = body.measures()
        try:
            import networkx
        except ImportError:
            self.skipTest("no python3-networkx")
        graph = measures.graph()
        self.assertTrue(networkx.is_connected(graph))
        self.assertEqual(graph.number_of_edges(), len(measures))
        self.assertEqual({data["part"] for _, _, data in graph.edges(data=True)}, set(range(1, len(measures) + 1)))
        for start, end, data in graph.edges(data=True):
            ends = {tuple(data["polyline"][0]), tuple(data["polyline"][-1])}
            self.assertEqual(ends, {graph.nodes[start]["place"], graph.nodes[end]["place"]})
            self.assertGreaterEqual(data["length"], data["straight_length"] * (1 - 1e-12))

    def test_the_jobs_own_operator_holds_unless_another_is_named(self):
        assert_same(sheared.skeleton().vertices, sheared.skeleton("chords").vertices)
        few, many = sheared.skeleton(threshold=.2), sheared.skeleton(threshold=1e-9)
        self.assertLess(len(few), len(many))
        self.assertIn("strength", few.attributes)

    def test_the_divergence_is_what_the_threshold_is_applied_to(self):
        divergence, points = body.divergence(), body.skeleton_points("zucker-hummel")
        kept = np.abs(divergence) > 7
        assert_same(divergence[kept], points.H)
        assert_same(body.field().points[kept], points.points)
        directory.client("fetch", body.id, "divergence", "--operator", "sobel", "-o", directory / "H.csv")
        assert_same(body.divergence("sobel"), directory.rows("H.csv")["H"])

    def test_the_mesh_is_what_was_submitted(self):
        self.assertTrue(body.mesh() == (directory / "body.off").read_bytes())

    def test_the_view_is_the_page_of_the_command_line(self):
        for options in ((), ("--operator", "chords", "--threshold", "0.01")):
            directory.client("view", body.id, *options, "-o", directory / "page.html")
            view = body.view(*(["chords", .01] if options else []))
            self.assertTrue(view.page == (directory / "page.html").read_text(encoding="utf-8"))
        self.assertTrue(view.save(directory / "copy.html").read_text(encoding="utf-8") == view.page)


class ClosedForms(unittest.TestCase):
    def test_in_a_bar_the_field_is_area_times_distance(self):
        """With the six normals of a box's faces the chords of x are the slabs between x and a face."""
        field, edges = box.field(), np.array([40.0, 6.0, 4.0])
        areas = edges.prod() / edges
        slabs = np.concatenate([field.points * areas, (edges - field.points) * areas], axis=1)
        nearest = slabs.argmin(axis=1)
        np.testing.assert_allclose(field.E, slabs.min(axis=1), rtol=1e-12)
        clear = np.sort(slabs, axis=1)[:, 1] - slabs.min(axis=1) > 1e-6
        self.assertGreater(clear.sum(), 1000)
        np.testing.assert_allclose(field.slope[clear], areas[nearest[clear] % 3], rtol=1e-12)
        inward = np.concatenate([np.eye(3), -np.eye(3)])
        np.testing.assert_allclose(field.normals[clear], inward[nearest[clear]], atol=1e-12)
        self.assertEqual(field.volume, 960)
        self.assertEqual(len(field), 80 * 12 * 8)

    def test_the_gradient_is_slope_times_normal(self):
        """To first order in the spacing, where a point and its neighbours have the same optimal direction."""
        field = body.field()
        E, direction = (field.lattice.dense(values, -1) for values in (field.E, field.direction))
        gradient = field.lattice.dense(field.slope[:, None] * field.normals, 0)
        places = field.lattice.all_points().reshape(*field.lattice.dims, 3)
        errors = []
        for axis in range(3):
            here, after = (np.delete(values, gone, axis) for values in (direction, ) for gone in (-1, 0))
            same = (here >= 0) & (here == after)
            rise, step = (np.diff(values, axis=axis)[same] for values in (E, places))
            means = (np.delete(gradient, -1, axis) + np.delete(gradient, 0, axis))[same] / 2
            expected = np.einsum("ij,ij->i", means, step)
            errors += list(np.abs(rise - expected) / (np.linalg.norm(means, axis=1) * np.linalg.norm(step, axis=1)))
        self.assertGreater(len(errors), 300)
        self.assertLess(np.median(errors), .02)

    def test_eroded_points_are_those_at_or_above_the_level(self):
        field = body.field()
        for options, level in ((dict(fraction=.05), .05 * field.volume), (dict(volume=2e9), 2e9)):
            points = body.eroded_points(**options)
            assert_same(points.E, field.E[field.E >= level])
            assert_same(points.points, field.points[field.E >= level])
            self.assertNotIn("H", points.table())

    def test_the_eroded_surface_is_closed_and_encloses_its_volume(self):
        surface = body.eroded(fraction=.05)
        edges = np.concatenate([surface.faces[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
        there, back = ({tuple(edge) for edge in edges[:, order].tolist()} for order in ([0, 1], [1, 0]))
        self.assertEqual(len(there), len(edges))
        self.assertEqual(there ^ back, set())
        self.assertAlmostEqual(enclosed_volume(surface) / surface.volume, 1, places=9)
        share = surface.volume / body.field().volume
        self.assertAlmostEqual(share, len(body.eroded_points(fraction=.05)) / len(body.field()), delta=.02)

    def test_what_is_empty_says_why(self):
        for empty in (lambda: body.eroded(fraction=.9), lambda: body.eroded_points(fraction=.9)):
            with self.assertWarnsRegex(affskel.AffskelWarning, "no sample point reaches the level"):
                self.assertEqual(len(empty()), 0)
        with self.assertWarnsRegex(affskel.AffskelWarning, "skeleton of job .* is empty: "):
            self.assertEqual(len(body.skeleton_points("zucker-hummel", threshold=1e6)), 0)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            body.skeleton()
            body.measures()

    def test_a_skeleton_that_is_a_point_is_not_empty(self):
        ball = client.submit(directory.make("sphere"), points=2000).wait()
        for ask in (ball.skeleton, ball.skeleton_points, ball.measures, lambda: ball.skeleton("curve")):
            with self.assertWarnsRegex(affskel.AffskelWarning, "the skeleton of job .*: it is hardly more than a point"):
                result = ask()
            if isinstance(result, affskel.Surface):
                self.assertEqual(result.vertices.shape, (1, 3))

    def test_no_level_is_above_the_volume(self):
        with self.assertRaisesRegex(affskel.UsageError, "below the solid's volume v0"):
            box.eroded(volume=1000)


class ForPeople(unittest.TestCase):
    def test_results_are_saved_as_the_command_line_writes_them(self):
        for result, command, extensions in (
                (body.field(), ["fetch", "{}", "field"], (".vti", ".csv")),
                (body.skeleton(), ["skeleton", "{}"], (".vtp", ".ply", ".stl", ".csv")),
                (body.skeleton("chords", .01, barrier=True), ["skeleton", "{}", "--operator", "chords", "--threshold", .01,
                                                              "--barrier"], (".ply",)),
                (body.skeleton_points("sobel"), ["skeleton", "{}", "--operator", "sobel"], (".csv",)),
                (body.eroded(fraction=.05), ["erode", "{}", "--fraction", .05], (".off",)),
                (body.eroded_points(volume=2e9), ["erode", "{}", "--volume", 2e9, "--as", "points"], (".xyz",)),
                (body.measures(3), ["measure", "{}", "--threshold", 3], (".json", ".csv"))):
            for extension in extensions:
                theirs, ours = directory / f"theirs{extension}", directory / f"ours{extension}"
                directory.client(*[str(word).format(body.id) for word in command], "-o", theirs)
                self.assertEqual(result.save(ours), ours)
                self.assertTrue(ours.read_bytes() == theirs.read_bytes(), (command, extension))
        with self.assertRaisesRegex(affskel.UsageError, r"'\.foo'; possible are"):
            body.field().save(directory / "field.foo")
        with self.assertRaisesRegex(affskel.UsageError, "does not come from a job"):
            affskel.Surface(np.zeros((0, 3)), np.zeros((0, 3), int)).save(directory / "s.vtp")

    def test_every_result_is_told_in_a_line(self):
        for result, words in ((body, f"<affskel.Job {body.id[:12]} 'body', done>"), (body.field(), "of [0-9]+ points, 500 dir"),
                              (body.lattice(), "[0-9]+ x [0-9]+ x [0-9]+, [0-9]+ points inside"),
                              (body.skeleton(), "triangles, [0-9]+ segments with E, "), (body.measures(), "of [0-9]+ parts, vol"),
                              (body.skeleton_points(), "Points, [0-9]+ with E, normal, direction, H")):
            self.assertRegex(repr(result), words)
            self.assertLess(len(repr(result)), 160)

    def test_status_has_report_and_warnings_of_the_command_line(self):
        coarse = client.submit(directory / "body.off", points=400, operator="zucker-hummel", threshold=14).wait()
        server_said = directory.client_notes("watch", coarse.id)
        warnings_said = [line[9:] for line in server_said.splitlines() if line.startswith("warning: ")]
        ours = coarse.status().warnings
        self.assertEqual(len(ours), len(warnings_said), (ours, warnings_said))
        for one, theirs in zip(ours, warnings_said):
            self.assertEqual(one.split(";")[0], theirs.split(";")[0])
        self.assertEqual(body.status().quality["components"], 1)
        self.assertIsNone(body.status().remaining)

    def test_the_module_shows_what_is_public_and_documents_it(self):
        self.assertEqual(set(dir(affskel)), {*affskel.__all__, "__doc__", "__version__"})
        for name in affskel.__all__:
            self.assertGreater(len(getattr(affskel, name).__doc__ or ""), 20, name)
        for function in (affskel.submit, affskel.jobs):
            self.assertIn("Args:", function.__doc__)
            self.assertIn(">>> ", function.__doc__)

    @unittest.skipIf(importlib.util.find_spec("matplotlib") is None, "no python3-matplotlib")
    def test_plots_have_the_triangles_and_the_places(self):
        import matplotlib
        matplotlib.use("Agg")
        sheet = body.skeleton()
        axes = sheet.plot()
        triangles, lines = axes.collections
        self.assertEqual(len(triangles.get_array()), len(sheet))
        self.assertEqual(len(lines._segments3d), len(sheet.segments))
        assert_same(np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()]).T,
                    np.array([sheet.vertices.min(axis=0), sheet.vertices.max(axis=0)]))
        axes.figure.savefig(directory / "sheet.png")
        image, = body.field().plot().images
        field = body.field()
        self.assertEqual(np.nanmax(image.get_array()), field.E.max())
        # The middle of the pixel with the greatest E is the place of that point.
        shown = image.axes.get_xlabel()[0], image.axes.get_ylabel()[0]
        left, right, low, high = image.get_extent()
        rows, columns = image.get_array().shape
        row, column = np.unravel_index(np.nanargmax(image.get_array()), (rows, columns))
        place = left + (column + .5) * (right - left) / columns, low + (row + .5) * (high - low) / rows
        np.testing.assert_allclose(place, [field.points[np.argmax(field.E)]["xyz".index(axis)] for axis in shown])
        curve = body.skeleton("curve")
        self.assertEqual(len(curve.plot().collections), 1)
        self.assertEqual((bool(curve), len(curve), len(curve.faces)), (True, len(curve.segments), 0))


@unittest.skipIf(vtkmodules is None, "no python3-vtk9")
class DataSets(unittest.TestCase):
    def arrays(self, dataset):
        data = dataset.GetPointData()
        return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}

    def test_the_field_stands_at_its_places(self):
        for job, kind in ((body, "vtkImageData"), (sheared, "vtkStructuredGrid")):
            field = job.field()
            dataset = field.to_pyvista()
            self.assertTrue(dataset.IsA(kind), type(dataset))
            arrays = self.arrays(dataset)
            inside = np.flatnonzero(arrays["inside"])
            self.assertEqual(len(inside), len(field))
            places = {tuple(np.round(dataset.GetPoint(index), 6)): index for index in inside.tolist()}
            order = [places[tuple(place)] for place in np.round(field.points, 6).tolist()]
            for name, values in (("E", field.E), ("slope", field.slope), ("normal", field.normals),
                                 ("direction", field.direction), ("E_share", field.share)):
                assert_same(arrays[name][order], values, name)
            outside = arrays["inside"] == 0
            self.assertEqual(set(arrays["direction"][outside].tolist()), {-1})
            self.assertEqual(set(arrays["E"][outside].tolist()), {0.0})

    def test_surfaces_are_those_of_the_vtp_file(self):
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
        directory.client("surface", body.id, "--operator", "chords", "-o", directory / "sheet.vtp")
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(directory / "sheet.vtp"))
        reader.Update()
        theirs, ours = reader.GetOutput(), body.skeleton("chords").to_pyvista()
        for get in (lambda data: data.GetPoints().GetData(), lambda data: data.GetPolys().GetConnectivityArray(),
                    lambda data: data.GetPolys().GetOffsetsArray()):
            assert_same(vtk_to_numpy(get(ours)), vtk_to_numpy(get(theirs)))
        self.assertEqual(set(self.arrays(ours)), set(self.arrays(theirs)))
        for name, values in self.arrays(theirs).items():
            assert_same(self.arrays(ours)[name], values, name)

    def test_vtk_measures_the_volume_of_an_eroded_solid(self):
        from vtkmodules.vtkFiltersCore import vtkMassProperties
        surface = body.eroded(volume=2e9)
        mass = vtkMassProperties()
        mass.SetInputData(surface.to_pyvista())
        self.assertAlmostEqual(mass.GetVolume() / surface.volume, 1, places=6)

    def test_points_have_a_cell_each(self):
        points = body.skeleton_points()
        dataset = points.to_pyvista()
        self.assertEqual(dataset.GetNumberOfVerts(), len(points))
        assert_same(self.arrays(dataset)["H"], points.H)

    def test_a_surface_comes_back_as_the_mesh_of_a_job(self):
        surface = body.eroded(fraction=.05)
        again = client.submit(surface.to_pyvista(), points=300).wait()
        self.assertAlmostEqual(again.status().volume / surface.volume, 1, places=9)


class Tables(unittest.TestCase):
    def setUp(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("no python3-pandas")
        self.pandas = pandas

    def test_pandas_takes_every_table(self):
        field = body.field()
        frame = self.pandas.DataFrame(field.table())
        self.assertEqual(frame.shape, (len(field), 9))
        self.assertEqual(frame["E"].max(), field.E.max())
        self.assertEqual(self.pandas.DataFrame(body.skeleton("chords").table()).shape[1], 12)
        jobs = self.pandas.DataFrame(job.seen for job in client.jobs())
        self.assertIn(body.id, set(jobs["id"]))
        self.assertEqual(self.pandas.DataFrame(body.events())["event"][0], "submitted")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
