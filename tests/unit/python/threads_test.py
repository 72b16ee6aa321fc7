"""The threads that work is done in: kept for the next work, whatever became of the last; forks, signals, the end of Python."""

import gc
import os
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np

import faultsim
from scenes import bits, plane_scene

ANGLE = {"friction_angle": 0.4}
MANY = np.full((200000, 1), 0.4)


def thread_ids():
    """One that was joined may be among them a moment longer: ask which are new."""
    return set(os.listdir("/proc/self/task"))


def exit_code_of_child(work):
    """A forked process ends with 0 where this is true, with 1 where not, with a signal where it hangs."""
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        os._exit(0 if work() else 1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def program_said(text):
    """What a program prints that begins with a prepared simulation s of a case that takes long enough."""
    start = "import faultsim, numpy as np, os, signal, sys, threading, time\nfrom scenes import plane_scene\n"
    start += "s = faultsim.Simulation(plane_scene()); s.run(); many = np.full((10**6, 1), 0.4)\n"
    start += "def run(): s.run_many(many, parameters=['friction_angle'])\n"
    return subprocess.run([sys.executable, "-c", start + text], capture_output=True, text=True, timeout=120, check=False)


class ThreadsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulation = faultsim.Simulation(plane_scene())
        cls.wanted = bits(cls.simulation.run(ANGLE))

    def run_many(self, progress, n=len(MANY)):
        return self.simulation.run_many(MANY[:n], parameters=list(ANGLE), progress=progress)

    def test_a_thread_is_kept(self):
        before = thread_ids()
        for _ in range(20):
            self.simulation.run(ANGLE)
        self.assertEqual(thread_ids() - before, set())

    def test_work_that_failed_leaves_nothing_to_the_next(self):
        def fail(done, n):
            raise LookupError("enough")

        before = thread_ids()
        for _ in range(3):
            with self.assertRaises(faultsim.InputError):
                self.simulation.run(friction_angle=100)
            self.assertEqual(bits(self.simulation.run(ANGLE)), self.wanted)
            with self.assertRaises(LookupError):
                self.run_many(fail)
            self.assertEqual(bits(self.simulation.run(ANGLE)), self.wanted)
        self.assertEqual(thread_ids() - before, set())

    def test_those_who_work_at_once_have_one_each(self):
        inner = self.simulation.twin()
        found = []

        def run_inner(done, n):
            found.append(bits(inner.run(ANGLE)))

        def run_outer():
            simulation = faultsim.Simulation(plane_scene())
            simulation.run_many(MANY[:300], parameters=list(ANGLE), progress=run_inner_of(simulation.twin()))

        def run_inner_of(twin):
            return lambda done, n: found.append(bits(twin.run(ANGLE)))

        thread = threading.Thread(target=run_outer)
        thread.start()
        self.run_many(run_inner, 300)
        thread.join()
        self.assertGreaterEqual(len(found), 2)
        self.assertTrue(all(one == self.wanted for one in found))
        kept = thread_ids()
        self.run_many(run_inner, 300)
        self.assertEqual(thread_ids() - kept, set())

    def test_a_simulation_may_go_while_its_thread_waits(self):
        for _ in range(3):
            simulation = faultsim.Simulation(plane_scene())
            result = simulation.run(ANGLE)
            del simulation
            gc.collect()
            self.assertEqual(bits(self.simulation.run(ANGLE)), self.wanted)
            self.assertEqual(bits(result), self.wanted)

    def test_a_forked_process_starts_its_own(self):
        def runs():
            return bits(self.simulation.run(ANGLE)) == self.wanted and exit_code_of_child(is_equal) == 0

        def is_equal():
            return bits(self.simulation.run(ANGLE)) == self.wanted

        for _ in range(2):
            self.assertEqual(exit_code_of_child(runs), 0)
            self.assertTrue(is_equal())

    def test_work_is_left_to_the_parent_of_a_fork(self):
        """A callback that forks: the child comes back from it, and nobody there does the work."""
        codes = []

        def fork(done, n):
            if not codes:
                child = os.fork()
                if child == 0:
                    signal.alarm(60)
                    return
                codes.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))

        parent = os.getpid()
        try:
            self.run_many(fork, 1000)
        except faultsim.Error as error:
            if os.getpid() == parent:
                raise
            twin_runs = bits(faultsim.Simulation(plane_scene()).run(ANGLE)) == self.wanted
            os._exit(0 if "parent process" in str(error) and twin_runs else 1)
        finally:
            if os.getpid() != parent:
                os._exit(2)
        self.assertEqual(codes, [0])

    def test_signals_that_somebody_waits_for_are_not_taken(self):
        said = program_said("signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGUSR1})\n"
                            "os.kill(os.getpid(), signal.SIGUSR1)\n"
                            "print(signal.sigwait({signal.SIGUSR1}).name)\n")
        self.assertEqual((said.returncode, said.stdout.strip()), (0, "SIGUSR1"), said.stderr)

    def test_python_ends_while_a_thread_works(self):
        said = program_said("threading.Thread(target=run, daemon=True).start()\n"
                            "time.sleep(0.1); print('ends', flush=True)\n")
        self.assertEqual((said.returncode, said.stdout.strip()), (0, "ends"), said.stderr)
        self.assertNotIn("terminate", said.stderr)

    def test_what_is_called_at_the_end_of_python_may_run(self):
        said = program_said("import atexit\n"
                            "@atexit.register\n"
                            "def last(): print(s.run().outcome, flush=True)\n")
        self.assertEqual((said.returncode, said.stdout.strip()), (0, "converged"), said.stderr)
        said = program_said("class Last:\n"
                            "    def __del__(self): print(s.run().outcome, flush=True)\n"
                            "last = Last()\n")
        self.assertEqual((said.returncode, said.stdout.strip()), (0, "converged"), said.stderr)


if __name__ == "__main__":
    unittest.main()
