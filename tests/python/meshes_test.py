"""Whatever a mesh is given as, and what is asked of it.

Usage: meshes_test.py PROGRAMS PROJECT"""
import json
import sys
import unittest

import numpy as np

import affskel

from lab import assert_same, serve_module

try:
    import vtkmodules
except ImportError:
    vtkmodules = None


def setUpModule():
    global directory, client, body
    directory, _, client = serve_module()
    body = client.submit(directory.make("body", "--triangles", 500), spacing=300).wait()


class SameMesh(unittest.TestCase):
    """However a mesh is given, its field is the same."""

    def field_of(self, mesh):
        job = client.submit(mesh, spacing=300).wait()
        field = job.field()
        return field.E, field.points

    def test_arrays_bytes_and_files(self):
        wanted = body.field()
        text = (directory / "body.off").read_bytes()
        rows = [line.split() for line in text.decode().splitlines()[1:] if line and not line.startswith("#")]
        n = int(rows[0][0])
        vertices = np.array(rows[1:1 + n], float)
        faces = np.array(rows[1 + n:], int)[:, 1:]
        directory.client("transform", directory / "body.off", "--scale", 1, "-o", directory / "body.ply")
        for mesh in (text, (vertices, faces), (vertices.tolist(), faces.tolist()), directory / "body.ply",
                     str(directory / "body.off")):
            with self.subTest(type(mesh)):
                E, points = self.field_of(mesh)
                assert_same(E, wanted.E)
                assert_same(points, wanted.points)

    @unittest.skipIf(vtkmodules is None, "no python3-vtk9")
    def test_a_mesh_of_vtk(self):
        from vtkmodules.vtkIOGeometry import vtkOBJReader
        directory.client("transform", directory / "body.off", "--scale", 1, "-o", directory / "body.obj")
        reader = vtkOBJReader()
        reader.SetFileName(str(directory / "body.obj"))
        reader.Update()
        # VTK holds the vertices of .obj in single precision: the mesh is another, by rounding.
        E, _ = self.field_of(reader.GetOutput())
        wanted = body.field().E
        self.assertLess(np.median(np.abs(E - wanted) / wanted), 1e-4)

    def test_another_format_is_checked_by_the_client_before_anything_is_sent(self):
        (directory / "hole.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n")
        before = len(client.jobs())
        with self.assertRaises(affskel.BadInputError) as failure:
            client.submit(directory / "hole.obj", spacing=.1)
        self.assertTrue(failure.exception.file.endswith("hole.obj"))
        self.assertNotIsInstance(failure.exception, affskel.JobFailedError)
        self.assertEqual(len(client.jobs()), before)

    def test_an_image_is_the_surface_at_a_value(self):
        def inner(*place):
            return all(1 < n < 10 for n in place)
        voxels = bytes(200 if inner(i, j, k) else 0 for k in range(12) for j in range(12) for i in range(12))
        (directory / "ct.nrrd").write_bytes(
            b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n" + voxels)
        job = client.submit(directory / "ct.nrrd", isovalue=100, points=500).wait()
        self.assertAlmostEqual(job.status().volume / 8 ** 3, 1, delta=.1)
        with self.assertRaises(affskel.BadInputError):
            client.submit(directory / "ct.nrrd", points=500)

    def test_holes_are_filled_where_that_is_said(self):
        points = [(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)]
        faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                 (0, 6, 4), (1, 5, 7)]
        with self.assertRaises(affskel.BadInputError):
            client.submit((points, faces), points=500)
        job = client.submit((points, faces), points=500, repair="fill=7").wait()
        self.assertAlmostEqual(job.status().volume, 8, places=9)

    def test_warnings_of_a_repair_are_warnings_of_its_job(self):
        points = [(s * x, s * y, s * z) for s in (10, 6) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        box = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
               (1, 5, 7), (1, 7, 3)]
        cavity = [(8 + a, 8 + c, 8 + b) for a, b, c in box]
        job = client.submit((points, box + cavity), points=500, repair="wrap=7").wait()
        notes = {note.code: note.severity for note in job.status().notes}
        self.assertEqual((notes["wrapped"], notes["closed-cavities"]), ("repaired", "warning"))
        self.assertTrue(any(warning.startswith("1 cavity closed") for warning in job.status().warnings))
        self.assertIn("warning: 1 cavity closed", directory.client_notes("watch", job.id))

    def test_a_small_hole_is_filled_unasked_and_the_mesh_kept_as_it_came(self):
        rows = (directory / "body.off").read_text().rstrip("\n").split("\n")
        head = next(n for n, row in enumerate(rows) if len(row.split()) == 3 and n > 0)
        points, faces, edges = rows[head].split()
        rows[head] = f"{points} {int(faces) - 1} {edges}"
        text = ("\n".join(rows[:-1]) + "\n").encode()
        (directory / "holed.off").write_bytes(text)
        job = client.submit(directory / "holed.off", points=500).wait()
        self.assertEqual(job.source(), text)
        self.assertIn("filled-holes", [note.code for note in job.status().notes])
        with self.assertRaises(affskel.NotFoundError):
            body.source()

    def test_shares_are_taken_as_the_command_line_takes_them(self):
        said = directory.client("submit", directory / "body.off", "--spacing", "3%", "--wait").strip()
        self.assertEqual(client.submit(directory / "body.off", spacing="3%").id, said)
        directory.client("transform", directory / "body.off", "--scale", 1, "-o", directory / "share.ply")
        theirs, ours = client.job(said), client.submit(directory / "share.ply", spacing="3%").wait()
        assert_same(ours.lattice().axes, theirs.lattice().axes)
        self.assertEqual(len(body.eroded("5%")), len(body.eroded(.05)))
        for wrong in ("10mm", "x%", "-1%"):
            with self.assertRaisesRegex(affskel.UsageError, "spacing is a number, in units of the mesh, or a share"):
                client.submit(directory / "body.off", spacing=wrong)

    def test_lines_are_saved_as_graphs_and_everything_as_fetch_does(self):
        for extension in ("json", "graphml", "swc", "glb"):
            file = body.skeleton("curve").save(directory / f"limbs.{extension}")
            self.assertGreater(file.stat().st_size, 100)
        file = body.save("divergence", directory / "H.csv", "--operator=sobel")
        self.assertEqual(file.read_text().splitlines()[0].split(",")[-1], "H")
        self.assertTrue(body.save("picture", directory / "body.png", "--level=5%").read_bytes().startswith(b"\x89PNG"))
        self.assertIn("<html", body.save("view", directory / "body.html").read_text())
        with self.assertRaisesRegex(affskel.UsageError, "'lattice' is not written to files: expected one of field, "):
            body.save("lattice", directory / "lattice.csv")
        measures = body.measures()
        body.save("curve", directory / "theirs.vtp")
        self.assertEqual(measures.curve.save(directory / "ours.vtp").read_bytes(), (directory / "theirs.vtp").read_bytes())
        body.save("thickness", directory / "thickness.ply")
        self.assertEqual(measures.surface.save(directory / "cut.ply").read_bytes(), (directory / "thickness.ply").read_bytes())
        body.save("curve", directory / "theirs.json", "--threshold=4")
        self.assertEqual(body.skeleton("curve", 4).save(directory / "ours.json").read_bytes(), (directory / "theirs.json").read_bytes())
        self.assertLess(len((directory / "ours.json").read_bytes()), len(body.skeleton("curve").save(directory / "all.json").read_bytes()))

    def test_the_same_again_is_the_same_job_and_options_arrive(self):
        again = client.submit(directory / "body.off", spacing=300)
        self.assertTrue(again.existed)
        self.assertEqual(again, body)
        for mesh in (directory / "body.off", directory / "body.ply"):
            directory.client("transform", directory / "body.off", "--scale", 1, "-o", directory / "body.ply")
            job = client.submit(mesh, points=500, directions="random:7:1", frame="pca", operator="flux", threshold=.4,
                                name="n", priority=7, request_id=mesh.suffix, repair="none")
            said = json.loads(directory.client("--json", "status", job.id))
            self.assertEqual(said["params"], dict(sampling=dict(target_points=500), directions="random:7:1",
                                                  repair=False, frame="pca", minimum="set"))
            self.assertEqual(said["skeleton"], dict(operator="flux", threshold=.4))
            self.assertEqual((said["name"], said["priority"]), ("n", 7))

    def test_a_job_has_the_name_of_its_file_unless_it_is_given_one(self):
        named = directory / "two\nlines\x1b\u0085.off"
        named.write_bytes((directory / "body.off").read_bytes())
        for number, name in enumerate((None, "")):
            self.assertEqual(client.submit(named, spacing=310 + number, name=name).status().name, "two lines??")
        for control in "\0\u0085":
            with self.assertRaises(affskel.UsageError):
                client.submit(named, spacing=320, name=f"a{control}b")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
