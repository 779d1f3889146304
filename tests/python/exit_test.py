"""A program that uses the package ends when it has ended: after every error, in every thread, after a fork, interrupted.

Usage: exit_test.py PROGRAMS PROJECT"""
import os
import signal
import socket
import subprocess
import sys
import textwrap
import time
import unittest

import affskel

from lab import Directory, Server

CUBE = ("OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n").encode()
NO_NUMBER = b"OFF\n1 0 0\n0 0 zero\n"

HANGS = 60  # seconds after which a process is taken for one that never ends
AT_ONCE = 1  # second from the last word of a program to its end
TRIES = 3  # of which the machine may be too busy for all but one

# `told` says when the program has nothing more to do.
PRELUDE = """
import os, signal, sys, threading, time, affskel
signal.signal(signal.SIGINT, signal.default_int_handler)  # a test in the background ignores it
def told():
    print("told", time.monotonic(), flush=True)
CUBE, NO_NUMBER, IDLE, BUSY, WAITING, CANCELLED = {values}
idle = affskel.Client(IDLE)
busy = affskel.Client(BUSY)
"""

ERRORS = {
    "UnreachableError": 'affskel.Client("127.0.0.1:1", patience=2).jobs()',
    "TimedOutError": "idle.job(WAITING).wait(timeout=.05)",
    "UsageError": 'idle.jobs(state="lost")',
    "BadInputError": "idle.submit(([(0, 0, 0)], [(0, 0, 9)]))",
    "NotFoundError": 'idle.job("ffffffffff")',
    "NotAllowedError": "idle.job(WAITING).delete()",
    "LimitError": "idle.submit(CUBE, spacing=.3)",
    "JobCancelledError": "idle.job(CANCELLED).wait()",
    "BadMeshError": "busy.submit(NO_NUMBER, spacing=.1).wait()",
    "JobTooLargeError": "busy.submit(CUBE, spacing=.05).wait()",
    "JobFailedError": "(_ for _ in idle.job(WAITING).progress()).throw(affskel.JobFailedError('made up'))",
    "InternalError": "idle.job(WAITING).view()",
}

CAUGHT = """
try:
    {call}
except affskel.{name}:
    told()
"""
UNCAUGHT = """
try:
    {call}
finally:
    told()
"""
IN_THREAD = """
def run():
    try:
        {call}
    except affskel.{name}:
        told()
thread = threading.Thread(target=run, daemon={daemon})
thread.start()
if {daemon}:
    thread.join()
"""
# The child is the first to use gRPC; each then ends as it would alone.
AFTER_FORK = """
child = os.fork()
try:
    {call}
except affskel.{name}:
    if child == 0:
        sys.exit(7)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
    told()
"""


class Ends(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = Directory()
        cls.addClassCleanup(cls.directory.remove)
        cls.directory.use_environment(cls.addClassCleanup)
        programs = cls.directory / "programs"
        programs.mkdir()
        (programs / "affskel-client").write_text("#!/bin/sh\nexit 99\n")
        (programs / "affskel-client").chmod(0o755)
        cls.idle = cls.server("idle", "--quota", "queued-jobs=1", workers=0)
        cls.busy = cls.server("busy", "--quota", "chords=1K")
        with affskel.Client(cls.idle.address) as client:
            cancelled = client.submit(CUBE, spacing=.2)
            cancelled.cancel()
            waiting = client.submit(CUBE, spacing=.1)
        cls.prelude = PRELUDE.format(values=(CUBE, NO_NUMBER, cls.idle.address, cls.busy.address, waiting.id,
                                             cancelled.id))
        cls.environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}")

    @classmethod
    def server(cls, name, *options, workers=1):
        (cls.directory / name).mkdir()
        directory = Directory.__new__(Directory)
        directory.path, directory.environment = cls.directory / name, cls.directory.environment
        server = Server(directory, *options, workers=workers)
        cls.addClassCleanup(server.end)
        return server

    def run_once(self, script, interrupt=False, typed=None, arguments=None):
        """Exit code, what it complains of, and the seconds from its last `told`, or the interrupt, to its end."""
        command = [sys.executable, "-B", *(arguments or ["-c", self.prelude + script])]
        with subprocess.Popen(command, env=self.environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
            said = ""
            if interrupt:
                said = process.stdout.readline()
                began = time.monotonic()
                process.send_signal(signal.SIGINT)
            try:
                rest, errors = process.communicate(typed, timeout=HANGS)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)  # with its children, which hold the pipes
                self.fail(f"it never ended: {process.communicate()}\n{script}")
            ended = time.monotonic()
        told = [float(line.split()[1]) for line in (said + rest).splitlines() if line.startswith("told ")]
        self.assertTrue(told, errors)
        return process.returncode, errors, ended - (began if interrupt else told[-1])

    def assert_ends(self, script, code=0, errors="", **options):
        """At once after `told`, or after the interrupt that follows it; `errors` is in its complaints, if any."""
        script = textwrap.dedent(script)
        took = []
        while not took or (took[-1] >= AT_ONCE and len(took) < TRIES):
            got, said, seconds = self.run_once(script, **options)
            self.assertEqual(got, code, said)
            self.assertIn(errors, said)
            self.assertEqual(said == "", errors == "", said)
            took.append(seconds)
        self.assertLess(min(took), AT_ONCE, script)


