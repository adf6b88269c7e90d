# SPDX-License-Identifier: GPL-2.0-or-later
"""The prediction of theory for an experiment."""

from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.readable import in_words
from ..laws.strengths import find_law
from ..theory import validity
from ..theory.backbone import Backbone
from ..theory.restitution import Impact
from ..theory.sliding import first_sliding_yield
from ..theory.waves import energy_split
from ..theory.yielding import yield_speed
from . import oblique
from .experiment import Experiment, strain_rate

if TYPE_CHECKING:
    import pandas as pd

FASTEST = 1e4  # strain rate [1/s] up to which the strength of metals grows with its logarithm
LARGEST_WAVE_SHARE = 0.05  # above it e_n of real impacts is noticeably lower than that of any law of force
SURFACE_FRICTION = 0.3  # above it a sliding contact first yields at its surface
LARGEST_TURN = 1e-3  # error of the overlap by the turn of the line of centres that is not worth a sentence


@dataclass(frozen=True)
class Prediction(Impact):
    """Theory for each speed, arrays of shape (n,), SI."""

    speed: np.ndarray
    strain: np.ndarray  # w a_max/R*, w: share of the weaker body
    yields: tuple[str, ...]  # materials that flow somewhere in the range of speeds; law.STRENGTH if it is one for all
    yield_speeds: dict[str, float]  # from which each material yields beneath its surface [m/s], eq. 8.78; inf: never
    rebound: oblique.Rebound | None = None  # of oblique impacts
    outside: tuple[str, ...] = ()  # sentences on impacts outside the law's domain
    finite_strain: tuple[str, ...] = ()  # sentences on contacts beyond small strain
    observation_time: float = np.nan  # duration for which sticking bodies are observed [s]; NaN: without adhesion
    experiment: Experiment | None = None  # None: its waves are not estimated

    @cached_property
    def wave_share(self) -> np.ndarray | None:
        """Share of the kinetic energy that a plane target radiates, shape (n,); it takes as long as all else."""
        return _wave_share(self.experiment) if self.experiment else None

    @property
    def caveats(self) -> tuple[str, ...]:
        """Sentences on impacts outside the domain of the law, or in which it leaves out much."""
        return self.outside + tuple(_radiating(self.speed, self.wave_share))

    @property
    def warnings(self) -> tuple[str, ...]:
        """All sentences on the domain of the law and of the theory."""
        return self.caveats + self.finite_strain

    @property
    def sticks(self) -> np.ndarray:
        """Where the bodies stay together."""
        return np.asarray(self.e_n == 0.0)

    @property
    def duration(self) -> np.ndarray:
        """Times of observation [s]: of contact, and of bodies that stick `observation_time`."""
        return np.where(np.isfinite(self.contact_time), self.contact_time, self.observation_time)

    def columns(self) -> dict[str, np.ndarray]:
        """The numbers of each impact by name, with the rebound of oblique ones."""
        rebound = {} if self.rebound is None else self.rebound.columns()
        return {name: getattr(self, name) for name in COLUMNS} | rebound

    def table(self) -> "pd.DataFrame":
        """`columns` as a table, one row per impact."""
        import pandas as pd  # a third of a second: only where a table is asked for

        return pd.DataFrame(self.columns())


COLUMNS = ("speed", *(f.name for f in fields(Impact)), "strain")


def predict(experiment: Experiment) -> Prediction:
    """The prediction of `experiment` from theory alone; the C++ laws are not called.

    With adhesion residual_overlap is that at which the contact ends, 3/4 d below the dent; what adhesion takes is
    neither in work_out nor in plastic_work.
    """
    x, law = experiment, experiment.theory()
    pair: dict[str, Any] = {"m_star": x.m_star, "speed": x.speed}
    impact = law.impact(**pair, restitution=x.viscous_restitution)
    first_yield = {
        b.material: law.first_yield_speed(b.yield_stress, m_star=x.m_star)
        for b in (x.body, x.target)
        if b.yield_stress is not None and not b.rigid
    }
    strain = x.law.share * impact.radius_max / x.R_star
    flattening = x.law.strain_curvature(x.R_star, x.body.radius) * impact.radius_max / x.R_star
    effect = validity.SOFTENED if "finite_strain" in x.law.ratios() else validity.OVERESTIMATED
    return Prediction(
        **vars(impact),
        speed=x.speed,
        strain=strain,
        yields=_softer(x) if law.has_yielded(impact) else (),
        yield_speeds={material: float(speed) for material, speed in first_yield.items() if speed is not None},
        rebound=oblique.predict(x, impact.e_n) if x.oblique else None,
        outside=(
            *law.caveats(**pair),
            *_too_fast(x, impact.radius_max),
            *_turning(x, impact.contact_time, impact.overlap_max),
            *surface_yields(x, x.oblique.friction if x.oblique else 0.0).values(),
        ),
        finite_strain=tuple(validity.finite_strain_of_impacts(flattening, x.speed, effect)),
        observation_time=law.observation_time(**pair),
        experiment=x,
    )


