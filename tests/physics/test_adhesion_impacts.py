# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts with adhesion against 30-digit quadrature and Runge-Kutta steps of the laws, written down anew here."""

import mpmath as mp
import numpy as np
import pytest

from epdem.theory import adhesion
from epdem.theory.jkr import JKR
from epdem.theory.thornton_ning import ThorntonNing

E, R, GAMMA = 215e9 / (2 * (1 - 0.3**2)), 1e-5, 0.2
M = 4 / 3 * np.pi * R**3 * 7850
V_S = 0.0162490834
# p_y, V of impacts on every kind of way: elastic, just and well yielded, yielded by the attraction alone
IMPACTS = [(None, 0.01626), (None, 0.02), (None, 0.5), (3.04e9, 0.3), (3.04e9, 1.0)]
IMPACTS += [(1e9, 0.05), (1e9, 10.0), (0.5e9, 0.05), (0.5e9, 3.0), (0.05e9, 10.0)]
every_impact = pytest.mark.parametrize(("p_y", "V"), IMPACTS)


def law_of(p_y, Gamma=GAMMA):
    numbers = {"E_star": E, "R_star": R, "Gamma": Gamma}
    return JKR(**numbers) if p_y is None else ThorntonNing(**numbers, p_y=p_y)


class Exact:
    """The laws by contact radius a, from the pressure that is cut at p_y; mpmath, lengths in R*, stresses in E*."""

    def __init__(self, p_y, Gamma=GAMMA):
        self.G, self.p = mp.mpf(Gamma) / mp.mpf(E) / mp.mpf(R), mp.inf if p_y is None else mp.mpf(p_y) / mp.mpf(E)
        self.a_0 = mp.cbrt(2 * mp.pi * self.G)
        self.a_y = (
            mp.inf if p_y is None else self._bisect(lambda a: self.peak(a) - self.p, self.a_0 / 100, 1000 * self.p)
        )

    @staticmethod
    def _bisect(f, low, high):
        for _ in range(110):
            middle = (low + high) / 2
            low, high = (middle, high) if f(middle) < 0 else (low, middle)
        return (low + high) / 2

    def peak(self, a):
        return 2 * a / mp.pi - mp.sqrt(2 * self.G / (mp.pi * a))

    def P(self, a):
        return mp.sqrt(8 * mp.pi * self.G * a**3)

    def d(self, a):
        return mp.sqrt(2 * mp.pi * self.G * a)

    def F(self, a):
        if a <= self.a_y:
            return 4 * a**3 / 3 - self.P(a)
        A, B, p = 2 * a / mp.pi, mp.sqrt(2 * self.G / (mp.pi * a)), self.p
        u = (p + mp.sqrt(p * p + 4 * A * B)) / (2 * A)
        return mp.pi * p * a**2 * (1 - u * u) + 2 * mp.pi * a**2 * (A * u**3 / 3 - B * u)

    def slope(self, a, radius=1):
        return 2 * a / radius - self.d(a) / (2 * a)

    def work(self, low, high):
        marks = [low, *[m for m in (self.a_y,) if low < m < high], high]
        size = self.F(high) * high**2
        return size * mp.quad(lambda a: self.F(a) * self.slope(a) / size, marks)

    def opened(self, top):
        """R_p, force and radius of the fold of the branch from `top`."""
        R_p = mp.mpf(1) if top <= self.a_y else 4 * top**3 / (3 * (self.F(top) + self.P(top)))
        return R_p, lambda a: 4 * a**3 / (3 * R_p) - self.P(a), mp.cbrt(mp.pi * self.G * R_p**2 / 8)

    def back(self, low, top):
        R_p, F, _ = self.opened(top)
        size = F(top) * top**2
        return size * mp.quad(lambda a: F(a) * self.slope(a, R_p) / size, [low, top])


def adhesive_work(law, x):
    """Lost in the jumps at touch and parting [J]."""
    first, (branch, _) = law.touch_radius, law.branch(x.radius_max)
    return branch.energy(branch.fold_radius) - law.branch(first)[0].energy(first)


@every_impact
def test_restitution_and_peaks_are_the_quadrature_of_the_law(p_y, V):
    """Work from touch to the peak that theory gives is m* V^2/2; what comes back to the fold is e_n^2 of it: 1e-11."""
    law = law_of(p_y)
    x = adhesion.impact(law, m_star=M, speed=V)
    with mp.workdps(30):
        exact, unit = Exact(p_y), mp.mpf(E) * mp.mpf(R) ** 3
        top = mp.mpf(float(x.radius_max)) / mp.mpf(R)
        assert float(exact.work(exact.a_0, top) * unit) == pytest.approx(0.5 * M * V * V, rel=1e-11)
        R_p, F, fold = exact.opened(top)
        back = exact.back(fold, top)
        assert float(x.e_n) == pytest.approx(float(mp.sqrt(back * unit / (mp.mpf(M) * V * V / 2))), rel=1e-11)
        assert float(x.force_max) == pytest.approx(float(exact.F(top) * E * R**2), rel=1e-12)
        assert float(x.overlap_max) == pytest.approx(float((top**2 - exact.d(top)) * R), rel=1e-12)
        dent = top**2 * (1 - 1 / R_p)
        branch, shift = law.branch(x.radius_max)
        assert float(shift) == pytest.approx(float(dent * R), rel=1e-9, abs=1e-25)
        assert float(x.residual_overlap) == pytest.approx(float((dent + fold**2 / R_p - exact.d(fold)) * R), rel=1e-9)
        assert float(branch.pull_off_force) == pytest.approx(float(1.5 * mp.pi * exact.G * R_p * E * R**2), rel=1e-11)
        lost = float(x.plastic_work + adhesive_work(law, x))
        assert float(x.work_in) == pytest.approx(float(x.work_out) + lost, rel=1e-13)


