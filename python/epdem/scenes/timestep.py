# SPDX-License-Identifier: GPL-2.0-or-later
"""The time step of a scene, from its highest speed."""

import math
from collections.abc import Iterator

from ..case.scene import SceneCase
from ..errors import CaseError
from ..impacts.experiment import Experiment
from ..impacts.prediction import Prediction, predict
from ..impacts.timestep import search, stability_limit
from ..theory.timestep import DENSE_PACKING, sticking_packing
from .model import model
from .pairs import sphere_impact, wall_impact
from .presets import parts

MARGIN = 0.8  # of the stable step of a bed: contacts there are a little stiffer than in the impact that stands for them


def bed_share(x: Experiment, *, sticking: bool) -> float:
    """Share of the stable step of the contact `x` alone that a step in a bed of such contacts may have.

    Velocity Verlet is stable up to a half of it in a dense packing of central springs; where contacts stick, up to
    `sticking_packing` (0.246 at nu = 0.3).
    """
    stable = DENSE_PACKING
    if sticking:
        stable = min(stable, float(sticking_packing(4.0 * x.G_star / x.E_star)))
    return MARGIN * stable


def highest_speed(case: SceneCase) -> float:
    """The highest possible speed [m/s]: free fall, the stream, the moving wall; or numerics.highest_speed.

    Raises CaseError if nothing in it moves.
    """
    if case.numerics.highest_speed is not None:
        return case.numerics.highest_speed
    scene = parts(case.scene)
    v = math.sqrt(2.0 * scene.gravity * scene.fall_height) + scene.drive
    if v == 0.0:
        raise CaseError(
            "scene.gravity = 0: nothing moves the spheres, so no time step follows; "
            "give gravity, or numerics.highest_speed"
        )
    return v


def leading_impact(case: SceneCase) -> Experiment:
    """The impact that stands for a scene: of its leading spheres on a wall, else on one, at its highest speed."""
    first = case.scene.leading
    return wall_impact(
        case,
        first.material,
        first.radii()[0],
        (*case.scene.wall_materials, first.material)[0],
        highest_speed(case),
    )


def _impacts(case: SceneCase) -> Iterator[tuple[Experiment, Prediction, float]]:
    """The impacts of the spheres of a scene on each material at its highest speed, and their stable steps [s]."""
    v = highest_speed(case)
    bodies = {(p.material, p.radii()[0]) for p in case.scene.filled}
    for material, radius in sorted(bodies):
        for other in sorted({m for m, _ in bodies} | {*case.scene.wall_materials}):
            x = sphere_impact(case, material, radius, other, v)
            prediction = predict(x)
            yield x, prediction, stability_limit(x, float(prediction.overlap_max.max()))


def stable_step(case: SceneCase) -> float:
    """The largest step [s] with which each contact of the scene alone is stable at its highest speed."""
    return min(stable for *_, stable in _impacts(case))


def time_step(case: SceneCase) -> float:
    """The step [s] of a scene: the target error of e_n at its speeds, below the stable step of a bed."""
    if case.numerics.time_step is not None:
        return case.numerics.time_step
    best, sticking = math.inf, model(case).sliding
    for x, prediction, stable in _impacts(case):
        try:
            step = search(x, prediction, case.numerics.error).time_step
        except CaseError as error:
            raise CaseError(f"numerics.{error}, or numerics.time_step") from None
        best = min(best, step, bed_share(x, sticking=sticking) * stable)
    power = 10.0 ** (math.floor(math.log10(best)) - 1)
    return float(f"{math.floor(best / power) * power:.1e}")  # two digits, rounded down: the deck is readable
