# SPDX-License-Identifier: GPL-2.0-or-later
"""A change of the base units of mass, length and time changes no function of the theory but by its own unit.

`printed.bridges_restitution` is left out: it is a fit with the unit of its speed built in.
"""

import inspect
from dataclasses import dataclass

import numpy as np
import pytest

import oblique
from epdem.theory import adhesion, pair, partial_slip, printed, restitution, timestep, waves, yielding
from epdem.theory.backbones import LAWS
from epdem.theory.cavity_adhesive import CavityAdhesive
from epdem.theory.thornton_ning import ThorntonNing

ONE, KG, M, S = np.zeros(3), *np.eye(3)
SPEED, PA, N, J, DENSITY = M - S, KG - M - 2 * S, KG + M - 2 * S, KG + 2 * M - 2 * S, KG - 3 * M

E, NU, P, A, Y = (208e9, PA), (0.3, ONE), (2.8e9, PA), (1e-4, M), (1e9, PA)
E_STAR, R_STAR, M_STAR, V = (1.14e11, PA), (0.01, M), (0.033, KG), (5.0, SPEED)
CONTACT = {"E_star": E_STAR, "R_star": R_STAR}
BODIES = {"E1": E, "nu1": NU, "E2": (70e9, PA), "nu2": (0.2, ONE)}
IMPACT = CONTACT | {"m_star": M_STAR}
ANGLE = {"e_n": (0.6, ONE), "theta": (0.5, ONE)}
HALF_SPACE = {"E": E, "nu": NU, "density": (7850.0, DENSITY)}
SLIDING = {"mu": (0.2, ONE), "e_n": (0.6, ONE), "nu": NU}


@dataclass(frozen=True)
class Row:
    """A function, its arguments as (value in SI, powers of kg, m, s), and the powers of what it returns."""

    function: object
    arguments: dict
    result: object
    name: str = ""

    def __str__(self):
        return f"{inspect.getmodule(self.function).__name__.rpartition('.')[2]}.{self.name or self.function.__name__}"


def law(name, E_star, R_star, strength):
    key = next(iter(LAWS[name].declaration().symbols.values()), None)
    return LAWS[name](E_star=E_star, R_star=R_star, **({key: strength} if key else {}))


def law_rows(name):
    """Restitution, times and peaks of one impact; force, radius and work at an overlap and on the way back."""
    both = CONTACT | {"strength": Y}
    units = {"e_n": ONE, "contact_time": S, "force_max": N, "overlap_max": M, "radius_max": M, "residual_overlap": M}
    units |= dict.fromkeys(("work_in", "work_out", "plastic_work"), J)

    def impact(m_star, speed, **numbers):
        x = restitution.impact(law(name, **numbers), m_star=m_star, speed=speed)
        return [getattr(x, key) for key in units]

    def e_n(m_star, speed, **numbers):
        return restitution.e_n(law(name, **numbers), m_star=m_star, speed=speed)

    def loading_time(m_star, top, start, **numbers):
        one = law(name, **numbers)
        return restitution.loading_time(one, *np.array([[m_star], [top], [start]]))

    def backbone(alpha, **numbers):
        one = law(name, **numbers)
        return [one.force(alpha), one.radius(alpha), one.work(alpha), one.unloading_force(0.9 * alpha, alpha)]

    def first_yield_speed(m_star, Y, **numbers):
        return yielding.first_yield_speed(law(name, **numbers), Y, m_star=m_star)

    move = {"m_star": M_STAR, "speed": V}
    return [
        Row(impact, both | move, list(units.values()), f"impact[{name}]"),
        Row(e_n, both | move, ONE, f"e_n[{name}]"),
        Row(loading_time, both | {"m_star": M_STAR, "top": (5e-5, M), "start": (1e-5, M)}, S, f"loading_time[{name}]"),
        Row(backbone, both | {"alpha": (5e-5, M)}, [N, M, J, N], f"backbone[{name}]"),
        Row(first_yield_speed, both | {"m_star": M_STAR, "Y": (0.6e9, PA)}, SPEED, f"first_yield_speed[{name}]"),
    ]


def oblique_impact(E_star, R_star, p_y, mass, G_star, v_n):
    both = LAWS["thornton"](E_star=E_star, R_star=R_star, p_y=p_y)
    numbers = {"mu": 0.2, "theta": 0.5, "steps": 200, "springs": 40}
    x = oblique.impact(both, mass=mass, R=R_star, G_star=G_star, v_n=v_n, **numbers)
    return [x.f, x.e_n, x.e_t, x.spin, x.patch]


def adhesive_impact(E_star, R_star, Gamma, p_y, m_star, speed):
    x = adhesion.impact(ThorntonNing(E_star=E_star, R_star=R_star, Gamma=Gamma, p_y=p_y), m_star=m_star, speed=speed)
    return [x.e_n, x.contact_time, x.force_max, x.overlap_max, x.radius_max, x.plastic_work]


