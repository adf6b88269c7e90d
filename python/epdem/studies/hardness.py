# SPDX-License-Identifier: GPL-2.0-or-later
"""Hardness numbers as mean pressures, and the strength of a law that has this pressure in the hardness test."""

import math
from dataclasses import replace

from ..errors import CaseError
from ..impacts.experiment import Body
from ..laws.strengths import LawNumbers, law_named, yields_by_stress
from ..theory import pair
from ..theory.backbones import JKR
from ..theory.indentation import PYRAMID, Indentation, mean_pressure, yield_stress
from ..theory.numerics import bisect

KGF_PER_MM2 = 9.80665e6  # Pa
VICKERS_FACETS = 2 / 1.8544  # area of the facets of a Vickers indentation over its projected area, 1/sin(136 deg/2)
BRINELL_DENT = 0.375  # dent over ball diameter in a usual Brinell test (0.24 to 0.6)
LEAST_STRENGTH = 1e-8  # of E*; the largest is E* itself


def hardness_test(
    *, vickers: float | None = None, brinell: float | None = None, dent_ratio: float | None = None
) -> Indentation:
    """The hardness test behind HV or HB (kgf/mm^2).

    Both hardnesses are the load over the area of the surface that the indenter leaves; the mean pressure (Meyer's
    hardness) is the load over its projection. For the pyramid of Vickers p_m = 1.0785 HV. For the cap of Brinell
    p_m = HB 2/(1 + sqrt(1 - x^2)) with x = `dent_ratio` in (0, 1], diameter of the indentation over that of the
    ball (None: BRINELL_DENT). Raises CaseError unless one hardness > 0 is given.
    """
    values = [value for value in (vickers, brinell) if value is not None]
    if len(values) != 1:
        raise CaseError("give one hardness, --hv or --hb")
    hardness = values[0]
    if not (math.isfinite(hardness) and hardness > 0):
        raise CaseError(f"hardness {hardness:g}, must be > 0")
    if vickers is not None:
        return Indentation(hardness * KGF_PER_MM2 * VICKERS_FACETS, PYRAMID)
    x = BRINELL_DENT if dent_ratio is None else dent_ratio
    if not 0.0 < x <= 1.0:
        raise CaseError(f"--dent-ratio {x:g}, must lie in (0, 1]")
    return Indentation(hardness * KGF_PER_MM2 * 2.0 / (1.0 + math.sqrt(1.0 - x**2)), x)


def specimen(body: Body, target: Body) -> Body:
    """The body whose hardness counts: of the lower yield stress, else of the lower modulus."""
    return min((b for b in (body, target) if not b.rigid), key=lambda b: (b.yield_stress or math.inf, b.young_modulus))


def strength(law: LawNumbers, test: Indentation, body: Body, source: str) -> float:
    """Strength [Pa] with which `body` has the mean pressure of a hardness test with a rigid indenter.

    A yield stress follows from the constraint of an expanding cavity, a contact pressure from the law's own mean
    pressure at a/R of the test. Raises CaseError for pressures that no strength gives.
    """
    E, nu = body.young_modulus, body.poisson_ratio
    plane = float(pair.E_star(E, nu, math.inf, 0.0))
    elastic = 4 / (3 * math.pi) * test.slope  # p_m/E* of Hertz at this a/R
    if not LEAST_STRENGTH <= test.pressure / plane < elastic:
        raise CaseError(
            f"{source}: its mean pressure {test.pressure:.3g} Pa must lie between {LEAST_STRENGTH:g} and {elastic:.2g} "
            f"of E* = {plane:.3g} Pa; a hardness is in kgf/mm^2, for steel 100 to 1000"
        )
    if yields_by_stress(law.name):
        try:
            return yield_stress(test, young_modulus=E, poisson_ratio=nu, most=law.ratios["plastic_ratio"])
        except ValueError as error:
            raise CaseError(f"{source}: {error}; a hardness is in kgf/mm^2, for steel 100 to 1000") from None
    dry = law_named(law.name).without_adhesion or law.name  # attraction plays no part in a hardness test

    def too_soft(p_y: float) -> bool:
        theory = replace(law, name=dry, absolute=p_y).pair(p_y, p_y).theory(E_star=plane, R_star=1.0)
        assert not isinstance(theory, JKR)
        return mean_pressure(theory, test.slope) < test.pressure

    if not too_soft(LEAST_STRENGTH * plane):
        raise CaseError(
            f"{source}: no {law_named(law.name).strength} above {LEAST_STRENGTH:g} of E* = {plane:.3g} Pa gives "
            f"{test.pressure:.3g} Pa with these parameters of {law.name}; lower law.hardening_exponent"
        )
    return float(bisect(too_soft, LEAST_STRENGTH * plane, 2.0 * test.pressure, steps=80)[1])
