# SPDX-License-Identifier: GPL-2.0-or-later
"""Every function of the theory at a value worked out by hand or by mpmath from the physics; none comes from the code.

Where a comment does not say otherwise the tolerance is 1e-13: the round-off of a few products and roots.
"""

import mpmath as mp
import numpy as np
import pytest

import oblique
from epdem.theory import pair, partial_slip, printed, restitution, timestep, viscous, waves, yielding
from epdem.theory.backbones import Cavity, Hertz, Johnson, Meyer, Thornton
from epdem.theory.thornton_ning import ThorntonNing

STEEL = {"E_star": 1.1428571428571429e11, "R_star": 0.01}  # E = 208 GPa, nu = 0.3, sphere of 10 mm on a plane
M = 0.032882003107573169
IMPACT = STEEL | {"m_star": M}


def exactly(value):
    return pytest.approx(float(value), rel=1e-13, abs=0)


def test_mean_pressure_of_the_three_regimes():
    """Elastic 4 x/(3 pi): 0.4 at 0.3 pi; cavity (2/3)(1 + ln(x/3)): 4/3 at 3 e; fully plastic: 2.8."""
    assert printed.elastic_mean(3 * np.pi) == exactly(4)
    assert printed.cavity_mean(3 * np.e) == exactly(mp.mpf(4) / 3)
    assert printed.mean_pressure([0.3 * np.pi, 3 * np.e, 1e4]) == pytest.approx([0.4, 4 / 3, 2.8], rel=1e-13)


def test_pressure_of_a_loading_contact_is_hertz_cut_off_at_the_yield_pressure():
    """r/a = 0.6: 0.8 of the peak, which is 3/2 of 4/3 E* a^3/R* over pi a^2: 4/pi GPa here."""
    assert printed.hertz_pressure([0.0, 1.2, 2.0, 3.0], p_0=5.0, a=2.0) == pytest.approx([5, 4, 0, 0], rel=1e-13)
    p_0 = 4e9 / np.pi
    contact = {"E_star": 2e11, "R_star": 0.01, "a": 1e-4}
    assert printed.loading_pressure([0.0, 6e-5], **contact, p_y=9e9) == pytest.approx([p_0, 0.8 * p_0], rel=1e-13)
    assert printed.loading_pressure([0.0, 6e-5], **contact, p_y=1.1e9) == pytest.approx([1.1e9, 0.8 * p_0], rel=1e-13)


@pytest.mark.parametrize("share", [1e-6, 1e-4, 1e-2, 0.5, 0.99])
def test_unloading_force_keeps_its_digits_down_to_a_tiny_circle(share):
    """8.82 summed over the circle in 40 digits, r = a sqrt(1 - u^2); it goes as (4/3) p a^3/a* when a is small."""
    with mp.workdps(40):
        k = mp.mpf(share)
        inner = lambda u: mp.asin(mp.sqrt(k * k * u * u / (1 - k * k * (1 - u * u))))  # noqa: E731
        exact = 4 * k * k * mp.quad(lambda u: u * inner(u), [0, 1])
    assert float(printed.unloading_force(a=2 * share, a_max=2.0, p=3.0)) == exactly(12 * exact)
    assert printed.unloading_pressure(np.linspace(0, 1.98, 5), a=2.0, a_max=2.0, p=3.0) == pytest.approx(3.0)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.95])
