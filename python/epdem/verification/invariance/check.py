# SPDX-License-Identifier: GPL-2.0-or-later
"""Does a contact model give the same impact in every variant of its set-up?

Swapping names, sorting bodies, changing owners or stopping and restarting in mid-contact must change neither
restitution nor momentum.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from ...engines import ImpactEngine
from ...engines.lammps.engine import Lammps
from ...engines.liggghts.engine import Liggghts
from ...engines.yade.engine import Yade
from ...errors import EngineError
from ...impacts.experiment import Experiment
from ...impacts.plan import plan
from ..models.predictions import prediction as predict
from . import lammps, liggghts, yade
from .pairs import AXIS, Pairs, pairs, unequal_spheres

VARIANTS = ("swap", "sort", "migration", "restart")
FAILED = float("inf")  # it died or lost particles: as wrong as can be


@dataclass(frozen=True)
class Invariance:
    """Largest change over the phases: of e_n (absolute), and of total momentum (relative to one body's change).

    NaN: the engine has no such variant; inf: it failed.
    """

    e_n: dict[str, float]
    momentum: dict[str, float]
    unequal_error: float  # of e_n against theory, relative, for these unequal spheres


class _Host(Protocol):
    """How an engine runs the variants of a set-up: a module of this package."""

    VARIANTS: tuple[str, ...]

    def velocities(self, tool: Any, pairs: Pairs, variant: str, folder: Path, /) -> np.ndarray:
        """Velocities [m/s] after the impacts, "plain" or in a variant: (2, n, 3), body first.

        Raises EngineError; ValueError if bodies are lost.
        """


def _host(tool: ImpactEngine) -> _Host | None:
    if tool.name == "lammps-mdr":  # walls only
        return None
    if isinstance(tool, Yade) and not (tool.classes or tool.own_law):  # a deck with the C library does not continue
        return None
    hosts: dict[type, _Host] = {Liggghts: liggghts, Lammps: lammps, Yade: yade}
    return next((host for kind, host in hosts.items() if isinstance(tool, kind)), None)


def examine(tool: ImpactEngine, x: Experiment, folder: Path) -> Invariance | None:
    """Run the impacts of unequal spheres in every variant; None: the engine has none. Raises EngineError."""
    if (host := _host(tool)) is None:
        return None
    pair = unequal_spheres(x)
    prediction = predict(tool, pair)
    p = plan(pair, prediction)
    scene = pairs(p, float(prediction.duration[0]))
    mass = np.array([pair.body.mass, pair.target.mass])[:, None, None]

    def restitution(v: np.ndarray) -> np.ndarray:
        return np.asarray((v[0] - v[1]) @ AXIS / p.speed)

    plain = host.velocities(tool, scene, "plain", folder / "plain")
    change = np.abs(pair.m_star * p.speed).max()
    e_n, momentum = {}, {}
    for variant in VARIANTS:
        e_n[variant] = momentum[variant] = float("nan")
        if variant not in host.VARIANTS:
            continue
        try:
            v = host.velocities(tool, scene, variant, folder / variant)
            e_n[variant] = float(np.abs(restitution(v) - restitution(plain)).max())
            momentum[variant] = float(np.abs((mass * (v - scene.drift)).sum(axis=0)).max() / change)
        except (EngineError, ValueError):
            e_n[variant] = momentum[variant] = FAILED
    error = np.abs(restitution(plain) / prediction.e_n[0] - 1).max()
    return Invariance(e_n, momentum, float(error))
