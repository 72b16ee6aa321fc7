"""Errors, by what kind of thing went wrong. How a case ended (no convergence) is a value: ``Result.outcome``."""

from __future__ import annotations

from typing import NamedTuple


class Problem(NamedTuple):
    """One thing wrong with a scene or its changes."""

    pointer: str  #: JSON Pointer to the value; "" = the whole document.
    line: int  #: in the file, from 1; 0 = none.
    what: str  #: what is wrong.
    cure: str  #: what would be right.


class Error(Exception):
    """Base of the errors that are not bugs of faultsim's."""


class InputError(Error, ValueError):
    """The input is wrong: ``problems`` has all that is."""

    problems: list[Problem]
    source: str  #: file name or other place.

    def __init__(self, message: str, source: str = "", problems: list[Problem] | None = None) -> None:
        super().__init__(message)
        self.source = source
        self.problems = problems if problems is not None else []


class ResourceError(Error, RuntimeError):
    """Not enough memory, no such program."""


class StorageError(Error, OSError):
    """The world failed: disk full, file locked or corrupt, no store."""


class Interrupted(Error):
    """Work was stopped. Ctrl-C raises KeyboardInterrupt instead."""


class InternalError(Exception):
    """faultsim is wrong: please report it."""


__all__ = ["Error", "InputError", "InternalError", "Interrupted", "Problem", "ResourceError", "StorageError"]
