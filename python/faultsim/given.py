"""What callers give, checked before it reaches the compiled part, whose words are not theirs."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any, SupportsIndex


def names_given(names: Sequence[str], what: str) -> list[str]:
    """Raises TypeError for one text, which is a sequence of letters, and for what is no text."""
    if isinstance(names, str):
        raise TypeError(f"{what} is a list of names: write [{names!r}]")
    all_names = list(names)
    wrong = [name for name in all_names if not isinstance(name, str)]
    if wrong:
        raise TypeError(f"{what} are names, and {', '.join(map(repr, wrong))} is none")
    return all_names


def threads_given(threads: SupportsIndex) -> int:
    """Raises TypeError for what is no whole number, ValueError for one below 1."""
    try:
        count = operator.index(threads)
    except TypeError:
        raise TypeError(f"threads is {threads!r}; write a whole number from 1") from None
    if count < 1:
        raise ValueError(f"threads is {count}; write a whole number from 1, for example os.cpu_count()")
    return count


def told_given(function: Any, what: str, arguments: str) -> Any:
    """A callback. Raises TypeError for what cannot be called."""
    if function is not None and not callable(function):
        raise TypeError(f"{what} is {function!r}; give a function of {arguments}, or None")
    return function
