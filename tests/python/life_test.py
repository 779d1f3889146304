"""Jobs from submission to their end, across restarts, without a configured server, and everything that can go wrong.

Usage: life_test.py PROGRAMS PROJECT"""
import contextlib
import importlib.util
import io
import json
import os
import pickle
import signal
import sys
import unittest
from concurrent import futures

import grpc
import numpy as np

import affskel
from affskel.v1 import client_service_pb2 as service

from lab import PROGRAMS, Directory, Server, assert_same

CUBE = ("OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n")
OPEN_CUBE = CUBE.replace("8 6 0", "8 5 0", 1).replace("4 3 0 4 7\n", "")


class WithDirectory(unittest.TestCase):
    def setUp(self):
        self.directory = Directory()
        self.addCleanup(self.directory.remove)
        self.directory.use_environment(self.addCleanup)

    def server(self, *options, workers=1):
        server = Server(self.directory, *options, workers=workers)
        self.addCleanup(lambda: server.process.poll() is None and server.end())
        return server

    def client(self, server, **options):
        return self.enterContext(affskel.Client(server.address, **options))


class Restarts(WithDirectory):
    def test_a_job_is_followed_across_a_stop_and_a_kill_of_the_server(self):
        server = self.server()
        client = self.client(server)
        job = client.submit(self.directory.make("body", "--triangles", 5000), points=20000)
        disturbances, seen = [signal.SIGTERM, signal.SIGKILL], []
        for status in job.progress(timeout=250):
            seen.append(status)
            # Only a job that is not finished is disturbed: each restart is in the middle of it.
            if disturbances and 0 < status.directions_done < status.directions_total:
                server.end(disturbances.pop())
                server.start()
        self.assertEqual(disturbances, [])
        self.assertEqual((seen[-1].state, seen[-1].directions_done), ("done", 5000))
        self.assertEqual([status.is_final for status in seen], [False] * (len(seen) - 1) + [True])
        self.directory.client("--server", server.address, "fetch", job.id, "field", "-o", self.directory / "field.csv")
        assert_same(job.field().E, self.directory.rows("field.csv")["E"])

    def test_every_call_waits_for_a_server_that_was_there(self):
        server = self.server()
        client = self.client(server)
        job = client.submit(CUBE.encode(), spacing=.1).wait()
        E = job.field().E.tolist()
        for call in (lambda: job.field().E.tolist() == E, lambda: client.submit(CUBE.encode(), spacing=.1) == job,
                     lambda: job.status().state == "done", lambda: client.jobs()[0].id == job.id):
            server.end(signal.SIGKILL)
            server.start()
            self.assertTrue(call())

    def test_it_is_given_up_after_the_patience(self):
        server = self.server()
        client = self.client(server, patience=.3)
        job = client.submit(CUBE.encode(), spacing=.1).wait()
        server.end()
        with self.assertRaisesRegex(affskel.UnreachableError, "cannot reach the server at unix:.*the argument server"):
            job.status()


class FullServer(grpc.GenericRpcHandler):
    """A server that answers the first calls of every client that it has no room."""

    def __init__(self, refusals):
        self.refusals = refusals

    def service(self, handler_call_details):
        def answer(_, context):
            if self.refusals:
                self.refusals -= 1
                context.abort(grpc.StatusCode.UNAVAILABLE, "no room")
            return service.ListJobsResponse(jobs=[{"id": "1"}]).SerializeToString()

        return grpc.unary_unary_rpc_method_handler(answer)


class Newcomers(unittest.TestCase):
    def serve(self, refusals):
        server = grpc.server(futures.ThreadPoolExecutor(1), handlers=[FullServer(refusals)])
        port = server.add_insecure_port("127.0.0.1:0")
        server.start()
        self.addCleanup(lambda: server.stop(0).wait())
        return self.enterContext(affskel.Client(f"127.0.0.1:{port}", patience=60))

    def test_a_server_without_room_is_waited_for_though_it_never_gave_another_answer(self):
        self.assertEqual([status.id for status in self.serve(2).jobs()], ["1"])


