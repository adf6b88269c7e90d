# SPDX-License-Identifier: GPL-2.0-or-later
"""A normal impact with adhesion: restitution, sticking, times, peaks, and where the energy goes.

The approach obeys m* alpha'' = -F from touch (alpha = 0, speed V) to the fold of the branch on which the contact
opens. Works are sums without truncation error; times are quadratures to 1e-10. Energies lost in the two jumps, when the
contact forms and when it ends, are called adhesive; what is lost between them is called plastic.
"""

import numpy as np

from .adhesive_curve import AdhesiveCurve, Numbers, Path
from .numerics import bisect, gauss, number
from .restitution import Impact

# Energy at the fold and at touch in E* (c R*)^(10/3)/R*^2: 4^(-4/3)/5 and -3/10. Their difference is W_s.
_LOSS = 0.3 + 4 ** (-4 / 3) / 5
STICKING_WORK = (2 * np.pi) ** (5 / 3) * _LOSS  # 7.0922: W_s in (Gamma^5 R*^4/E*^2)^(1/3)
# (a/a_0)^1.5 > 1 at which an opening contact has the energy of its fold, so that it just comes loose
_REACH = 2.0547413698273668
TABOR_MIN = 3.0


def sticking_work(law: AdhesiveCurve) -> Numbers:
    """Work that an elastic contact loses by adhesion [J]: W_s = 7.0922 (Gamma^5 R*^4/E*^2)^(1/3).

    The difference of the energies at the fold and at touch; Thornton and Ning 1998 print 7.09 of it.
    """
    return STICKING_WORK * np.cbrt(law.Gamma**5 * law.R_star**4 / law.E_star**2)


def yield_speed(law: AdhesiveCurve, *, m_star: Numbers) -> Numbers:
    """Impact speed of first yield [m/s]; 0 if a contact yields by its own attraction, inf for JKR. m_star [kg] > 0."""
    m = number("m_star", m_star)
    a_y = np.asarray(law.yield_radius, float)
    if not np.any(np.isfinite(a_y)):
        return a_y + 0.0 * m
    return np.where(a_y <= law.touch_radius, 0.0, np.sqrt(2 * np.maximum(law.work(a_y), 0.0) / m))


def sticking_speed(law: AdhesiveCurve, *, m_star: Numbers) -> Numbers:
    """Impact speed V_s up to which the bodies stick [m/s]. m_star [kg] > 0.

    Elastic: sqrt(2 W_s/m*). With yield: that at which the opening branch gives back just nothing; what it gives back
    grows with a_m, so that there is one such speed. Bisection to round-off.
    """
    m = number("m_star", m_star)
    reach = np.cbrt(_REACH * law.c * law.R_star) ** 2  # the elastic contact radius at V_s
    if not np.any(np.isfinite(law.yield_radius)):
        return np.sqrt(2 * sticking_work(law) / m)

    def detaches(a: Numbers) -> Numbers:
        return _recovered(law, a) > 0

    low, high = np.maximum(reach, law.touch_radius), 2 * reach
    for _ in range(2000):
        if np.all(detaches(high) | (reach == 0)):
            break
        high = np.where(detaches(high), high, 2 * high)
    _, high = bisect(lambda a: np.logical_not(detaches(a)), low, high, steps=120)
    flows = np.sqrt(2 * np.maximum(law.work(high), 0.0) / m)
    return np.where(reach <= law.yield_radius, np.sqrt(2 * sticking_work(law) / m), flows)


def _recovered(law: AdhesiveCurve, a_max: Numbers) -> Numbers:
    """Work that the opening branch gives back from a_max to its fold [J]; negative if it cannot come loose."""
    branch, _ = law.branch(a_max)
    return branch.energy(a_max) - branch.energy(branch.fold_radius)


def e_n(law: AdhesiveCurve, *, m_star: Numbers, speed: Numbers) -> Numbers:
    """Coefficient of restitution of an impact at `speed` [m/s] > 0 with m_star [kg] > 0; 0 if the bodies stick.

    Elastic: sqrt(1 - (V_s/V)^2) (Thornton and Ning 1998). With yield e_n^2 is the work of the opening branch over
    m* V^2/2.
    """
    m, v = number("m_star", m_star), number("speed", speed)
    if not np.any(np.isfinite(law.yield_radius)):
        ratio = np.minimum(sticking_speed(law, m_star=m) / v, 1.0)
        return np.sqrt((1 - ratio) * (1 + ratio))
    W = 0.5 * m * v * v
    a = law.radius_of_work(W)
    elastic = np.maximum(1 - sticking_work(law) / W, 0.0)
    flows = np.clip(_recovered(law, a) / W, 0.0, 1.0)
    return np.sqrt(np.where(a <= law.yield_radius, elastic, flows))


def plastic_work(law: AdhesiveCurve, top: Numbers) -> Numbers:
    """Work lost by yield [J] of a contact that reached the contact radius `top` [m]."""
    (branch, _), (start, _), first = law.branch(top), law.branch(law.touch_radius), law.touch_radius
    yields = top > np.maximum(law.yield_radius, first)
    return np.where(yields, np.maximum(law.work(top) + start.energy(first) - branch.energy(top), 0.0), 0.0)


