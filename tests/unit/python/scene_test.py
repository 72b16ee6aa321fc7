"""Scenes from dict, file and starter; changes with units; problems as one exception."""

import json
import os
import pickle
import tempfile
import unittest

import numpy as np

import faultsim
from faultsim.units import MPa, bar, deg, m
from scenes import plane_scene


class SceneTest(unittest.TestCase):
    def test_dict_file_and_starter_are_the_same_scene(self):
        starter = faultsim.Scene.field()
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "field.json")
            with open(file, "w", encoding="utf-8") as out:
                out.write(starter.to_json())
            self.assertEqual(faultsim.Scene.from_file(file).identity, starter.identity)
        self.assertEqual(faultsim.Scene(starter.to_dict()).identity, starter.identity)
        self.assertNotEqual(faultsim.Scene.box().identity, starter.identity)

    def test_numbers_are_in_si_and_texts_have_units(self):
        by_text = plane_scene(offset="120 m", cohesion="2 bar", ratio_across="0.7")
        by_number = plane_scene(offset=120 * m, cohesion=np.int64(200000), ratio_across=np.float64(0.7))
        self.assertEqual(by_text.to_dict()["geometry"]["blocks"][1]["offset"], "120 m")
        self.assertEqual(by_number.to_dict()["geometry"]["blocks"][1]["offset"], "120 m")
        self.assertEqual(by_text.identity, by_number.identity)
        angle = plane_scene(friction_angle=25 * deg).to_dict()["friction"]["friction_angle"]
        self.assertEqual(angle, f"{25 * deg:.17g} rad")

    def test_numbers_keep_their_bits(self):
        for value in (0.1, 1 / 3, 123456.789e3, 2.2250738585072014e-300, np.nextafter(0.7, 1)):
            text = faultsim.scene.value_as_text(value, "Pa")
            self.assertEqual(float(text.split()[0]), value)

    def test_values_other_than_numbers(self):
        scene = plane_scene()
        scene.set({"/numerics/follow_events": False, "/friction/cohesion": 1 * MPa})
        document = scene.to_dict()
        self.assertIs(document["numerics"]["follow_events"], False)
        self.assertEqual(document["friction"]["cohesion"], "1000000 Pa")

    def test_set_returns_itself_and_a_copy_is_another(self):
        scene = plane_scene()
        copy = scene.copy()
        self.assertIs(scene.set(friction_angle=20 * deg), scene)
        self.assertNotEqual(scene.identity, copy.identity)

    def test_all_problems_in_one_exception(self):
        with self.assertRaises(faultsim.InputError) as raised:
            plane_scene(frction_angle=0.4, offset_eats="3 m")
        error = raised.exception
        self.assertEqual(len(error.problems), 2)
        self.assertIn('did you mean "friction_angle"?', error.problems[0].cure)
        self.assertIsInstance(error, ValueError)
        self.assertIsInstance(error, faultsim.Error)

        wrong = plane_scene(friction_angle="99 deg", cohesion="-1 bar")
        with self.assertRaises(faultsim.InputError) as raised:
            faultsim.Simulation(wrong)
        problems = raised.exception.problems
        self.assertEqual(sorted(one.pointer for one in problems), ["/friction/cohesion", "/friction/friction_angle"])
        for one in problems:
            self.assertTrue(one.what and one.cure and one.pointer)
            self.assertIn(one.what, str(raised.exception))
        with self.assertRaises(faultsim.InputError):
            wrong.plan()

    def test_a_refused_set_changes_nothing(self):
        scene = plane_scene()
        before = scene.to_json()
        with self.assertRaises(faultsim.InputError):
            scene.set(friction_angle=20 * deg, nothing=1)
        self.assertEqual(scene.to_json(), before)

    def test_documents_that_are_none(self):
        with self.assertRaises(faultsim.InputError) as raised:
            faultsim.Scene.from_file("/nowhere/scene.json")
        self.assertIn("/nowhere/scene.json", str(raised.exception))
        with self.assertRaises(faultsim.InputError):
            faultsim.Scene({"title": "no geometry"}).check()
        with self.assertRaises(TypeError):
            faultsim.Scene({"title": object()})
        for wrong in ("field.json", [1]):
            with self.assertRaisesRegex(TypeError, "Scene.from_file"):
                faultsim.Scene(wrong)
            with self.assertRaisesRegex(TypeError, "is no Scene"):
                faultsim.Simulation(wrong)

    def test_numpy_in_documents(self):
        document = faultsim.Scene.field().to_dict()
        document["numerics"] = {"follow_events": np.bool_(False)}
        self.assertIs(faultsim.Scene(document).to_dict()["numerics"]["follow_events"], False)
        self.assertEqual(faultsim.Scene.field({"/numerics/plane_strain": "on"}, tier="screening").identity, plane_scene().identity)

    def test_plan(self):
        plan = plane_scene().plan()
        self.assertIn("plane strain", str(plan))
        self.assertGreater(plan.n_steps if "n_steps" in plan else len(plan), 0)

    def test_parameters(self):
        parameters = {one.alias: one for one in plane_scene().parameters() if one.alias}
        self.assertEqual(parameters["friction_angle"].unit, "rad")
        self.assertTrue(parameters["friction_angle"].description)

    def test_a_scene_can_be_pickled(self):
        scene = plane_scene(cohesion=3 * bar)
        self.assertEqual(pickle.loads(pickle.dumps(scene)).identity, scene.identity)
        json.dumps(scene.to_dict())


if __name__ == "__main__":
    unittest.main()