def test_fully_plastic_cavity_unloads_by_the_integral_of_8_82(share):
    """The law's force is the pressure 8.82 summed over the circle; its slope is that of a rigid punch, 2 E* a."""
    # equation: curve.Curve.elastic_branch
    law = Cavity(**STEEL, Y=1e9)
    top = 3 * law.plastic_overlap
    assert law.flatness(top) == 1
    alpha = top - share * law.recovered_overlap(top)
    force, a = law.unloading(alpha, top)
    a_max, p = np.sqrt(2 * STEEL["R_star"] * top), 2.8e9
    x, w = np.polynomial.legendre.leggauss(60)
    theta = np.pi / 4 * (x + 1)
    r = a * np.sin(theta)  # the root at the rim becomes smooth
    ring = 2 * np.pi * r * a * np.cos(theta) * printed.unloading_pressure(r, a=a, a_max=a_max, p=p)
    assert float(force) == pytest.approx(np.pi / 4 * float(w @ ring), rel=1e-12, abs=0)  # round-off of 60 nodes
    h = 1e-5 * law.recovered_overlap(top)
    slope = (law.unloading_force(alpha + h, top) - law.unloading_force(alpha - h, top)) / (2 * h)
    # central difference: (h/delta_e)^2 = 1e-10 times a third derivative of order 10, and round-off 1e-16/1e-5
    assert slope == pytest.approx(2 * STEEL["E_star"] * float(a), rel=1e-8, abs=0)


def test_mean_pressure_at_first_yield_is_two_thirds_of_the_peak():
    """Printed p_0/Y: 1.61280 at nu = 0.3, 1.55435 at 0.25; 2/3 of their 5 decimals."""
    assert printed.first_yield_mean(np.array([0.3, 0.25])) == pytest.approx([1.07520, 1.03623], abs=4e-6)


def test_each_body_yields_from_the_speed_whose_energy_presses_hertz_to_1_60_of_its_stress():
    """m* v^2/2 = integral of 4/3 E* sqrt(R*) alpha^1.5 up to a = pi R* 1.6 Y/(2 E*); never above the 2.8 Y_soft."""
    E, R = (mp.mpf(STEEL[k]) for k in ("E_star", "R_star"))

    def speed(p):
        alpha = (mp.pi * R * p / (2 * E)) ** 2 / R
        mean_force = mp.quad(lambda x: mp.mpf(4) / 3 * E * mp.sqrt(R) * (alpha * x) ** mp.mpf(1.5), [0, 1])
        return float(mp.sqrt(2 * alpha * mean_force / M))

    law = Thornton(**STEEL, p_y=2.8e9)
    found = yielding.first_yield_speed(law, np.array([1e9, 1.5e9]), m_star=M)
    assert found == pytest.approx([speed(1.6e9), speed(2.4e9)], rel=1e-13, abs=0)
    assert speed(1.6e9) == pytest.approx(0.138086424357753, rel=1e-14)
    assert yielding.first_yield_speed(law, 2e9, m_star=M) == np.inf  # 3.2 GPa is above 2.8 GPa
    assert yielding.first_yield_speed(Hertz(**STEEL), np.inf, m_star=M) == np.inf


def test_mass_of_a_sphere_and_first_yield_speed_of_the_reference_case():
    """Printed: m* = 0.032882003107573169 kg, v_y = 0.559430455498519 m/s."""
    assert pair.sphere_mass(radius=0.01, density=7850.0) == exactly(M)
    assert yielding.yield_speed(p_y=2.8e9, m_star=M, **STEEL) == exactly(0.559430455498519)


def test_velocity_verlet_of_one_contact_is_stable_up_to_the_limit():
    """k = 2 E* a = 2e7 N/m, m* = 0.02 kg: one step has trace 2 - k dt^2/m*, at -2 it blows up: dt = 2 sqrt(1e-9) s."""
    limit = timestep.stability_limit(E_star=1e11, m_star=0.02, radius=1e-4)
    assert limit == exactly(2 * mp.sqrt(mp.mpf("1e-9")))
    assert 2 - 2e7 * limit**2 / 0.02 == pytest.approx(-2, rel=1e-13)