class AfterErrors(Ends):
    def test_every_error_is_here(self):
        kinds = {name for name in affskel.__all__ if name.endswith("Error")}
        self.assertEqual(set(ERRORS), kinds - {"AffskelError"})

    def each(self, script, **options):
        for name, call in ERRORS.items():
            with self.subTest(name):
                self.assert_ends(script.format(name=name, call=call, **options))

    def test_caught_at_module_level(self):
        self.each(CAUGHT)

    def test_not_caught(self):
        for name, call in ERRORS.items():
            with self.subTest(name):
                self.assert_ends(UNCAUGHT.format(call=call), 1, f"\naffskel._errors.{name}: ")

    def test_in_a_thread(self):
        self.each(IN_THREAD, daemon=False)

    def test_in_a_daemon_thread(self):
        self.each(IN_THREAD, daemon=True)

    def test_after_a_fork(self):
        self.each(AFTER_FORK)

    def test_in_an_interactive_interpreter(self):
        for name, call in ERRORS.items():
            with self.subTest(name):
                # A blank line ends the definition.
                typed = self.prelude.replace("\nCUBE", "\n\nCUBE") + f"{call}\ntold()\n"
                self.assert_ends("", 0, f"affskel._errors.{name}: ", arguments=["-i"], typed=typed)


