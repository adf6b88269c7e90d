# SPDX-License-Identifier: GPL-2.0-or-later
"""Adhesion of flattened contacts against quadratures of the superposition, written down anew here."""

import mpmath as mp
import numpy as np
import pytest

from epdem.theory import adhesion, restitution
from epdem.theory.adhesive_curve import AdhesiveCurve
from epdem.theory.cavity import Cavity
from epdem.theory.cavity_adhesive import CavityAdhesive, Flattened
from epdem.theory.thornton_ning import ThorntonNing

E, R, Y = 215e9 / (2 * (1 - 0.3**2)), 1e-5, 1e9 / 2.8
M = 4 / 3 * np.pi * R**3 * 7850
LIMIT = 0.2155120  # J/m^2 for these bodies, by 4000 points of the condition on each phase
A0, F0 = 1e-6, 3e-3
P0 = F0 / (np.pi * A0**2)


def contact(tau, chi):
    """An opening contact of Gamma E*/(p0^2 a0) = chi."""
    return Flattened(E_star=E, Gamma=chi * P0**2 * A0 / E, force=F0, radius=A0, flatness=tau)


def curve(tau, chi):
    """F/F0 and d(alpha)/dt in F0/(E* a0) of a = a0 sin t: eq. 8.82 less the punch."""
    k, tau = mp.sqrt(2 * mp.mpf(chi) / mp.pi), mp.mpf(tau)

    def F(t):
        s = mp.sin(t)
        return (1 - tau) * s**3 + 2 * tau / mp.pi * (t - s * mp.cos(t)) - 2 * k * s * mp.sqrt(s)

    def slope(t):
        s, y = mp.sin(t), mp.cos(t)
        return 3 * (1 - tau) / 2 * s * y + 2 * tau / mp.pi * s - k * y / (2 * mp.sqrt(s))

    return F, slope


