# SPDX-License-Identifier: GPL-2.0-or-later
"""Hardness tests: the mean pressure under a pyramid or a ball, of an expanding cavity or of a law."""

import math
from dataclasses import dataclass

import numpy as np

from .curve import Curve
from .numerics import bisect

PYRAMID = math.tan(math.radians(19.7))  # slope of the cone with the volume of a Vickers pyramid
FULLY_PLASTIC = 2.8  # p_m/Y of a fully plastic indentation (Tabor 1951)
KGF_PER_MM2 = 9.80665e6  # Pa
VICKERS = KGF_PER_MM2 * 2 / 1.8544  # p_m [Pa] of 1 HV: area of the facets over its projection, 1/sin(136 deg/2)


@dataclass(frozen=True)
class Indentation:
    """A hardness test: mean pressure p_m [Pa], load over projected area; slope of the indenter at the rim.

    The slope is a/R for a ball and PYRAMID for a Vickers pyramid. The indenter is rigid.
    """

    pressure: float
    slope: float


def constraint(stiffness: float, *, poisson_ratio: float, slope: float, most: float = FULLY_PLASTIC) -> float:
    """p_m/Y of an indentation in a material with E/Y = `stiffness` > 0, at most `most`.

    A cavity of the contact radius a expands as a hemispherical core. The plastic radius c follows from the volume of
    the indenter, (Y/E) [3 (1-nu) (c/a)^3 - 2 (1-2 nu)] = slope/2; the pressure of the core is 2Y/3 + 2Y ln(c/a); the
    mean pressure exceeds the pressure of the core by 2Y/3 (Johnson 1985, section 6.3; Studman et al. 1977).
    """
    core = (stiffness * slope + 4 * (1 - 2 * poisson_ratio)) / (6 * (1 - poisson_ratio))
    return min(most, 2 / 3 * (2 + math.log(core)))


def yield_stress(
    test: Indentation, *, young_modulus: float, poisson_ratio: float, most: float = FULLY_PLASTIC
) -> float:
    """Y [Pa] with which `constraint` gives the mean pressure of the test.

    young_modulus [Pa] and poisson_ratio are those of the specimen. ValueError if p_m would be below Y, where the
    specimen hardly yields.
    """

    def too_soft(Y: float) -> bool:
        ratio = constraint(young_modulus / Y, poisson_ratio=poisson_ratio, slope=test.slope, most=most)
        return Y * ratio < test.pressure

    if too_soft(test.pressure):
        raise ValueError(f"its mean pressure {test.pressure:.3g} Pa is that of an elastic indentation")
    return float(bisect(too_soft, test.pressure / most, test.pressure)[1])


def mean_pressure(law: Curve, slope: float) -> float:
    """Mean pressure F/(pi a^2) [Pa] of a law at a/R* = `slope`; laws with one R*."""
    a = slope * float(law.R_star)
    overlap = bisect(lambda alpha: law.radius(alpha) < a, 0.0, a**2 / float(law.R_star))[1]  # a^2 >= R* alpha
    return float(law.force(overlap) / (np.pi * law.radius(overlap) ** 2))
