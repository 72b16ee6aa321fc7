"""Many cases: bits, tables, threads, callbacks that raise, interrupts, memory."""

import os
import signal
import threading
import time
import unittest

import numpy as np

import faultsim
from faultsim.units import deg
from scenes import plane_scene

NAMES = ["friction_angle", "ratio_across", "cohesion"]


def sample(n, seed=1):
    random = np.random.default_rng(seed)
    return np.column_stack([random.uniform(15, 35, n) * deg, random.uniform(0.65, 0.85, n), random.uniform(0, 1e6, n)])


def resident_kilobytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


class RunManyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulation = faultsim.Simulation(plane_scene())
        cls.cases = sample(40)
        cls.runs = cls.simulation.run_many(cls.cases, parameters=NAMES, histories=["chi_bar"])

    def test_numbers_are_those_of_single_runs(self):
        for i in (0, 7, 39):
            result = self.simulation.run(dict(zip(NAMES, self.cases[i])), fields=False)
            whole = result.whole
            self.assertEqual(self.runs["chi_bar"][i], whole.chi_bar)
            self.assertEqual(self.runs["max_slip"][i], whole.max_slip_m)
            self.assertEqual(bool(self.runs["slides"][i]), whole.activated)
            self.assertEqual(self.runs.outcomes[i], result.outcome)
            np.testing.assert_array_equal(self.runs.histories["chi_bar"][i], result.history("chi_bar"))
            np.testing.assert_array_equal(self.runs.times, result.times)

    def test_threads_change_no_bit(self):
        for threads in (2, 3, 50):
            again = self.simulation.run_many(self.cases, parameters=NAMES, histories=["chi_bar"], threads=threads)
            np.testing.assert_array_equal(again.outputs, self.runs.outputs)
            np.testing.assert_array_equal(again.histories["chi_bar"], self.runs.histories["chi_bar"])
            np.testing.assert_array_equal(again.outcomes, self.runs.outcomes)

    def test_threads_with_operators_of_their_own(self):
        cases = {"offset": ["40 m", "80 m", "60 m", "40 m"], "friction_angle": [0.4, 0.5, 0.45, 0.35]}
        one = self.simulation.run_many(cases, outputs=["chi_bar", "max_slip"])
        two = self.simulation.run_many(cases, outputs=["chi_bar", "max_slip"], threads=2)
        np.testing.assert_array_equal(one.outputs, two.outputs)
        self.assertEqual(len({tuple(row) for row in one.outputs}), 4)

    def test_outputs_of_faults_and_stages(self):
        result = self.simulation.run(dict(zip(NAMES, self.cases[0])))
        stage = result.stages[-1]
        fault = stage.faults[0]
        names = ["chi_bar", f"{fault.fault}.chi_bar", f"max_slip in {stage.stage}", f"{fault.fault}.moment in {stage.stage}",
                 "pressure_margin", "activated"]
        runs = self.simulation.run_many(self.cases[:1], parameters=NAMES, outputs=names)
        wanted = [result.whole.chi_bar, result.whole.faults[0].chi_bar, stage.max_slip_m, fault.moment_nm,
                  result.pressure_margin_pa, result.whole.activated]
        for name, value in zip(names, wanted):
            if value is None:
                self.assertTrue(np.isnan(runs[name][0]), name)
            else:
                self.assertEqual(runs[name][0], value, name)
        for wrong in ("chi", "F9.chi_bar", "F1.chi_bar in nowhere"):
            with self.assertRaises(faultsim.InputError):
                self.simulation.run_many(self.cases[:1], parameters=NAMES, outputs=[wrong])
        with self.assertRaises(KeyError):
            runs["opens"]

    def test_data_frames(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed")
        frame = pandas.DataFrame(self.cases, columns=NAMES)
        np.testing.assert_array_equal(self.simulation.run_many(frame).outputs, self.runs.outputs)
        part = self.simulation.run_many(frame.iloc[::2], parameters=NAMES[:2])
        np.testing.assert_array_equal(
            part.outputs, self.simulation.run_many(self.cases[::2, :2], parameters=NAMES[:2]).outputs)
        frame["friction_angle"] = [f"{angle:.17g} rad" for angle in frame["friction_angle"]]
        runs = self.simulation.run_many(frame)
        np.testing.assert_array_equal(runs.outputs, self.runs.outputs)
        with self.assertRaisesRegex(ValueError, "columns are there twice: 'cohesion'"):
            self.simulation.run_many(pandas.DataFrame(self.cases, columns=["cohesion", "friction_angle", "cohesion"]))
        row = frame.iloc[0]
        self.assertEqual(self.simulation.run(row).whole.chi_bar, self.runs["chi_bar"][0])
        table = runs.to_pandas()
        self.assertEqual(list(table.columns), [*NAMES, "outcome", *faultsim.outputs()])
        np.testing.assert_array_equal(table["chi_bar"], self.runs["chi_bar"])

    def test_shapes_that_do_not_fit(self):
        for wrong, names in ((self.cases, NAMES[:2]), (self.cases[0], NAMES), (self.cases, None)):
            with self.assertRaises(ValueError):
                self.simulation.run_many(wrong, parameters=names)
        with self.assertRaises(ValueError):
            self.simulation.run_many({"friction_angle": [0.4, 0.5], "cohesion": [0]})
        with self.assertRaises(faultsim.InputError):
            self.simulation.run_many(self.cases, parameters=["frction", *NAMES[1:]])
        with self.assertRaises(ValueError):
            self.simulation.run_many(self.cases, parameters=NAMES, on_error="ignore")
        self.assertEqual(self.simulation.run_many(self.cases[:0], parameters=NAMES).outputs.shape[0], 0)

    def test_all_that_is_wrong_is_said_before_the_first_case(self):
        cases = self.cases.copy()
        cases[[5, 7], 2] = np.nan, np.inf
        with self.assertRaises(faultsim.InputError) as raised:
            self.simulation.run_many(cases, parameters=["frction_angle", "friction_angle", "friction_angle"],
                                     outputs=["chi_bra", "slides", "F9.chi_bar"], histories=["chi_barr"])
        said = str(raised.exception)
        self.assertEqual(len(raised.exception.problems), 6, said)
        for part in ('did you mean "friction_angle"', "given twice", "in 2 of 40 cases, first in case 5", "chi_bra", "F9", "chi_barr"):
            self.assertIn(part, said)
        with self.assertRaises(faultsim.InputError):  # also of no case
            self.simulation.run_many(cases[:0], parameters=["nothing", *NAMES[1:]])

    def test_lists_that_are_none(self):
        run = self.simulation.run_many
        for wrong in ({"parameters": "cohesion"}, {"parameters": NAMES, "outputs": "chi_bar"}, {"parameters": NAMES, "histories": "chi_bar"}):
            with self.assertRaisesRegex(TypeError, "is a list of names"):
                run(self.cases, **wrong)
        with self.assertRaisesRegex(TypeError, "are names, and 0 is none"):
            run({0: [0.4]})
        with self.assertRaisesRegex(ValueError, r"values\[:, None\]"):
            run(self.cases[:, 0], parameters=NAMES[:1])
        with self.assertRaisesRegex(TypeError, "friction_angle, case 1, counted from 0"):
            run({"friction_angle": np.array([0.4, object()])})
        with self.assertRaisesRegex(ValueError, "threads is 0"):
            run(self.cases, parameters=NAMES, threads=0)
        with self.assertRaisesRegex(TypeError, "progress is 3"):
            run(self.cases, parameters=NAMES, progress=3)

    def test_values_that_are_refused(self):
        cases = self.cases.copy()
        cases[3, 0] = 100 * deg
        with self.assertRaises(faultsim.InputError) as raised:
            self.simulation.run_many(cases, parameters=NAMES)
        self.assertIn("running case 3 of 40", str(raised.exception))
        cases[5, 1] = np.nan
        runs = self.simulation.run_many(cases, parameters=NAMES, on_error="keep", threads=2)
        self.assertEqual(sorted(runs.refused), [3, 5])
        self.assertEqual(runs.outcomes[3], "refused")
        self.assertTrue(np.isnan(runs.outputs[3]).all())
        kept = [i for i in range(40) if i not in (3, 5)]
        np.testing.assert_array_equal(runs.outputs[kept], self.runs.outputs[kept])

    def test_progress_is_told_in_the_thread_that_called(self):
        told = []
        self.simulation.run_many(sample(300), parameters=NAMES, threads=2,
                                 progress=lambda done, n: told.append((done, n, threading.get_ident())))
        self.assertEqual(told[-1][:2], (300, 300))
        self.assertEqual([one[0] for one in told], sorted(one[0] for one in told))
        self.assertEqual({one[2] for one in told}, {threading.get_ident()})

    def test_what_a_callback_raises_ends_the_work(self):
        def fail(done, n):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            self.simulation.run_many(sample(100000), parameters=NAMES, threads=2, progress=fail)
        again = self.simulation.run_many(self.cases, parameters=NAMES)
        np.testing.assert_array_equal(again.outputs, self.runs.outputs)
        with self.assertRaises(TypeError):
            self.simulation.run_many(sample(100000), parameters=NAMES, progress=lambda: None)

    def test_a_callback_may_run_another_simulation(self):
        other = self.simulation.twin()
        told = []
        wanted = self.simulation.run(friction_angle=0.4).whole.chi_bar

        def run_other(done, n):
            told.append(other.run(friction_angle=0.4).whole.chi_bar)

        runs = self.simulation.run_many(self.cases, parameters=NAMES, progress=run_other)
        np.testing.assert_array_equal(runs.outputs, self.runs.outputs)
        self.assertEqual(set(told), {wanted})

    def test_a_forked_process_has_threads_of_its_own(self):
        wanted = self.simulation.run(friction_angle=0.4).whole.chi_bar
        child = os.fork()
        if child == 0:
            signal.alarm(60)  # which ends it where it hangs
            os._exit(0 if self.simulation.run(friction_angle=0.4).whole.chi_bar == wanted else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)

    def test_other_threads_of_python_run_meanwhile(self):
        counted = [0]
        ends = threading.Event()

        def count():
            while not ends.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        self.simulation.run_many(sample(1000), parameters=NAMES)
        seen = counted[0]
        ends.set()
        thread.join()
        self.assertGreater(seen, 10)

    def interrupted_after(self, work):
        """Seconds from Ctrl-C to KeyboardInterrupt."""
        sent = []

        def send():
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(0.15, send)
        timer.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                work()
            return time.monotonic() - sent[0]
        finally:
            timer.join()

    def test_ctrl_c(self):
        many = sample(200000)
        fresh = faultsim.Simulation(faultsim.Scene.field(tier="demonstration"))
        works = {
            "many cases": lambda: self.simulation.run_many(many, parameters=NAMES, threads=2),
            "the build of an operator": fresh.prepare,
        }
        limit = 0.05 if "FAULTSIM_SLOW_MACHINE" not in os.environ else 5
        for name, work in works.items():
            latencies = sorted(self.interrupted_after(work) for _ in range(3))
            self.assertLess(latencies[0], limit, f"{name}: {latencies}")
        again = self.simulation.run_many(self.cases, parameters=NAMES)
        np.testing.assert_array_equal(again.outputs, self.runs.outputs)

    def test_memory_does_not_grow(self):
        if "FAULTSIM_SLOW_MACHINE" in os.environ:
            self.skipTest("sanitizers keep what was freed")
        n = int(os.environ.get("FAULTSIM_MEMORY_RUNS", "2000"))
        cases = sample(n // 4)
        self.simulation.run_many(cases[:200], parameters=NAMES, threads=2)
        for angle in cases[:200, 0]:
            self.simulation.run(friction_angle=angle).fields.traction.sum()
        before = resident_kilobytes()
        for _ in range(2):
            self.simulation.run_many(cases, parameters=NAMES, threads=2)
        for angle in np.tile(cases[:, 0], 2):
            result = self.simulation.run(friction_angle=angle)
            result.fields.traction.sum()
            del result
        self.assertLess(resident_kilobytes() - before, 8000)


if __name__ == "__main__":
    unittest.main()