class InTheMidst(Ends):
    """Calls under way when the program ends."""

    def test_a_loop_over_the_progress_that_is_left(self):
        for leave, code, errors in (("sys.exit(3)", 3, ""), ("raise ValueError('mine')", 1, "ValueError: mine"),
                                    ("break", 0, "")):
            with self.subTest(leave):
                self.assert_ends(f"""
                    states = idle.job(WAITING).progress()
                    for state in states:
                        told()
                        {leave}
                    """, code, errors)

    def test_a_daemon_thread_that_waits(self):
        self.assert_ends("""
            seen = threading.Event()
            def run():
                try:
                    for state in idle.job(WAITING).progress():
                        seen.set()
                except affskel.UnreachableError:
                    pass
            threading.Thread(target=run, daemon=True).start()
            seen.wait()
            told()
            """)

    def test_daemon_threads_that_never_stop_calling(self):
        self.assert_ends("""
            seen = threading.Semaphore(0)
            def run():
                while True:
                    try:
                        idle.jobs()
                        seen.release()
                    except affskel.AffskelError:
                        pass
            for _ in range(4):
                threading.Thread(target=run, daemon=True).start()
            for _ in range(20):
                seen.acquire()
            told()
            """)

    def test_an_interrupt_while_it_waits(self):
        for call in ("idle.job(WAITING).wait()", "list(idle.job(WAITING).progress())"):
            with self.subTest(call):
                self.assert_ends(f"idle.jobs()\ntold()\n{call}", -signal.SIGINT, "KeyboardInterrupt", interrupt=True)

    def test_an_interrupt_while_a_server_is_silent(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            for call in ("client.jobs()", "client.submit(CUBE)", "client.job('ffffffffff')"):
                with self.subTest(call):
                    self.assert_ends(f"""
                        client = affskel.Client("127.0.0.1:{silent.getsockname()[1]}")
                        told()
                        {call}
                        """, -signal.SIGINT, "KeyboardInterrupt", interrupt=True)

    def test_an_exit_handler_that_calls(self):
        for registered in ("first", "last"):
            with self.subTest(registered):
                self.assert_ends(f"""
                    import atexit
                    if {registered == "last"}:
                        idle.jobs()
                    atexit.register(lambda: (idle.jobs(), told()))
                    told()
                    """)

    def test_another_thread_closes_the_client_of_a_call(self):
        self.assert_ends("""
            seen = threading.Event()
            def run():
                try:
                    for state in idle.job(WAITING).progress():
                        seen.set()
                except affskel.UnreachableError as error:
                    assert "was closed" in str(error), error
                    told()
            thread = threading.Thread(target=run)
            thread.start()
            seen.wait()
            idle.close()
            thread.join()
            assert idle.jobs()[0].id == WAITING
            """)


class Forks(Ends):
    """A child of a process that has used gRPC has none of its threads."""

    def test_the_child_is_told_and_both_end(self):
        for before in ("idle.jobs()", "states = idle.job(WAITING).progress(); next(states)",
                       "job = idle.job(WAITING); threading.Thread(target=job.wait, daemon=True).start()"):
            for call in ("idle.jobs()", "affskel.Client(IDLE).jobs()", "idle.job(WAITING).wait()", "list(states)"):
                if "states" in call and "states" not in before:
                    continue
                with self.subTest(f"{before}: {call}"):
                    self.assert_ends(f"""
                        sys.excepthook = lambda *_: None
                        threading.excepthook = lambda *_: None
                        {before}
                        child = os.fork()
                        if child == 0:
                            try:
                                {call}
                            except affskel.UsageError as error:
                                assert "forked" in str(error)
                                idle.close()
                                sys.exit(7)
                        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
                        assert idle.jobs()[0].id == WAITING
                        told()
                        """)

    def test_a_child_that_drops_what_it_was_given_ends(self):
        self.assert_ends("""
            states = idle.job(WAITING).progress()
            next(states)
            child = os.fork()
            if child == 0:
                del states, idle, busy
                sys.exit(7)
            assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
            idle.job(WAITING).status()
            told()
            """)

    def test_pools_of_processes(self):
        file = self.directory / "pool.py"
        file.write_text(self.prelude + textwrap.dedent("""
            import multiprocessing
            def count(_):
                return len(affskel.Client(IDLE).jobs())
            def refused(_):
                try:
                    return count(_)
                except affskel.UsageError as error:
                    return "forked" in str(error)
            if __name__ == "__main__":
                with multiprocessing.get_context("fork").Pool(2) as pool:
                    assert pool.map(count, range(4)) == [2] * 4
                idle.jobs()
                with multiprocessing.get_context("fork").Pool(2) as pool:
                    assert pool.map(refused, range(4)) == [True] * 4
                with multiprocessing.get_context("spawn").Pool(2) as pool:
                    assert pool.map(count, range(4)) == [2] * 4
                told()
            """))
        self.assert_ends("", arguments=[str(file)])


class Dropped(Ends):
    def test_clients_that_are_dropped_leave_neither_descriptors_nor_threads(self):
        self.assert_ends("""
            def held():
                return len(os.listdir("/proc/self/fd")), threading.active_count()
            def use():
                client = affskel.Client(IDLE)
                next(client.job(WAITING).progress())
                for failing in (lambda: client.job("ffffffffff"), affskel.Client("127.0.0.1:1").jobs):
                    try:
                        failing()
                    except affskel.AffskelError:
                        pass
            import gc
            gc.disable()  # nothing may wait for it
            def settled(most):
                while any(now > limit for now, limit in zip(held(), most)):
                    time.sleep(.01)  # the threads of calls end after them; a leak never gets here
            use()
            settled((1 << 30, 1))
            before = held()
            for _ in range(200):
                use()
            settled(before)
            told()
            """)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