def test_a_dense_packing_shortens_the_stable_step():
    """By the highest frequency: in a lattice all neighbours pull."""
    # face-centred cubic at the edge of the zone: n n^T (1 - cos q.d) summed over 12 neighbours
    near = [(np.array(d) - 1) / 2 for d in np.ndindex(3, 3, 3) if sum(x != 1 for x in d) == 2]
    assert len(near) == 12
    matrix = sum(np.outer(d, d) / (d @ d) * (1 - np.cos(2 * np.pi * d[0])) for d in near)
    lattice = np.linalg.eigvalsh(matrix).max()  # m omega^2/k
    assert pytest.approx((2 / lattice) ** 0.5, rel=1e-12) == timestep.DENSE_PACKING  # of a pair: k/m* = 2 k/m


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_grains_that_turn_alike_shorten_the_stable_step_of_a_sticking_packing(nu):
    """Highest frequency of a face-centred cubic lattice of spheres, I = 2/5 m R^2, springs k_n and k_t = kappa k_n in
    every contact: waves exp(i q.d) over the Brillouin zone, degrees of freedom u and R theta."""
    kappa = 2 * (1 - nu) / (2 - nu)
    near = [(np.array(d) - 1) / 2 for d in np.ndindex(3, 3, 3) if sum(x != 1 for x in d) == 2]

    def lattice(q):  # largest m omega^2/k_n
        stiffness = np.zeros((6, 6), complex)
        for d in near:
            n, phase = d / np.linalg.norm(d), np.exp(2j * np.pi * d @ q)
            turn = -(1 + phase) * np.cross(np.eye(3), n).T  # surfaces move by theta x n, both the same way apart
            moves, spring = np.hstack([(phase - 1) * np.eye(3), turn]), kappa * np.eye(3) + (1 - kappa) * np.outer(n, n)
            stiffness += moves.conj().T @ spring @ moves / 2  # each contact is counted from both its ends
        mass = np.array([1, 1, 1, 0.4, 0.4, 0.4]) ** -0.5
        return np.linalg.eigvalsh(mass[:, None] * stiffness * mass).max()

    zone = np.linspace(0, 1, 5)
    highest = max(lattice(np.array([a, b, c])) for a in zone for b in zone for c in zone)
    assert highest == pytest.approx(40 * kappa, rel=1e-12)
    # dt omega = 2, against 2 sqrt(m*/k_n) of a pair, m* = m/2
    assert timestep.sticking_packing(kappa) == exactly(mp.sqrt(2 / mp.mpf(highest)))
    assert timestep.sticking_packing(14 / 17) == pytest.approx(0.246, abs=5e-4)
    assert timestep.sticking_packing(kappa, contacts=6) == exactly(mp.sqrt(mp.mpf(3) / 5 / (6 * mp.mpf(kappa))))


def test_rayleigh_time_is_half_a_girth_at_the_speed_of_the_surface_wave():
    """R = 10 mm, G = 80 GPa, 7850 kg/m^3, nu = 0.3: pi R/(0.92553 c_s) = 10.633 us."""
    found = timestep.rayleigh_time(radius=0.01, density=7850.0, young_modulus=208e9, poisson_ratio_=0.3)
    shear = mp.sqrt(mp.mpf(80) * 10**9 / 7850)
    assert found == exactly(mp.pi / 100 / (mp.mpf("0.92553") * shear))
    ratio = (1 - 0.6) / (2 - 0.6)  # (c_s/c_p)^2
    c = mp.findroot(
        lambda c: (2 - c * c) ** 2 - 4 * mp.sqrt(1 - c * c) * mp.sqrt(1 - ratio * c * c), (0.8, 0.99), solver="illinois"
    )
    # 0.1631 nu + 0.8766 is a straight line through the root of Rayleigh's equation, 0.2 % off here
    assert found == pytest.approx(float(mp.pi / 100 / (c * shear)), rel=3e-3)


def test_hertz_contact_time_is_the_beta_function_of_its_power_law():
    """t = 2 alpha_max/v times the integral of dx/sqrt(1 - x^2.5) = (2/5) B(2/5, 1/2); alpha_max from the energy."""
    v = 0.1
    top = (mp.mpf(15) / 16 * M * v**2 / (STEEL["E_star"] * mp.sqrt(mp.mpf("0.01")))) ** mp.mpf("0.4")
    time = float(2 * top / v * mp.mpf(2) / 5 * mp.beta(mp.mpf(2) / 5, mp.mpf(1) / 2))
    assert timestep.hertz_time(**STEEL, m_star=M, speed=v) == exactly(time)