def _too_fast(x: Experiment, radius: np.ndarray) -> list[str]:
    """A sentence on impacts of a case with [rate] beyond the strain rates for which its formula holds."""
    rate = np.asarray(strain_rate(x.speed, radius, share=x.law.share))
    if not x.rated or rate.max() <= FASTEST:
        return []
    return [
        f"the strain rate reaches {rate.max():.2g} per s, above {FASTEST:g} per s from "
        f"{x.speed[rate > FASTEST].min():.3g} m/s on: [rate] is an extrapolation there"
    ]


def _turning(x: Experiment, contact_time: np.ndarray, overlap: np.ndarray) -> list[str]:
    """A sentence on oblique impacts of two spheres whose line of centres turns during contact, for theory holds it."""
    if not x.oblique or not np.isfinite(x.target.radius):
        return []
    slip = x.speed * np.tan(x.friction_of_oblique().angle)
    turn = slip * contact_time / (x.body.radius + x.target.radius)
    error = (slip / x.speed) ** 2 * overlap / (x.body.radius + x.target.radius)  # work of the centrifugal force
    if not (error > LARGEST_TURN).any():
        return []
    angle = np.degrees(x.friction_of_oblique().angle[error > LARGEST_TURN].min())
    return [
        f"the line of centres turns by up to {np.degrees(np.nanmax(turn)):.2g} deg during contact, which theory "
        f"neglects: from {angle:.3g} deg on, overlap_max and force_max of engines with positions are lower, by up to "
        f"about {100 * np.nanmax(error):.2g} %"
    ]


def _wave_share(x: Experiment) -> np.ndarray | None:
    """Estimated share of the kinetic energy that a plane target radiates as waves, shape (n,).

    None for two spheres, in which waves return, and where the theory has no history of the force: with adhesion or a
    dashpot, and for a rigid target or nu of 0.5 or below 0.
    """
    law, b = x.theory(), x.target
    if not isinstance(law, Backbone) or x.viscous_restitution is not None:
        return None
    if np.isfinite(b.radius) or b.rigid or not 0.0 <= b.poisson_ratio < 0.4999:
        return None
    half_space = {"E": b.young_modulus, "nu": b.poisson_ratio, "density": b.density}
    return energy_split(law, m_star=x.m_star, speed=x.speed, **half_space)["waves"]


def _radiating(speed: np.ndarray, share: np.ndarray | None) -> list[str]:
    """A sentence on impacts that lose much energy to waves."""
    if share is None or share.max() <= LARGEST_WAVE_SHARE:
        return []
    return [
        f"elastic waves take an estimated {100 * share.max():.2g} % of the kinetic energy, above "
        f"{100 * LARGEST_WAVE_SHARE:g} % from {speed[share > LARGEST_WAVE_SHARE].min():.3g} m/s on: e_n of real "
        "impacts is lower than that of any law of force"
    ]


def surface_yields(x: Experiment, mu: float) -> dict[float, str]:
    """A sentence for each material on first yield at the surface under a large friction (section 8.2.5), by the peak
    pressure [Pa]."""
    pair = {"E_star": x.E_star, "R_star": x.R_star, "m_star": x.m_star}
    found = {}
    for b in (x.body, x.target):
        if mu <= SURFACE_FRICTION or b.yield_stress is None or b.rigid or np.isinf(b.yield_stress):
            continue
        ratio = float(first_sliding_yield(mu, b.poisson_ratio)[0])
        pressure = ratio * b.yield_stress
        found[pressure] = (
            f"friction {mu:g}: a sliding contact of {b.material} yields at its surface from a peak pressure of "
            f"{in_words(pressure, 'Pa')} ({ratio:.2f} Y) on, which normal impacts reach at "
            f"{float(yield_speed(p_y=pressure, **pair)):.3g} m/s"
        )
    return found


def _softer(x: Experiment) -> tuple[str, ...]:
    """The materials of the smaller strength, or the key of the strength of all bodies."""
    if x.law.common:
        return (f"law.{find_law(x.law.name).strength}",)
    bodies = zip((x.body, x.target), x.law.strengths, strict=True)
    return tuple(dict.fromkeys(b.material for b, strength in bodies if strength == min(x.law.strengths)))
