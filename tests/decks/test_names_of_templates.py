# SPDX-License-Identifier: GPL-2.0-or-later
"""What a template reads of a deck is there, also in branches that no stored deck takes."""

import types
import typing
from pathlib import Path

import jinja2
import pytest
from jinja2 import nodes

from epdem.engines.lammps import engine as lammps
from epdem.engines.lammps import scene_deck as lammps_scene
from epdem.engines.liggghts import engine as liggghts
from epdem.engines.liggghts import scene_deck as liggghts_scene
from epdem.engines.yade import engine as yade
from epdem.engines.yade import scene_deck as yade_scene

TEMPLATES = Path(__file__).parents[2] / "templates"
IMPACTS = {"liggghts": liggghts.ImpactDeck, "lammps": lammps.ImpactDeck, "yade": yade.ImpactDeck}
SCENES = {"liggghts": liggghts_scene.SceneDeck, "lammps": lammps_scene.SceneDeck, "yade": yade_scene.SceneDeck}
OF_DECKS = [path for path in sorted(TEMPLATES.rglob("*.j2")) if path.parent.name in SCENES]


def decks_of(path: Path) -> list[type]:
    """The decks that a template is filled with."""
    host = path.parent.name
    if path.name == "macros.j2":
        return [IMPACTS[host], SCENES[host]]
    return [SCENES[host] if path.name.startswith("scene") or path.name == "spheres.data.j2" else IMPACTS[host]]


def type_of(owner: type, name: str) -> object:
    """The type of a field or property of a class; None: there is none."""
    hints = typing.get_type_hints(owner)
    if name in hints:
        return hints[name]
    there = getattr(owner, name, None)
    return typing.get_type_hints(there.fget)["return"] if isinstance(there, property) else there


def chain(node: nodes.Node) -> list[str]:
    """The names of `deck.a.b`, without deck; empty: it is something else."""
    if isinstance(node, nodes.Getattr):
        if isinstance(node.node, nodes.Name):
            return [node.attr] if node.node.name == "deck" else []
        return [*before, node.attr] if (before := chain(node.node)) else []
    return []


@pytest.mark.parametrize("path", OF_DECKS, ids=lambda path: str(path.relative_to(TEMPLATES)))
def test_a_name_that_a_template_reads_is_in_the_plan_or_the_deck(path):
    chains = {tuple(chain(node)) for node in jinja2.Environment().parse(path.read_text()).find_all(nodes.Getattr)}
    for names in chains - {()}:
        for deck in decks_of(path):
            owner: object = deck
            for name in names:
                found = type_of(owner, name)
                assert found is not None, f"{owner.__name__} has no {name}: deck.{'.'.join(names)}"
                some = [part for part in typing.get_args(found) if part is not types.NoneType]
                owner = some[0] if isinstance(found, types.UnionType) else found
                if not (isinstance(owner, type) and owner.__module__.startswith("epdem.")):
                    break
