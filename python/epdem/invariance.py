# SPDX-License-Identifier: GPL-2.0-or-later
"""Does a contact model in LIGGGHTS give the same impact however the impact is told?

Pairs of unequal spheres, tilted against the bins and drifting across the border between two ranks while they touch:
swapping names, sorting atoms, changing owners or stopping and restarting must change neither restitution nor momentum.
"""

import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from . import deck as decks
from . import paths
from .case import Target
from .engines.base import call
from .engines.liggghts import Liggghts, read_dump
from .errors import EngineError
from .experiment import Experiment, experiment
from .plan import Plan, plan
from .predict import predict

# From target to body. Bins are sorted by z first, then y: with this tilt the lower body in z is the upper one in y, and
# the order of the two turns twice as they drift across the border of bins at z = 0.
# The tilt in x makes them change their owner one after the other.
AXIS = np.array([0.03, 1.0, -0.03]) / np.linalg.norm([0.03, 1.0, -0.03])
WAYS = ("swap", "sort", "migration", "restart")


@dataclass(frozen=True)
class Invariance:
    """Largest change over the phases: of e_n (absolute), and of total momentum (relative to one body's change)."""

    e_n: dict[str, float]
    momentum: dict[str, float]
    unequal_error: float  # of e_n against theory, relative, for these unequal spheres


def unequal_spheres(x: Experiment) -> Experiment:
    """The case's body against a sphere of 0.6 times its radius and the target's material, at the middle speed."""
    impact = x.case.impact
    material = impact.target.material if impact.target.material in x.case.materials else impact.body.material
    target = Target.model_construct(material=material, radius=0.6 * x.body.radius)
    update = {"kind": "sphere-sphere", "target": target, "speeds": [float(x.speed[x.speed.size // 2])]}
    case = x.case.model_copy(update={"impact": impact.model_copy(update=update)})
    return experiment(case, None if x.law.name == x.case.law.name else x.law.name)


class _Scene:
    """The pairs of a plan, all in one run, and the ways to tell them."""

    def __init__(self, tool: Liggghts, p: Plan, contact_time: float, folder: Path):
        self.tool, self.plan, self.folder, x = tool, p, folder, p.experiment
        self.deck = replace(tool.deck(p), path="out.bin")
        self.middle = int(0.4 * contact_time / p.time_step)
        n, reach = p.n, max(x.body.radius, x.target.radius)
        # the contact point crosses x = 0, the border of the ranks, and z = 0, a border of bins, in mid-contact
        self.drift = 0.05 * reach / (self.middle * p.time_step) * np.array([1.0, 0.0, 1.0])
        y = 5.2 * reach * np.arange(n)[:, None] * np.array([0.0, 1.0, 0.0])
        share = x.m_star / x.body.mass
        rest = 1 - share
        start = y - self.drift * self.middle * p.time_step
        gap, v = p.gap[:, None], p.speed[:, None]
        self.bodies = [
            (1, x.body, start + AXIS * (x.body.radius + share * gap), -share * v * AXIS),
            (len(self.deck.types), x.target, start - AXIS * (x.target.radius + rest * gap), rest * v * AXIS),
        ]  # fmt: skip
        travel = p.steps * p.time_step * (p.speed.max() + self.drift[0]) + 4 * reach
        self.box = [(-travel, travel), (-travel, float(y.max()) + travel), (-travel, travel)]

    def data(self, swap: bool) -> str:
        """The data file; `swap` gives the targets the lower ids."""
        rows, speeds, k = [], [], 0
        for kind, body, place, v in self.bodies[:: -1 if swap else 1]:
            for xyz, vxyz in zip(place, v + self.drift, strict=True):
                k += 1
                numbers = (2 * body.radius, body.density, *xyz)
                rows.append(f"{k} {kind} " + " ".join(map(decks.number, numbers)))
                speeds.append(f"{k} " + " ".join(map(decks.number, vxyz)) + " 0 0 0")
        box = [
            f"{decks.number(lo)} {decks.number(hi)} {a}lo {a}hi" for a, (lo, hi) in zip("xyz", self.box, strict=True)
        ]
        types = len(self.deck.types)
        head = ["pairs: id type diameter density x y z", "", f"{k} atoms", f"{types} atom types", *box, ""]
        return "\n".join([*head, "Atoms", "", *rows, "", "Velocities", "", *speeds, ""])

    def outcome(self, way: str) -> np.ndarray:
        """Velocities after the impact, shape (2, n, 3), body first."""
        p, n, folder = self.plan, self.plan.n, self.folder / way
        folder.mkdir(parents=True, exist_ok=True)
        (folder / self.deck.data).write_text(self.data(way == "swap"))
        words = {"deck": self.deck, "way": way, "ranks": 2 if way == "migration" else 1, "restart": None, "stop": None,
                 "sort": 0.499 * self.box[2][1] if way == "sort" else None, "steps": p.steps}  # fmt: skip
        parts = [words]
        if way == "restart":
            parts = [words | {"steps": self.middle, "stop": "middle.restart"},
                     words | {"steps": p.steps - self.middle, "restart": "middle.restart"}]  # fmt: skip
        for k, part in enumerate(parts):
            (folder / f"in.{k}").write_text(decks.render("liggghts/invariance.in.j2", **part))
            command = [str(paths.launcher()), "-in", f"in.{k}", "-log", f"log.{k}"]
            if part["ranks"] > 1:
                extra = ["--allow-run-as-root"] if os.geteuid() == 0 else []
                command = ["mpirun", "-np", "2", "--oversubscribe", *extra, *command]
            (folder / self.deck.path).unlink(missing_ok=True)
            call(command, folder, log=f"out.{k}", seconds=120)
        v = read_dump(folder / self.deck.path, 4)[-1].reshape(2, n, 3)
        return v[::-1] if way == "swap" else v


def examine(tool: Liggghts, x: Experiment, folder: Path) -> Invariance:
    """Tell the impacts of unequal spheres in every way. Raises EngineError."""
    pair = unequal_spheres(x)
    prediction = predict(pair)
    p = plan(pair, prediction)
    scene = _Scene(tool, p, float(prediction.contact_time[0]), folder)
    mass = np.array([pair.body.mass, pair.target.mass])[:, None, None]

    def restitution(v: np.ndarray) -> np.ndarray:
        return (v[0] - v[1]) @ AXIS / p.speed

    plain = scene.outcome("plain")
    change = np.abs(pair.m_star * p.speed).max()
    e_n, momentum = {}, {}
    for way in WAYS:
        try:
            v = scene.outcome(way)
            e_n[way] = float(np.abs(restitution(v) - restitution(plain)).max())
            momentum[way] = float(np.abs((mass * (v - scene.drift)).sum(axis=0)).max() / change)
        except (EngineError, ValueError):  # it died or lost particles: as wrong as can be
            e_n[way] = momentum[way] = float("nan")
    error = np.abs(restitution(plain) / prediction.e_n[0] - 1).max()
    return Invariance(e_n, momentum, float(error))