class PrivateServer(WithDirectory):
    def tearDown(self):
        self.directory.stop_private_server()

    def test_it_starts_by_itself_and_again_and_is_that_of_the_command_line(self):
        client = self.enterContext(affskel.Client())
        job = client.submit(self.directory.make("box", "--size", "3,2,1"), spacing=.1).wait()
        self.assertEqual(self.directory.client("status", "@last").split()[1], job.id)
        first = client.server_info()
        self.assertEqual(first["data_dir"], os.environ["AFFSKEL_HOME"])
        os.kill(first["pid"], signal.SIGKILL)
        self.assertEqual(job.status().state, "done")
        self.assertNotEqual(client.server_info()["pid"], first["pid"])
        self.assertEqual(len(job.field()), job.status().points)

    def test_a_home_too_deep_for_a_socket_is_no_obstacle(self):
        os.environ["AFFSKEL_HOME"] = self.directory.environment["AFFSKEL_HOME"] = str(self.directory / ("deep" * 25))
        client = self.enterContext(affskel.Client())
        self.assertEqual(client.submit(CUBE.encode(), spacing=.1).wait().status().points, 1000)

    def test_without_affskel_client_it_is_said_what_to_do(self):
        os.environ["PATH"] = os.pathsep.join(part for part in os.environ["PATH"].split(os.pathsep)
                                             if part != str(PROGRAMS))
        with self.assertRaisesRegex(affskel.UnreachableError, "name one with server=.*not in .PATH"):
            affskel.Client().server_info()

    def test_a_directory_that_cannot_be_used_is_the_error_of_affskel_client(self):
        (self.directory / "file").write_text("")
        os.environ["AFFSKEL_HOME"] = self.directory.environment["AFFSKEL_HOME"] = str(self.directory / "file")
        code, said = self.directory.client_error("server-info")
        with self.assertRaises(affskel.NotAllowedError) as failure:
            affskel.Client().server_info()
        self.assertEqual((failure.exception.exit_code, failure.exception.message, failure.exception.file),
                         (code, said["message"], said["file"]))