@pytest.mark.parametrize("tau", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("chi", [0.01, 0.1])
def test_the_closed_energy_is_the_quadrature_of_the_force(tau, chi):
    c, (F, slope) = contact(tau, chi), curve(tau, chi)
    scale = F0**2 / (E * A0)
    with mp.workdps(25):
        for s in (0.2, 0.7, 0.99):
            ends = [mp.mpf(0), mp.mpf("0.01"), mp.asin(mp.mpf(s))]
            work, overlap = mp.quad(lambda t: F(t) * slope(t), ends), mp.quad(slope, ends)
            assert float(c.energy(s * A0)) == pytest.approx(float(work) * scale, abs=1e-14 * scale)
            assert float(c.force(s * A0)) == pytest.approx(float(F(ends[-1])) * F0, abs=1e-14 * F0)
            assert float(c.overlap(s * A0)) == pytest.approx(float(overlap) * F0 / (E * A0), abs=1e-14 * F0 / (E * A0))
    overlaps = c.overlap(np.linspace(0.001, 1, 20001) * A0)
    assert float(c.fold_overlap) <= overlaps.min() + 1e-15 * F0 / (E * A0)
    assert float(c.fold_overlap) == pytest.approx(overlaps.min(), rel=1e-5)


@pytest.mark.parametrize("chi", [1e-4, 0.1])
def test_a_contact_without_flatness_opens_as_thornton_and_ning_say(chi):
    """JKR's contact of R_p = 4 E* a0^3/(3 F0), by its closed forms."""
    c = contact(0.0, chi)
    jkr = AdhesiveCurve(E_star=E, R_star=4 * E * A0**3 / (3 * F0), Gamma=c.Gamma)
    a = np.geomspace(float(jkr.fold_radius), A0, 50)
    for quantity in ("force", "overlap", "energy"):
        most = np.abs(getattr(jkr, quantity)(a)).max()
        assert getattr(c, quantity)(a) == pytest.approx(getattr(jkr, quantity)(a), abs=1e-13 * most)
    for quantity in ("fold_radius", "fold_overlap", "touch_radius", "pull_off_force"):
        assert float(getattr(c, quantity)) == pytest.approx(float(getattr(jkr, quantity)), rel=1e-12)
    ning = ThorntonNing(E_star=E, R_star=R, Gamma=0.05, p_y=1e9)
    top = 5 * ning.yield_radius
    branch, _ = ning.branch(top)
    F = float(ning.force(top) + ning.adhesive_load(top))
    same = Flattened(E_star=E, Gamma=0.05, force=F, radius=float(top), flatness=0.0)
    assert same.force(0.4 * top) == pytest.approx(float(branch.force(0.4 * top)), rel=1e-12)


@pytest.mark.parametrize(
    ("tau", "chi", "share"), [(1.0, 1e-4, 0.9985), (1.0, 1e-2, 0.969), (1.0, 0.3, 0.764), (0.5, 0.1, 0.976)]
)
def test_pull_off_force_in_shares_of_the_small_contact(tau, chi, share):
    """The least force of a table of 400,000 radii; the shares are printed to their digits."""
    c = contact(tau, chi)
    s = np.linspace(1e-4, 1, 400_001)
    k = np.sqrt(2 * chi / np.pi)
    F = (1 - tau) * s**3 + 2 * tau / np.pi * (np.arcsin(s) - s * np.sqrt(1 - s * s)) - 2 * k * s**1.5
    assert float(c.pull_off_force) == pytest.approx(-F0 * F.min(), rel=1e-8)
    assert float(c.pull_off_force) / (1.5 * np.pi * c.Gamma * float(c.R_star)) == pytest.approx(share, abs=5e-4)


def test_a_fully_plastic_contact_pulls_2_356_times_as_much():
    """3 pi/4 = 2.3562 of the contact without flatness of the same peak, as chi goes to 0."""
    ratio = contact(1.0, 1e-9).pull_off_force / contact(0.0, 1e-9).pull_off_force
    assert float(ratio) == pytest.approx(3 * np.pi / 4, rel=1e-4)


def law_of(Gamma):
    return CavityAdhesive(E_star=E, R_star=R, Gamma=Gamma, Y=Y)


def growing(Gamma, marks):
    """Work from marks[0] to marks[-1] [J] while a contact grows: mpmath, by contact radius, of the pressures of the
    phases."""
    Gamma, e, r, y = (mp.mpf(x) for x in (Gamma, E, R, Y))
    c_Y, c_P = mp.mpf("1.6"), mp.mpf("2.8")
    a_Y = mp.pi * r * c_Y * y / (2 * e)
    log = 3 * (c_P - 2 * c_Y / 3) - mp.log(2)
    q = (1 + mp.log(2) / log) / 2
    a_P = a_Y * mp.exp(q * log)

    def power(a):
        d, P = mp.sqrt(2 * mp.pi * Gamma * a / e), mp.sqrt(8 * mp.pi * e * Gamma * a**3)
        if a <= a_Y:
            F, rate = 4 * e * a**3 / (3 * r), 2 * a / r
        elif a < a_P:
            ln_s = mp.log(a / a_Y) / q
            F, rate = mp.pi * a * a * y * (2 * c_Y / 3 + 2 * q / 3 * ln_s), a_Y**2 / r * mp.exp(ln_s) / (q * a)
        else:
            F, rate = mp.pi * a * a * c_P * y, a / r
        return (F - P) * (rate - d / (2 * a))

    ends = sorted([*(mp.mpf(float(x)) for x in marks), *(x for x in (a_Y, a_P) if marks[0] < x < marks[-1])])
    scale = E * R**3
    return scale * mp.quad(lambda a: power(a) / scale, ends)


@pytest.mark.parametrize("Gamma", [0.0, 0.02, 0.2])
def test_the_work_of_growth_is_the_quadrature_of_its_force(Gamma):
    """Gamma = 0.2 yields in the moment of touch."""
    law = law_of(Gamma)
    for ratio in (1.2, 3.0, 12.0, 40.0):
        top = max(ratio * law.yield_radius, 1.01 * float(law.touch_radius))
        with mp.workdps(25):
            exact = float(growing(Gamma, [float(law.touch_radius), top]))
        assert float(law.work(top)) == pytest.approx(exact, rel=1e-11)


SOFT = {"E_star": 1.0, "R_star": 1.0, "Y": 0.02}  # a_Y = 0.05 R*
SOFT_LIMIT = 5.953794  # Y^3 R*/E*^2 of a sphere on a rigid plane with finite strain, by 400,001 points of the condition


def softened(log, share, q):
    """Force, radius and overlap of `cavity` with finite strain at ln alpha/alpha_Y: formulas of docs/strain.md."""
    y = mp.mpf(SOFT["Y"])
    a_Y, top = mp.pi * mp.mpf("1.6") * y / 2, mp.mpf(3) * (mp.mpf("2.8") - mp.mpf("3.2") / 3) - mp.log(2)
    middle, b = log < top, a_Y**2 * mp.exp(log)
    a = a_Y * mp.exp(q * log) if middle else mp.sqrt(2 * b)
    p = y * (mp.mpf("3.2") / 3 + 2 * q / 3 * log) if middle else mp.mpf("2.8") * y
    f = [1 - mp.exp(-mp.mpf("0.82") * (share * x) ** -mp.mpf("0.7")) for x in (a, a_Y)]
    kept = 1 - mp.mpf(share) ** 2 / 2 * (b - a_Y**2)
    return mp.pi * a * a * kept * p * f[0] / f[1], a * mp.sqrt(kept), b


@pytest.mark.parametrize("share", [0.5, 1.0])
@pytest.mark.parametrize("strength", [0.1, 0.9])
def test_the_work_of_growth_with_finite_strain_is_the_quadrature_of_its_force(strength, share):
    """F d(alpha) = (F_b - P_t) d(alpha_b - d) of d = sqrt(2 pi Gamma a), by mpmath in ln alpha_b; strength: Gamma over
    its largest value."""
    Gamma = strength * SOFT_LIMIT * SOFT["Y"] ** 3
    law = CavityAdhesive(**SOFT, Gamma=Gamma, c_strain=0.82, share=share)
    with mp.workdps(20):
        top = mp.mpf(3) * (mp.mpf("2.8") - mp.mpf("3.2") / 3) - mp.log(2)
        q = (1 + mp.log(2) / top) / 2

        def force(log):
            F, a, _ = softened(log, share, q)
            return F - mp.sqrt(8 * mp.pi * Gamma * a**3)

        def overlap(log):
            _, a, b = softened(log, share, q)
            return b - mp.sqrt(2 * mp.pi * Gamma * a)

        for ends in ([0.01, 1.0], [1.0, top, 5.0]):
            ends = [mp.mpf(x) for x in ends]
            exact = mp.quad(lambda x: force(x) * mp.diff(overlap, x), ends)
            a = [float(softened(x, share, q)[1]) for x in (ends[0], ends[-1])]
            assert float(law.work(a[1]) - law.work(a[0])) == pytest.approx(float(exact), rel=1e-9)
            for k, x in enumerate((ends[0], ends[-1])):
                assert float(law.overlap(a[k])) == pytest.approx(float(overlap(x)), rel=1e-11)
                assert float(law.force(a[k])) == pytest.approx(float(force(x)), rel=1e-11)
                assert float(law.radius(float(overlap(x)))) == pytest.approx(a[k], rel=1e-11)


@pytest.mark.parametrize("V", [3e-3, 0.05])
def test_the_energies_of_an_impact_with_finite_strain_close(V):
    law = CavityAdhesive(**SOFT, Gamma=4 * SOFT["Y"] ** 3, c_strain=0.82, share=0.5)
    x = adhesion.impact(law, m_star=1.0, speed=V)
    branch, _ = law.branch(x.radius_max)
    first = law.touch_radius
    lost = x.plastic_work + branch.energy(branch.fold_radius) - law.branch(first)[0].energy(first)
    assert float(x.work_in) == pytest.approx(float(x.work_out + lost), rel=1e-12)
    other = CavityAdhesive(**SOFT, Gamma=4 * SOFT["Y"] ** 3)
    assert float(x.e_n) < float(adhesion.impact(other, m_star=1.0, speed=V).e_n)


def test_finite_strain_lowers_the_largest_adhesion():
    """Trapezoids of d(W_b - U) - d (2 E* a d alpha_b - dF_b) up to the least area of share = 1."""
    law = CavityAdhesive(**SOFT, Gamma=0.0, c_strain=0.82)
    assert float(law.largest_adhesion) == pytest.approx(SOFT_LIMIT * SOFT["Y"] ** 3, rel=1e-6)
    body = Cavity(**SOFT, c_strain=0.82)
    b = np.geomspace(1.0001 * body.yield_overlap, body.least_overlap, 400_001)
    F, U, a = body.force(b), body.recovered_work(b), body.radius(b)
    kept = 0.5 * (F[1:] + F[:-1]) * np.diff(b) - np.diff(U)
    stiff = (a[1:] + a[:-1]) * np.diff(b) - np.diff(F)
    d = kept[stiff > 0] / stiff[stiff > 0]
    middle = 0.5 * (a[1:] + a[:-1])[stiff > 0]
    assert (d * d / (2 * np.pi * middle)).min() == pytest.approx(SOFT_LIMIT * SOFT["Y"] ** 3, rel=1e-5)


@pytest.mark.parametrize("Gamma", [0.02, 0.2])
@pytest.mark.parametrize("V", [0.1, 1.0, 10.0])
def test_an_impact_gives_back_the_quadrature_of_its_opening(Gamma, V):
    law = law_of(Gamma)
    x = adhesion.impact(law, m_star=M, speed=V)
    peak = float(law.backbone_overlap(x.radius_max))
    tau, F, a = float(law.backbone.flatness(peak)), float(law.backbone.force(peak)), float(x.radius_max)
    chi = Gamma * E * (np.pi * a * a / F) ** 2 / a
    force, slope = curve(tau, chi)
    with mp.workdps(25):
        fold = mp.findroot(slope, (mp.mpf("1e-3"), mp.mpf("1.2")), solver="anderson", maxsteps=200)
        back = F * F / (E * a) * mp.quad(lambda t: force(t) * slope(t), [fold, mp.pi / 2])
        assert float(x.e_n) == pytest.approx(float(mp.sqrt(back / (M * V * V / 2))), rel=1e-9)
    lost = x.plastic_work + law.branch(a)[0].energy(law.branch(a)[0].fold_radius)
    first = law.touch_radius
    lost = lost - law.branch(first)[0].energy(first)  # in the jumps
    assert float(x.work_in) == pytest.approx(float(x.work_out + lost), rel=1e-12)


@pytest.mark.parametrize("Gamma", [0.02, 0.2])
def test_times_are_those_of_velocity_verlet(Gamma):
    """20,000 steps of the force at the radius of the overlap."""
    law, V = law_of(Gamma), 1.0
    x = adhesion.impact(law, m_star=M, speed=V)
    a = np.geomspace(float(law.touch_radius), float(x.radius_max), 4001)
    way, force = law.overlap(a), law.force(a)
    branch, dent = law.branch(x.radius_max)
    b = np.geomspace(float(branch.fold_radius), float(x.radius_max), 4001)
    back, pull = dent + branch.overlap(b), branch.force(b)

    def acceleration(alpha, opens):
        return -np.interp(alpha, back, pull) / M if opens else -np.interp(alpha, way, force) / M

    dt, alpha, v, t, opens = float(x.contact_time) / 20_000, 0.0, V, 0.0, False
    while not (opens and alpha < back[0]):
        half = v + 0.5 * dt * acceleration(alpha, opens)
        alpha += dt * half
        opens = opens or half < 0
        v = half + 0.5 * dt * acceleration(alpha, opens)
        t += dt
    assert t == pytest.approx(float(x.contact_time), rel=1e-3)
    assert -v / V == pytest.approx(float(x.e_n), rel=1e-3)


def test_without_adhesion_an_impact_is_that_of_cavity():
    speed = np.geomspace(1e-3, 50, 40)
    x = adhesion.impact(law_of(0.0), m_star=M, speed=speed)
    y = restitution.impact(Cavity(E_star=E, R_star=R, Y=Y), m_star=M, speed=speed)
    for name in ("e_n", "contact_time", "force_max", "overlap_max", "radius_max", "work_out"):
        assert getattr(x, name) == pytest.approx(getattr(y, name), rel=1e-9), name
    assert x.residual_overlap == pytest.approx(y.residual_overlap, abs=1e-11 * R)


@pytest.mark.parametrize(("share", "creates"), [(0.995, False), (1.005, True)])
def test_growth_creates_no_energy_up_to_the_largest_adhesion(share, creates):
    """Lost work along the backbone by trapezoids: d(W_b - U) - d (2 E* a d alpha_b - dF_b)."""
    body, most = Cavity(E_star=E, R_star=R, Y=Y), float(law_of(0.1).largest_adhesion)
    assert most == pytest.approx(LIMIT, rel=1e-6)
    b = body.yield_overlap * np.geomspace(1.0001, 1e4, 400_001)
    d = np.sqrt(2 * np.pi * share * most * body.radius(b) / E)
    stiff = E * (body.radius(b)[1:] + body.radius(b)[:-1])
    kept = np.diff(body.work(b) - body.recovered_work(b))
    lost = kept - 0.5 * (d[1:] + d[:-1]) * (stiff * np.diff(b) - np.diff(body.force(b)))
    assert (lost < 0).any() == creates


def test_more_is_refused_with_its_value_and_limit():
    with pytest.raises(ValueError, match=r"0\.22 J/m\^2 creates energy .* R\* = 1e-05 m .* up to 0\.2155 J/m\^2"):
        law_of(0.22)
    with pytest.raises(ValueError, match=r"R\* = 1e-06 m"):
        CavityAdhesive(E_star=E, R_star=np.array([1e-5, 1e-6]), Gamma=0.2, Y=Y)