def flattened(E_star, R_star, Gamma, Y, c_strain, a):
    law = CavityAdhesive(E_star=E_star, R_star=R_star, Gamma=Gamma, Y=Y, c_strain=c_strain)
    branch, dent = law.branch(a)
    found = [law.force(a), law.overlap(a), law.work(a), law.largest_adhesion, dent, branch.pull_off_force]
    return [*found, branch.energy(0.5 * a), branch.fold_radius]


def split(E_star, R_star, p_y, m_star, speed, E, nu, density):
    both = LAWS["thornton"](E_star=E_star, R_star=R_star, p_y=p_y)
    return list(waves.energy_split(both, m_star=m_star, speed=speed, E=E, nu=nu, density=density).values())


def slip_rebound(E_star, R_star, p_y, G_star, m_star, speed, slip):
    both = LAWS["thornton"](E_star=E_star, R_star=R_star, p_y=p_y)
    numbers = {"m_tangential": 2 / 7 * m_star, "mu": 0.2, "steps": 200, "springs": 40}
    return partial_slip.rebound(both, m_star=m_star, G_star=G_star, v_n=speed, slip=slip, **numbers)


ROWS = [
    Row(pair.E_star, BODIES, PA),
    Row(pair.G_star, BODIES, PA),
    Row(pair.R_star, {"R1": (0.01, M), "R2": (0.03, M)}, M),
    Row(pair.m_star, {"m1": (0.01, KG), "m2": (0.03, KG)}, KG),
    Row(pair.strain_share, {"strength1": (1.0e9, PA), "strength2": (1.3e9, PA)}, ONE),
    Row(pair.curvature_share, {"share1": (0.8, ONE), "R_star": (0.01, M), "R1": (0.02, M)}, ONE),
    Row(pair.sphere_mass, {"radius": (0.01, M), "density": (7850.0, DENSITY)}, KG),
    Row(
        pair.contact_conductance,
        {"k_i": (50.0, KG + M - 3 * S), "k_j": (20.0, KG + M - 3 * S), "radius": A},
        KG + 2 * M - 3 * S,
    ),
    Row(printed.cavity_mean, {"x": (10.0, ONE)}, ONE),
    Row(printed.cavity_end, {"p": (2.8, ONE)}, ONE),
    Row(printed.elastic_mean, {"x": (10.0, ONE)}, ONE),
    Row(printed.mean_pressure, {"x": (10.0, ONE)}, ONE),
    Row(printed.unloading_pressure, {"r": (3e-5, M), "a": (6e-5, M), "a_max": A, "p": P}, PA),
    Row(printed.unloading_force, {"a": (6e-5, M), "a_max": A, "p": P}, N),
    Row(printed.hertz_pressure, {"r": (6e-5, M), "p_0": P, "a": A}, PA),
    Row(printed.loading_pressure, CONTACT | {"r": (6e-5, M), "a": A, "p_y": (2e9, PA)}, PA),
    Row(
        partial_slip.line_load,
        {"x": (3e-5, M), "force": (50.0, N), "a": (6e-5, M), "a_max": A, "flatness": (0.4, ONE)},
        N - M,
    ),
    Row(printed.von_mises, {"s1": Y, "s2": P, "s3": E}, PA),
    Row(printed.tresca, {"s1": Y, "s2": P, "s3": E}, PA),
    Row(printed.axis_difference, {"z": (0.5, ONE), "nu": NU}, ONE),
    Row(printed.first_yield, {"nu": NU}, [ONE, ONE]),
    Row(printed.first_yield_mean, {"nu": NU}, ONE),
    Row(printed.fully_plastic_mean, {"Y": Y}, [PA, PA]),
    Row(waves.wave_constant, {"nu": NU}, ONE),
    Row(waves.rayleigh_share, {"nu": NU}, ONE),
    Row(waves.radiated, HALF_SPACE | {"force": (np.array([0, 3, 1.0]), N), "time": (np.array([0, 1, 3.0]), S)}, J),
    Row(waves.elastic_wave_share, HALF_SPACE | {"speed": V}, ONE),
    Row(waves.plastic_wave_share, {"p_d": P, "E": E, "nu": NU, "e_n": (0.4, ONE)}, ONE),
    Row(split, IMPACT | HALF_SPACE | {"p_y": P, "speed": V}, [ONE] * 3),
    Row(oblique.kappa, {"nu": NU}, ONE),
    Row(oblique.tangential_restitution, ANGLE | {"f": (0.2, ONE)}, ONE),
    Row(oblique.spin, {"f": (0.2, ONE), "e_n": (0.6, ONE), "v_n": V, "R": R_STAR, "w_i": (7.0, -S)}, -S),
    Row(oblique.patch_rebound, ANGLE | {"f": (0.2, ONE)}, ONE),
    Row(oblique.sliding_angle, SLIDING, ONE),
    Row(oblique_impact, CONTACT | {"p_y": P, "mass": M_STAR, "G_star": (1e10, PA), "v_n": V}, [ONE, ONE, ONE, -S, ONE]),
    Row(slip_rebound, IMPACT | {"p_y": P, "G_star": (1e10, PA), "speed": V, "slip": (0.7, SPEED)}, SPEED),
    *(
        Row(
            adhesive_impact,
            IMPACT | {"Gamma": (G, PA + M), "p_y": P, "speed": V},
            [ONE, S, N, M, M, J],
            f"adhesion[{G}]",
        )
        for G in (0.2, 2e3)
    ),
    *(
        Row(
            flattened,
            CONTACT | {"Gamma": (2.0, PA + M), "Y": Y, "c_strain": (c, ONE), "a": (1e-3, M)},
            [N, M, J, PA + M, M, N, J, M],
            f"flattened[{c}]",
        )
        for c in (0.82, 1e6)
    ),
    Row(oblique.maw_barber_fawcett, {"psi_1": (2.0, ONE), "kappa": (0.8, ONE)}, ONE),
    Row(yielding.yield_speed, IMPACT | {"p_y": P}, SPEED),
    Row(printed.thornton_restitution, {"speed": V, "v_y": (0.5, SPEED)}, ONE),
    Row(printed.johnson_restitution, IMPACT | {"speed": (50.0, SPEED), "p_m": P}, ONE),
    Row(
        printed.johnson_plane_restitution,
        {"speed": (50.0, SPEED), "p_m": P, "E_star": E_STAR, "density": (7850.0, DENSITY)},
        ONE,
    ),
    Row(printed.wu_restitution, {"speed": (50.0, SPEED), "v_y0": (0.1, SPEED)}, ONE),
    Row(timestep.sticking_packing, {"kappa": (0.8, ONE), "contacts": (12.0, ONE)}, ONE),
    Row(timestep.retreating_packing, {"screening_": (0.4, ONE)}, ONE),
    Row(timestep.pressed_radius, {"relative_density": (0.9, ONE)}, ONE),
    Row(timestep.screening, {"radius": (0.4, ONE), "poisson_ratio_": NU, "contacts": (8.0, ONE)}, ONE),
    Row(timestep.stability_limit, {"E_star": E_STAR, "m_star": M_STAR, "radius": A}, S),
    Row(
        timestep.rayleigh_time,
        {"radius": R_STAR, "density": (7850.0, DENSITY), "young_modulus": E, "poisson_ratio_": NU},
        S,
    ),
    Row(timestep.hertz_time, IMPACT | {"speed": V}, S),
    *(row for name in LAWS for row in law_rows(name)),
]

