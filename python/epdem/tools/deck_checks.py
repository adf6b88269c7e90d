# SPDX-License-Identifier: GPL-2.0-or-later
"""Inputs of any LIGGGHTS deck that are probably wrong: `epdem deck --check my.in`. A value of variables that the deck
computes is not judged."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..base.declarations import declarations
from ..case.toml import text_of
from ..errors import CaseError
from .convert import HYSTERESIS, commands, number, variable

LARGEST_RATIO = 10.0  # of adhesion stiffness over loading stiffness; of materials below 1
LARGEST_STRENGTH = 0.1  # of E*, above which contacts are elastic up to overlaps of 2.5 % of R* or more
RAYLEIGH = 1.0  # largest time step over Rayleigh's time of the smallest sphere


@dataclass
class _Deck:
    """Statements of a deck: properties with places and values, words of the models, smallest sphere, time steps, ids of
    walls without a mesh, restart files that are read."""

    properties: dict[str, tuple[str, list[float]]] = field(default_factory=dict)
    models: list[tuple[str, list[str]]] = field(default_factory=list)
    spheres: list[tuple[float, float]] = field(default_factory=list)  # radius, density, in the units of the deck
    steps: list[tuple[str, float]] = field(default_factory=list)
    known: dict[str, str] = field(default_factory=dict)  # variables with a plain value
    walls: list[str] = field(default_factory=list)
    renewed: list[tuple[str, str]] = field(default_factory=list)  # plastic walls without a mesh, defined again
    restarts: list[tuple[str, str]] = field(default_factory=list)

    def number(self, word: str) -> float:
        """The value of a word; NaN if the deck computes it."""
        return number(word, self.known)

    def values(self, name: str) -> list[float]:
        """The values of a property; none if it is absent."""
        return self.properties.get(name, ("", []))[1]


def _read(text: str, place: Path) -> _Deck:
    deck = _Deck()
    for where, words in commands(text, place):
        deck.known |= variable(words)
        match words:
            case ["fix", _, _, "property/global", name, kind, *values]:
                values = values[1:] if kind == "peratomtypepair" else values
                deck.properties[name] = (where, [deck.number(v) for v in values])
            case ["pair_style", *rest] if "gran" in rest:
                deck.models.append((where, rest))
            case ["fix", name, _, "wall/gran", *rest]:
                deck.models.append((where, rest))
                if "primitive" in rest:
                    if name in deck.walls and _is_plastic(rest):
                        deck.renewed.append((where, name))
                    deck.walls.append(name)
            case ["read_restart", name, *_]:
                deck.restarts.append((where, name))
            case ["timestep", value]:
                deck.steps.append((where, deck.number(value)))
            case ["fix", _, _, "particletemplate/sphere", *rest]:
                deck.spheres += _template(deck, rest)
    return deck


def _template(deck: _Deck, words: list[str]) -> Iterator[tuple[float, float]]:
    if "radius" not in words or "density" not in words:
        return
    radius, density = (words[words.index(key) + 1 :] for key in ("radius", "density"))
    if radius[:1] == ["constant"] and density[:1] == ["constant"] and len(radius) > 1 and len(density) > 1:
        yield deck.number(radius[1]), deck.number(density[1])


def _model(words: list[str]) -> str:
    return words[words.index("model") + 1] if "model" in words[:-1] else ""


def _is_plastic(words: list[str]) -> bool:
    return _model(words) == HYSTERESIS or _model(words).startswith("ep/")


def check(text: str, place: Path) -> list[str]:
    """A sentence for each input of the deck `text` that is probably wrong; `place` names the deck."""
    deck = _read(text, place)
    return [
        *_adhesion(deck),
        *_strength(deck),
        *_restitution(deck),
        *_steps(deck),
        *_histories(deck, Path(place).parent),
        *_renewed_walls(deck),
    ]


def check_file(path: Path) -> list[str]:
    """The sentences on a deck's file. Raises CaseError for a file without a contact model."""
    text = text_of(path)
    if not _read(text, path).models:
        raise CaseError(f"{path}: no line 'pair_style gran ...' or 'fix ... wall/gran ...'; name a LIGGGHTS deck")
    return check(text, path)