def test_sliding_impact_of_a_sphere_by_the_balance_of_its_impulses():
    """m = 1, v_n = 3 m/s, e_n = 0.6, f = 0.2: P_n = 4.8, P_t = 0.96; R = 20 mm, so I = 2/5 m R^2 = 1.6e-4."""
    P_t, R, inertia = 0.2 * (1 + 0.6) * 3, 0.02, 0.4 * 0.02**2
    turned = P_t * R / inertia
    assert oblique.spin(0.2, e_n=0.6, v_n=3.0, R=R, w_i=5.0) == exactly(5 + turned)
    assert oblique.spin(0.2, e_n=0.6, v_n=3.0, R=R) == exactly(120)
    v_t = 2 * 3.0  # tan theta = 2
    assert oblique.tangential_restitution(0.2, e_n=0.6, theta=np.arctan(2.0)) == exactly((v_t - P_t) / v_t)
    assert oblique.patch_rebound(0.2, e_n=0.6, theta=np.arctan(2.0)) == exactly((v_t - P_t - R * turned) / 3)


def test_a_patch_slides_throughout_from_the_angle_of_maw_barber_and_fawcett():
    """kappa = 14/17 at nu = 0.3, mu = 0.1: tan theta = 0.1 (7 - 17/14) for e_n = 1."""
    assert oblique.kappa(0.3) == exactly(mp.mpf(14) / 17)
    assert np.tan(oblique.sliding_angle(0.1, e_n=1.0, nu=0.3)) == exactly(mp.mpf(81) / 140)
    half = oblique.sliding_angle(0.1, e_n=0.5, nu=0.3)
    assert np.tan(half) == exactly((mp.mpf(7) / 2 * mp.mpf(3) / 2 - mp.mpf(17) / 28) / 10)


@pytest.mark.parametrize("restitution_", [1.0, 0.9])
@pytest.mark.parametrize(
    ("law", "circle"), [(Hertz(**STEEL), 1), (Thornton(**STEEL, p_y=2.8e9), 1), (Johnson(**STEEL, p_m=3e9), 2)]
)
def test_contact_radius_at_the_peak_is_that_of_the_overlap_with_and_without_a_dashpot(law, circle, restitution_):
    """a^2 = R* alpha, and 2 R* alpha where a fully plastic contact cuts its circle out (20 m/s is above its yield)."""
    x = viscous.impact(law, m_star=M, speed=20.0, restitution=restitution_)
    a = float(np.sqrt(circle * 0.01 * x.overlap_max))
    assert float(x.radius_max) == exactly(a)


def test_damping_ratio_of_a_known_restitution():
    """phi = pi/6: zeta = 1/2, e = exp(-(2 pi/3)/sqrt 3) = 0.2984."""
    e = float(mp.exp(-2 * mp.pi / 3 / mp.sqrt(3)))
    assert round(e, 4) == 0.2984
    assert float(viscous.damping_ratio(e)) == exactly(0.5)


def test_printed_equations_give_nan_outside_their_domain_and_say_why():
    assert np.isnan(printed.wu_restitution(99.0, v_y0=1.0)) and printed.wu_restitution(
        100.0, v_y0=1.0
    ) == pytest.approx(2.08 * 100**-0.25)
    v_y0 = yielding.yield_speed(p_y=1.6e9, **IMPACT)
    assert np.isnan(printed.johnson_restitution(26.8 * v_y0, p_m=3e9, **IMPACT))
    assert float(printed.johnson_restitution(26.9 * v_y0, p_m=3e9, **IMPACT)) == pytest.approx(
        1, abs=2e-3
    )  # 26.85 v_y0
    assert np.isnan(printed.bridges_restitution(0.06)) and printed.bridges_restitution(0.01) == pytest.approx(0.32)


