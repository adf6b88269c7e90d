# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases and scenes of a program: from plain values, quantities or a file; they never change."""

import contextlib
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
import tomlkit

from ..case import impact as impact_case
from ..case import scene as scene_case
from ..files import atomic
from ..studies.sweep import keys
from ..studies.sweep.points import with_unit


class _File:
    """A case or scene: the text of its file, checked. Its `model` has every value in SI; both are never changed."""

    kind: ClassVar[str]

    def __init__(self, **tables: Any):
        """From the tables of a case file, `Case(case={"name": "ball"}, materials={...}, impact={...}, law={...})`.

        A plain number where a quantity stands is in SI; texts with units and quantities of pint are taken as they are;
        title and source can be left out. Raises CaseError.
        """
        name = tables.get("case", {}).get("name", self.kind)
        header = {"name": name, "title": name, "source": "made in Python"} | tables.get("case", {})
        data = _plain({"case": header} | {key: value for key, value in tables.items() if key != "case"})
        self._read(tomlkit.dumps(_with_units(data, keys.keys_of(data))), name)

    def _read(self, text: str, path: object) -> None:
        self.text = text
        self.model = self._parse(tomllib.loads(text), path)

    @staticmethod
    def _parse(data: dict[str, Any], path: object) -> Any:
        raise AttributeError("a case is a Case or a Scene")

    @classmethod
    def from_toml(cls, path: Path | str) -> Self:
        """The case in a file. Raises CaseError."""
        impact_case.read_toml(path)
        found = cls.__new__(cls)
        found._read(Path(path).read_text(encoding="utf-8-sig"), path)
        return found

    def to_toml(self, path: Path | str) -> Path:
        """Write the case as a file that the commands take."""
        with atomic(Path(path)) as temporary:
            temporary.write_text(self.text, encoding="utf-8")
        return Path(path)

    def replace(self, changes: Mapping[str, Any]) -> Self:
        """A case that differs in some keys, by their dotted names: `replace({"impact.body.radius": "5 mm"})`.

        Raises CaseError for a key that no case has, with the nearest one, and for a wrong value.
        """
        document = tomlkit.parse(self.text)
        names = keys.keys_of(document.unwrap())
        for name, value in changes.items():
            keys.assign(document, name, with_unit(value, keys.known(name, names, "replace")))
        found = type(self).__new__(type(self))
        found._read(document.as_string(), self.name)
        return found

    @property
    def name(self) -> str:
        """The name of the case."""
        return str(self.model.name)

    @property
    def title(self) -> str:
        """The title of the case."""
        return str(self.model.case.title)

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, _File) and self.model == other.model

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r}: {self.title})"

    def _repr_html_(self) -> str:
        import html

        return f"<b>{html.escape(self.title)}</b><pre>{html.escape(self.text)}</pre>"

    @contextlib.contextmanager
    def as_file(self) -> Iterator[Path]:
        """A file of the case while the block lasts."""
        with tempfile.TemporaryDirectory(prefix="epdem-") as place:
            yield self.to_toml(Path(place) / f"{self.name}.toml")


class Case(_File):
    """Impacts of one body on one target over a range of speeds."""

    kind = "impact"

    @staticmethod
    def _parse(data: dict[str, Any], path: object) -> Any:
        return impact_case.parse(data, path)


class Scene(_File):
    """A bulk scene."""

    kind = "scene"

    @staticmethod
    def _parse(data: dict[str, Any], path: object) -> Any:
        return scene_case.parse(data, path)


def _plain(value: Any) -> Any:
    """Arrays and tuples as lists, at any depth."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(v) for v in value] if isinstance(value, list | tuple) else value


def _with_units(value: Any, names: dict[str, keys.Key], place: str = "") -> Any:
    below = f"{place}." if place else ""
    if isinstance(value, dict):
        return {k: _with_units(v, names, f"{below}{k}") for k, v in value.items()}
    if isinstance(value, list) and any(isinstance(v, dict) for v in value):
        return [_with_units(v, names, f"{below}{n}") for n, v in enumerate(value)]
    return with_unit(value, names.get(place, keys.Key()))
