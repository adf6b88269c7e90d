# SPDX-License-Identifier: GPL-2.0-or-later
"""Each name that a template reads of a deck is there by its type, also in branches that no stored deck takes."""

import contextlib
import functools
import types
import typing
from dataclasses import dataclass
from pathlib import Path

import jinja2
import pytest
from jinja2 import nodes

from epdem.engines.lammps import deck as lammps
from epdem.engines.liggghts import deck as liggghts
from epdem.engines.yade import deck as yade

TEMPLATES = Path(__file__).parents[2] / "templates"
HOSTS = {"liggghts": liggghts, "lammps": lammps, "yade": yade}
OF_DECKS = [path for path in sorted(TEMPLATES.rglob("*.j2")) if path.parent.name in HOSTS and "macros" not in path.name]
# filters that keep the type of the elements
SAME = {"list", "reject", "rejectattr", "select", "selectattr", "sort", "unique"}


def deck_of(path: Path) -> type:
    """The deck that a template is filled with."""
    host = HOSTS[path.parent.name]
    return host.SceneDeck if path.name.startswith(("scene", "spheres")) else host.ImpactDeck


def members(found: object) -> list[object]:
    """The types of a union, without None."""
    if typing.get_origin(found) is typing.Annotated:
        return members(typing.get_args(found)[0])
    if isinstance(found, types.UnionType) or typing.get_origin(found) is typing.Union:
        return [m for part in typing.get_args(found) for m in members(part)]
    return [] if found in (None, types.NoneType) else [found]


def type_of(owner: type, name: str) -> object:
    """The type of a field or property of a class. Raises AttributeError."""
    hints = typing.get_type_hints(owner)
    if name in hints:
        return hints[name]
    there = getattr(owner, name)
    there = there.fget if isinstance(there, property) else getattr(there, "func", there)  # of a cached property
    return typing.get_type_hints(there).get("return")


def elements(found: object) -> object:
    """The type of the elements of a tuple, list or sequence; None: unknown."""
    sequences = [m for m in members(found) if typing.get_args(m) and typing.get_origin(m) is not dict]
    return typing.get_args(sequences[0])[0] if sequences else None


@dataclass
class Reader:
    """The types of the names in a template, followed through loops, assignments and macros of any file."""

    path: Path
    names: dict[str, object]

    def inside(self, **names: object) -> "Reader":
        return Reader(self.path, self.names | names)

    def attribute(self, owner: object, name: str) -> object:
        """The type of `owner.name`; None: unknown. Fails where no class of epdem in the union has it."""
        if isinstance(owner, dict):  # the macros of another file
            return owner.get(name)
        ours = [m for m in members(owner) if isinstance(m, type) and m.__module__.startswith("epdem.")]
        found = []
        for one in ours:
            with contextlib.suppress(AttributeError):
                found.append(type_of(one, name))
        assert found or not ours, f"{self.path.name}: {' and '.join(m.__name__ for m in ours)} have no {name}"
        return found[0] if found else None

    def type(self, node: nodes.Node) -> object:
        """The type of an expression; None: unknown."""
        match node:
            case nodes.Name():
                return self.names.get(node.name)
            case nodes.Getattr(node=nodes.Name(name="loop")):
                return self.names["loop"] if node.attr in ("previtem", "nextitem") else None
            case nodes.Getattr():
                return self.attribute(self.type(node.node), node.attr)
            case nodes.Getitem(arg=nodes.Slice()):
                return self.type(node.node)
            case nodes.Getitem():
                return elements(self.type(node.node))
            case nodes.Filter(node=nodes.Node()) if node.name in SAME:
                return self.type(node.node)
            case nodes.CondExpr():
                return self.type(node.expr1) or self.type(node.expr2)
        return None

    def walk(self, node: nodes.Node) -> None:
        match node:
            case nodes.Import():
                self.names[node.target] = macros_of(TEMPLATES / node.template.value)
            case nodes.FromImport():
                self.names |= {n: macros_of(TEMPLATES / node.template.value)[n] for n in node.names}
            case nodes.Macro():
                self.names[node.name] = (self.path, node)
            case nodes.For():
                of = elements(self.type(node.iter))
                self.walk(node.iter)
                bound = {"loop": of}
                if isinstance(node.target, nodes.Tuple):
                    parts = typing.get_args(of) or [None] * len(node.target.items)
                    bound |= {name.name: part for name, part in zip(node.target.items, parts, strict=True)}
                else:
                    bound[node.target.name] = of
                reader = self.inside(**bound)
                for part in (*([node.test] if node.test else []), *node.body, *node.else_):
                    reader.walk(part)
            case nodes.Assign(target=nodes.Name()):
                self.walk(node.node)
                self.names[node.target.name] = self.type(node.node)
            case nodes.Call():
                self.call(node)
            case _:
                self.type(node)
                for child in node.iter_child_nodes():
                    self.walk(child)

    def call(self, node: nodes.Call) -> None:
        """The body of a macro with the types of its arguments."""
        for child in node.iter_child_nodes():
            self.walk(child)
        called = self.type(node.node)
        if isinstance(called, tuple):
            path, macro = called
            given = dict(zip((arg.name for arg in macro.args), map(self.type, node.args), strict=False))
            reader = Reader(path, macros_of(path) | dict.fromkeys(arg.name for arg in macro.args) | given)
            if path == self.path:
                reader.names = self.names | reader.names
            for part in macro.body:
                reader.walk(part)


@functools.cache
def parsed(path: Path) -> nodes.Template:
    return jinja2.Environment().parse(path.read_text())


@functools.cache
def macros_of(path: Path) -> dict[str, object]:
    """The macros of a file, and of the files that it imports."""
    reader = Reader(path, {})
    for node in parsed(path).body:
        if isinstance(node, nodes.Macro | nodes.Import | nodes.FromImport):
            reader.walk(node)
    return reader.names


@pytest.mark.parametrize("path", OF_DECKS, ids=lambda path: str(path.relative_to(TEMPLATES)))
def test_a_name_that_a_template_reads_is_in_the_plan_or_the_deck(path):
    Reader(path, {"deck": deck_of(path)}).walk(parsed(path))