def test_equation_8_87_is_8_86_for_a_sphere_on_a_plane():
    """Its printed constant 1.718 has four digits."""
    v = np.array([10.0, 100.0])
    plane = printed.johnson_plane_restitution(v, p_m=3e9, E_star=STEEL["E_star"], density=7850)
    assert plane == pytest.approx(printed.johnson_restitution(v, p_m=3e9, **IMPACT), rel=5e-4, abs=0)


def test_equation_8_86_is_the_work_of_a_uniform_pressure_against_hertz_recovery():
    """Work in: p_m on the volume pi a^4/(4 R*) of the dent; work out: 3 F^2/(10 a E*). Round-off only."""
    v, p_m, R = np.array([20.0, 200.0]), 3e9, STEEL["R_star"]
    work = M * v**2 / 2
    a = (4 * R * work / (np.pi * p_m)) ** 0.25
    out = 0.3 * (np.pi * a**2 * p_m) ** 2 / (a * STEEL["E_star"])
    assert printed.johnson_restitution(v, p_m=p_m, **IMPACT) == pytest.approx(np.sqrt(out / work), rel=1e-14, abs=0)


def test_fits_to_elements_and_ice_at_points_worked_out_by_hand():
    """8.88: 2.08/100^(1/4) and 2.08/10; 8.89: 0.32 at 1 cm/s, and a tenth of the speed raises e_n by 10^0.234."""
    assert printed.wu_restitution(np.array([13.0, 1300.0]), v_y0=0.13) == pytest.approx([0.65775, 0.208], abs=1e-5)
    assert printed.bridges_restitution(np.array([0.01, 0.001])) == pytest.approx([0.32, 0.32 * 1.71396], abs=1e-5)


