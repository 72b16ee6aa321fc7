"""A campaign by the commands and by the module: the same values."""

import json
import os
import pickle
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import faultsim

BIN = Path(os.environ["FAULTSIM_BIN"])
ROOT = Path(os.environ["FAULTSIM_ROOT"])


class CampaignTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.store = os.path.join(cls.folder.name, "store")
        spec = ROOT / "docs/examples/campaigns/small.json"
        subprocess.run([BIN / "faultsweep", "submit", spec, "--store", cls.store], check=True, capture_output=True)
        subprocess.run([BIN / "faultsweep", "run", "--workers", "1", "--store", cls.store], check=False, capture_output=True)
        cls.campaign = faultsim.Campaign(cls.store)

    @classmethod
    def tearDownClass(cls):
        del cls.campaign
        cls.folder.cleanup()

    def said(self, *command):
        """What a command prints with --json."""
        return json.loads(subprocess.run([BIN / "faultsweep", *command, "--store", self.store, "--json"], check=True,
                                         capture_output=True).stdout)

    def check(self, answer, *command):
        said, got = self.said(*command), answer.to_dict()
        self.assertEqual(got, said)
        for key in answer:
            self.assertEqual(len(answer[key]), len(said[key]))

    def test_counts_and_names(self):
        self.assertEqual(faultsim.campaigns(self.store), [self.campaign.name])
        counts = self.campaign.counts
        self.assertEqual(counts["cases"], len(self.campaign))
        self.assertEqual(counts["done"], counts["cases"])
        self.assertEqual(list(self.campaign), list(range(1, counts["cases"] + 1)))

    def test_answers_are_those_of_the_commands(self):
        name = self.campaign.name
        self.check(self.campaign.ranking(), "rank", name, "--top", "0")
        self.check(self.campaign.ranking("max_slip", where="chi_bar > 0.5", ascending=True, top=3),
                   "rank", name, "--top", "3", "--by", "max_slip", "--where", "chi_bar > 0.5", "--ascending")
        self.check(self.campaign.probability("chi_bar > 0.8"), "probability", name, "--of", "chi_bar > 0.8")
        self.check(self.campaign.sensitivity(), "sensitivity", name)
        self.check(self.campaign[1].show(), "show", f"{name}/1")
        self.check(self.campaign[1].explain(), "explain", f"{name}/1")
        self.check(faultsim.metrics(), "rank", "--list-metrics")

    def test_cases(self):
        case = self.campaign[2]
        said = self.said("show", f"{self.campaign.name}/2")
        self.assertEqual(case.number, 2)
        self.assertEqual(case.result["whole"]["chi_bar"], said["result"]["whole"]["chi_bar"])
        history = case.history("chi_bar")
        np.testing.assert_array_equal(
            history, [[fault["chi_bar"] for fault in step["faults"]] for step in said["result"]["steps"]])
        self.assertEqual(self.campaign[case.identity[:12]].number, 2)
        self.assertTrue(case.settings)
        for setting in case.settings:
            self.assertIsInstance(setting.text, str)
        with self.assertRaises(faultsim.InputError):
            self.campaign[100000]

    def test_tables(self):
        ranking = self.campaign.ranking()
        table = next(iter(ranking.values()))
        chi = table.column("chi_bar")
        self.assertEqual(len(chi), len(table))
        self.assertEqual(chi[0], table[0].chi_bar)
        np.testing.assert_array_equal(table.column("parameters.friction_angle"),
                                      [row.parameters.friction_angle for row in table])
        with self.assertRaises(KeyError):
            table.column("nothing")
        try:
            import pandas  # noqa: F401
        except ImportError:
            return
        self.assertEqual(list(table.to_pandas()["chi_bar"]), list(chi))

    def test_shown_in_notebooks(self):
        self.assertIn("<svg", self.campaign._repr_html_())
        self.assertIn("<table", self.campaign.ranking()._repr_html_())
        self.assertIn("<svg", self.campaign[1]._repr_html_())
        self.assertTrue(self.campaign[1].plot().svg.startswith("<svg"))
        self.assertTrue(str(self.campaign.status()))
        with self.assertRaises(faultsim.InputError):
            self.campaign[1].plot("profiles")

    def test_what_is_not_there(self):
        with self.assertRaises(faultsim.StorageError) as raised:
            faultsim.Campaign("/nowhere")
        self.assertIn("/nowhere", str(raised.exception))
        with self.assertRaises(faultsim.InputError):
            faultsim.Campaign(self.store, "nobody")
        with self.assertRaises(faultsim.InputError):
            self.campaign.ranking("chi_bra")
        with self.assertRaises(TypeError):
            pickle.dumps(self.campaign)

    def test_read_only(self):
        before = os.stat(os.path.join(self.store, "campaign.sqlite")).st_mtime_ns
        self.campaign.refresh()
        self.campaign.status()
        self.assertEqual(os.stat(os.path.join(self.store, "campaign.sqlite")).st_mtime_ns, before)


if __name__ == "__main__":
    unittest.main()
