# SPDX-License-Identifier: GPL-2.0-or-later
"""Restitution, peaks and times against 30-digit quadrature of the laws as the chapter states them."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from epdem.theory import pair, printed, restitution, yielding
from epdem.theory.backbones import LAWS, Cavity, Hertz, Meyer, Thornton
from epdem.theory.johnson import Johnson
from marks import thorough

STEEL = {"E_star": 1.1428571428571429e11, "R_star": 0.01}
M = 0.032882003107573169
SPEEDS = np.array([0.05, 0.2, 1, 5, 20, 50])
# v, thornton 2.8 Y, johnson 3 Y, cavity: e_n, alpha_max [m], F_max [N], a_max [m]; the chapter's reference sphere
TABLE = [
    (0.05, 1, 1, 1, 2.14561127e-6, 47.89136837, 1.464790521e-4),
    (0.2, 1, 1, 0.9835348647963, 6.503943179e-6, 252.4810503, 2.609058606e-4),
    (1, 0.9476311322744, 1, 0.8593720083638, 2.41605381e-5, 1638.282004, 5.562575829e-4),
    (5, 0.6763264338717, 1, 0.7167680993893, 9.382704576e-5, 10265.34867, 1.216738778e-3),
    (20, 0.4830544367755, 0.6723365058094, 0.6001427773615, 3.0923996e-4, 49091.68148, 2.421098399e-3),
    (50, 0.3849048136277, 0.5239170209996, 0.4837161666937, 7.016832267e-4, 123446.5607, 3.746153298e-3),
]


def steel(name):
    return {
        "hertz": lambda: Hertz(**STEEL),
        "thornton": lambda: Thornton(**STEEL, p_y=2.8e9),
        "johnson": lambda: Johnson(**STEEL, p_m=3e9),
        "cavity": lambda: Cavity(**STEEL, Y=1e9),
        "meyer": lambda: Meyer(**STEEL, p_y=2.8e9, x=0.3),
    }[name]()


class Exact:
    """A law with 30 digits, written from its definition; force, radius and flatness only: the rest is quadrature."""

    def __init__(self, name, E, R, strength, x=0.3):
        self.x = mp.mpf(x)
        self.name, self.E, self.R, self.Y = name, mp.mpf(E), mp.mpf(R), mp.mpf(strength)
        ratio = {"hertz": mp.mpf(10) ** 6, "thornton": 1, "johnson": 3, "cavity": mp.mpf(1.6), "meyer": 1}[name]
        self.a_y = mp.pi * self.R * ratio * self.Y / (2 * self.E)
        self.y = self.a_y**2 / self.R
        self.ln_s_P = 3 * (mp.mpf(2.8) - 2 * mp.mpf(1.6) / 3) - mp.log(2)
        self.marks = [self.y, self.y * mp.exp(self.ln_s_P)] if name == "cavity" else [self.y]

    def point(self, alpha):
        hertz = mp.mpf(4) / 3 * self.E * mp.sqrt(self.R) * alpha ** mp.mpf(1.5)
        if alpha <= self.y:
            return hertz, mp.sqrt(self.R * alpha), mp.mpf(0)
        if self.name == "thornton":
            F_y = mp.mpf(4) / 3 * self.E * mp.sqrt(self.R) * self.y ** mp.mpf(1.5)
            return F_y + mp.pi * self.Y * self.R * (alpha - self.y), mp.sqrt(self.R * alpha), mp.mpf(0)
        if self.name == "meyer":  # dF = 2 pi a p_y (a/a_y)^x da
            a, n = mp.sqrt(self.R * alpha), 2 + self.x
            flow = 2 * mp.pi * self.Y / n * (a**n - self.a_y**n) / self.a_y**self.x
            return self.point(self.y)[0] + flow, a, mp.mpf(0)
        if self.name == "johnson":
            return 2 * mp.pi * self.R * self.Y * alpha, mp.sqrt(2 * self.R * alpha), mp.mpf(0)
        s = mp.log(alpha / self.y)
        if s >= self.ln_s_P:
            return 2 * mp.pi * self.R * mp.mpf(2.8) * self.Y * alpha, mp.sqrt(2 * self.R * alpha), mp.mpf(1)
        beta = mp.log(2) / self.ln_s_P
        a = self.a_y * mp.exp((1 + beta) / 2 * s)
        return mp.pi * a**2 * self.Y * (2 * mp.mpf(1.6) / 3 + (1 + beta) / 3 * s), a, s / self.ln_s_P

    def unloading(self, alpha, top):
        F, a, tau = self.point(top)
        w = (top - alpha) * self.E * a / F
        A, B = mp.mpf(3) / 4 * (1 - tau), 2 / mp.pi * tau
        if w <= 0:
            return F
        y = 2 * w / (B + mp.sqrt(B * B + 4 * A * w))
        if y >= 1:
            return mp.mpf(0)
        return F * ((1 - tau) * (1 - y * y) ** mp.mpf(1.5) + B * (mp.acos(y) - y * mp.sqrt(1 - y * y)))

    def work(self, top):
        unit = self.point(top)[0]  # mpmath stops at an absolute error: the integral must be of order 1
        parts = [0, *[m / top for m in self.marks if m < top], 1]
        return unit * top * mp.quad(lambda x: self.point(top * x)[0] / unit, parts)

    def given_back(self, top):
        F, a, tau = self.point(top)
        recovery = (mp.mpf(3) / 4 * (1 - tau) + 2 / mp.pi * tau) * F / (self.E * a)
        share = mp.quad(lambda x: self.unloading(top - recovery * x, top) / F, mp.linspace(0, 1, 5))
        return F * recovery * share


@pytest.mark.parametrize(("column", "name"), [(1, "thornton"), (2, "johnson"), (3, "cavity")])
def test_reference_values_of_the_chapter(column, name):
    """13 printed digits."""
    e_n = restitution.e_n(steel(name), m_star=M, speed=SPEEDS)
    assert e_n == pytest.approx([row[column] for row in TABLE], abs=1e-13)


def test_reference_peaks_of_cavity():
    """8 to 10 printed digits."""
    x = restitution.impact(steel("cavity"), m_star=M, speed=SPEEDS)
    for k, values in ((4, x.overlap_max), (5, x.force_max), (6, x.radius_max)):
        assert values == pytest.approx([row[k] for row in TABLE], rel=5e-8, abs=0)


def test_thornton_law_and_equation_8_83_are_the_same_number():
    """Quadrature of the law in closed form against the printed equation, over twelve decades of speed."""
    v_y = yielding.yield_speed(p_y=2.8e9, m_star=M, **STEEL)
    speed = v_y * np.geomspace(1e-6, 1e6, 400)
    e_n = restitution.e_n(steel("thornton"), m_star=M, speed=speed)
    assert e_n == pytest.approx(printed.thornton_restitution(speed, v_y=v_y), rel=1e-13, abs=0)


@settings(max_examples=25)
@given(
    st.sampled_from(["thornton", "johnson", "cavity", "meyer"]),
    st.floats(0, 0.99),
    st.floats(3, 12),
    st.floats(-6, 1),
    st.floats(-5, -1.5),
    st.floats(-6, 6),
)
def test_restitution_is_the_quadrature_of_the_law(name, x, log_E, log_R, log_ratio, log_speed):
    """E 1 kPa to 1 TPa, R 1 um to 10 m, strength 1e-5 to 0.03 of E*, v/v_y 1e-6 to 1e6: 1e-12 relative."""
    E, R, strength = 10.0**log_E, 10.0**log_R, 10.0 ** (log_E + log_ratio)
    key = {"thornton": "p_y", "johnson": "p_m", "cavity": "Y", "meyer": "p_y"}[name]
    law = LAWS[name](E_star=E, R_star=R, **{key: strength}, **({"x": x} if name == "meyer" else {}))
    m = 4 / 3 * np.pi * R**3 * 2500
    v_y = np.sqrt(2 * law.work(law.yield_overlap) / m)
    found = restitution.impact(law, m_star=m, speed=v_y * 10.0**log_speed)
    with mp.workdps(30):
        exact, top = Exact(name, E, R, strength, x), mp.mpf(float(found.overlap_max))
        work, back = exact.work(top), exact.given_back(top)
        assert float(found.work_in) == pytest.approx(float(work), rel=1e-12, abs=0)
        if abs(float(top / exact.y) - 1) > 1e-9:
            e_n = float(mp.sqrt(back / work)) if top > exact.y else 1.0
            # the inverse W -> alpha and kappa F^2/(aE*): a few roundings of powers
            assert float(found.e_n) == pytest.approx(e_n, rel=1e-12, abs=0)


@pytest.mark.parametrize("name", ["hertz", "thornton", "johnson", "cavity", "meyer"])
@pytest.mark.parametrize("speed", [0.01, thorough(0.3), thorough(3.0), 30.0])
def test_contact_time_is_the_time_integral_of_the_motion(name, speed):
    """t = integral of d alpha/v on both ways, with alpha = alpha_max - u^2, which is regular at the turning point."""
    found = restitution.impact(steel(name), m_star=M, speed=speed)
    strength = {"hertz": 1e9, "thornton": 2.8e9, "johnson": 3e9, "cavity": 1e9, "meyer": 2.8e9}[name]
    with mp.workdps(18):
        exact, top = Exact(name, *STEEL.values(), strength), mp.mpf(float(found.overlap_max))

        def time(force, low, high):
            """From overlap low to high, both below top, at the speed that the work between alpha and top gives."""

            def rate(u):
                alpha = top - u * u
                marks = [alpha, *[m for m in exact.marks if alpha < m < top and force is not back], top]
                energy = mp.quad(force, marks, method="gauss-legendre", maxdegree=4)
                return 2 * u / mp.sqrt(2 * energy / M)

            return mp.quad(rate, [mp.sqrt(top - high) + tiny, mp.sqrt(top - low)], maxdegree=5)

        def back(alpha):
            return exact.unloading(alpha, top)

        def forth(alpha):
            return exact.point(alpha)[0]

        tiny = mp.mpf(10) ** -10 * mp.sqrt(top)
        F, a, tau = exact.point(top)
        dent = top - (mp.mpf(3) / 4 * (1 - tau) + 2 / mp.pi * tau) * F / (exact.E * a)
        marks = [mp.mpf(0), *[m for m in exact.marks if m < top], top]
        total = sum(time(forth, low, high) for low, high in zip(marks[:-1], marks[1:], strict=True))
        total += time(back, dent, top)
    # tiny leaves out 1e-10 of each way
    assert float(found.contact_time) == pytest.approx(float(total), rel=1e-9, abs=0)


@pytest.mark.parametrize(
    ("name", "kink"), [("thornton", 0), ("johnson", 0), ("cavity", 0), ("cavity", 1), ("meyer", 0)]
)
@pytest.mark.parametrize("beyond", [thorough(1e-6), 3e-4])
def test_loading_time_keeps_its_digits_where_the_law_has_just_changed_its_formula(name, kink, beyond):
    """The kink of the force lies next to the turning point. 1e-10: what is asked of contact times."""
    strength = {"thornton": 2.8e9, "johnson": 3e9, "cavity": 1e9, "meyer": 2.8e9}[name]
    law = steel(name)
    top = float(law.kinks()[kink]) * (1 + beyond)
    found = restitution.impact(law, m_star=M, speed=np.sqrt(2 * law.work(top) / M))
    back = restitution._unloading_time(law, M, np.asarray(found.overlap_max), np.asarray(found.work_out))
    with mp.workdps(22):
        exact, top = Exact(name, *STEEL.values(), strength), mp.mpf(float(found.overlap_max))
        kinks = [top - k for k in exact.marks if k < top]  # as widths below the top

        def rate(u):  # alpha = top - u^2; the work is summed from the top down, so that nothing cancels
            width = max(u * u, mp.mpf(10) ** -18 * top)
            parts = [0, *sorted(k for k in kinks if k < width), width]
            energy = mp.quad(lambda q: exact.point(max(top - q, mp.mpf(0)))[0], parts, maxdegree=4)
            return 2 * mp.sqrt(width * M / (2 * energy))

        total = mp.quad(rate, [0, *sorted(mp.sqrt(k) for k in kinks), mp.sqrt(top)], maxdegree=5)
    assert float(found.contact_time - back) == pytest.approx(float(total), rel=1e-10, abs=0)


def test_elastic_contact_time_is_hertz_classical_constant():
    """t_c = 2.9432751843 alpha_max/v = 2.868265 (m*^2/(R* E*^2 v))^(1/5)."""
    speed = np.geomspace(1e-6, 1e3, 50)
    x = restitution.impact(steel("hertz"), m_star=M, speed=speed)
    assert x.contact_time == pytest.approx(2.9432751843 * x.overlap_max / speed, rel=1e-10, abs=0)


def test_thornton_unloading_time_has_a_closed_constant():
    """1.4716375922 = (2/5) B(2/5, 1/2): the unloading branch is a Hertz contact of another radius."""
    with mp.workdps(30):
        exact = mp.mpf(2) / 5 * mp.beta(mp.mpf(2) / 5, mp.mpf(1) / 2)
    assert float(exact) == pytest.approx(restitution.UNLOADING_TIME, rel=1e-15, abs=0)


def test_cavity_predicts_the_constant_of_the_finite_element_fit():
    """2.069 (v/v_y0)^(-1/4) far above yield, where the fit 8.88 prints 2.08; and its table on the way there."""
    v_y0 = yielding.yield_speed(p_y=1.6e9, m_star=M, **STEEL)
    ratio = np.array([100, 145, 216, 300, 1000, 3000])
    e_n = restitution.e_n(steel("cavity"), m_star=M, speed=ratio * v_y0)
    assert e_n == pytest.approx([0.630, 0.600, 0.569, 0.511, 0.369, 0.280], abs=6e-4)
    far = restitution.e_n(steel("cavity"), m_star=M, speed=1e7 * v_y0) * 1e7**0.25
    assert far == pytest.approx(2.069, abs=1e-3)


def test_parameters_broadcast_with_speeds():
    law = Thornton(E_star=STEEL["E_star"], R_star=0.01, p_y=np.array([[1e9], [2e9]]))
    x = restitution.impact(law, m_star=M, speed=SPEEDS)
    assert x.e_n.shape == x.contact_time.shape == (2, 6)
    single = restitution.impact(Thornton(**STEEL, p_y=2e9), m_star=M, speed=SPEEDS)
    assert x.contact_time[1] == pytest.approx(single.contact_time, rel=1e-14, abs=0)


def test_fully_plastic_force_is_a_uniform_pressure_on_the_circle_that_the_overlap_cuts_out():
    """8.85 by geometry: a plane cuts a circle of a^2 = 2 R* alpha out of the sphere (alpha << R*), p_m acts on it."""
    law, R_star, p_m = Johnson(**STEEL, p_m=3e9), STEEL["R_star"], 3e9
    alpha = law.yield_overlap * np.array([1.5, 10.0, 1e3])
    circle = np.pi * (2 * R_star * alpha)
    assert law.force(alpha) == pytest.approx(p_m * circle, rel=1e-13, abs=0)  # round-off of three products
    assert np.pi * law.radius(alpha) ** 2 == pytest.approx(circle, rel=1e-13, abs=0)


def test_two_spheres_are_a_sphere_on_a_plane_with_the_effective_quantities():
    assert pair.R_star(0.01, np.inf) == 0.01 and pair.R_star(0.02, 0.02) == 0.01
    assert pair.m_star(1.0, np.inf) == 1.0 and pair.E_star(2e11, 0.3, np.inf, 0.3) == pytest.approx(2e11 / 0.91)
