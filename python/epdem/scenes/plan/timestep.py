# SPDX-License-Identifier: GPL-2.0-or-later
"""The time step of a scene, from its highest speed, and the impacts that stand for its contacts. SI."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...case.scene import SceneCase
from ...errors import CaseError
from ...impacts.experiment import Experiment, plane, sphere
from ...impacts.plan import search, stability_limit
from ...impacts.prediction import Prediction, predict
from ...theory import timestep as times
from .model import model, pair_law

MARGIN = 0.8  # of the stable step of a bed: contacts there are a little stiffer than in the impact that stands for them
# of the stable step of a bed with adhesion beside compaction: with the whole one a press of 600 spheres loses half of
# its pressure in a hold
STICKING_PRESS = 0.5


def bed_share(x: Experiment, *, sticking: bool, screening: float = 1.0) -> float:
    """Share of the stable step of the contact `x` alone that a step in a bed of such contacts may have.

    Velocity Verlet is stable up to a half of it in a dense packing of central springs; where contacts stick, up to
    `sticking_packing` (0.246 at nu = 0.3). `screening` divides the normal stiffness alone, and bodies
    retreat one step later (`times.retreating_packing`).
    """
    stable = times.retreating_packing(screening)
    if sticking:
        stable = min(stable, float(times.sticking_packing(screening * 4.0 * x.G_star / x.E_star)))
    if screening < 1.0 and x.law.adheres:
        stable *= STICKING_PRESS
    return MARGIN * stable


def highest_speed(case: SceneCase) -> float:
    """The highest possible speed [m/s]: free fall, the stream, the moving wall; or numerics.highest_speed.

    Raises CaseError if nothing in it moves.
    """
    if case.numerics.highest_speed is not None:
        return case.numerics.highest_speed
    scene = case.parts
    v = math.sqrt(2.0 * scene.gravity * scene.fall_height) + scene.drive
    if v == 0.0:
        raise CaseError(
            "scene.gravity = 0: nothing moves the spheres, so no time step follows; "
            "give gravity, or numerics.highest_speed"
        )
    return v


def leading_impact(case: SceneCase) -> Experiment:
    """The impact that stands for a scene: of its leading spheres on a wall, else on one, at its highest speed."""
    first = case.parts.leading
    other = (*case.parts.wall_materials, first.material)[0]
    return impact(case, first.material, first.radii()[0], other, highest_speed(case))


def _impacts(case: SceneCase, density: float) -> Iterator[tuple[Experiment, Prediction, float, float]]:
    """The impacts of the spheres of a scene on each material at its highest speed, stable steps [s] and screening.

    With law.compaction contacts are as wide as in a bed of this relative density, and screened.
    """
    v = highest_speed(case)
    bodies = {(p.material, p.radii()[0]) for p in case.parts.filled}
    for material, radius in sorted(bodies):
        for other in sorted({m for m, _ in bodies} | {*case.parts.wall_materials}):
            x = impact(case, material, radius, other, v, wall=False)
            prediction = predict(x)
            if not case.law.numbers.compaction:
                yield x, prediction, stability_limit(x, float(prediction.overlap_max.max())), 1.0
                continue
            a = max(float(prediction.radius_max.max()), float(times.pressed_radius(max(density, times.LOOSE))) * radius)
            screening = float(times.screening(a / radius, poisson_ratio_=x.body.poisson_ratio))
            stable = float(times.stability_limit(E_star=x.E_star, m_star=x.m_star, radius=a / screening))
            yield x, prediction, stable, screening


def stable_step(case: SceneCase, density: float) -> float:
    """The largest step [s] with which each contact of the scene alone is stable, at its highest speed and relative
    density.
    """
    return min(stable for *_, stable, _ in _impacts(case, density))


def unstable_steps(case: SceneCase, density: float) -> list[str]:
    """A sentence for each given time step with which not even a single contact is stable."""
    given = {"numerics.time_step": case.numerics.time_step}
    given |= {f"scene.phase.{phase.name}.time_step": phase.time_step for phase in case.parts.phase}
    if not (given := {place: step for place, step in given.items() if step}):
        return []
    try:
        stable = stable_step(case, density)
    except CaseError:  # no speed follows from the case
        return []
    contact = "an impact at the scene's highest speed"
    if case.law.numbers.compaction and density > times.LOOSE:
        contact = f"a contact of a bed at a relative density of {density:.2g}, with law.compaction,"
    return [
        f"{place} = {step:g} s: {contact} is stable up to {stable:.2g} s, a bed of spheres up to a quarter or a half "
        "of it; give less, or leave it out"
        for place, step in given.items()
        if step > stable
    ]


def time_step(case: SceneCase, density: float) -> float:
    """The step [s] of a scene: the target error of e_n at its speeds, below the stable step of a bed.

    density: the largest relative density that it is pressed to (`beds.largest_density`).
    """
    if case.numerics.time_step is not None:
        return case.numerics.time_step
    best, sticking = math.inf, model(case).sliding
    for x, prediction, stable, screening in _impacts(case, density):
        try:
            step = search(x, prediction, case.numerics.error).time_step
        except CaseError as error:
            raise CaseError(f"numerics.{error}, or numerics.time_step") from None
        best = min(best, step, bed_share(x, sticking=sticking, screening=screening) * stable)
    power = 10.0 ** (math.floor(math.log10(best)) - 1)
    return float(f"{math.floor(best / power) * power:.1e}")  # two digits, rounded down: the deck is readable


def impact(case: SceneCase, material: str, radius: float, other: str, v: float, *, wall: bool = True) -> Experiment:
    """The impact of a sphere of `radius` [m] on a flat wall of `other`, or on a sphere of its own size, at speeds up to
    v [m/s]. That of spheres is a scene's shortest."""
    law = pair_law(case, material, other)[0]
    viscous = case.viscous.restitution if case.viscous and not law.adheres else None  # no theory has both
    body, target = (sphere(case.materials[name], radius=radius, name=name) for name in (material, other))
    target = plane(case.materials[other], name=other) if wall else target
    x = Experiment(law, body, target, np.geomspace(v / 100, v, 5), viscous_restitution=viscous, name=case.name)
    return replace(x, speed=_far_from_sticking(x))


def _far_from_sticking(x: Experiment) -> np.ndarray:
    """The speeds at which the error of e_n says something: near the sticking speed e_n falls to 0 as a root."""
    v = x.speed
    share = v / max(float(x.theory().sticking_speed(m_star=x.m_star)), 1e-300)
    far = v[(share < 0.5) | (share > 2.0)]
    return far if far.size else v[-1:] * 2.0 / share[-1]
