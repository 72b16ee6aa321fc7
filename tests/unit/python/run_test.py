"""Runs: arrays that are seen and not copied, lifetimes, threads, histories, operator."""

import copy
import gc
import pickle
import threading
import unittest

import numpy as np

import faultsim
from faultsim.units import deg
from scenes import bits, plane_scene


class RunTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulation = faultsim.Simulation(plane_scene())
        cls.result = cls.simulation.run()

    def test_values_are_those_of_the_result(self):
        result = self.result
        self.assertEqual(result.outcome, "converged")
        self.assertEqual(result.whole.chi_bar, result.to_dict()["whole"]["chi_bar"])
        self.assertEqual(dict(result.whole), result.to_dict()["whole"])
        self.assertEqual(result["title"], result.title)
        self.assertEqual(len(result.times), len(result.steps))
        np.testing.assert_array_equal(result.history("chi_bar"),
                                      [[fault.chi_bar for fault in step.faults] for step in result.steps])
        with self.assertRaises(faultsim.InputError):
            result.history("chi_bra")
        with self.assertRaises(AttributeError):
            result.whole.nothing

    def test_shapes(self):
        fields, geometry = self.result.fields, self.result.geometry
        n, s = geometry.n_nodes, len(self.result.steps)
        self.assertEqual(fields.traction.shape, (s, n, 3))
        self.assertEqual(fields.slip.shape, (s, n, 3))
        self.assertEqual(fields.creep_traction.shape, (0, n, 3))
        for name in ("critical_index", "static_critical_index", "fault_pressure_change", "state"):
            self.assertEqual(getattr(fields, name).shape, (s, n), name)
        for name in ("position", "normal", "strike", "dip", "dof"):
            self.assertEqual(getattr(geometry, name).shape, (n, 3), name)
        for name in ("area", "shear_modulus"):
            self.assertEqual(getattr(geometry, name).shape, (n,), name)
        np.testing.assert_array_equal(fields.steps, range(s))
        np.testing.assert_array_equal(fields.times, self.result.times)

    def test_fields_and_measures_agree(self):
        fields, geometry = self.result.fields, self.result.geometry
        for i, fault in enumerate(geometry.faults):
            nodes = slice(fault.first_node, fault.first_node + fault.n_nodes)
            slip = np.linalg.norm(fields.slip[:, nodes, 1:], axis=2).max(axis=1)
            np.testing.assert_allclose(slip, self.result.history("max_slip_m")[:, i], rtol=1e-12)
            np.testing.assert_allclose(fields.critical_index[:, nodes].max(axis=1),
                                       self.result.history("chi_max")[:, i], rtol=1e-12)

    def test_geometry(self):
        geometry = self.result.geometry
        frames = np.stack([geometry.normal, geometry.strike, geometry.dip], axis=1)
        np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), frames.shape), atol=1e-12)
        for fault in geometry.faults:
            nodes = fault.node_of_point >= 0
            np.testing.assert_array_equal(fault.points[nodes], geometry.position[fault.node_of_point[nodes]])
            self.assertLess(fault.faces.max(), len(fault.points))
            for line in fault.profiles:
                self.assertEqual(len(line.edge), len(line.position) + 1)
                np.testing.assert_allclose(line.weight.sum(axis=1), 1)
                self.assertTrue(np.all(np.diff(line.position) > 0))
        self.assertEqual(geometry.dof_area.shape, (geometry.n_dofs,))

    def test_arrays_are_views_that_cannot_be_written(self):
        fields = self.result.fields
        one, two = fields.traction, fields.traction
        self.assertEqual(one.ctypes.data, two.ctypes.data)
        self.assertFalse(one.flags.owndata)
        for array in (one, self.result.geometry.position, self.simulation.operator.stiffness):
            self.assertFalse(array.flags.writeable)
            with self.assertRaises(ValueError):
                array[0] = 1

    def test_results_and_arrays_outlive_all_they_came_from(self):
        simulation = faultsim.Simulation(plane_scene())
        result = simulation.run()
        traction, stiffness = result.fields.traction, simulation.operator.stiffness
        position, edge = result.geometry.position, result.geometry.faults[0].profiles[0].edge
        wanted = [array.copy() for array in (traction, stiffness, position, edge)]
        svg = result.plot("profiles").svg
        del simulation
        gc.collect()
        self.assertEqual(result.plot("profiles").svg, svg)
        del result
        gc.collect()
        ballast = [np.full(100000, np.nan) for _ in range(20)]
        for array, copy in zip((traction, stiffness, position, edge), wanted):
            np.testing.assert_array_equal(array, copy)
        del ballast

    def test_without_fields(self):
        result = self.simulation.run(fields=False)
        self.assertIsNone(result.fields)
        self.assertEqual(bits(result), bits(self.result))
        result.plot("history")
        with self.assertRaises(faultsim.InputError) as raised:
            result.plot("profiles")
        self.assertIn("fields=True", str(raised.exception))

    def test_changes_are_of_one_run(self):
        changed = self.simulation.run(friction_angle=20 * deg)
        self.assertNotEqual(bits(changed), bits(self.result))
        self.assertEqual(bits(self.simulation.run()), bits(self.result))
        same = self.simulation.run({"friction_angle": "20 deg"})
        self.assertEqual(bits(same), bits(changed))
        self.assertNotEqual(same.identity, self.result.identity)

    def test_a_refused_change_leaves_the_scene_at_hand(self):
        before = self.simulation.identity
        with self.assertRaises(faultsim.InputError) as raised:
            self.simulation.run(friction_angle=120 * deg, cohesion=-1)
        self.assertEqual(len(raised.exception.problems), 2)
        self.assertEqual(self.simulation.identity, before)

    def test_what_is_no_value_is_said_by_name(self):
        run = self.simulation.run
        with self.assertRaisesRegex(TypeError, r"(?s)friction_angle: .*run_many.*cohesion: .* is no value"):
            run(friction_angle=np.array([0.4, 0.5]), cohesion=object())
        for wrong in ("friction_angle", [0.4]):
            with self.assertRaisesRegex(TypeError, "give a dict by parameter"):
                run(wrong)
        one = bits(run(friction_angle=0.4))
        for same in (np.float64(0.4), np.array(0.4), np.array([0.4])):  # the last is what scipy's optimisers give
            self.assertEqual(bits(run(friction_angle=same)), one)
        self.assertEqual(bits(run({"/numerics/follow_events": np.bool_(False)})), bits(run({"/numerics/follow_events": False})))

    def test_threads_and_callbacks_that_are_none(self):
        for work in (self.simulation.run, self.simulation.prepare, self.simulation.influence):
            for wrong in (0, -1):
                with self.assertRaisesRegex(ValueError, "whole number from 1"):
                    work(threads=wrong)
            for wrong in (1.5, "2", None):
                with self.assertRaisesRegex(TypeError, "whole number from 1"):
                    work(threads=wrong)
            with self.assertRaisesRegex(TypeError, "give a function of a share"):
                work(monitor=3)
        with self.assertRaisesRegex(TypeError, "compartments is a list"):
            self.simulation.influence("reservoir")

    def test_another_operator_where_one_is_needed(self):
        simulation = self.simulation.twin()
        self.assertFalse(simulation.needs_operator)
        simulation.change(offset="50 m")
        self.assertTrue(simulation.needs_operator)
        self.assertTrue(simulation.prepare())
        self.assertFalse(simulation.prepare())
        self.assertEqual(bits(simulation.run()), bits(self.result))

    def test_operator(self):
        operator = self.simulation.operator
        h = operator.stiffness
        self.assertEqual(h.shape, (operator.geometry.n_dofs,) * 2)
        np.testing.assert_array_equal(h, h.T)
        self.assertGreater(np.linalg.eigvalsh(h).min(), 0)
        self.assertEqual(operator.load_traction.shape, (len(h), len(operator.load_names)))
        self.assertEqual(operator.fingerprint, self.result.operator_fingerprint)
        self.assertEqual(operator.observed_per_jump.shape, (len(operator.observed_names), len(h)))

    def test_influence_of_cells_adds_up_to_the_load(self):
        operator, block = self.simulation.operator, self.simulation.influence()
        stress = np.ones(len(block.cell)) * block.fraction
        for region, name in enumerate(block.region_names):
            loads = [i for i, load in enumerate(operator.load_names) if load.startswith(f"pressure:{region}:")]
            of_region = np.where(block.region == region, stress, 0)
            change = block.locked_change(of_region[:, None])
            np.testing.assert_allclose(change[:, 0], block.traction @ of_region, rtol=1e-9, atol=1e-12)
            total = operator.load_traction[:, loads].sum(axis=1)
            np.testing.assert_allclose(change[:, 0], total, rtol=1e-6, atol=1e-9 * abs(total).max(), err_msg=name)
        self.assertEqual(block.operator_fingerprint, operator.fingerprint)
        with self.assertRaises(faultsim.InputError):
            self.simulation.influence(["nowhere"])

    def test_two_threads_with_two_simulations(self):
        angles = [np.linspace(15, 30, 12) * deg, np.linspace(31, 18, 12) * deg]
        results = [[], []]

        def run(which):
            simulation = faultsim.Simulation(plane_scene(offset=f"{60 + 20 * which} m"))
            results[which] = [bits(simulation.run(friction_angle=angle)) for angle in angles[which]]

        threads = [threading.Thread(target=run, args=(which,)) for which in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        at_once = results
        results = [[], []]
        for which in (0, 1):
            run(which)
        self.assertEqual(at_once, results)

    def test_one_simulation_is_for_one_thread(self):
        simulation = faultsim.Simulation(plane_scene())
        errors = []

        def intrude(done, total):
            try:
                simulation.run()
            except RuntimeError as error:
                errors.append(str(error))

        simulation.run_many(np.full((200, 1), 0.4), parameters=["friction_angle"], progress=intrude)
        self.assertTrue(errors)
        self.assertIn("another thread is using this simulation", errors[0])

    def test_pickling_is_refused(self):
        for what in (self.simulation, self.result):
            with self.assertRaises(TypeError) as raised:
                pickle.dumps(what)
            self.assertIn("cannot be pickled", str(raised.exception))
        pickle.dumps(self.result.to_dict())
        with self.assertRaisesRegex(TypeError, r"twin\(\)"):
            copy.copy(self.simulation)

    def test_charts(self):
        for chart in faultsim.charts():
            svg = self.result.plot(chart)._repr_svg_()
            self.assertTrue(svg.startswith("<svg"), chart)
        html = self.result._repr_html_()
        self.assertIn("<svg", html)
        self.assertIn("F1", html)
        with self.assertRaises(faultsim.InputError):
            self.result.plot("histroy")
        with self.assertRaises(faultsim.InputError):
            self.result.plot(fault="F99")

    def test_pandas(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("pandas is not installed")
        frame = self.result.to_pandas()
        self.assertEqual(len(frame), len(self.result.steps) * len(self.result.fault_names))
        np.testing.assert_array_equal(
            frame["chi_bar"].to_numpy().reshape(-1, len(self.result.fault_names)), self.result.history("chi_bar"))


if __name__ == "__main__":
    unittest.main()
