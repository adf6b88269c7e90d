# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts with adhesion against 30-digit quadrature and Runge-Kutta steps of the laws, written down anew here."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from epdem.theory import adhesion, restitution
from epdem.theory.backbones import Hertz, Thornton
from epdem.theory.jkr import JKR
from epdem.theory.thornton_ning import ThorntonNing

E, R, GAMMA = 215e9 / (2 * (1 - 0.3**2)), 1e-5, 0.2
M = 4 / 3 * np.pi * R**3 * 7850
V_S = 0.0162490834
# p_y, V of impacts on every kind of way: elastic, just and well yielded, yielded by the attraction alone
IMPACTS = [
    (None, 0.01626),
    (None, 0.02),
    (None, 0.5),
    (3.04e9, 0.3),
    (3.04e9, 1.0),
    (1e9, 0.05),
    (1e9, 10.0),
    (0.5e9, 0.05),
    (0.5e9, 3.0),
    (0.05e9, 10.0),
]
every_impact = pytest.mark.parametrize(("p_y", "V"), IMPACTS)


def law_of(p_y, Gamma=GAMMA):
    numbers = {"E_star": E, "R_star": R, "work_of_adhesion": Gamma}
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


@every_impact
def test_restitution_and_peaks_are_the_quadrature_of_the_law(p_y, V):
    """Work from touch to the peak that theory gives is m* V^2/2; what comes back to the fold is e_n^2 of it: 1e-11."""
    x = adhesion.impact(law_of(p_y), m_star=M, speed=V)
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
        assert float(x.residual_overlap) == pytest.approx(float(dent * R), rel=1e-9, abs=1e-25)
        assert float(x.parting_overlap) == pytest.approx(float((dent + fold**2 / R_p - exact.d(fold)) * R), rel=1e-9)
        assert float(x.pull_max) == pytest.approx(float(1.5 * mp.pi * exact.G * R_p * E * R**2), rel=1e-11)
        assert float(x.work_in) == pytest.approx(float(x.work_out + x.plastic_work + x.adhesive_work), rel=1e-13)


def test_work_far_beyond_yield_has_no_quadrature_error():
    """a = 1000 a_y with p_y far below the pressure of the attraction: every power of the core pressure counts."""
    law = law_of(0.05e9)
    top = 1000 * law.yield_radius
    with mp.workdps(30):
        exact = Exact(0.05e9)
        work = float(exact.work(exact.a_0, mp.mpf(float(top)) / mp.mpf(R)) * mp.mpf(E) * mp.mpf(R) ** 3)
    assert law.work(top) == pytest.approx(work, rel=1e-12)


@every_impact
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