# a fit with its own unit, words, an integration in steps, and those that the rows above call under another name
OTHERWISE = {"printed.bridges_restitution", "oblique.impact", "oblique.one_spring", "waves.energy_split"}
OTHERWISE |= {"waves.history", "restitution.impact", "restitution.e_n", "restitution.loading_time"}
OTHERWISE |= {"yielding.first_yield_speed", "partial_slip.rebound"}


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_other_units_of_mass_length_and_time_give_the_same_quantity(row):
    here = row.function(**{name: value for name, (value, _) in row.arguments.items()})
    rng = np.random.default_rng(5)
    for _ in range(3):
        base = 10.0 ** rng.uniform(-3, 3, 3)  # the new base units in SI; a speed keeps between 1e-6 and 1e6

        def unit(powers, base=base):
            return np.prod(base**powers)

        there = row.function(**{name: value / unit(powers) for name, (value, powers) in row.arguments.items()})
        for x, y, powers in zip(
            *((here, there, row.result) if isinstance(row.result, list) else ((here,), (there,), (row.result,))),
            strict=True,
        ):
            # round-off of fractional powers of numbers up to 1e30, and of 10^3 time steps
            assert y * unit(powers) == pytest.approx(x, rel=1e-10, abs=0)
            assert np.all(np.isfinite(x))


def test_no_function_of_these_modules_is_missing_from_the_table():
    modules = (oblique, pair, partial_slip, printed, restitution, timestep, waves, yielding)
    public = {
        f"{m.__name__.rpartition('.')[2]}.{name}"
        for m in modules
        for name, f in vars(m).items()
        if inspect.isfunction(f) and f.__module__ == m.__name__ and not name.startswith("_")
    }
    assert public - OTHERWISE == {str(row) for row in ROWS if inspect.getmodule(row.function) in modules}