def lost_work(law: AdhesiveCurve, alpha_max: Numbers) -> Numbers:
    """Work [J] that a contact loses which reaches the overlap alpha_max [m] > 0 and parts: by adhesion and by yield."""
    top = law.radius(alpha_max)
    return law.work(top) - _recovered(law, top)


def _nodes() -> tuple[Numbers, Numbers, Numbers]:
    """Doubly exponential quadrature on [0, 1]: t, 1 - t and weights, t and 1 - t both with full relative accuracy."""
    s = np.arange(-60, 61) / 16
    half = 0.5 * np.pi * np.sinh(s)
    t, rest = 1 / (1 + np.exp(-2 * half)), 1 / (1 + np.exp(2 * half))
    return t, rest, np.pi * np.cosh(s) * t * rest / 16


def _time(m: Numbers, path: Path, above: Numbers, nodes: int) -> Numbers:
    """Time [s] on a path (d alpha/dt, F d alpha/dt) over t in [0, 1]; `above` [J] is the kinetic energy at t = 1.

    At t it is that and the work between t and 1, by Gauss's rule of so many nodes.
    """
    slope, power = path
    points = list(zip(*gauss(nodes), strict=True))
    t, rest, w = (np.reshape(x, (-1, *(1,) * np.ndim(above))) for x in _nodes())
    left = above + rest * sum(wk * power(t + rest * tk) for tk, wk in points)
    return np.sum(w * np.abs(slope(t)) * np.sqrt(0.5 * m / np.maximum(left, np.finfo(float).tiny)), axis=0)


def _loading_time(law: AdhesiveCurve, m: Numbers, top: Numbers) -> Numbers:
    """Time from touch to the largest contact radius `top` [s]."""
    W, time = law.work(top), np.zeros(np.shape(top))
    for path, end in law.loading_paths(top):
        time = time + _time(m, path, np.where(end == top, 0.0, W - law.work(end)), law.path_nodes)
    return time


def contact_time(law: AdhesiveCurve, *, m_star: Numbers, speed: Numbers) -> Numbers:
    """Time from touch to parting [s]; inf if the bodies stick. Arguments as of `impact`; to 1e-10."""
    m, v = number("m_star", m_star), number("speed", speed)
    top = law.radius_of_work(0.5 * m * v * v)
    branch, _ = law.branch(top)
    back = _time(m, branch.elastic_path(branch.fold_radius, top), np.zeros(np.shape(top)), branch.path_nodes)
    return np.where(e_n(law, m_star=m, speed=v) > 0, _loading_time(law, m, top) + back, np.inf)


def observation_time(law: AdhesiveCurve, *, m_star: Numbers, speed: Numbers) -> float:
    """Time [s] for which impacts at `speed` [m/s] that stick are observed, beyond their largest overlap; NaN: none."""
    m, v = number("m_star", m_star), number("speed", speed)
    stick = sticking_speed(law, m_star=m)
    if not stick > 0:
        return float("nan")
    loading = _loading_time(law, m, law.radius_of_work(0.5 * m * v * v))[v <= stick]
    return 1.5 * float(np.max([contact_time(law, m_star=m, speed=1.001 * stick), *loading]))


def impact(law: AdhesiveCurve, *, m_star: Numbers, speed: Numbers) -> Impact:
    """The impact at `speed` [m/s] > 0 with effective mass m_star [kg] > 0; they broadcast. It ends at the fold."""
    like = law.E_star * law.R_star * law.Gamma * law.yield_radius
    m, v, _ = np.broadcast_arrays(number("m_star", m_star), number("speed", speed), like)
    W = 0.5 * m * v * v
    top, e = law.radius_of_work(W), e_n(law, m_star=m, speed=v)
    branch, dent = law.branch(top)
    columns = {
        "e_n": e,
        "contact_time": contact_time(law, m_star=m, speed=v),
        "force_max": law.force(top),
        "overlap_max": law.overlap(top),
        "radius_max": top,
        "residual_overlap": dent + branch.fold_overlap,
        "work_in": W,
        "work_out": e * e * W,
        "plastic_work": plastic_work(law, top),
    }
    return Impact(**{name: np.broadcast_to(column, v.shape) for name, column in columns.items()})


def tabor_number(law: AdhesiveCurve, *, z_0: Numbers = 0.2e-9) -> Numbers:
    """Tabor's number (R* Gamma^2/(E*^2 z_0^3))^(1/3) (Tabor 1977).

    z_0 [m] > 0 is the range of the attraction, about an atom's distance. ValueError outside.
    """
    return np.cbrt(law.R_star * (law.Gamma / law.E_star) ** 2) / number("z_0", z_0)


def warning(law: AdhesiveCurve) -> str | None:
    """One sentence if an adhesive contact lies outside the domain of JKR (Tabor's number below 3), else None."""
    numbers = np.asarray(tabor_number(law) + 0.0 * law.Gamma)
    low = numbers[(numbers > 0) & (numbers < TABOR_MIN)]
    if not low.size:
        return None
    return (
        f"Tabor's number is {low.min():.2g} (< {TABOR_MIN:g}): the attraction reaches far beyond the contact; the "
        "pull-off force of DMT, 2 pi Gamma R*, is nearer there than that of JKR, 3/2 pi Gamma R*"
    )
