# SPDX-License-Identifier: GPL-2.0-or-later
"""Impact speeds of first yield under a sphere."""

from typing import Any

import numpy as np

from .curve import Curve
from .numerics import Array, Real, bisect, number

FIRST_YIELD_ROUNDED = 1.60  # p_0/Y at first yield, nu = 0.3; eq. 8.78


def first_yield_speed(law: Curve, Y: Real, *, m_star: Real, ratio: Real = FIRST_YIELD_ROUNDED) -> Array:
    """Impact speed [m/s] from which a body of yield stress Y [Pa] yields (section 8.2.2): its peak pressure is ratio Y.

    `law` has the strength of the softer body of the pair, whose flow limits the pressure: a much harder body never
    yields (inf; neither does Y = inf). The law's pressure is Hertz's half-ellipse to uniform, by its flatness.
    m_star [kg] > 0; all broadcast. ValueError outside.
    """
    wanted = number("ratio", ratio) * number("Y", Y, infinite=True)
    far = 1e20 * law.R_star  # there the elastic start counts no more
    if np.all(np.isfinite(law.yield_overlap)):  # with finite strain the pressure falls beyond its largest value
        steps = np.geomspace(1.0 + 1e-9, 1e6, 601).reshape(-1, *[1] * np.ndim(law.yield_overlap))
        largest = np.argmax(law.pressure_max(law.yield_overlap * steps), axis=0)
        far = law.yield_overlap * steps.ravel()[largest]
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
