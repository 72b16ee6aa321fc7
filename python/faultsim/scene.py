"""Scenes: what is modelled."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, NamedTuple, Union

import numpy as np

from . import _core
from .records import Record

#: What a parameter can be given: a number in SI (``25 * deg``), a text with its unit (``"25 deg"``, ``"off"``), a
#: flag, or, for what is no single number, the value as JSON has it.
Value = Union[float, int, bool, str, None, Mapping[str, Any], list[Any]]


class Parameter(NamedTuple):
    """A number or word of a scene that can be set."""

    pointer: str  #: JSON Pointer into the scene.
    alias: str  #: short name, "" = none.
    unit: str  #: SI, of numbers that are given without a unit; "" = a plain number or a word.
    value: str  #: as given in the scene, or the default.
    default: str
    range: str
    new_operator: bool  #: changing it costs a new operator.
    is_text: bool  #: a word.
    description: str


class Plan(Record):
    """What will be modelled of a scene, why, and what it costs: the values of ``faultsim plan --json``."""

    def __init__(self, text: str, values: Mapping[str, Any]) -> None:
        super().__init__(values)
        self._text = text

    def __str__(self) -> str:
        return self._text

    __repr__ = __str__


class Scene:
    """A scene: geometry, rock, faults, stress, pressures, stages.

    ``Scene(dict)`` takes a document as scene files have it; see ``Scene.from_file``, ``Scene.field`` and ``Scene.box``.
    What is wrong with it is said by ``check``, ``plan`` and ``Simulation``, all at once (InputError.problems).
    """

    def __init__(self, document: Mapping[str, Any], source: str = "scene") -> None:
        if not isinstance(document, Mapping):
            raise TypeError(f"{document!r} is no document; Scene takes a dict, Scene.from_file the name of a file")
        self._document = _core.SceneDocument.from_text(json.dumps(document, default=_plain), source)

    @classmethod
    def _of(cls, document: _core.SceneDocument) -> Scene:
        scene = cls.__new__(cls)
        scene._document = document
        return scene

    @classmethod
    def from_file(cls, file: str | os.PathLike[str]) -> Scene:
        """A scene as ``faultsim run`` reads it, with the tables that it names."""
        return cls._of(_core.SceneDocument.from_file(os.fspath(file)))

    @classmethod
    def field(cls, values: Mapping[str, Value] | None = None, /, **changes: Value) -> Scene:
        """The field of ``faultsim init field``, with changes as of ``set``: ``Scene.field(tier="screening", offset="120 m")``."""
        return cls._of(_core.SceneDocument.starter("field")).set(values, **changes)

    @classmethod
    def box(cls, values: Mapping[str, Value] | None = None, /, **changes: Value) -> Scene:
        """The box of ``faultsim init box``, with changes as of ``set``."""
        return cls._of(_core.SceneDocument.starter("box")).set(values, **changes)

    def set(self, values: Mapping[str, Value] | None = None, /, **changes: Value) -> Scene:
        """Puts values in place of those that it has, and returns itself.

        values: by JSON Pointer (``{"/numerics/plane_strain": "on"}``) or by the short names of ``parameters``;
        changes: by short name: ``scene.set(offset="120 m", friction_angle=25 * deg)``.

        Raises InputError with every name that is none.
        """
        self._document.put(changes_as_text(self, values, changes))
        return self

    def copy(self) -> Scene:
        """Another one with the same values."""
        return Scene._of(self._document.copy())

    def parameters(self) -> list[Parameter]:
        """All numbers and words that can be set, with units and ranges, as of ``faultsim parameters``."""
        return [Parameter(**one) for one in self._document.parameters()]

    def check(self) -> None:
        """Raises InputError with all that is wrong with it, its mesh included."""
        self._document.check()

    def plan(self) -> Plan:
        """What will be modelled, why, and what it costs. Raises InputError as ``check``."""
        return Plan(*self._document.plan())

    @property
    def identity(self) -> str:
        """Fingerprint of the case: equal cases have equal ones, however they are spelled."""
        return self._document.identity()

    def to_dict(self) -> dict[str, Any]:
        """The document, as ``json`` reads it from a scene file."""
        return self._document.value()

    def to_json(self) -> str:
        """The document as the text of a scene file."""
        return self._document.text()

    def __repr__(self) -> str:
        return f"<faultsim.Scene {self.to_dict().get('title', self._document.source())!r}>"

    def __getstate__(self) -> tuple[str, str]:
        return self.to_json(), self._document.source()

    def __setstate__(self, state: tuple[str, str]) -> None:
        self._document = _core.SceneDocument.from_text(*state)


def units_of(scene: Scene) -> dict[str, str]:
    """The SI unit of each parameter, by pointer and by every short name; words are missing."""
    by_pointer = {one.pointer: one.unit for one in scene.parameters() if not one.is_text}
    by_name = dict(by_pointer)
    for alias, pointer in _core.aliases(scene._document).items():
        if pointer in by_pointer:
            by_name[alias] = by_pointer[pointer]
    return by_name


def value_as_text(value: Value, unit: str) -> str:
    """A value as ``faultsim run --set`` takes it. 17 digits read back as the same bits. Raises TypeError for what is none."""
    if isinstance(value, (np.generic, np.ndarray)) and value.size == 1:
        value = value.item()
    if isinstance(value, str):
        return value
    if isinstance(value, bool) or value is None or isinstance(value, (Mapping, list)):
        return json.dumps(value, default=_plain)
    if isinstance(value, int) and not unit:
        return str(value)
    try:
        text = format(float(value), ".17g")
    except (TypeError, ValueError):
        raise TypeError(f"{value!r} is no value; write a number in SI, or a text with its unit"
                        f"{' (many cases: run_many)' if isinstance(value, np.ndarray) else ''}") from None
    return f"{text} {unit}" if unit else text


def changes_as_text(
    scene: Scene, values: Mapping[str, Value] | None, changes: Mapping[str, Value], units: dict[str, str] | None = None
) -> list[tuple[str, str]]:
    """Both as (parameter, text). Raises TypeError with all values that are none."""
    if values is not None and not hasattr(values, "keys"):  # a row of a DataFrame has keys
        raise TypeError(f"{values!r} does not say which values it is: give a dict by parameter, or name=value")
    everything = {**(values if values is not None else {}), **changes}
    if units is None:
        has_numbers = any(not isinstance(value, str) for value in everything.values())
        units = units_of(scene) if has_numbers else {}
    texts, wrong = [], []
    for name, value in everything.items():
        try:
            texts.append((name, value_as_text(value, units.get(name, ""))))
        except TypeError as error:
            wrong.append(f"{name}: {error}")
    if wrong:
        raise TypeError("\n".join(wrong))
    return texts


def _plain(value: Any) -> Any:
    """numpy's values as JSON has them."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{value!r} is no value that JSON has")
