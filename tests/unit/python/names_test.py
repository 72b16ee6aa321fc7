"""Every public name is documented, is in the types, and these hold."""

import inspect
import subprocess
import sys
import unittest
from pathlib import Path

import faultsim

HERE = Path(__file__).parent


def members(cls):
    """Public members of a class that are its own or of a class of ours."""
    for name, member in inspect.getmembers(cls):
        if name.startswith("_") or name in ("with_traceback", "add_note"):
            continue
        owner = next((one for one in cls.__mro__ if name in vars(one)), None)
        if owner is not None and owner.__module__.startswith("faultsim"):
            yield name, vars(owner)[name]


class NamesTest(unittest.TestCase):
    def test_every_public_name_is_documented(self):
        missing = []
        for name in faultsim.__all__:
            thing = getattr(faultsim, name)
            if not (thing.__doc__ or "").strip():
                missing.append(name)
            if inspect.isclass(thing) and not issubclass(thing, tuple):
                missing += [f"{name}.{member}" for member, value in members(thing)
                            if not (getattr(value, "__doc__", None) or "").strip()]
        self.assertEqual(missing, [])

    def test_the_list_of_names_is_whole(self):
        here = {name for name, value in vars(faultsim).items() if not name.startswith("_")
                and (inspect.isclass(value) or inspect.isfunction(value))}
        self.assertEqual(here - set(faultsim.__all__), {"annotations"} & here)

    def test_arrays_say_shape_and_unit(self):
        for cls in (faultsim.Geometry, faultsim.Fault, faultsim.Profile, faultsim.Fields, faultsim.Operator, faultsim.Influence):
            for name, member in members(cls):
                if isinstance(member, property) and "NDArray" in stub_of(cls.__name__, name):
                    self.assertRegex(member.__doc__, r"n_|\(", f"{cls.__name__}.{name}")

    def test_types_hold(self):
        root = Path(faultsim.__file__).parent.parent
        checked = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", "-p", "faultsim"],
            capture_output=True, text=True, cwd=root, check=False)
        if "No module named mypy" in checked.stderr:
            self.skipTest("mypy is not installed")
        self.assertEqual(checked.returncode, 0, checked.stdout)
        checked = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", str(HERE / "typed_example.py")],
            capture_output=True, text=True, env={"MYPYPATH": str(root), "PATH": "/usr/bin:/bin"}, check=False)
        self.assertEqual(checked.returncode, 0, checked.stdout)

    def test_stubs_have_what_the_compiled_part_has(self):
        for name, cls in inspect.getmembers(faultsim._core, inspect.isclass):
            for member in vars(cls):
                if not member.startswith("_"):
                    self.assertTrue(stub_of(name, member), f"{name}.{member} is not in _core.pyi")
        text = stub_text()
        for name, _ in inspect.getmembers(faultsim._core, inspect.isbuiltin):
            self.assertIn(f"def {name}(", text)


def stub_text():
    return (Path(faultsim.__file__).parent / "_core.pyi").read_text(encoding="utf-8")


def stub_of(cls, member):
    """The line of a member in the stubs; "" = none."""
    body = stub_text().split(f"class {cls}:")[1].split("\nclass ")[0] if f"class {cls}:" in stub_text() else ""
    lines = [line for line in body.splitlines() if line.strip().startswith(f"def {member}(")]
    return lines[0] if lines else ""


if __name__ == "__main__":
    unittest.main()