@pytest.mark.parametrize(("p_y", "V"), [(None, 0.05), (3.04e9, 1.0), (1e9, 0.1), (0.5e9, 0.05)])
def test_motion_by_runge_kutta_steps_gives_the_same_impact(p_y, V):
    """Fourth order on alpha(t) with a found by bisection at every stage, 3000 steps; kinks leave a few 1e-6."""
    x = adhesion.impact(law_of(p_y), m_star=M, speed=V)
    d = lambda a: np.sqrt(2 * np.pi * GAMMA * a / E)  # noqa: E731
    P = lambda a: np.sqrt(8 * np.pi * E * GAMMA * a**3)  # noqa: E731

    def growing(a):
        A, B = 2 * E * a / (np.pi * R), np.sqrt(2 * GAMMA * E / (np.pi * a))
        if p_y is None or p_y >= A - B:
            return 4 * E * a**3 / (3 * R) - P(a)
        u = (p_y + np.sqrt(p_y**2 + 4 * A * B)) / (2 * A)
        return np.pi * p_y * a**2 * (1 - u * u) + 2 * np.pi * a**2 * (A * u**3 / 3 - B * u)

    def radius(al, radius, fold):
        low, high = fold, 3 * float(x.radius_max)
        for _ in range(55):
            a = 0.5 * (low + high)
            low, high = (a, high) if a * a / radius - d(a) < al else (low, a)
        return 0.5 * (low + high)

    top, R_p, dent = 0.0, R, 0.0

    def rate(al, v):
        a = radius(al, R, (np.pi * GAMMA * R**2 / (8 * E)) ** (1 / 3))
        if a >= top:
            return v, -growing(a) / M
        a = radius(al - dent, R_p, (np.pi * GAMMA * R_p**2 / (8 * E)) ** (1 / 3))
        return v, (P(a) - 4 * E * a**3 / (3 * R_p)) / M

    al, v, t, dt = 0.0, V, 0.0, float(x.contact_time) / 3000
    while True:
        step, before = dt, (al, v)
        if v > 0 and al + dt * v > 0.999 * x.overlap_max:
            step = dt / 16  # the slope of the force jumps at the peak
        k1 = rate(al, v)
        k2 = rate(al + step / 2 * k1[0], v + step / 2 * k1[1])
        k3 = rate(al + step / 2 * k2[0], v + step / 2 * k2[1])
        k4 = rate(al + step * k3[0], v + step * k3[1])
        al += step / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        v += step / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
        t += step
        a = radius(al, R, (np.pi * GAMMA * R**2 / (8 * E)) ** (1 / 3))
        if v > 0 and a > top:
            top = a
            R_p = 4 * E * top**3 / (3 * (growing(top) + P(top)))
            dent = top**2 * (1 / R - 1 / R_p)
        fold = (np.pi * GAMMA * R_p**2 / (8 * E)) ** (1 / 3)
        end = dent + fold**2 / R_p - d(fold)
        if v < 0 and al < end:
            share = (before[0] - end) / (before[0] - al)
            v, t = before[1] + share * (v - before[1]), t - (1 - share) * step
            break
    assert -v / V == pytest.approx(float(x.e_n), abs=2e-5)
    assert t == pytest.approx(float(x.contact_time), rel=2e-5)
    assert top == pytest.approx(float(x.radius_max), rel=1e-5)


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
    assert x.adhesive_work[-1] == pytest.approx(W_s, rel=1e-12)


@pytest.mark.parametrize("p_y", [3.04e9, 1e9, 0.5e9, 0.1e9])
def test_restitution_vanishes_at_the_sticking_speed_and_only_below_it(p_y):
    law = law_of(p_y)
    V_s = adhesion.sticking_speed(law, m_star=M)
    below, above = np.geomspace(1e-4, 1 - 1e-9, 40) * V_s, V_s * (1 + np.geomspace(1e-9, 1e4, 40))
    assert np.all(adhesion.e_n(law, m_star=M, speed=below) == 0)
    assert np.all(adhesion.e_n(law, m_star=M, speed=above) > 0)
    assert V_s >= adhesion.sticking_speed(law_of(None), m_star=M)


@pytest.mark.parametrize(("p_y", "V_y"), [(3.04e9, 0.63494633), (1e9, 0.02359088), (0.5e9, 0.0)])
def test_speed_of_first_yield(p_y, V_y):
    """Printed to 8 digits of quadrature; 0: a_0 < a_y, but the attraction alone carries the contact beyond a_y."""
    law = law_of(p_y)
    found = adhesion.yield_speed(law, m_star=M)
    assert found == pytest.approx(V_y, abs=6e-9)
    assert adhesion.yield_speed(law_of(None), m_star=M) == np.inf
    if V_y:
        assert adhesion.impact(law, m_star=M, speed=V_y * 0.9999).plastic_work == 0
        assert adhesion.impact(law, m_star=M, speed=V_y * 1.001).plastic_work > 0
    else:
        assert adhesion.impact(law, m_star=M, speed=1e-6).plastic_work > 0


