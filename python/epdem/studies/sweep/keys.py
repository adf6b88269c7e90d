# SPDX-License-Identifier: GPL-2.0-or-later
"""The keys that a case or scene can have, by their dotted names, and how a value is set in one."""

import difflib
import types
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import tomlkit
from pydantic import BaseModel

from ...base.declarations import Declaration, declarations
from ...case.fields import LawChoice, Material, Quantity
from ...case.impact import Case
from ...case.scene import SceneCase, SceneMaterial, is_scene
from ...errors import CaseError
from ...laws.strengths import ADHESION


@dataclass(frozen=True)
class Key:
    """What a key takes: a quantity of the unit `unit` or a list of such, a whole number, or anything else."""

    unit: str | None = None
    whole: bool = False


def keys_of(data: dict[str, Any]) -> dict[str, Key]:
    """Every key that the case or scene `data` (TOML tables) has or can have, by its dotted name."""
    keys: dict[str, Key] = {}
    for place, key in _walk(SceneCase if is_scene(data) else Case, (), data, data):
        name = ".".join(place)
        if name not in keys or keys[name] == Key():
            keys[name] = key
    return keys


def _walk(kind: Any, place: tuple[str, ...], data: Any, case: dict[str, Any]) -> Iterator[tuple[tuple[str, ...], Key]]:
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Annotated:
        for quantity in arguments[1:]:
            if isinstance(quantity, Quantity):
                yield place, Key(unit=quantity.si)
                return
        yield from _walk(arguments[0], place, data, case)
    elif origin in (Union, types.UnionType):
        for one in arguments:
            yield from _walk(one, place, data, case)
    elif origin is dict:
        for name in data if isinstance(data, dict) else ():
            yield from _walk(arguments[1], (*place, name), data[name], case)
    elif origin is list:
        quantities = [m for m in get_args(arguments[0])[1:] if isinstance(m, Quantity)]
        yield place, Key(unit=quantities[0].si if quantities else None)
        for n, entry in enumerate(data if isinstance(data, list) else ()):
            yield from _walk(arguments[0], (*place, str(n)), entry, case)
    elif isinstance(kind, type) and issubclass(kind, BaseModel):
        yield from _fields(kind, place, data if isinstance(data, dict) else {}, case)
    elif kind is not type(None):
        yield place, Key(whole=kind is int)


def _fields(
    model: type[BaseModel], place: tuple[str, ...], data: dict[str, Any], case: dict[str, Any]
) -> Iterator[tuple[tuple[str, ...], Key]]:
    kind = model.model_fields.get("kind")
    if kind and get_origin(kind.annotation) is Literal and data.get("kind") not in get_args(kind.annotation):
        return  # another kind of scene
    for name, field in model.model_fields.items():
        quantity = next((m for m in field.metadata if isinstance(m, Quantity)), None)
        key = field.alias or name
        if quantity:
            yield (*place, key), Key(unit=quantity.si)
        else:
            yield from _walk(field.annotation, (*place, key), data.get(key), case)
    if issubclass(model, Material):
        yield (*place, "from"), Key()
    if issubclass(model, LawChoice | SceneMaterial):
        for parameter, entry in _of_law(case, ratio=issubclass(model, LawChoice)):
            yield (*place, parameter), entry


def _law(data: dict[str, Any]) -> Declaration | None:
    """The law that a case names; None if there is no such law."""
    table = data.get("law")
    return declarations().get(str(table.get("name"))) if isinstance(table, dict) else None


def _of_law(case: dict[str, Any], *, ratio: bool) -> Iterator[tuple[str, Key]]:
    """Parameters of the case's law, and the ratio that can stand for its strength."""
    law = _law(case)
    if law is None:
        return
    for p in law.parameters:
        if not ratio and p.name == ADHESION:
            continue  # of pairs; a material has a surface energy
        yield p.name, Key(unit=p.unit)
        if ratio and p.name == law.strength:
            yield f"{p.name}_ratio", Key(unit="1")


def known(key: str, keys: dict[str, Key], place: str) -> Key:
    """The key of that name. Raises CaseError that names the nearest ones."""
    if key in keys:
        return keys[key]
    last = [name for name in keys if name.split(".")[-1] == key.split(".")[-1]]
    near = [*difflib.get_close_matches(key, keys, n=1, cutoff=0.0), *last]
    nearest = ", ".join(list(dict.fromkeys(near))[:4])
    raise CaseError(f"{place}: the case has no key {key!r}; the nearest: {nearest}")


def _rivals(key: str, data: dict[str, Any]) -> tuple[str, ...]:
    """Keys that say the same as `key` in another way, so that only one of them may stand in a case."""
    if key == "numerics.error":
        return ("numerics.steps_in_contact",)
    if key == "numerics.steps_in_contact":
        return ("numerics.error",)
    law = _law(data)
    if law and law.strength and key in (f"law.{law.strength}", f"law.{law.strength}_ratio"):
        return (f"law.{law.strength}", f"law.{law.strength}_ratio")
    return ()


def assign(document: Any, key: str, value: Any) -> None:
    """Set `key` in a TOML document or plain tables; missing tables are made, rival keys are removed."""
    *way, last = key.split(".")
    for rival in _rivals(key, document):
        table, name = rival.rsplit(".", 1)
        if rival != key and name in document.get(table, {}):
            del document[table][name]
    table = document
    for name in way:
        if isinstance(table, list):
            table = table[int(name)]
            continue
        if name not in table:
            table[name] = tomlkit.table() if isinstance(document, tomlkit.TOMLDocument) else {}
        table = table[name]
    table[int(last) if isinstance(table, list) else last] = value
