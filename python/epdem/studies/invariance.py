# SPDX-License-Identifier: GPL-2.0-or-later
"""Does a contact model give the same impact however the impact is told?

Swapping names, sorting bodies, changing owners or stopping and restarting in mid-contact must change neither
restitution nor momentum.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..engines import Engine
from ..errors import EngineError
from ..impacts.experiment import Experiment
from ..impacts.foreign import prediction as predict
from ..impacts.pairs import AXIS, pairs, unequal_spheres
from ..impacts.plan import plan
from ..liggghts import pairs as liggghts_pairs
from ..liggghts.impacts import Liggghts
from ..yade import pairs as yade_pairs
from ..yade.impacts import Yade

WAYS = ("swap", "sort", "migration", "restart")
TELLERS = ((Liggghts, liggghts_pairs), (Yade, yade_pairs))
FAILED = float("inf")  # it died or lost particles: as wrong as can be


@dataclass(frozen=True)
class Invariance:
    """Largest change over the phases: of e_n (absolute), and of total momentum (relative to one body's change).

    NaN: the engine has no such way; inf: it failed.
    """

    e_n: dict[str, float]
    momentum: dict[str, float]
    unequal_error: float  # of e_n against theory, relative, for these unequal spheres


def examine(tool: Engine, x: Experiment, folder: Path) -> Invariance | None:
    """Tell the impacts of unequal spheres in every way; None: nothing can be told. Raises EngineError."""
    teller = next((module for kind, module in TELLERS if isinstance(tool, kind)), None)
    if teller is None:  # one contact in the embedded engine has no order, owner or restart to depend on
        return None
    pair = unequal_spheres(x)
    prediction = predict(tool, pair)
    p = plan(pair, prediction)
    scene = pairs(p, float(prediction.contact_time[0]))
    mass = np.array([pair.body.mass, pair.target.mass])[:, None, None]

    def restitution(v: np.ndarray) -> np.ndarray:
        return (v[0] - v[1]) @ AXIS / p.speed

    plain = teller.velocities(tool, scene, "plain", folder / "plain")
    change = np.abs(pair.m_star * p.speed).max()
    e_n, momentum = {}, {}
    for way in WAYS:
        e_n[way] = momentum[way] = float("nan")
        if way not in teller.WAYS:
            continue
        try:
            v = teller.velocities(tool, scene, way, folder / way)
            e_n[way] = float(np.abs(restitution(v) - restitution(plain)).max())
            momentum[way] = float(np.abs((mass * (v - scene.drift)).sum(axis=0)).max() / change)
        except (EngineError, ValueError):
            e_n[way] = momentum[way] = FAILED
    error = np.abs(restitution(plain) / prediction.e_n[0] - 1).max()
    return Invariance(e_n, momentum, float(error))