@pytest.mark.parametrize("p_y", [None, 3.04e9, 1e9, 0.5e9])
def test_energy_is_only_lost_and_plastic_work_grows_with_speed(p_y):
    x = adhesion.impact(law_of(p_y), m_star=M, speed=np.geomspace(1e-3, 100, 200))
    assert np.all((x.e_n >= 0) & (x.e_n < 1))
    assert np.all(np.diff(x.plastic_work) >= -1e-16 * x.work_in[1:])
    free = x.e_n > 0
    assert np.all(x.adhesive_work[free] > 0)
    for name in ("force_max", "overlap_max", "radius_max", "pull_max"):
        assert np.all(np.diff(getattr(x, name)) >= 0), name


def test_without_adhesion_an_impact_is_that_of_hertz_and_thornton():
    speed = np.geomspace(1e-3, 100, 60)
    for p_y, old in ((None, Hertz(E_star=E, R_star=R)), (1e9, Thornton(E_star=E, R_star=R, p_y=1e9))):
        x, y = adhesion.impact(law_of(p_y, 0.0), m_star=M, speed=speed), restitution.impact(old, m_star=M, speed=speed)
        for name in vars(y):
            scale = np.maximum(np.abs(getattr(y, name)), 1e-7 * np.abs(getattr(y, name)).max())
            scale = y.work_in if name == "plastic_work" else y.overlap_max if name == "residual_overlap" else scale
            assert np.all(np.abs(getattr(x, name) - getattr(y, name)) <= 1e-11 * scale), name
        assert np.all(x.adhesive_work == 0)


@settings(max_examples=40)
@given(st.tuples(*[st.floats(-9, 9)] * 3), st.floats(-2, 2), st.floats(0.1, 5))
def test_a_change_of_units_changes_nothing(powers, log_p, log_V):
    """Mass, length and time in new units: e_n the same; works and times in the new units."""
    mass, length, time = (10.0**p for p in powers)
    pressure = mass / (length * time**2)
    p_y, V = 10.0**log_p * 1e9, 10.0**log_V * V_S
    here = adhesion.impact(law_of(p_y), m_star=M, speed=V)
    law = ThorntonNing(E_star=E * pressure, R_star=R * length, work_of_adhesion=GAMMA * pressure * length,
                       p_y=p_y * pressure)  # fmt: skip
    there = adhesion.impact(law, m_star=M * mass, speed=V * length / time)
    # where e_n is near 0 rounding of the energy is seen as its root
    assert float(there.e_n) ** 2 == pytest.approx(float(here.e_n) ** 2, abs=1e-12)
    for name, unit in {"force_max": pressure * length**2, "overlap_max": length, "radius_max": length,
                       "plastic_work": mass * length**2 / time**2}.items():  # fmt: skip
        scale = here.work_in if name == "plastic_work" else getattr(here, name)
        assert getattr(there, name) / unit == pytest.approx(float(getattr(here, name)), abs=1e-11 * float(scale)), name


def test_arrays_of_contacts_are_their_scalars():
    """Every argument may be an array; a million e_n of `jkr` come at once."""
    E_, R_, G_, p_ = np.array([1e6, 1e11]), np.array([1e-3, 1e-6]), np.array([0.05, 0.5]), np.array([1e4, 1e9])
    speed = np.geomspace(0.1, 10, 5)[:, None]
    law = ThorntonNing(E_star=E_, R_star=R_, work_of_adhesion=G_, p_y=p_)
    both = adhesion.impact(law, m_star=1e-6, speed=speed)
    for k in range(2):
        one = ThorntonNing(E_star=E_[k], R_star=R_[k], work_of_adhesion=G_[k], p_y=p_[k])
        for i, v in enumerate(speed[:, 0]):
            single = adhesion.impact(one, m_star=1e-6, speed=v)
            for name in vars(single):
                a, b = float(getattr(both, name)[i, k]), float(getattr(single, name))
                assert a == pytest.approx(b, rel=1e-12, abs=1e-14 * float(single.work_in)), name
    many = adhesion.e_n(law_of(None), m_star=M, speed=np.linspace(0.5, 2, 1_000_000) * V_S)
    assert many.shape == (1_000_000,)
    assert many[-1] == pytest.approx(np.sqrt(3) / 2, rel=1e-8)  # sqrt(1 - 1/2^2)
