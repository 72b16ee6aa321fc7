"""Campaigns: a store, read only. The values are those of the commands of ``faultsweep``."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, Union

import numpy as np
import numpy.typing as npt

from . import _core
from .charts import Chart
from .records import Record, refuse_pickle

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

Numbers = npt.NDArray[np.float64]
#: A case: its number from 1, or the beginning of its identity.
CaseName = Union[int, str]


def campaigns(store: str | os.PathLike[str]) -> list[str]:
    """The names of the campaigns of a store, newest last."""
    return _core.campaigns_of(os.fspath(store))


class Setting(NamedTuple):
    """A parameter of a case."""

    name: str
    value: float | None  #: in SI; None = a word.
    text: str  #: as given, with its unit.


class Table(Sequence[Record]):
    """A table of an answer: rows, or columns by key; numbers are in SI."""

    def __init__(self, rows: list[dict[str, Any]], columns: list[dict[str, Any]]) -> None:
        self._rows = rows
        self.keys: list[str] = [column["key"] for column in columns]  #: of its columns.
        self.units: dict[str, str] = {column["key"]: column["unit"] for column in columns}  #: SI, "" = a plain number.

    def __getitem__(self, i: Any) -> Any:
        return [Record(row) for row in self._rows[i]] if isinstance(i, slice) else Record(self._rows[i])

    def __len__(self) -> int:
        return len(self._rows)

    def column(self, key: str) -> Numbers:
        """A column of numbers or flags, NaN where there is none (n_rows); ``parameters.offset`` is within an object."""
        values = [_within(row, key) for row in self._rows]
        if values and all(value is _MISSING for value in values):
            raise KeyError(f"there is no column {key!r}; there are {', '.join(self.keys)}")
        return np.array([np.nan if value is None or value is _MISSING else value for value in values], dtype=np.float64)

    def to_pandas(self) -> pandas.DataFrame:
        """The same as a DataFrame; what is within objects has columns such as ``parameters.offset``. Needs pandas."""
        import pandas

        return pandas.json_normalize(self._rows)


_MISSING = object()


def _within(row: Any, key: str) -> Any:
    for part in key.split("."):
        row = row.get(part, _MISSING) if isinstance(row, dict) else _MISSING
    return row


class Answer(Mapping[str, Table]):
    """What a command answers: sentences, and tables by name. A notebook shows it as its page does."""

    def __init__(self, core: _core.CoreAnswer) -> None:
        self._core = core
        self._values = core.value()
        self.headline: list[str] = core.headline()  #: the answer in sentences, the most important first.
        self.notes: list[str] = self._values.get("notes", [])  #: what is to be known of it.

    def __getitem__(self, table: str) -> Table:
        return Table(self._values[table], self._values["columns"][table])

    def __iter__(self) -> Iterator[str]:
        return iter(self._values.get("columns", {}))

    def __len__(self) -> int:
        return len(self._values.get("columns", {}))

    def to_dict(self) -> dict[str, Any]:
        """What the command prints with ``--json``."""
        return self._values

    def plot(self) -> Chart:
        """Its first chart. Raises ValueError where it has none."""
        svg = self._core.drawn()
        if not svg:
            raise ValueError("this answer has no chart")
        return Chart(svg)

    def __str__(self) -> str:
        return self._core.text()

    def __repr__(self) -> str:
        return f"<faultsim.Answer: {self.headline[0] if self.headline else ''}>"

    def _repr_html_(self) -> str:
        return self._core.html()


class Case:
    """A case of a campaign."""

    def __init__(self, campaign: Campaign, name: CaseName) -> None:
        self._campaign = campaign
        number, self.identity, self.state, self.has_result, self.fields_folder, settings = campaign._core.case_info(
            str(name)
        )
        self.number: int = number  #: its number in the campaign, from 1.
        self.settings: list[Setting] = [Setting(*one) for one in settings]  #: its parameters.

    @property
    def result(self) -> Record | None:
        """Its result, as of ``Result``: the keys of ``result.json``; None where it has none."""
        kept = self._campaign._core.case_result(str(self.number))
        return None if kept is None else Record(kept.value())

    def history(self, key: str) -> Numbers:
        """A measure of each fault at the end of each load step, n_steps x n_faults, in SI: ``chi_bar``."""
        kept = self._campaign._core.case_result(str(self.number))
        if kept is None:
            raise ValueError(f"case {self.number} has no result")
        return kept.history(key)

    def show(self, *, stage: str = "", fault: str = "") -> Answer:
        """What ``faultsweep show`` says of it."""
        return Answer(self._campaign._core.show(str(self.number), stage, fault))

    def why(self, *, by: str = "") -> Answer:
        """Why it stands where it does, as of ``faultsweep rank --why``."""
        return Answer(self._campaign._core.why(str(self.number), by))

    def explain(self) -> Answer:
        """Whether it will run and why, as of ``faultsweep explain``."""
        return Answer(self._campaign._core.explain(str(self.number)))

    def plot(self, chart: str = "history", *, fault: str = "", step: int | None = None, show: str = "chi") -> Chart:
        """A chart of it, as of ``Result.plot``; some need fields, which campaigns keep where they are told to."""
        return Chart(self._campaign._core.draw_case(str(self.number), chart, fault, step, show))

    def _repr_html_(self) -> str:
        return self.show()._repr_html_() + (self.plot().svg if self.has_result else "")


class Campaign(Mapping[int, Case]):
    """A campaign of a store, open for reading: cases by number, and its answers.

    Every question sees the store as it is then, also while the campaign runs; ``counts`` after ``refresh``.
    """

    def __init__(self, store: str | os.PathLike[str], name: str = "") -> None:
        """name: "" = the newest. Raises StorageError where there is no store, InputError for a name that is none."""
        self._core = _core.StoredCampaign(os.fspath(store), name)

    @property
    def name(self) -> str:
        """Its name."""
        return self._core.name()

    @property
    def counts(self) -> dict[str, int]:
        """How many cases it has, and how many are done, wait, failed, and are complete."""
        return dict(self._core.counts())

    def refresh(self) -> None:
        """Counts again."""
        self._core.refresh()

    def __getitem__(self, name: CaseName) -> Case:
        return Case(self, name)

    def __iter__(self) -> Iterator[int]:
        return iter(range(1, self.counts["cases"] + 1))

    def __len__(self) -> int:
        return self.counts["cases"]

    def status(self) -> Answer:
        """How it stands, as of ``faultsweep status``."""
        return Answer(self._core.status())

    def ranking(
        self, by: str = "", *, where: str = "", stage: str = "", fault: str = "", ascending: bool = False, top: int = 0
    ) -> Answer:
        """Cases in order, as of ``faultsweep rank``; top: 0 = all."""
        return Answer(self._core.ranking(by, where, stage, fault, ascending, top))

    def probability(self, of: str = "", *, where: str = "", by: str = "", confidence: float = 0.95) -> Answer:
        """How often something holds, with bounds, as of ``faultsweep probability``; of: "" = that each fault slides."""
        return Answer(self._core.probability(of, where, by, confidence))

    def curves(
        self, against: str = "step", *, where: str = "", stage: str = "", confidence: float = 0.95
    ) -> Answer:
        """How often each fault has begun to slide by then; against: ``step``, ``time`` or ``pressure``."""
        return Answer(self._core.curves(against, where, stage, confidence))

    def quantiles(
        self,
        metrics: str | Sequence[str],
        *,
        at: Sequence[float] = (0.05, 0.5, 0.95),
        where: str = "",
        confidence: float = 0.95,
    ) -> Answer:
        """Quantiles of metrics, as of ``faultsweep probability --quantiles``."""
        names = metrics if isinstance(metrics, str) else ",".join(metrics)
        return Answer(self._core.quantiles(names, list(at), where, confidence))

    def posterior(
        self,
        seen: str | Sequence[str],
        *,
        of: str | Sequence[str] = (),
        where: str = "",
        confidence: float = 0.95,
    ) -> Answer:
        """What follows once something was seen, as of ``faultsweep posterior``: "F2 did not slide before 8 yr"."""
        statements = [seen] if isinstance(seen, str) else list(seen)
        conditions = [of] if isinstance(of, str) else list(of)
        return Answer(self._core.posterior(statements, conditions, where, confidence))

    def sensitivity(
        self,
        metrics: str | Sequence[str] = "",
        *,
        where: str = "",
        stage: str = "",
        fault: str = "",
        by_step: bool = False,
        confidence: float = 0.95,
    ) -> Answer:
        """Which parameter matters, as of ``faultsweep sensitivity``."""
        names = metrics if isinstance(metrics, str) else ",".join(metrics)
        return Answer(self._core.sensitivity(names, where, stage, fault, by_step, confidence))

    def limits(self) -> Answer:
        """Limits that a search has found, as of ``faultsweep limits``."""
        return Answer(self._core.limits())

    def plot(self, x: str = "", y: str = "") -> Chart:
        """What became of its cases over two parameters, as of ``faultsweep plot map``; "" = the first ones."""
        return Chart(self._core.draw_map(x, y))

    def __repr__(self) -> str:
        counts = self.counts
        return f"<faultsim.Campaign {self.name!r}: {counts['done']} of {counts['cases']} cases done>"

    def _repr_html_(self) -> str:
        try:
            svg = self.plot().svg
        except ValueError as error:  # no parameters, or no results yet
            svg = f"<p>{escape(str(error))}</p>"
        return self.status()._repr_html_() + svg

    def __reduce__(self) -> NoReturn:
        refuse_pickle("an open campaign", "open it in the other process")
        raise AssertionError


def metrics() -> Answer:
    """What cases can be ranked and filtered by, as of ``faultsweep rank --list-metrics``."""
    return Answer(_core.metrics())