def test_work_far_beyond_yield_has_no_quadrature_error():
    """a = 1000 a_y with p_y far below the pressure of the attraction: every power of the core pressure counts."""
    law = law_of(0.05e9)
    top = 1000 * law.yield_radius
    with mp.workdps(30):
        exact = Exact(0.05e9)
        work = float(exact.work(exact.a_0, mp.mpf(float(top)) / mp.mpf(R)) * mp.mpf(E) * mp.mpf(R) ** 3)
    assert law.work(top) == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize(("p_y", "V"), [IMPACTS[k] for k in (0, 2, 4, 5, 8, 9)])
def test_contact_time_is_the_quadrature_of_the_motion(p_y, V):
    """dt = d alpha/v on both ways, by mpmath's own rule, in a: 1e-10."""
    x = adhesion.impact(law_of(p_y), m_star=M, speed=V)
    with mp.workdps(20):
        exact = Exact(p_y)
        top = mp.mpf(float(x.radius_max)) / mp.mpf(R)
        R_p, F, fold = exact.opened(top)
        x_w, w_w = (list(map(mp.mpf, values)) for values in np.polynomial.legendre.leggauss(12))

        def work(F, radius, low, width):  # Gauss in sqrt(a), where the integrand is smooth; no difference near the peak
            y, h = mp.sqrt(low), width / (mp.sqrt(low + width) + mp.sqrt(low))
            nodes = [y + h * (1 + t) / 2 for t in x_w]
            return sum(
                wk * h / 2 * F(s * s) * exact.slope(s * s, radius) * 2 * s for s, wk in zip(nodes, w_w, strict=True)
            )

        def way(F, radius, low, high, above):
            def rate(s):  # a = high - (high - low) s^2
                width = (high - low) * s * s
                return (
                    exact.slope(high - width, radius) / mp.sqrt(2 * (above + work(F, radius, high - width, width))) * s
                )

            return 2 * (high - low) * mp.quad(rate, [0, 0.1, 0.5, 0.9, 0.99, 1])

        edge = min(max(exact.a_y, exact.a_0), top)
        time = way(F, R_p, fold, top, 0) + way(exact.F, 1, exact.a_0, edge, exact.work(edge, top) if edge < top else 0)
        time += way(exact.F, 1, edge, top, 0) if edge < top else 0
        unit = mp.sqrt(mp.mpf(M) / (mp.mpf(E) * mp.mpf(R)))
        assert float(x.contact_time) == pytest.approx(float(time * unit), rel=1e-10)


def test_elastic_bodies_stick_up_to_the_printed_speed():
    """W_s = 7.0922 (Gamma^5 R*^4/E*^2)^(1/3), printed as 7.09 (Thornton and Ning 1998): what F takes from touch to the
    fold, here by quadrature."""
    law = law_of(None)
    with mp.workdps(25):
        exact = Exact(None)
        fold = mp.cbrt(mp.pi * exact.G / 8)
        unit = exact.P(fold) * fold**2
        taken = unit * mp.quad(lambda a: exact.F(a) * exact.slope(a) / unit, [exact.a_0, fold])
        W_s = float(taken * mp.mpf(E) * mp.mpf(R) ** 3)
    assert W_s == pytest.approx(7.0921959718639584 * (GAMMA**5 * R**4 / E**2) ** (1 / 3), rel=1e-12)
    assert adhesion.sticking_work(law) == pytest.approx(W_s, rel=1e-12)
    V_s = float(adhesion.sticking_speed(law, m_star=M))
    assert V_s == pytest.approx(V_S, rel=1e-8)
    speed = V_s * np.array([1e-3, 0.5, 1 - 1e-9, 1 + 1e-9, 2.0])
    assert np.array_equal(adhesion.e_n(law, m_star=M, speed=speed) > 0, [False, False, False, True, True])
    x = adhesion.impact(law, m_star=M, speed=speed)
    assert np.array_equal(np.isinf(x.contact_time), x.e_n == 0)
    assert adhesive_work(law, x) == pytest.approx(W_s, rel=1e-12)
    assert (x.work_in - x.work_out)[-1] == pytest.approx(W_s, rel=1e-12)
