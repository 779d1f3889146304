"""Jobs from submission to their end, across restarts, and without a configured server.

Usage: life_test.py PROGRAMS PROJECT"""
import contextlib
import importlib.util
import io
import os
import pickle
import signal
import sys
import time
import unittest
from concurrent import futures

import grpc

import affskel
from affskel.v1 import client_service_pb2 as service

from lab import PROGRAMS, assert_same
from servers import CUBE, WithDirectory


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

    def test_a_first_status_is_waited_for_no_longer_than_is_said(self):
        server = self.server()
        client = self.client(server, patience=20)
        job = client.submit(CUBE.encode(), spacing=.1).wait()
        server.end()
        begin = time.monotonic()
        with self.assertRaisesRegex(affskel.TimedOutError, "the time is over"):
            client._session.get_job(job.id, .3)
        self.assertLess(time.monotonic() - begin, 10)


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
        with self.assertRaisesRegex(affskel.TimedOutError, "the job is not at its end; it goes on"):
            waiting.wait(timeout=-1)

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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
