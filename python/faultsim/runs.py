"""Many cases: numbers in, arrays out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from .given import names_given
from .scene import value_as_text

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

Numbers = npt.NDArray[np.float64]
#: A parameter of many cases: its name, its SI unit, and a number or text per case.
Column = tuple[str, str, Any]


class Runs(Mapping[str, Numbers]):
    """What many cases gave: by name of the output an array with a number per case, NaN where it has none.

    What is true or not is 1 or 0, so that ``runs["slides"].mean()`` is a share.
    """

    def __init__(
        self, names: list[str], histories: list[str], faults: list[str], given: tuple[Any, ...], inputs: dict[str, Any]
    ) -> None:
        outputs, outcomes, refused, times, histories_given = given
        self._names = names
        self._inputs = inputs
        self.outputs: Numbers = outputs  #: n_cases x n_outputs, in SI.
        #: how each case ended, as of ``Result.outcome``; "refused" where its values were.
        self.outcomes: npt.NDArray[np.str_] = np.array(_core.outcome_names(), dtype="U16")[np.array(outcomes, dtype=int)]
        self.outcomes[list(refused)] = "refused"
        self.refused: dict[int, str] = refused  #: why, by the number of the case from 0.
        self.times: Numbers = np.array(times)  #: s, of load steps (n_steps); NaN where the first case did not get there.
        self.fault_names: list[str] = faults
        #: by key, n_cases x n_steps x n_faults, in SI; NaN behind the end of a history.
        self.histories: dict[str, Numbers] = {key: histories_given[..., i] for i, key in enumerate(histories)}

    def __getitem__(self, name: str) -> Numbers:
        try:
            column: Numbers = self.outputs[:, self._names.index(name)]
        except ValueError:
            raise KeyError(f"{name!r} was not asked for; there are {', '.join(self._names)}") from None
        return column

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def to_pandas(self) -> pandas.DataFrame:
        """A row per case: its parameters, how it ended, its outputs. Needs pandas."""
        import pandas

        columns: dict[str, Any] = {**self._inputs, "outcome": self.outcomes, **{name: self[name] for name in self}}
        return pandas.DataFrame(columns)

    def __repr__(self) -> str:
        return f"<faultsim.Runs of {len(self.outcomes)} cases: {', '.join(self._names)}>"


def columns_of(cases: Any, parameters: Sequence[str] | None, units: Mapping[str, str]) -> tuple[list[Column], int]:
    """Rows of cases as columns, each checked. Raises ValueError where shapes do not fit."""
    if hasattr(cases, "columns") and hasattr(cases, "iloc"):  # a DataFrame, without needing pandas
        twice = [name for name, again in zip(cases.columns, cases.columns.duplicated()) if again]
        if twice:
            raise ValueError(f"columns are there twice: {', '.join(map(repr, twice))}")
        cases = {name: cases[name].to_numpy() for name in cases.columns}
    if isinstance(cases, Mapping):
        names = names_given(list(cases) if parameters is None else parameters, "columns")
        missing = [name for name in names if name not in cases]
        if missing:
            raise ValueError(f"there is no column {', '.join(map(repr, missing))}")
        return _checked([_column(name, np.asarray(cases[name]), units) for name in names])
    values = np.asarray(cases)
    if parameters is None:
        raise ValueError("an array does not say what its columns are: give parameters=[...]")
    parameters = names_given(parameters, "parameters")
    if values.ndim != 2 or values.shape[1] != len(parameters):
        hint = "; write values[:, None]" if values.ndim == 1 and len(parameters) == 1 else ""
        raise ValueError(f"an array for {parameters} is n_cases x {len(parameters)}, and this is {values.shape}{hint}")
    columns = [_column(name, values[:, i], units) for i, name in enumerate(parameters)]
    return columns, values.shape[0]


def _checked(columns: list[Column]) -> tuple[list[Column], int]:
    lengths = {len(column[2]) for column in columns}
    if len(lengths) != 1:
        raise ValueError("columns have different lengths" if lengths else "there is no column")
    return columns, lengths.pop()


def _column(name: str, values: npt.NDArray[Any], units: Mapping[str, str]) -> Column:
    if values.ndim != 1:
        raise ValueError(f"{name!r} has {values.ndim} dimensions; a number or text per case is wanted")
    if values.dtype.kind in "fiu":
        return name, units.get(name, ""), np.ascontiguousarray(values, dtype=np.float64)
    return name, "", [_text(name, i, value, units.get(name, "")) for i, value in enumerate(values.tolist())]


def _text(name: str, case: int, value: Any, unit: str) -> str:
    try:
        return value_as_text(value, unit)
    except TypeError as error:
        raise TypeError(f"{name}, case {case}, counted from 0: {error}") from None
