# SPDX-License-Identifier: GPL-2.0-or-later
"""First yield under a sphere: pressure, depth, impact speed."""

from typing import Any

import numpy as np

from .backbone import Backbone
from .numerics import Array, Real, bisect, number, poisson_ratio

FIRST_YIELD_ROUNDED = 1.60  # p_0/Y at first yield, nu = 0.3; eq. 8.78


def axis_difference(z: Real, nu: Real) -> Array:
    """s_z - s_r on the axis of a Hertz contact at depth z (in a), in units of -p_0: the stress of both criteria."""
    z, nu = np.asarray(z, float), poisson_ratio("nu", nu)
    deep = np.maximum(z, 1e-300)
    s_r = -(1 + nu) * (1 - deep * np.arctan(1 / deep)) + 1 / (2 * (1 + z * z))
    return s_r + 1 / (1 + z * z)


def first_yield(nu: Real) -> tuple[Array, Array]:
    """(p_0/Y, depth z/a) of first yield on the axis under a sphere, exactly. nu in (-1, 0.5], of any shape.

    Eq. 8.78 [Johnson 1985]: p_0 = Y/max(s_r - s_z), 1.60 Y at nu = 0.3

    Both criteria coincide on the axis (section 6.1). The edge of the contact yields before it for nu below -0.34 (von
    Mises) or -0.13 (Tresca), where p_0/Y = sqrt(3)/(1-2 nu) or 1.5/(1-2 nu).
    """
    nu = poisson_ratio("nu", nu)
    low, high = 0.3 * (1 + nu), np.zeros(np.shape(nu)) + 1.5  # z goes to pi/6 (1 + nu) as nu goes to -1

    def slope(z: Array) -> Array:  # of axis_difference by z, in closed form
        return (1 + nu) * (np.arctan(1 / z) - z / (1 + z * z)) - 3 * z / (1 + z * z) ** 2

    z, _ = bisect(lambda z: slope(z) > 0, low, high)
    return 1 / axis_difference(z, nu), z


def first_yield_speed(law: Backbone, Y: Real, *, m_star: Real, ratio: Real = FIRST_YIELD_ROUNDED) -> Array:
    """Impact speed [m/s] from which a body of yield stress Y [Pa] yields (section 8.2.2): its peak pressure is ratio Y.

    `law` has the strength of the softer body of the pair, whose flow limits the pressure: a much harder body never
    yields (inf; neither does Y = inf). The law's pressure is Hertz's half-ellipse to uniform, by its flatness.
    m_star [kg] > 0; all broadcast. ValueError outside.
    """
    wanted = number("ratio", ratio) * number("Y", Y, infinite=True)
    far = 1e20 * law.R_star  # there the elastic start counts no more
    limit = law.pressure_max(far)
    p = np.minimum(wanted, limit)
    low = law.R_star * (np.pi * p / (2 * law.E_star)) ** 2  # Hertz's overlap at p; a law that yields needs more
    high = np.where(low <= law.yield_overlap, low, far)

    def below(log: Array) -> Any:
        return law.pressure_max(low * np.exp(log)) < p

    alpha = low * np.exp(bisect(below, 0.0, np.log(high / low))[1])
    return np.where(wanted <= limit, np.sqrt(2 * law.work(alpha) / number("m_star", m_star)), np.inf)


def yield_speed(*, p_y: Real, E_star: Real, R_star: Real, m_star: Real) -> Real:
    """Impact speed at which the peak pressure reaches p_y [m/s].

    Eq. 8.84 [Thornton 1997]: v_y = (pi/(2E*))^2 sqrt(8 pi R*^3 p_y^5/(15 m*))

    With p_y = 2.8 Y it is v_y, with 1.60 Y v_y0 = v_y/4.0513. p_y, E_star [Pa], R_star [m], m_star [kg] > 0.
    """
    p_y, E_star = number("p_y", p_y), number("E_star", E_star)
    R_star, m_star = number("R_star", R_star), number("m_star", m_star)
    return (np.pi / (2 * E_star)) ** 2 * np.sqrt(8 * np.pi * R_star**3 * p_y**5 / (15 * m_star))