class Waiting(WithDirectory):
    def test_without_a_worker_a_job_waits_and_can_be_cancelled_and_resumed(self):
        client = self.client(self.server(workers=0))
        job = client.submit(CUBE.encode(), spacing=.1, name="cube")
        status = job.status()
        self.assertEqual((status.state, status.name, status.points), ("queued", "cube", 0))
        self.assertIsNone(status.finished)
        with self.assertRaises(affskel.TimedOutError):
            job.wait(timeout=.2)
        for result in (job.field, job.lattice, job.skeleton, job.skeleton_points, lambda: job.eroded(.1)):
            with self.assertRaises(affskel.NotFoundError):
                result()
        with self.assertRaises(affskel.NotAllowedError):
            job.delete()
        self.assertEqual(job.cancel().state, "cancelled")
        with self.assertRaisesRegex(affskel.JobCancelledError, job.id):
            job.wait()
        self.assertEqual(job.resume().state, "queued")
        with self.assertRaisesRegex(affskel.TimedOutError, "not at its end after 0.05 s; it goes on"):
            job.wait(timeout=.05)
        job.cancel()
        self.assertEqual([event["event"] for event in job.events()],
                         ["submitted", *["cancel_requested", "cancelled", "resumed"] * 2][:-1])
        job.delete()
        with self.assertRaisesRegex(affskel.NotFoundError, job.id):
            job.status()

    def test_timeouts_without_end_and_without_a_number(self):
        client = self.client(self.server())
        job = client.submit(CUBE.encode(), spacing=.1)
        for timeout in (float("inf"), 1e300, 1e10):
            job.wait(timeout=timeout)
            self.assertEqual(len(job.directions(timeout=timeout)), 12)
        self.assertRegex(repr(job.status()), "^<affskel.Status of .*, done, [0-9]+ points, skeleton of [0-9]+: it is hardly more than a point.*>$")
        for call in (job.wait, job.lattice):
            for wrong in (float("nan"), "x", True, [1]):
                with self.subTest(wrong), self.assertRaisesRegex(affskel.UsageError, "timeout is "):
                    call(timeout=wrong)

    def test_no_time_is_enough_for_a_job_at_its_end_alone(self):
        job = self.client(self.server()).submit(CUBE.encode(), spacing=.1).wait()
        for timeout in (0, -1, 0.0):
            self.assertEqual(job.wait(timeout=timeout).seen.state, "done")

    def test_no_time_is_too_little_for_another(self):
        waiting = self.client(self.server(workers=0)).submit(CUBE.encode(), spacing=.1)
        with self.assertRaisesRegex(affskel.TimedOutError, "not at its end after 0 s"):
            waiting.wait(timeout=0)

    def test_a_pickled_job_is_the_same_job(self):
        job = self.client(self.server()).submit(CUBE.encode(), spacing=.1).wait()
        other = pickle.loads(pickle.dumps(job))
        self.assertEqual((other, repr(other)), (job, repr(job)))
        self.assertIsNot(other._session, job._session)
        self.assertEqual(other.status().state, "done")

    def test_a_face_that_is_there_twice_is_left_out_as_affskel_client_does(self):
        corners = [(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)]
        faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                 (0, 6, 4), (1, 5, 7), (1, 7, 3)]
        job = self.client(self.server()).submit((corners, [*faces, faces[0]]), spacing=.2)
        self.assertIn("'mesh'", repr(job))  # also of a job that affskel-client submitted
        self.assertIn("repeated-triangles", [note.code for note in job.wait().status().notes])

    def test_a_finished_job_tells_what_it_was(self):
        client = self.client(self.server())
        job = client.submit(CUBE.encode(), spacing=.1, priority=9).wait()
        status = job.status()
        self.assertEqual((status.state, status.stage, status.points, status.directions_done, status.priority),
                         ("done", "complete", 1000, 12, 9))
        self.assertEqual((status.volume, status.spacing, status.share_done), (1.0, .1, 1.0))
        self.assertTrue(status.created <= status.started <= status.finished)
        self.assertEqual(client.job(job.id[:8]), job)
        self.assertEqual(client.job("@last"), job)
        self.assertEqual([one.id for one in client.jobs(state="done", limit=1)], [job.id])
        self.assertEqual(client.jobs(state="failed"), [])
        for wrong in (0, -1, 1.5, True, "1"):
            with self.subTest(wrong), self.assertRaisesRegex(affskel.UsageError, "the limit .* above 0"):
                client.jobs(limit=wrong)

    def test_a_mesh_of_several_messages_goes_there_and_back(self):
        client = self.client(self.server())
        text = CUBE.replace("OFF\n", "OFF\n" + "".join(f"# {number:070}\n" for number in range(40000))).encode()
        self.assertGreater(len(text), 2 << 20)
        job = client.submit(text, spacing=.1).wait()
        self.assertTrue(job.mesh() == text)
        self.assertEqual(job.status().points, 1000)

    def test_the_bar_of_tqdm_reaches_the_end(self):
        if importlib.util.find_spec("tqdm") is None:
            self.skipTest("no python3-tqdm")
        client = self.client(self.server())
        job = client.submit(CUBE.encode(), spacing=.1)
        shown = io.StringIO()
        with contextlib.redirect_stderr(shown):
            job.wait(progress=True)
            self.assertRegex(shown.getvalue().split("\r")[-1], "100%.* 12/12 .*complete")
            before = shown.getvalue()
            job.wait()  # no terminal
            self.assertEqual(shown.getvalue(), before)


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
