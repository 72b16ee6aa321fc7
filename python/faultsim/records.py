"""Values by name, as result.json has them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any


class Record(Mapping[str, Any]):
    """Values by the keys of result.json, also as attributes: ``record.chi_bar``, ``record["moment_nm"]``.

    The end of a key is its unit: ``max_slip_m`` is in m, ``moment_nm`` in N m. Objects within are records too.
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._values = dict(values)

    def __getitem__(self, key: str) -> Any:
        return as_record(self._values[key])

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        try:
            return self[key]
        except KeyError:
            raise AttributeError(f"there is no {key!r}; there are {', '.join(self._values)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._values]

    def __repr__(self) -> str:
        return f"Record({self._values!r})"


def as_record(value: Any) -> Any:
    """Objects as records, lists of them as lists of records."""
    if isinstance(value, Mapping):
        return Record(value)
    if isinstance(value, list):
        return [as_record(one) for one in value]
    return value


def refuse_pickle(what: str, cure: str) -> Any:
    """Raises TypeError, for ``__reduce__``: why it cannot be pickled, and what to do instead."""
    raise TypeError(f"{what} cannot be pickled or copied, as its memory belongs to this process; {cure}")