def _adhesion(deck: _Deck) -> Iterator[str]:
    name = "coefficientAdhesionStiffness"
    where, values = deck.properties.get(name, ("", []))
    most = max((v for v in values if v == v), default=0.0)
    if most > LARGEST_RATIO:
        yield (
            f"{where}: {name} = {most:g} is the ratio of the adhesion stiffness to the loading stiffness, not in N/m, "
            "and of materials below 1; above it a contact pulls with this multiple of the force that pressed it"
        )


def _elastic(deck: _Deck) -> list[tuple[float, float]]:
    """(E, nu) of each type; none where the deck computes them."""
    pairs = [*zip(deck.values("youngsModulus"), deck.values("poissonsRatio"), strict=False)]
    return pairs if pairs and not np.isnan(pairs).any() else []


def _strength(deck: _Deck) -> Iterator[str]:
    """A strength of a type that its E* does not allow: the modulus is softened, or the unit is wrong."""
    ratios = {
        law.parameter(law.strength).property: law.default_ratio for law in declarations().values() if law.strength
    }
    for name, ratio in ratios.items():
        where, values = deck.properties.get(name, ("", []))
        peak = 1.6 if ratio == 1.0 else 1.0  # of a yield stress: the pressure at first yield
        for n, ((E, nu), value) in enumerate(zip(_elastic(deck), values, strict=False), 1):
            E_star = E / (2 * (1 - nu**2))
            if value < 1e25 and peak * value > LARGEST_STRENGTH * E_star:
                yield (
                    f"{where}: {name} of type {n} = {value:g} is {value / E_star:.2g} E* (youngsModulus {E:g}): such "
                    "contacts are elastic up to an overlap of 2.5 % of R* or more; give the real modulus, or soften "
                    "the strength with it, by k^0.8 where the modulus has 1/k (epdem soften)"
                )


def _restitution(deck: _Deck) -> Iterator[str]:
    """Plastic loss and a normal dashpot in one contact."""
    least = min((v for v in deck.values("coefficientRestitution") if v == v), default=1.0)
    where = deck.properties.get("coefficientRestitution", ("", []))[0]
    stiffer = max((v for v in deck.values("coefficientMaxElasticStiffness") if v == v), default=1.0)
    plastic = any(_model(words) == HYSTERESIS for _, words in deck.models)
    if plastic and stiffer > 1.0 and least <= math.sqrt(1.0 / stiffer):
        yield (
            f"{where}: coefficientRestitution = {least:g} is a dashpot beside the plastic loss of {HYSTERESIS}, "
            f"which alone gives e_n down to {math.sqrt(1.0 / stiffer):.2g} (coefficientMaxElasticStiffness = "
            f"{stiffer:g}): restitution acts twice; give 1 for the plastic loss alone"
        )


def _steps(deck: _Deck) -> Iterator[str]:
    elastic = _elastic(deck)
    spheres = [(r, rho) for r, rho in deck.spheres if r > 0 and rho > 0]
    if not elastic or not spheres:
        return
    times = [
        math.pi * r * math.sqrt(rho * 2 * (1 + nu) / E) / (0.1631 * nu + 0.8766)
        for r, rho in spheres
        for E, nu in elastic
        if E < 1e25
    ]
    limit = RAYLEIGH * min(times, default=math.inf)
    for where, step in deck.steps:
        if step > limit:
            yield (
                f"{where}: timestep {step:g} is above Rayleigh's time of the smallest sphere, {limit:.3g}: contacts "
                "create energy; give a fifth of it, or less"
            )


def _histories(deck: _Deck, folder: Path) -> Iterator[str]:
    """Walls whose histories a restart file holds under other ids; a file that is not there is not judged."""
    for where, name in deck.restarts:
        stored = (folder / name).read_bytes() if (folder / name).is_file() else b""
        before = {text.decode() for text in re.findall(rb"(?<!\w)history_(\w+)", stored)}
        lost, new = sorted(before - {*deck.walls}), [wall for wall in deck.walls if wall not in before]
        if lost and new:
            yield (
                f"{where}: {name} holds the contacts of walls {', '.join(lost)}, and walls {', '.join(new)} of the "
                "deck begin without any, in silence; give walls the ids that they had when the file was written"
            )


def _renewed_walls(deck: _Deck) -> Iterator[str]:
    """Walls whose second definition deletes the dents of their contacts."""
    for where, name in deck.renewed:
        yield (
            f"{where}: wall {name} is defined a second time: its contacts begin without dents, and a pressed contact "
            "pushes with the force of a first load; move the wall instead, or define it once before the first run"
        )