ADHESIVE, HARDENING = STEEL | {"Gamma": 0.2, "p_y": 1e9}, STEEL | {"p_y": 1e9, "x": 0.1}
WAVES, NAN = {"E": 208e9, "nu": 0.3, "density": 7850.0}, np.nan
SLIP = {"m_star": M, "m_tangential": M, "mu": 0.3, "G_star": 3e10, "v_n": 1.0, "slip": 0.1, "steps": 50}
BAD = {  # what a message holds, and the call
    "E1": lambda: pair.E_star(-1, 0.3, 1e9, 0.3),
    "nu1": lambda: pair.E_star(1e9, 0.51, 1e9, 0.3),
    "R1": lambda: pair.R_star(0.0, 1.0),
    "density": lambda: pair.sphere_mass(radius=1.0, density=NAN),
    "p_y = -1": lambda: Thornton(E_star=1e11, R_star=0.01, p_y=-1),
    "E_star": lambda: Hertz(E_star=np.inf, R_star=1),
    "speed = -2": lambda: restitution.e_n(Hertz(E_star=1e9, R_star=1), m_star=1, speed=np.array([1.0, -2.0])),
    "mu": lambda: oblique.sliding_angle(-0.1, e_n=1, nu=0.3),
    "e_n = -5": lambda: oblique.tangential_restitution(0.3, e_n=-5, theta=0.5),
    "e_n = -0.1": lambda: oblique.spin(0.3, e_n=-0.1, v_n=1.0, R=0.01),
    "e_n = nan": lambda: oblique.sliding_angle(0.3, e_n=NAN, nu=0.3),
    "theta": lambda: oblique.patch_rebound(0.3, e_n=1.0, theta=np.pi),
    "e_n = -1": lambda: oblique.patch_rebound(0.3, e_n=-1.0, theta=1.0),
    "a = 2": lambda: printed.unloading_pressure(0.0, a=2.0, a_max=1.0, p=1.0),
    "nu": lambda: waves.wave_constant(0.5),
    "time, from sample to sample = 0": lambda: waves.radiated([0, 1, 2], [0, 1, 1], **WAVES),
    "force": lambda: waves.radiated([0, NAN], [0, 1], **WAVES),
    "E_star = 0": lambda: ThorntonNing(**ADHESIVE | {"E_star": 0.0}),
    "R_star = -1": lambda: ThorntonNing(**ADHESIVE | {"R_star": -1.0}),
    "Gamma = -0.1": lambda: ThorntonNing(**ADHESIVE | {"Gamma": -0.1}),
    "p_y = 0": lambda: ThorntonNing(**ADHESIVE | {"p_y": 0.0}),
    "p_y = 0, must lie in (0, inf)": lambda: Meyer(**HARDENING | {"p_y": 0.0}),
    "x = 1, must lie in [0, 1)": lambda: Meyer(**HARDENING | {"x": 1.0}),
    "x = -0.1, must lie in [0, 1)": lambda: Meyer(**HARDENING | {"x": -0.1}),
    "x = nan, must lie in [0, 1)": lambda: Meyer(**HARDENING | {"x": NAN}),
    "= -1": lambda: pair.strain_share(-1.0, 1.0, hardening=1.75),
    "= 0": lambda: pair.strain_share(1.0, 0.0, hardening=1.75),
    "= nan": lambda: pair.strain_share(1.0, NAN, hardening=1.75),
    "= 1": lambda: pair.strain_share(1.0, 2.0, hardening=1.0),
    "m_tangential = 0": lambda: partial_slip.rebound(Hertz(**STEEL), **SLIP | {"m_tangential": 0.0}),
    "mu = -0.1": lambda: partial_slip.rebound(Hertz(**STEEL), **SLIP | {"mu": -0.1}),
    "v_n = 0": lambda: partial_slip.rebound(Hertz(**STEEL), **SLIP | {"v_n": 0.0}),
    "G_star = -1": lambda: partial_slip.rebound(Hertz(**STEEL), **SLIP | {"G_star": -1.0}),
}
NOT_FINITE = {
    "both bodies are rigid": lambda: pair.E_star(np.inf, 0.3, np.inf, 0.3),
    ": both bodies are rigid": lambda: pair.G_star(np.array([1e9, np.inf]), 0.3, np.inf, 0.3),
    "both bodies are planes": lambda: pair.R_star(np.inf, np.inf),
    "both bodies are fixed": lambda: pair.m_star(np.inf, np.inf),
}


@pytest.mark.parametrize("says", [*BAD, *NOT_FINITE])
def test_bad_input_is_named_with_its_range(says):
    with pytest.raises(ValueError, match="must lie in" if says in BAD else "both bodies are") as caught:
        (BAD | NOT_FINITE)[says]()
    assert says in str(caught.value)


def test_effective_quantities_are_exact_for_any_poisson_ratio():
    """30 digits over E 1 kPa to 1 TPa, nu 0 to 0.5, radii 1 um to 10 m."""
    rng = np.random.default_rng(3)
    for _ in range(200):
        E1, E2 = 10 ** rng.uniform(3, 12, 2)
        n1, n2 = rng.uniform(0, 0.5, 2)
        R1, R2 = 10 ** rng.uniform(-6, 1, 2)
        with mp.workdps(30):
            a, b, c, d = map(mp.mpf, (E1, n1, E2, n2))
            e_star = 1 / ((1 - b**2) / a + (1 - d**2) / c)
            g_star = 1 / (2 * (2 - b) * (1 + b) / a + 2 * (2 - d) * (1 + d) / c)
            r_star = 1 / (1 / mp.mpf(R1) + 1 / mp.mpf(R2))
        assert pair.E_star(E1, n1, E2, n2) == pytest.approx(float(e_star), rel=1e-14, abs=0)
        assert pair.G_star(E1, n1, E2, n2) == pytest.approx(float(g_star), rel=1e-14, abs=0)
        assert pair.R_star(R1, R2) == pytest.approx(float(r_star), rel=1e-14, abs=0)
