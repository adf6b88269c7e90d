# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases and scenes as objects: the text of a file, checked."""

import copy
import html
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, Self

import tomlkit
from pydantic import BaseModel

from ..base.files import write_text
from ..case import impact as impact_case
from ..case import scene as scene_case
from ..case.keys import Key, entry, keys_of, law_of
from ..case.law import LawChoice, alternatives
from ..case.toml import LoadedCase, portable_text
from ..case.units import to_si
from ..errors import CaseError
from ..laws.strengths import find_law
from ..studies.sweep import points
from ..studies.sweep.points import with_units
from .arguments import Table, take


def _law_defaults(table: BaseModel) -> dict[str, float]:
    """The numbers of a law by its keys, of a strength the ratio to the yield stress; {}: not a law."""
    if not isinstance(table, LawChoice):
        return {}
    law, numbers = find_law(table.name), table.numbers
    return numbers.ratios | ({f"{law.strength}_ratio": numbers.ratio} if law.strength and not numbers.absolute else {})


class _File:
    """A case or scene: the text of its file, checked. Its `model` has every value in SI; both are never changed."""

    kind: ClassVar[str]
    parse: ClassVar[Any]  # from tables and place to the model

    def __init__(self, **tables: Any):
        """From the tables of a case file, `Case(case={"name": "ball"}, materials={...}, impact={...}, law={...})`.

        A plain number where a quantity stands is in SI; title and source can be left out. Raises CaseError.
        """
        given = tables.pop("case", {})
        name = given.get("name", self.kind) if isinstance(given, dict) else self.kind
        header = {"name": name, "title": name, "source": "made in Python"}
        data = with_units({"case": header | given if isinstance(given, dict) else given} | tables, {})
        self._read(tomlkit.dumps(with_units(data, keys_of(data))), name)

    def _read(self, text: str, path: object) -> None:
        self.text, self.place = text, path
        self.model = self.parse(tomllib.loads(text), path)

    @classmethod
    def from_toml(cls, path: Path | str) -> Self:
        """The case in a file. Raises CaseError."""
        path = take("path", path, Path)
        case = cls.__new__(cls)
        case._read(portable_text(path), path)
        return case

    def to_toml(self, path: Path | str) -> Path:
        """Write the case as a file that the commands take."""
        path = take("path", path, Path)
        write_text(Path(path), self.text)
        return Path(path)

    def replace(self, changes: Mapping[str, Any] | None = None, /, **tables: Any) -> Self:
        """A case that differs in some keys or tables, by their dotted names: `replace({"impact.body.radius": "5 mm"})`.

        Values and `tables` are what `Case(...)` takes: `replace(law={"name": "johnson", "yield_pressure": 2e9})`.
        Raises CaseError for a key that no case has, with the nearest one, and for a wrong value.
        """
        changes = take("changes", {} if changes is None else changes, Table) | tables
        document = tomlkit.parse(self.text)
        before = document.unwrap()
        data = copy.deepcopy(before)
        for name, value in changes.items():
            try:
                points.assign(data, name, with_units(value, {}, name))
            except (TypeError, ValueError, LookupError):  # a name below a value, or beyond the end of a list
                points.require_key(name, keys_of(before), "replace")
                raise
        names = keys_of(data)  # with the keys of a law or kind that the changes choose
        for name, value in changes.items():
            if not any(key.startswith(f"{name}.") for key in names):
                points.require_key(name, names, "replace")
            points.assign(document, name, with_units(value, names, name))
        case = type(self).__new__(type(self))
        case._read(document.as_string(), self.name)
        return case

    def __getitem__(self, key: str) -> Any:
        """The value of a key by its dotted name, a quantity in SI: `case["impact.body.radius"]`; also a default.

        Raises CaseError for a key that the case does not have, with the nearest one.
        """
        value: Any = self.model
        try:
            for part in take("key", key, str).split("."):
                if isinstance(value, BaseModel):
                    named = {
                        field.alias or name: getattr(value, name) for name, field in type(value).model_fields.items()
                    }
                    value = named | _law_defaults(value) | (value.model_extra or {})
                value = value[entry(value, part) if isinstance(value, list) else part]
        except (LookupError, TypeError, ValueError):
            data = tomllib.loads(self.text)
            points.require_key(key, keys_of(data), "case")
            law, name = law_of(data), key.removeprefix("law.")
            others = [f"law.{other}" for other in (alternatives(law, name) if law else ()) if other != name]
            instead = f"; the law has {others[0]}" if others else ""
            raise CaseError(f"case: {key!r} is not given and has no default{instead}") from None
        unit = keys_of(tomllib.loads(self.text)).get(key, Key()).unit
        return to_si(value, unit) if unit and isinstance(value, str) else value

    @property
    def name(self) -> str:
        return str(self.model.name)

    @property
    def read(self) -> LoadedCase:
        """The case as runs and studies take it."""
        return LoadedCase(self.model, self.text, self.place)

    @property
    def title(self) -> str:
        return str(self.model.case.title)

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, _File) and self.model == other.model

    def __hash__(self) -> int:
        return hash((type(self), self.name))  # few cases have one name

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r}: {self.title})"

    def _repr_html_(self) -> str:
        return f"<b>{html.escape(self.title)}</b><pre>{html.escape(self.text)}</pre>"


class Case(_File):
    """Impacts of one body on one target over a range of speeds."""

    kind = "impact"
    parse = staticmethod(impact_case.parse)


class Scene(_File):
    """A bulk scene."""

    kind = "scene"
    parse = staticmethod(scene_case.parse)
