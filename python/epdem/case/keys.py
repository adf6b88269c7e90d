# SPDX-License-Identifier: GPL-2.0-or-later
"""Every key that a case can have, by its dotted name, from the models of cases."""

import types
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

from ..base.declarations import Declaration, declarations
from .fields import Material, Quantity
from .impact import Case
from .kinds import Keys, model_of
from .law import LawChoice, LawMaterial, law_keys
from .scene import SceneCase, is_scene


@dataclass(frozen=True)
class Key:
    """Kind of a key's value: quantity of `unit` or a list of quantities, whole number, or any other value."""

    unit: str | None = None
    whole: bool = False


def keys_of(data: dict[str, Any], *, scene: bool | None = None) -> dict[str, Key]:
    """Every key that the case or scene `data` (TOML tables) has or can have, by its dotted name.

    A part of a list goes by its number and by its name (scene.wall.0, scene.wall.floor). scene: whether the keys are
    those of scenes; by default those of `data`.
    """
    keys: dict[str, Key] = {}
    for place, key in _walk(SceneCase if (is_scene(data) if scene is None else scene) else Case, (), data, data):
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
            for name in {str(n), str(entry.get("name", n)) if isinstance(entry, dict) else str(n)}:
                yield from _walk(arguments[0], (*place, name), entry, case)
    elif kind is Keys:
        table = data if isinstance(data, dict) else {}
        if model := model_of(table.get("kind")):
            yield from _fields(model, place, table, case)
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
    law = law_of(case)
    if law and issubclass(model, LawChoice):
        for parameter, unit in law_keys(law).items():
            yield (*place, parameter), Key(unit=unit)
    elif law and law.strength and issubclass(model, LawMaterial):
        yield (*place, law.strength), Key(unit="Pa")


def law_of(data: dict[str, Any]) -> Declaration | None:
    """The declaration of the law that a case names."""
    table = data.get("law")
    return declarations().get(str(table.get("name"))) if isinstance(table, dict) else None


def entry(parts: list[Any], name: str) -> int:
    """The number of an entry of a list by its number or the name of a part. Raises ValueError."""
    names = [one.get("name") if isinstance(one, dict) else getattr(one, "name", None) for one in parts]
    return names.index(name) if name in names else int(name)
