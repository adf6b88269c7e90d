# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's conical-damage law as a basis of our laws: its formula and its four free numbers.

`Law2_ScGeom_MindlinPhysCDM_HertzMindlinCDM` (YADE 2023.02a and 2025.2) computes, at overlap u,

    uN = u + (radius - R) alphaFac      F = 4/3 E sqrt(R uN) uN      a = sqrt(R uN)      k_t = 8 G a

and where 2E/pi sqrt(uN/R) > sigmaMax it first grows R to (u + radius alphaFac)/(h + alphaFac),
h = (pi sigmaMax/(2E))^2, and sets isYielding. So R and (R - radius) alphaFac = dent make any Hertz branch,
sigmaMax places its end, and alphaFac, otherwise free, gives the slope beyond that end.
"""

from math import atan, pi, sqrt

# Shortest increment for a secant, relative to the overlap: below it F_next/F - 1 would be all round-off.
SMALL = 1e-6

# sigmaMax over Young's modulus: of a material that never yields (YADE refuses 1 and more); the most of one that does
NEVER, STRONGEST = 0.4, 0.36


def friction_angle(friction: float) -> float:
    """The angle [rad] of a coefficient of friction; YADE's law needs one above 0."""
    return max(atan(friction), 1e-9)


def strongest(young_modulus: float, trigger_factor: float) -> float:
    """The strength [Pa] from which on YADE's class does not take it, for a law that yields at this factor times it."""
    return STRONGEST * young_modulus / trigger_factor


def force(E_star: float, R: float, radius: float, growth: float, u: float) -> float:
    """What YADE's law gives at overlap u [m] with these numbers, after any growth of R [N]."""
    depth = u + (radius - R) * growth
    return 4.0 / 3.0 * E_star * sqrt(R * depth) * depth if depth > 0.0 else 0.0


def damage_limit(E_star: float, R: float, dent: float, delta_max: float) -> tuple[float, float]:
    """(h, sigmaMax): the branch (R, dent) ends at delta_max; a contact that rests there must not yield by round-off."""
    h = (delta_max - dent) / R
    return h, 2.0 * E_star / pi * sqrt(h) * (1.0 + 2e-15)


def growth_by_secant(R: float, h: float, step: float, rise: float) -> float:
    """alphaFac with which the force beyond the end of the branch rises by the share `rise` over `step` [m].

    F grows there as R^2, and R by step/(h + alphaFac): hence R sqrt(1 + rise) = R + step/(h + alphaFac). If the force
    does not rise, the result is h/3, with which F goes on as the branch.
    """
    if not rise > 0.0:
        return h / 3.0
    return step * (sqrt(1.0 + rise) + 1.0) / (R * rise) - h


def hertz_branch(E_star: float, force: float, radius: float, delta: float) -> tuple[float, float]:
    """(R, dent) of the Hertz contact F = 4/3 E* sqrt(R) (delta - dent)^1.5 with this force and slope 2 E* a at delta.

    For a law that does not flatten it is the whole elastic branch, exactly; else it touches the branch at delta.
    """
    x = 0.75 * force / (E_star * radius)
    return radius * radius / x, delta - x
