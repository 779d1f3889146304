"""Everything that can go wrong, and how it is told.

Usage: errors_test.py PROGRAMS PROJECT"""
import json
import os
import pathlib
import subprocess
import sys
import unittest

import numpy as np

import affskel

from servers import CUBE, OPEN_CUBE, WithDirectory


class Errors(WithDirectory):
    def test_a_mesh_that_is_no_good_is_told_with_the_place(self):
        client = self.client(self.server())
        with self.assertRaisesRegex(affskel.BadMeshError, "zero") as failure:
            client.submit("OFF\n1 0 0\n0 0 zero\n".encode(), spacing=.1).wait()
        error = failure.exception
        self.assertIsInstance(error, affskel.JobFailedError)
        self.assertIsInstance(error, affskel.BadInputError)
        self.assertEqual((error.code, error.exit_code, error.reason), ("BAD_INPUT", 3, "BAD_INPUT"))
        self.assertIn(error.job, str(error))
        self.assertEqual(error.line, 3)
        self.assertEqual(client.job(error.job).status().state, "failed")

    def test_it_is_told_as_affskel_client_tells_it(self):
        server = self.server()
        file = self.directory / "hole.off"
        for text in (CUBE.replace("4 3 0 4 7", "4 3 0 4 8"), CUBE.replace("1 0 0", "1 nan 0", 1),
                     "OFF\n1 0 0\n0 0 zero\n", "OFF\n"):
            file.write_text(text)
            code, said = self.directory.client_error("--server", server.address, "submit", file)
            with self.assertRaises(affskel.BadInputError) as failure:
                self.client(server).submit(file, spacing=.1).wait()
            error = failure.exception
            self.assertEqual((code, said["code"], said["file"], said.get("line", 0)),
                             (error.exit_code, error.code, error.file, error.line))
            self.assertTrue(error.message.endswith(said["message"]), (error.message, said["message"]))

    def test_holes_and_foreign_units_are_told_before_anything_is_sent(self):
        server = self.server(workers=0)
        client = self.client(server)
        file = self.directory / "hole.off"
        file.write_text(OPEN_CUBE)
        _, said = self.directory.client_error("--server", server.address, "submit", "--repair", "none", file)
        with self.assertRaises(affskel.BadInputError) as failure:
            client.submit(file, spacing=.1, repair="none")
        self.assertEqual(failure.exception.file, str(file))
        self.assertEqual(failure.exception.message.split(" (")[0], said["message"].split(" (")[0])
        cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
        faces = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
        with self.assertRaisesRegex(affskel.BadInputError, "4 open edges"):
            client.submit((cube, faces[1:]), repair="none")
        with self.assertRaisesRegex(affskel.BadInputError, "1 hole is left"):
            client.submit((cube, faces[1:]))
        with self.assertRaisesRegex(affskel.BadInputError, r"^1 hole is left[^/]*; fill them by repair='fill=4\.04', or take a new surface .* by repair='wrap'$"):
            client.submit((cube, faces[1:]))
        points = self.directory / "points.xyz"
        points.write_text("".join(f"{x} {y} {z}\n" for x, y, z in cube))
        with self.assertRaisesRegex(affskel.BadInputError, r"no triangles; take a new surface round all of it by repair='wrap'$"):
            client.submit(points)
        with self.assertRaisesRegex(affskel.BadInputError, "is empty"):
            client.submit(b"")
        for nothing, words in ((b"OFF\n0 0 0\n", "no points"), (b"OFF # a point\n1 0 0\n0 0 0\n", "no faces")):
            with self.assertRaisesRegex(affskel.BadInputError, words):
                client.submit(nothing)
        with self.assertRaisesRegex(affskel.BadInputError, "vertex 1 is not finite"):
            client.submit(CUBE.encode().replace(b"1 0 0", b"1 nan 0", 1))
        wrong = "spacing 200 .* measures 1 x 1 x 1 units, the size of a person in metres; a spacing of 0.022 gives 100000"
        with self.assertRaisesRegex(affskel.BadInputError, wrong) as failure:
            client.submit((cube, faces), spacing=200)
        with self.assertRaisesRegex(affskel.LimitError, "gives about 1e.12 sample points, and at most 2147483648"):
            client.submit((cube, faces), spacing=1e-4)
        # Nor do a few points make a lattice, and a comment hides no mesh.
        commented = b"OFF # a cube\n# of ours\n" + CUBE.encode().split(b"\n", 1)[1]
        for mesh in (CUBE.encode(), commented):
            with self.assertRaisesRegex(affskel.BadInputError, "leaves no room"):
                client.submit(mesh, spacing=.6)
        self.assertNotIsInstance(failure.exception, affskel.JobFailedError)
        for wrong in ("10mm", "10", None, True, "150%", "100%", "1_0%", "\u0661%", "inf%", "0%"):
            with self.assertRaisesRegex(affskel.UsageError, "points is a number" if wrong is None else "spacing is a number"):
                client.submit((cube, faces), **({"points": [1]} if wrong is None else {"spacing": wrong}))
        self.assertEqual(client.jobs(), [])
        # Seams, whose vertices stand twice at one place, are no holes; the server joins them.
        apart = np.concatenate([cube[face] for face in faces])
        self.assertFalse(client.submit((apart, np.arange(24).reshape(6, 4)), spacing=np.float32(.25)).existed)

    def test_wrong_arguments_are_refused_before_anything_is_stored(self):
        client = self.client(self.server(workers=0))
        for wrong in (dict(spacing=-1), dict(spacing=float("nan")), dict(points=0), dict(points=2.5),
                      dict(points=1 << 40), dict(spacing=1, points=1), dict(operator="fuzzy"), dict(frame="mesh"),
                      dict(threshold=0), dict(threshold=float("inf")), dict(priority=10), dict(priority=-1),
                      dict(repair="some"), dict(directions="sphere"), dict(name="x" * 201), dict(request_id="x" * 201),
                      dict(spacing=10 ** 400), dict(threshold="6"), dict(threshold=10 ** 400), dict(priority=5.0),
                      dict(name=5), dict(name="\ud800"), dict(request_id=None), dict(directions=None), dict(repair=None)):
            with self.subTest(wrong), self.assertRaises(affskel.UsageError):
                client.submit(CUBE.encode(), **wrong)
        for spacing, error in ((1e-300, affskel.LimitError), (1e300, affskel.BadInputError)):
            with self.subTest(spacing), self.assertRaises(error):
                client.submit(CUBE.encode(), spacing=spacing)
        with self.assertRaises(affskel.UsageError):
            affskel.Client(5)
        self.assertEqual(client.jobs(), [])

    def test_results_that_do_not_exist(self):
        client = self.client(self.server())
        job = client.submit(CUBE.encode(), spacing=.1).wait()
        for call in (lambda: job.eroded(), lambda: job.eroded(.1, .1), lambda: job.eroded(1.5),
                     lambda: job.skeleton("fuzzy"), lambda: job.skeleton(threshold=-1), lambda: job.view("fuzzy"),
                     lambda: client.jobs(state="lost"), lambda: job.divergence("chords")):
            with self.assertRaises(affskel.UsageError):
                call()
        for call, words in ((lambda: client.job(3), "job is a text, not 3"),
                            (lambda: client.jobs(owner=3), "owner is a text, not 3"),
                            (lambda: job.skeleton(alpha="x"), "alpha is a number, not 'x'"),
                            (lambda: job.skeleton(min_barrier="x"), "min_barrier is a number, not 'x'"),
                            (lambda: job.skeleton(barrier="yes"), "barrier is True or False, not 'yes'"),
                            (lambda: job.save("field", None), "file is a path, not None"),
                            (lambda: job.field().save(None), "file is a path, not None")):
            with self.assertRaisesRegex(affskel.UsageError, words):
                call()
        for nothing in (1, 2), (None, None):
            with self.assertRaisesRegex(affskel.BadInputError, f"faces are rows of indices, not {nothing[1]}"):
                client.submit(nothing)
        with self.assertRaisesRegex(affskel.NotFoundError, "ffffff"):
            client.job("ffffffffff")

    def test_the_same_request_with_other_content_is_refused(self):
        client = self.client(self.server(workers=0))
        job = client.submit(CUBE.encode(), spacing=.1, request_id="one")
        self.assertTrue(client.submit(CUBE.encode(), spacing=.1, request_id="one").existed)
        with self.assertRaisesRegex(affskel.UsageError, "one"):
            client.submit(CUBE.encode(), spacing=.2, request_id="one")
        self.assertEqual([status.id for status in client.jobs()], [job.id])

    def test_limits_are_told(self):
        client = self.client(self.server("--quota", "queued-jobs=1", workers=0))
        client.submit(CUBE.encode(), spacing=.1)
        with self.assertRaises(affskel.LimitError) as failure:
            client.submit(CUBE.encode(), spacing=.2)
        self.assertEqual(failure.exception.exit_code, 8)

    def test_a_job_that_is_too_large_says_so(self):
        client = self.client(self.server("--quota", "chords=1K"))
        with self.assertRaises(affskel.JobTooLargeError) as failure:
            client.submit(CUBE.encode(), spacing=.05).wait()
        self.assertEqual((failure.exception.reason, failure.exception.code), ("LIMIT", "LIMIT"))

    def test_a_server_that_was_never_there_is_an_error_at_once(self):
        with self.assertRaisesRegex(affskel.UnreachableError, r"address from \$AFFSKEL_SERVER"):
            os.environ["AFFSKEL_SERVER"] = f"unix:{self.directory / 'none.sock'}"
            affskel.jobs()
        from affskel import _programs, _settings
        nowhere = _settings.choose(f"unix:{self.directory / 'none.sock'}", {}, {})
        with self.assertRaisesRegex(affskel.UnreachableError, "address from the argument server"):
            _programs.run_program(nowhere, ["list"], "")

    def test_source_that_was_not_built_says_so(self):
        source = pathlib.Path(__file__).parents[2] / "client" / "python"
        found = subprocess.run([sys.executable, "-c", "import affskel"], env={**os.environ, "PYTHONPATH": str(source)},
                               capture_output=True, text=True)
        self.assertRegex(found.stderr, "ImportError: .*install it by pip")

    def test_an_isovalue_of_arrays_names_the_mesh(self):
        client = self.client(self.server(workers=0))
        with self.assertRaisesRegex(affskel.BadInputError, "^the mesh is no image of voxels"):
            client.submit(([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]),
                          points=100, isovalue=3)

    def test_the_server_tells_what_it_tells_affskel_client(self):
        server = self.server(workers=0)
        client = self.client(server)
        client.submit(CUBE.encode(), spacing=.1)
        said = json.loads(self.directory.client("--server", server.address, "--json", "server-info"))
        ours = client.server_info()
        self.assertEqual(set(ours), set(said))
        for name in ("address", "version", "started_ms", "pid", "data_dir", "workers", "jobs_queued", "schema_version", "caller"):
            self.assertEqual(ours[name], said[name], name)

    def test_lists_longer_than_one_answer_are_whole(self):
        client = self.client(self.server(workers=0))
        ids = [client.submit(CUBE.encode(), spacing=.1, name=str(number)).id for number in range(7)]
        from affskel import _session
        most, _session.MAX_LISTED = _session.MAX_LISTED, 3
        self.addCleanup(setattr, _session, "MAX_LISTED", most)
        self.assertEqual([job.id for job in client.jobs()], ids[::-1])
        self.assertEqual([job.seen.name for job in client.jobs(limit=4)], list("6543"))
        self.assertRegex(repr(client.jobs(limit=1)), r"\[<affskel.Job [0-9a-f]{12} '6', queued>\]")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
