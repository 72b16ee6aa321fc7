"""Numbers bit for bit those of `faultsim run`, in plane strain and in 3D, with weakening and with creeping salt."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import faultsim
from scenes import bits

BIN = Path(os.environ["FAULTSIM_BIN"])
ROOT = Path(os.environ["FAULTSIM_ROOT"])


def run_program(file, changes, folder):
    """The result.json of a run, by the program."""
    out = os.path.join(folder, "result")
    sets = [part for change in changes.items() for part in ("--set", "=".join(change))]
    subprocess.run([BIN / "faultsim", "run", file, *sets, "--no-cache", "--path", "condensed", "-o", out],
                   check=True, capture_output=True)
    with open(os.path.join(out, "result.json"), encoding="utf-8") as result:
        return json.load(result)


class ProgramTest(unittest.TestCase):
    def check(self, file, changes):
        with tempfile.TemporaryDirectory() as folder:
            wanted = bits(run_program(file, changes, folder))
        result = faultsim.Simulation(faultsim.Scene.from_file(file).set(changes)).run(threads=2)
        got = bits(result)
        for key in got:
            self.assertEqual(got[key], wanted[key], key)
        self.assertLessEqual(set(wanted) - set(got), {"initial_state", "field_integrals"})

    def test_plane_strain(self):
        self.check(ROOT / "docs/examples/scenes/rotliegend.json",
                   {"tier": "screening", "/numerics/plane_strain": "on", "friction_angle": "22 deg"})

    def test_three_dimensions(self):
        self.check(ROOT / "docs/examples/scenes/rotliegend.json", {"tier": "screening", "offset": "60 m"})

    def test_weakening(self):
        self.check(ROOT / "docs/examples/scenes/rotliegend-weakening.json",
                   {"tier": "screening", "/numerics/plane_strain": "on"})

    def test_salt_that_creeps(self):
        self.check(ROOT / "docs/examples/scenes/rotliegend-salt.json",
                   {"tier": "screening", "/numerics/plane_strain": "on"})

    def test_the_linear_algebra_is_the_program_s(self):
        said = subprocess.run([BIN / "faultsim", "environment"], check=True, capture_output=True, text=True).stdout
        kernel = next(line.split()[1] for line in said.splitlines() if line.startswith("blas_kernel "))
        self.assertIn(kernel, faultsim.environment()["blas"])

    def test_an_old_kernel_is_left_unless_the_user_wants_it(self):
        say = "import faultsim; print(faultsim.environment()['blas'])"
        # What OpenBLAS takes on a processor that it does not know.
        taken = "import ctypes, os; ctypes.CDLL('libopenblas.so.0'); del os.environ['OPENBLAS_CORETYPE']; "
        run = "faultsim.Simulation(faultsim.Scene.field(tier='screening')).run()"
        said = [subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True,
                               env={**os.environ, "OPENBLAS_CORETYPE": "Prescott"}).stdout
                for program in (say, f"{taken}{say}; {run}")]
        self.assertIn("Prescott", said[0])
        with open("/proc/cpuinfo", encoding="utf-8") as cpu:
            if " avx2 " not in cpu.read():
                self.skipTest("the processor has no wider one")
        self.assertNotIn("Prescott", said[1])


if __name__ == "__main__":
    unittest.main()
