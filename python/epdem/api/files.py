# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases and scenes as objects: the text of a file, checked."""

import copy
import html
import inspect
import re
import reprlib
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, ClassVar, ParamSpec, Self, TypeVar

import numpy as np
import pandas as pd
import tomlkit
from pydantic import BaseModel, BeforeValidator, Field, TypeAdapter, ValidationError

from ..base import tables as h5
from ..base.files import write_text
from ..case import impact as impact_case
from ..case import scene as scene_case
from ..case.keys import Key, entry, keys_of, law_of
from ..case.law import LawChoice, alternatives
from ..case.messages import text_of_problem
from ..case.toml import LoadedCase, portable_text
from ..case.units import to_si
from ..errors import CaseError, EpdemError
from ..impacts import store
from ..impacts.measurement import UNITS
from ..laws.strengths import find_law
from ..scenes.tables import results as scene_results
from ..scenes.tables.columns import units as scene_units
from ..studies.sweep import folder as sweep_folder
from ..studies.sweep import points
from ..studies.sweep.points import MOST, with_units
from ..studies.sweep.table import collect

Given = ParamSpec("Given")
Result = TypeVar("Result")
PLURALS = {"set": "settings"}  # and names with an s

Names = Annotated[list[str], BeforeValidator(lambda given: [given] if isinstance(given, str) else given)]
Many = Annotated[list[Any], BeforeValidator(lambda given: [given] if np.ndim(given) == 0 else list(given))]
Table = dict[str, Any]
# numpy's integers have `item`, which gives Python's
_Whole = Annotated[int, BeforeValidator(lambda given: given.item() if hasattr(given, "item") else given)]
Ranks = Annotated[_Whole, Field(ge=1, le=1024, strict=True)]
Count = Annotated[_Whole, Field(ge=1, le=MOST, strict=True)]
Seed = Annotated[_Whole, Field(ge=0, lt=2**63, strict=True)]


def names_arguments(function: Callable[Given, Result]) -> Callable[Given, Result]:
    """`function` with errors that name its arguments where the sentences of the commands name options."""
    known = inspect.signature(function).parameters
    rest = any(p.kind is p.VAR_KEYWORD for p in known.values())

    def argument(option: re.Match[str]) -> str:
        name = option[1].replace("-", "_")
        candidates = [c for c in (name, f"{name}s", PLURALS.get(name, name)) if c in known]
        return candidates[0] if candidates else name if rest else str(option[0])

    @wraps(function)
    def call(*args: Given.args, **kwargs: Given.kwargs) -> Result:
        try:
            return function(*args, **kwargs)
        except EpdemError as error:
            said = re.sub(r"(?<![\w-])--([a-z][a-z-]*)", argument, str(error))
            raise type(error)(said) from error.__cause__

    return call


def take(name: str, given: object, kind: Any) -> Any:
    """An argument as a value of its kind. Raises CaseError."""
    try:
        return TypeAdapter(kind).validate_python(given)
    except ValidationError as error:
        problem = error.errors()[0]
        raise type_error(name, problem["input"], text_of_problem(problem)) from None


def type_error(name: str, given: object, wanted: str) -> CaseError:
    """The error for an argument that is no such value."""
    return CaseError(f"{name} = {reprlib.repr(given)}: of type {type(given).__name__}; {wanted}")


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


def marked(table: pd.DataFrame, units: Mapping[str, str]) -> pd.DataFrame:
    """A copy with the units of its columns in `attrs["units"]`."""
    found = table.copy()
    found.attrs["units"] = {name: units[name] for name in map(str, found) if name in units}
    return found


@dataclass(frozen=True)
class Stored(h5.WithTables):
    """Results of a folder. Each of its `tables` is an attribute, too: `read("runs/settle_glass").rows`.

    Impacts have `comparison` (measured and predicted), `impacts`, `predictions` and `paths`; scenes the tables of
    `SceneRun.tables`; sweeps `points`. Tables have the SI units of their columns in `attrs["units"]`. title: kind and
    name. text: the case file.
    """

    folder: Path
    title: str
    passed: bool
    text: str
    tables: dict[str, pd.DataFrame]

    def __repr__(self) -> str:
        return two_lines(self.title, self.passed, self.folder, self.tables)


def two_lines(title: str, passed: bool, folder: Path, tables: Mapping[str, pd.DataFrame]) -> str:
    """What ran with its verdict, and where its tables are with their numbers of rows."""
    sizes = ", ".join(f"{name} ({len(table)} rows)" for name, table in tables.items())
    return f"{title}: {'passed' if passed else 'not passed'}\n{folder}: {sizes}"


def read(folder: Path | str) -> Stored:
    """The results that a run, a scene or a sweep has stored in `folder`, or in a file results.h5. Nothing runs.

    Raises CaseError for a folder without results.
    """
    place = take("folder", folder, Path)
    if (place / sweep_folder.DEFINITION).exists():
        sweep = sweep_folder.read(place)
        points = collect(sweep, place)
        done = (points["status"] == sweep_folder.DONE).all() and "passed" in points and points["passed"].all()
        return Stored(place, f"sweep {sweep.name}", bool(done), sweep.case, {"points": points})
    path = place if place.is_file() else place / "results.h5"
    if not path.exists():
        raise CaseError(f"{place}: no results.h5 and no sweep; name the folder of a finished run")
    with h5.open_results(path, "a results file of epdem") as file:
        of_scene = h5.attributes(file).get("kind") == "scene"
    return _scene(path) if of_scene else _impacts(path)


def _scene(path: Path) -> Stored:
    found = scene_results.read(path)
    tables = {name: marked(table, scene_units(table)) for name, table in found.tables.items()}
    passed = "checks" not in tables or bool(tables["checks"]["passed"].all())
    return Stored(path.parent, f"scene {found.attributes['case']}", passed, found.case_text, tables)


def _impacts(path: Path) -> Stored:
    found = store.read(path)
    tables = {"comparison": found.comparison}
    for name in ("impacts", "predictions", "paths"):
        parts: dict[str, pd.DataFrame] = getattr(found, name)
        names = ["law", "engine"] if name != "predictions" else ["law"]
        rows = [table.assign(**dict(zip(names, key.split("/"), strict=True))) for key, table in parts.items()]
        tables[name] = pd.concat(rows, ignore_index=True) if rows else pd.DataFrame()
    tables = {name: marked(table, UNITS) for name, table in tables.items()}
    passed = bool(found.comparison["passed"].all())
    return Stored(path.parent, f"impacts {found.attributes['case']}", passed, found.case_text, tables)
