"""Simulations: a scene that is held, and its operator."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, Union

import numpy.typing as npt

from . import _core
from .given import names_given, threads_given, told_given
from .records import refuse_pickle
from .result import Result
from .runs import Runs, columns_of
from .scene import Scene, Value, changes_as_text, units_of

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

#: Cases as rows: a DataFrame, whose columns are parameters, a 2D array, or columns by parameter.
Cases = Union["pandas.DataFrame", npt.ArrayLike, Mapping[str, Sequence[Any]]]
#: Told how far work is: a share from 0 to 1, and what is being done.
Monitor = Callable[[float, str], object]
_SHARE_AND_WHAT = "a share and what is done"


class Simulation:
    """A scene that is held, and the operator that it and its changes run on.

    The first run builds the operator, which takes seconds to minutes; further ones take what their contact problem
    takes. A change of mesh, stiffness or boundary conditions needs another operator, which is built when it runs.

    One simulation is for one thread at a time; ``twin`` makes another one. While it works, other threads of Python
    run, and Ctrl-C is heard within 50 ms.
    """

    def __init__(self, scene: Scene, *, cache: str | os.PathLike[str] | None = None) -> None:
        """Raises InputError with all that is wrong with the scene.

        cache: a folder where operators are kept as files, for other runs and processes; None = nowhere.
        """
        if not isinstance(scene, Scene):
            raise TypeError(f"{scene!r} is no Scene; make one with Scene(dict), Scene.from_file(name) or Scene.field()")
        self._scene = scene.copy()
        self._held = _core.HeldSimulation(self._scene._document, os.fspath(cache) if cache is not None else "")
        self._units = units_of(self._scene)

    @property
    def scene(self) -> Scene:
        """A copy of the scene that is held, without changes."""
        return self._scene.copy()

    @property
    def plan_text(self) -> str:
        """What will be modelled of the scene at hand, why, and what it costs."""
        return self._held.plan_text()

    @property
    def identity(self) -> str:
        """Fingerprint of the case at hand."""
        return self._held.identity()

    @property
    def needs_operator(self) -> bool:
        """Whether the scene at hand needs another operator than the one that is there."""
        return self._held.needs_operator()

    def twin(self) -> Simulation:
        """Another one of the same scene, for another thread, which shares the operator."""
        other = Simulation.__new__(Simulation)
        other._scene, other._units = self._scene, self._units
        other._held = self._held.twin()
        return other

    def change(self, values: Mapping[str, Value] | None = None, /, **changes: Value) -> None:
        """Makes the scene at hand the held one with these changes, and none of earlier ones.

        Raises InputError with all that is wrong; the scene at hand is then the one before.
        """
        self._held.change(self._texts(values, changes))

    def prepare(self, *, monitor: Monitor | None = None, threads: int = 1) -> bool:
        """Reads or builds the operator of the scene at hand, unless it is there. Returns whether it did.

        threads: of the factorisation. No bit of a result depends on them.
        """
        return self._held.prepare(told_given(monitor, "monitor", _SHARE_AND_WHAT), threads_given(threads))

    def run(
        self,
        values: Mapping[str, Value] | None = None,
        /,
        *,
        fields: bool = True,
        monitor: Monitor | None = None,
        threads: int = 1,
        **changes: Value,
    ) -> Result:
        """Runs the held scene with these changes: ``simulation.run(friction_angle=25 * deg)``.

        values: changes by JSON Pointer, or by short name where one is called as an argument here.
        fields: keep the fields of the faults at each load step.
        """
        told = told_given(monitor, "monitor", _SHARE_AND_WHAT)
        return Result(self._held.run(self._texts(values, changes), fields, told, threads_given(threads)))

    def run_many(
        self,
        cases: Cases,
        *,
        parameters: Sequence[str] | None = None,
        outputs: Sequence[str] | None = None,
        histories: Sequence[str] = (),
        threads: int = 1,
        progress: Callable[[int, int], object] | None = None,
        on_error: str = "raise",
    ) -> Runs:
        """Runs the held scene once per row, each with its changes to it.

        cases: a DataFrame (its columns are parameters) or a 2D array, n_cases x n_parameters, of numbers in SI; columns
            of a DataFrame may be texts with units.
        parameters: short names or JSON Pointers of the columns; None = those of the DataFrame.
        outputs: names of ``faultsim.outputs()``, of the whole case; ``F2.chi_bar`` is of a fault, ``chi_bar in production``
            of a stage, ``F2.chi_bar in production`` of both. None = all of the whole case.
        histories: measures of each fault at each load step, as of ``Result.history``.
        threads: each has a twin of this simulation. No bit depends on how many there are.
        progress: called with how many are done, and of how many, in this thread; what it raises ends the work.
        on_error: "raise" = values that are refused end the work; "keep" = such a case has no numbers, and
            ``Runs.refused`` says why.

        Raises InputError with all that is wrong before the first case: names that are none, numbers that are not finite
        (unless such cases are kept). Fields are not kept. Ctrl-C ends it within 50 ms.
        """
        if on_error not in ("raise", "keep"):
            raise ValueError(f"on_error is {on_error!r}; write 'raise' or 'keep'")
        columns, n_cases = columns_of(cases, parameters, self._units)
        names = names_given(outputs, "outputs") if outputs is not None else _core.output_names()
        kept = names_given(histories, "histories")
        told = told_given(progress, "progress", "how many are done and of how many")
        given = _core.run_many(
            self._held, columns, n_cases, names, kept, on_error == "keep", threads_given(threads), told
        )
        return Runs(names, kept, self._held.fault_names(), given, {c[0]: c[2] for c in columns})

    @property
    def geometry(self) -> _core.Geometry:
        """Where the nodes of the faults are. Builds the operator unless it is there."""
        self.prepare()
        return self._held.geometry()

    @property
    def operator(self) -> _core.Operator:
        """The rock condensed onto the faults, as arrays. Builds it unless it is there."""
        self.prepare()
        return _core.operator_of(self._held)

    def influence(
        self, compartments: Sequence[str] = (), *, monitor: Monitor | None = None, threads: int = 1
    ) -> _core.Influence:
        """What stress in single cells of these compartments (all where none is named) does to the faults.

        It takes a factorisation, unless the simulation has a cache with it.
        """
        told = told_given(monitor, "monitor", _SHARE_AND_WHAT)
        return _core.influence_of(self._held, names_given(compartments, "compartments"), told, threads_given(threads))

    def _texts(self, values: Mapping[str, Value] | None, changes: Mapping[str, Value]) -> list[tuple[str, str]]:
        return changes_as_text(self._scene, values, changes, self._units)

    def __repr__(self) -> str:
        return f"<faultsim.Simulation of {self._scene!r}>"

    def __reduce__(self) -> NoReturn:
        refuse_pickle("a simulation", "twin() makes another one here; for another process pickle its scene")
        raise AssertionError

