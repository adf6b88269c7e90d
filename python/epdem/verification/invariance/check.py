# SPDX-License-Identifier: GPL-2.0-or-later
"""Does a contact model give the same impact in every variant of its set-up?

Swapping names, sorting bodies, changing owners or stopping and restarting in mid-contact must change neither
restitution nor momentum.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ...engines import ImpactEngine
from ...engines.lammps.engine import Lammps
from ...engines.liggghts.engine import Liggghts
from ...engines.yade.engine import Yade
from ...errors import EngineError
from ...impacts.experiment import Experiment
from ...impacts.plan import plan
from ..models.theories import prediction as predict
from . import input_scripts, yade
from .pairs import AXIS, VARIANTS, pairs, unequal_spheres

FAILED = float("inf")  # it died or lost particles: as wrong as can be


def _host(tool: ImpactEngine) -> tuple[tuple[str, ...], Callable[..., np.ndarray]] | None:
    """The variants of an engine, and the function that runs one: velocities [m/s], (2, n, 3); None: it has none."""
    if isinstance(tool, Yade) and (tool.classes or tool.own_law):  # a deck with the C library does not continue
        return yade.VARIANTS, yade.velocities
    if isinstance(tool, Liggghts | Lammps) and tool.name != "lammps-mdr":  # which has walls only
        return VARIANTS, input_scripts.velocities
    return None


def examine(tool: ImpactEngine, x: Experiment, folder: Path) -> dict[str, float]:
    """Run the impacts of unequal spheres in every variant. Raises EngineError. Empty: the engine has none.

    unequal_error: of e_n against theory, relative; by the name of a variant the largest absolute change of e_n over
    the phases, NaN if the engine does not have it, inf if it failed; momentum: the largest change in any variant,
    relative to one body's change.
    """
    if (host := _host(tool)) is None:
        return {}
    variants, velocities = host
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
