# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of unequal spheres side by side, tilted against the axes and drifting, for variants of one scene.

The contact point crosses x = 0 and z = 0 in mid-contact, each pair at a moment of its own, so that some of them unload:
there an engine puts a border of ranks, and one of bins.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..base import rendering as decks
from ..engines import ImpactEngine
from ..engines.host import Host
from ..engines.input_script import data_text, equal_spheres
from ..engines.lammps.engine import Lammps
from ..engines.lammps.tables import impact_frames
from ..engines.liggghts import dump
from ..engines.liggghts.engine import Liggghts
from ..engines.yade.engine import Yade
from ..engines.yade.scene_parts import table_text
from ..errors import EngineError
from ..impacts.experiment import Body, Experiment
from ..impacts.plan import Group, Plan, plan
from ..theory.pair import sphere_mass
from .models.theories import prediction as predict

VARIANTS: tuple[str, ...] = ("swap", "sort", "migration", "restart")
# From target to body. Bins are sorted by z first, then y: with this tilt the lower body in z is the upper one in y, and
# the order of the two changes twice as they drift across the border of bins at z = 0.
# With the tilt in x they change their rank one after the other.
AXIS = np.array([0.03, 1.0, -0.03]) / np.linalg.norm([0.03, 1.0, -0.03])
OTHER_RADIUS, OTHER_MODULUS = 0.6, 0.7  # of the target, in units of those of the case
FIRST, LAST, STOP = 0.2, 0.9, 0.8  # crossings, and the stop of a run, in contact times
DRIFT = 0.2  # larger radii per contact time


@dataclass(frozen=True)
class Pairs:
    """All pairs of a plan: the moving side, the side that is hit, and the numbers that an engine needs for the run."""

    plan: Plan
    sides: tuple[Group, Group]
    stop: int  # a step in mid-contact, where a run may be stopped
    drift: np.ndarray  # velocity of the centre of mass of all [m/s]
    spread: float  # how far a pair reaches around its first place [m]

    def ordered(self, swap: bool) -> tuple[Group, ...]:
        """The sides in the order in which an engine adds them: `swap` puts the targets first."""
        return self.sides[:: -1 if swap else 1]

    def runs(self, variant: str, file: str) -> list[dict[str, Any]]:
        """The runs of a variant, one after the other: their steps, and what they `load` before and `save` after."""
        whole: dict[str, Any] = {"variant": variant, "steps": self.plan.steps, "load": None, "save": None}
        if variant != "restart":
            return [whole]
        return [whole | {"steps": self.stop, "save": file}, whole | {"steps": whole["steps"] - self.stop, "load": file}]


