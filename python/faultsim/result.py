"""Results: what became of a case."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
import numpy.typing as npt

from . import _core
from .charts import Chart
from .records import Record, as_record, refuse_pickle

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

Numbers = npt.NDArray[np.float64]
_FAULT_COLUMNS = ("step", "stage", "time_s", "fault")


class Result(Record):
    """A case that was run: the values of ``result.json``, by its keys, and its fields.

    ``result.outcome``, ``result.whole.chi_bar``, ``result.steps[3].time_s``, ``result.stages[1].faults[0].max_slip_m``.
    It needs neither its simulation nor any other result, and goes on being whole when they are gone.
    """

    def __init__(self, kept: _core.KeptResult) -> None:
        self._kept = kept

    @cached_property
    def _values(self) -> dict[str, Any]:  # type: ignore[override]
        return self._kept.value()

    @property
    def outcome(self) -> str:
        """How it ended: ``converged``, ``event``, ``unresolved_event`` (in equilibrium to the end), ``unconverged``,
        ``unstable``, ``interrupted``, ``failed``."""
        return self._kept.outcome

    @cached_property
    def whole(self) -> Record:
        """Measures over the whole case, also by fault; quicker to get than all values are: ``result.whole.chi_bar``."""
        return Record(self._kept.whole())

    @property
    def geometry(self) -> _core.Geometry:
        """Where the nodes of its faults are."""
        return self._kept.geometry

    @property
    def fields(self) -> _core.Fields | None:
        """Traction, slip and others at the nodes of all faults; None where it was run with ``fields=False``."""
        return self._kept.fields

    @property
    def times(self) -> Numbers:
        """s, of its load steps (n_steps)."""
        return np.array([step["time_s"] for step in self._values["steps"]])

    @property
    def fault_names(self) -> list[str]:
        """In the order of histories."""
        return list(self._values["faults"])

    def history(self, key: str) -> Numbers:
        """A measure of each fault at the end of each load step, n_steps x n_faults, in SI.

        key: ``chi_bar``, ``max_slip_m``, ``moment_nm``: the keys of ``steps[k].faults[i]``.
        """
        return self._kept.history(key)

    def sentences(self) -> list[str]:
        """What slides, how far, and what is not to be taken for certain."""
        return self._kept.sentences()

    def plot(self, chart: str = "history", *, fault: str = "", step: int | None = None, show: str = "chi") -> Chart:
        """A chart of it, as of ``faultsim plot``.

        chart: ``history``, ``thickness``, ``slip``, ``section``, ``profiles``, ``fault-map``, ``stress-path``.
        fault: "" = that of the largest chi bar. step: None = that of the largest chi bar.
        show: of a fault map: ``chi``, ``slip``, ``state`` or ``pressure``.
        """
        return Chart(self._kept.drawn(chart, fault, step, show))

    def to_dict(self) -> dict[str, Any]:
        """What ``json`` reads from the ``result.json`` of a run."""
        return self._kept.value()

    def to_pandas(self) -> pandas.DataFrame:
        """A row per load step and fault with its measures, in SI. Needs pandas."""
        import pandas

        values = self._values
        rows = [
            {"step": step["step"], "stage": step["stage"], "time_s": step["time_s"], "fault": name, **measures}
            for step in values["steps"]
            for name, measures in zip(values["faults"], step["faults"])
        ]
        return pandas.DataFrame(rows, columns=None if rows else list(_FAULT_COLUMNS))

    def __repr__(self) -> str:
        return f"<faultsim.Result {self._values['title']!r}: {self.outcome}>"

    def _repr_html_(self) -> str:
        paragraphs = "".join(f"<p>{escape(one)}</p>" for one in self.sentences())
        return f"<div>{paragraphs}{_fault_table(self._values)}{self.plot().svg if self._values['steps'] else ''}</div>"

    def __reduce__(self) -> NoReturn:
        refuse_pickle("a result", "pickle its to_dict(), and copies of its arrays")
        raise AssertionError


def _fault_table(values: Mapping[str, Any]) -> str:
    columns = {"fault": "fault", "activated": "slides", "chi_bar": "chi bar", "max_slip_m": "max slip, m"}
    head = "".join(f"<th>{escape(name)}</th>" for name in columns.values())
    rows = "".join(
        "<tr>" + "".join(f"<td>{escape(_shown(fault.get(key)))}</td>" for key in columns) + "</tr>"
        for fault in values["whole"]["faults"]
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _shown(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


__all__ = ["Result", "as_record"]
