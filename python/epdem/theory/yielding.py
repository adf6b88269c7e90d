# SPDX-License-Identifier: GPL-2.0-or-later
"""When and where a contact yields: criteria, first yield under a sphere, fully plastic range, which body."""

import numpy as np

from .backbones import Backbone
from .checks import number, poisson_ratio

FIRST_YIELD_ROUNDED = 1.60  # p_0/Y at first yield, nu = 0.3; eq. 8.78
FIRST_YIELD_MEAN_ROUNDED = 1.10  # p_m/Y at first yield; eq. 8.79
FULLY_PLASTIC = (2.8, 3.0)  # p_m/Y; see fully_plastic_mean


def principal(stress):
    """Principal stresses, shape (..., 3), ascending, of symmetric tensors of shape (..., 3, 3)."""
    stress = np.asarray(stress, float)
    if stress.shape[-2:] != (3, 3):
        raise ValueError(f"stress has shape {stress.shape}, must end in (3, 3)")
    return np.linalg.eigvalsh(stress)


def von_mises(s1, s2, s3):
    """Equivalent stress sqrt(3 J2) of principal stresses [Pa]: yield when it reaches Y. Any shapes that broadcast.

    Eq. 8.76 [Johnson 1985]: J2 = [(s1-s2)^2 + (s2-s3)^2 + (s3-s1)^2]/6 = k^2 = Y^2/3
    """
    s1, s2, s3 = (np.asarray(s, float) for s in (s1, s2, s3))
    return np.sqrt(((s1 - s2) ** 2 + (s2 - s3) ** 2 + (s3 - s1) ** 2) / 2)


def tresca(s1, s2, s3):
    """Largest difference of principal stresses [Pa]: yield when it reaches Y. Any shapes that broadcast.

    Eq. 8.77 [Johnson 1985]: max(|s1-s2|, |s2-s3|, |s3-s1|) = 2k = Y
    """
    s = np.stack(np.broadcast_arrays(*(np.asarray(x, float) for x in (s1, s2, s3))))
    return s.max(axis=0) - s.min(axis=0)


CRITERIA = {"von_mises": von_mises, "tresca": tresca}


def equivalent(stress, criterion: str):
    """Equivalent stress of tensors (..., 3, 3) by "von_mises" or "tresca". ValueError for another name."""
    if criterion not in CRITERIA:
        raise ValueError(f"criterion = {criterion!r}, must be one of {', '.join(CRITERIA)}")
    p = principal(stress)
    return CRITERIA[criterion](p[..., 0], p[..., 1], p[..., 2])


def axis_difference(z, nu):
    """s_z - s_r on the axis of a Hertz contact at depth z (in a), in units of -p_0: what both criteria see there."""
    z, nu = np.asarray(z, float), poisson_ratio("nu", nu)
    deep = np.maximum(z, 1e-300)
    s_r = -(1 + nu) * (1 - deep * np.arctan(1 / deep)) + 1 / (2 * (1 + z * z))
    return s_r + 1 / (1 + z * z)


def first_yield(nu):
    """(p_0/Y, depth z/a) of first yield on the axis under a sphere, exactly. nu in (-1, 0.5], of any shape.

    Eq. 8.78 [Johnson 1985]: p_0 = Y/max(s_r - s_z), 1.60 Y at nu = 0.3

    Both criteria coincide on the axis (section 6.1). The edge of the contact yields before it for nu below -0.34 (von
    Mises) or -0.13 (Tresca), where p_0/Y = sqrt(3)/(1-2 nu) or 1.5/(1-2 nu).
    """
    nu = poisson_ratio("nu", nu)
    low, high = 0.3 * (1 + nu), np.zeros(np.shape(nu)) + 1.5  # z goes to pi/6 (1 + nu) as nu goes to -1

    def slope(z):  # of axis_difference by z, in closed form
        return (1 + nu) * (np.arctan(1 / z) - z / (1 + z * z)) - 3 * z / (1 + z * z) ** 2

    for _ in range(60):
        middle = 0.5 * (low + high)
        rising = slope(middle) > 0
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    z = 0.5 * (low + high)
    return 1 / axis_difference(z, nu), z


def first_yield_mean(nu):
    """Mean pressure p_m/Y at first yield, exactly. nu in (-1, 0.5], any shape; ValueError outside.

    Eq. 8.79 [Johnson 1985]: p_m = 2/3 p_0, rounded to 1.10 Y
    """
    return 2 / 3 * first_yield(nu)[0]


def fully_plastic_mean(Y):
    """Mean pressure of fully plastic contact (low, high) [Pa]; Y [Pa] > 0, any shape; ValueError outside.

    Eq. 8.80 [Johnson 1985]: p_m = 2.8 Y to 3.0 Y
    """
    Y = number("Y", Y)
    return tuple(ratio * Y for ratio in FULLY_PLASTIC)


def first_yield_speed(law: Backbone, Y, *, m_star, ratio=FIRST_YIELD_ROUNDED):
    """Impact speed [m/s] from which a body of yield stress Y [Pa] yields (section 8.2.2): its peak pressure is ratio Y.

    `law` has the strength of the softer body of the pair, whose flow limits the pressure: a much harder body never
    yields (inf; neither does Y = inf). The law's pressure is Hertz's half-ellipse to uniform, by its flatness.
    m_star [kg] > 0; all broadcast. ValueError outside.
    """
    wanted = number("ratio", ratio) * number("Y", Y, infinite=True)
    far = 1e20 * law.R_star  # there the elastic start counts no more
    limit = law.force(far) / (np.pi * law.radius(far) ** 2)
    p = np.minimum(wanted, limit)
    low = law.R_star * (np.pi * p / (2 * law.E_star)) ** 2  # Hertz's overlap at p; a law that yields needs more
    high = np.where(low <= law.yield_overlap, low, np.maximum(low, law.marks()[-1]))
    for _ in range(60):
        middle = np.sqrt(low * high)
        below = (1.5 - 0.5 * law.flatness(middle)) * law.force(middle) < p * np.pi * law.radius(middle) ** 2
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(wanted <= limit, np.sqrt(2 * law.work(high) / number("m_star", m_star)), np.inf)