def unequal_spheres(x: Experiment) -> Experiment:
    """The experiment's body against a smaller sphere of the target's material, made softer, at the middle speed."""
    material, strength = (x.body, x.law.strengths[0]) if x.target.rigid else (x.target, x.law.strengths[1])
    radius = OTHER_RADIUS * x.body.radius
    other = Body(
        radius,
        float(sphere_mass(radius=radius, density=material.density)),
        material.density,
        OTHER_MODULUS * material.young_modulus,
        material.poisson_ratio,
        material.yield_stress,
        material.material + "_softer",
    )
    law = x.law.of(x.law.strengths[0], strength)
    return replace(x, law=law, target=other, speed=x.speed[x.speed.size // 2 :][:1], oblique=None)


def pairs(p: Plan, contact_time: float) -> Pairs:
    """The pairs of a plan of sphere on sphere; contact_time [s] is the theory's."""
    x = p.experiment
    n, reach = p.n, max(x.body.radius, x.target.radius)
    drift = DRIFT * reach / contact_time * np.array([1.0, 0.0, 1.0])
    crossing = np.linspace(FIRST, LAST, n)[:, None] * contact_time
    y = 5.2 * reach * np.arange(n)[:, None] * np.array([0.0, 1.0, 0.0])
    share = x.m_star / x.body.mass  # of the speed, in the centre-of-mass frame
    rest = 1 - share
    start = y - drift * crossing
    gap, v = p.gap[:, None], p.speed[:, None]
    body = Group(x.body, start + AXIS * (x.body.radius + share * gap), drift - share * v * AXIS)
    target = Group(x.target, start - AXIS * (x.target.radius + rest * gap), drift + rest * v * AXIS)
    spread = p.steps * p.time_step * (p.speed.max() + drift[0]) + 4 * reach
    return Pairs(p, (body, target), int(STOP * contact_time / p.time_step), drift, spread)


FAILED = float("inf")  # it died or lost particles: as wrong as can be
# a serial YADE keeps bodies where they are in memory and has no ranks: sorting and migration do not exist
OF_YADE = ("swap", "restart")


def variants_of(tool: ImpactEngine) -> tuple[str, ...]:
    """The variants that an engine has; none where it takes no pairs of spheres."""
    if isinstance(tool, Yade):
        return OF_YADE if tool.classes or tool.own_law else ()  # a deck with the C library does not continue
    return VARIANTS if isinstance(tool, Liggghts | Lammps) and tool.name != "lammps-mdr" else ()  # which has walls only


def examine(tool: ImpactEngine, x: Experiment, folder: Path) -> dict[str, float]:
    """Run the impacts of unequal spheres in every variant. Raises EngineError. Empty: the engine has none.

    unequal_error: of e_n against theory, relative; by the name of a variant the largest absolute change of e_n over
    the phases, NaN if the engine does not have it, inf if it failed; momentum: the largest change in any variant,
    relative to one body's change.
    """
    if not (variants := variants_of(tool)):
        return {}
    assert isinstance(tool, Host)
    pair = unequal_spheres(x)
    prediction = predict(tool, pair)
    p = plan(pair, prediction)
    scene = pairs(p, float(prediction.duration[0]))
    mass = np.array([pair.body.mass, pair.target.mass])[:, None, None]
    change = np.abs(pair.m_star * p.speed).max()

    def run(variant: str) -> tuple[Any, Any]:
        """e_n, and the lost momentum."""
        v = velocities(tool, scene, variant, folder / variant)
        lost = np.abs((mass * (v - scene.drift)).sum(axis=0)).max() / change
        return (v[0] - v[1]) @ AXIS / p.speed, lost

    plain, momentum = run("plain")[0], 0.0
    row = {"unequal_error": float(np.abs(plain / prediction.e_n[0] - 1).max())} | dict.fromkeys(VARIANTS, np.nan)
    for variant in variants:
        try:
            e_n, lost = run(variant)
            row[variant], momentum = float(np.abs(e_n - plain).max()), max(momentum, float(lost))
        except (EngineError, ValueError):
            row[variant] = momentum = FAILED
    return row | {"momentum": momentum}


def _box(pairs: Pairs) -> tuple[float, ...]:
    """x = 0 is the border between two ranks, z = 0 one of bins."""
    s, y = pairs.spread, pairs.sides[0].place[:, 1]
    return -s, s, -s, float(y.max()) + s, -s, s


def _data(pairs: Pairs, types: Sequence[str], swap: bool) -> str:
    """The data file of the pairs; `swap`: the targets have the lower ids."""
    rows = [row for g in pairs.ordered(swap) for row in equal_spheres(1 + types.index(g.body.material), g)]
    return data_text("pairs", len(types), _box(pairs), rows)


def _ranks(variant: str) -> int:
    return 2 if variant == "migration" else 1


def scripts(tool: Host, deck: Any, pairs: Pairs, variant: str) -> list[str]:
    """The scripts of a variant in the order in which they run."""
    if isinstance(tool, Yade):
        sides = pairs.ordered(variant == "swap")
        files = [(f"side{k}.data", s.body.radius, s.body.material) for k, s in enumerate(sides)]
        template, about = "verification/yade/pairs.py.j2", {"deck": deck, "sides": files}
        return [decks.render(template, **about, **run) for run in pairs.runs(variant, "middle.yade.gz")]
    sort = 0.499 * _box(pairs)[-1] if variant == "sort" else None
    template = f"verification/{'lammps' if isinstance(tool, Lammps) else 'liggghts'}/invariance.in.j2"
    about = {"deck": deck, "ranks": _ranks(variant), "sort": sort}
    return [decks.render(template, **about, **run) for run in pairs.runs(variant, "middle.restart")]


def velocities(tool: Host, pairs: Pairs, variant: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    deck, swap, in_yade = tool.deck(pairs.plan), variant == "swap", isinstance(tool, Yade)
    found = scripts(tool, deck, pairs, variant)
    texts = {f"pairs{k}.py" if in_yade else f"in.{k}": text for k, text in enumerate(found)}
    if in_yade:
        tables = [np.hstack([side.place, side.velocity]).tolist() for side in pairs.ordered(swap)]
        data = {f"side{k}.data": table_text("# x y z v_x v_y v_z, SI", table) for k, table in enumerate(tables)}
    else:
        data = {"impact.data": _data(pairs, deck.types, swap)}
    tool.put(texts | data, folder)
    path = folder / ("path.bin" if in_yade else "out.txt" if isinstance(tool, Lammps) else "out.bin")
    for name in texts:
        path.unlink(missing_ok=True)
        tool.launcher.run(name, folder, ranks=_ranks(variant), out=f"out.{name}", seconds=120)
    return np.flip(_read(tool, path, pairs.plan.n), axis=0) if swap else _read(tool, path, pairs.plan.n)


def _read(tool: Host, path: Path, n: int) -> np.ndarray:
    """The velocities that a run has left, in the order of its bodies."""
    if not isinstance(tool, Yade):
        return (impact_frames(path, 1, 2 * n) if isinstance(tool, Lammps) else dump.series(path)[-1]).reshape(2, n, 3)
    try:
        return np.asarray(np.load(path)).reshape(2, n, 3)
    except OSError as error:
        raise EngineError(f"{path}: the run left no result ({error}); see the logs beside it") from None
