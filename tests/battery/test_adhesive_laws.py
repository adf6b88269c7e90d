# SPDX-License-Identifier: GPL-2.0-or-later
"""The adhesive laws of C++ against theory: force on prescribed paths, the life of a contact, impacts, sticking."""

from dataclasses import replace

import numpy as np
import pytest
from adhesive import DENSITY, E_STEEL, R_FINE, Contact, ask, e_n_errors, impacts
from hypothesis import given, settings
from hypothesis import strategies as st

from epdem.theory import adhesion, restitution
from epdem.theory.cavity import Cavity

CONTACTS = {
    "jkr": Contact(),
    "3.04 GPa": Contact(3.04e9),
    "1 GPa": Contact(1e9),
    "0.5 GPa": Contact(0.5e9),
    "cavity, yields late": Contact(1e9 / 2.8, Gamma=0.02, cavity=True),
    "cavity, yields at touch": Contact(1e9 / 2.8, Gamma=0.2, cavity=True),
    "cavity, finite strain": Contact(2e9, Gamma=30.0, cavity=True, c_strain=0.82),
}
every_contact = pytest.mark.parametrize("c", CONTACTS.values(), ids=CONTACTS)


def extremes(count: int, seed: int) -> list[tuple[Contact, float]]:
    """Impacts at 3 to 3000 V_s; Gamma 1e-6 to 10 J/m^2, R* 1 um to 10 mm, p_y/E* 1e-4 to 0.1; a_max < 0.3 R*."""
    rng, cases = np.random.default_rng(seed), []
    while len(cases) < count:
        p_y = None if rng.random() < 0.1 else 1.18e11 * 10 ** rng.uniform(-4, -1)
        c = Contact(p_y, 10 ** rng.uniform(-6, 1), 10 ** rng.uniform(-6, -2), 1.18e11)
        V = c.V_s * (3.0 if rng.random() < 0.3 else 10 ** rng.uniform(np.log10(3), np.log10(3000)))
        if c.theory.radius_of_work(0.5 * c.m_star * V * V) < 0.3 * c.R_star:  # as far as small deformation goes
            cases.append((c, V))
    return cases


@every_contact
def test_force_and_radius_follow_the_theory_on_the_way_in_and_out_and_in_again(c):
    law, peak = c.theory, 40 * -c.theory.fold_overlap
    top = law.radius(peak)
    branch, dent = law.branch(top)
    rising = np.geomspace(1e-4, 1, 60) * peak
    falling = peak - (peak - dent - 0.999 * branch.fold_overlap) * np.linspace(0.01, 1, 80)
    beyond = peak * np.linspace(1.05, 3, 10)
    F, a, U = c.path([*rising, *falling, *falling[::-1], *beyond])
    a_theory = [law.radius(rising), *[branch.radius(falling - dent)] * 2, law.radius(beyond)]
    a_theory[2] = a_theory[2][::-1]
    F_theory = [law.force(a_theory[0]), *map(branch.force, a_theory[1:3]), law.force(a_theory[3])]
    # rounding of the overlap is seen as its root near the fold
    assert a == pytest.approx(np.concatenate(a_theory), abs=1e-9 * top)
    assert np.abs(F - np.concatenate(F_theory)).max() <= 1e-10 * law.force(top)
    assert np.array_equal(F[60:140], F[140:220][::-1])  # to the last bit
    assert U[60:140] == pytest.approx(branch.energy(a_theory[1]), abs=1e-10 * branch.energy(top))
    if c.p_y is None:
        assert U[:60] == pytest.approx(law.energy(a_theory[0]), abs=1e-10 * branch.energy(top))


@every_contact
@pytest.mark.parametrize("peak", [5, 40, 1000])
def test_pull_off_force_by_slow_separation(c, peak):
    """3/2 pi Gamma R_p of a JKR contact, to 1e-6."""
    peak = peak * -c.theory.fold_overlap
    branch, dent = c.theory.branch(c.theory.radius(peak))
    F, _, _ = c.path([peak, *(dent + branch.fold_overlap * np.linspace(-0.1, 1.01, 20_000))])
    expected = float(branch.pull_off_force) if c.cavity else 1.5 * np.pi * c.Gamma * float(branch.R_star)
    assert F.min() == pytest.approx(-expected, rel=1e-6)
    assert F[-1] == 0


@every_contact
def test_no_contact_reaches_farther_than_the_elastic_fold(c):
    """However far it has grown before it is pulled off: an engine looks for pairs as far as this, and no farther."""
    ((gap,),) = ask([f"gap {c.words}"])
    assert gap == pytest.approx(1.6087720 * np.cbrt(c.Gamma**2 * c.R_star / c.E_star**2), rel=1e-7)
    for peak in np.geomspace(1e-3, 1e3, 25) * gap:
        overlaps = np.linspace(peak, -1.05 * gap, 2000)
        F, a, _ = c.path([peak, *overlaps])
        assert overlaps[a[1:] > 0].min() >= -gap
        assert F[-1] == 0


@every_contact
def test_a_contact_forms_at_zero_overlap_pulls_at_a_distance_and_ends_at_the_fold(c):
    fold = c.theory.fold_overlap
    F, a, _ = c.path([0.5 * fold, -1e-15, 0.0, 1e-15, -1e-15, 0.5 * fold])
    assert np.all(F[:3] == 0)
    assert np.all(a[:3] == 0)  # nothing before touch
    assert F[3:5] == pytest.approx(float(c.theory.force(c.theory.touch_radius)), rel=1e-4)
    touch = c.theory.branch(c.theory.radius(1e-15))
    ends = touch[1] + touch[0].fold_overlap
    F, a, _ = c.path([1e-15, ends * (1 - 1e-9), ends * (1 + 1e-9), 0.5 * ends, 1e-15])
    assert F[1] == pytest.approx(float(touch[0].force(touch[0].fold_radius)), rel=1e-3)
    assert np.all(F[2:4] == 0)  # ended, and again apart until it touches
    assert np.all(a[2:4] == 0)
    assert F[4] < 0


@pytest.mark.parametrize("c", [c for c in CONTACTS.values() if c.p_y and c.p_y < 3e9])
def test_a_contact_that_broke_in_its_dent_forms_again_there_and_forgets_outside(c):
    law, peak = c.theory, 400 * -c.theory.fold_overlap
    branch, dent = law.branch(law.radius(peak))
    ends = dent + branch.fold_overlap
    assert ends > 0
    F, a, _ = c.path(
        [peak, ends * 0.999, dent * 0.999, dent * 1.0001, ends * 1.001, peak, ends * 0.99, 0.0, 0.1 * dent]
    )
    assert np.all(F[1:3] == 0)
    assert F[3] == pytest.approx(float(branch.force(branch.radius(1e-4 * dent))), rel=1e-6)
    assert F[4] == pytest.approx(float(branch.force(branch.radius(ends * 1.001 - dent))), rel=1e-6)
    assert F[5] == pytest.approx(float(law.force(law.radius(peak))), rel=1e-12)
    assert F[6] == F[7] == 0
    assert F[8] == pytest.approx(float(law.force(law.radius(0.1 * dent))), rel=1e-12)  # new ground after alpha = 0


@pytest.mark.parametrize(("name", "p_y"), [("hertz", None), ("thornton", 1e9), ("cavity", 0.4e9)])
@given(shares=st.lists(st.floats(1e-6, 1), min_size=1, max_size=60))
def test_without_adhesion_the_forces_are_those_of_the_other_headers(name, p_y, shares):
    """Any path of overlaps up to R*/10: to 1e-12 of the largest force."""
    c = Contact(p_y, Gamma=0.0, cavity=name == "cavity")
    overlaps = 0.1 * R_FINE * np.array(shares)
    words = f"{name} {c.E_star!r} {c.R_star!r} {p_y or 0.0!r} {len(shares)}"
    (row,) = ask([f"{words} {' '.join(repr(float(x)) for x in overlaps)}"])
    F, a, U = c.path(overlaps)
    assert np.abs(F - row[::3]).max() <= 1e-12 * row[::3].max()
    assert np.abs(a - row[1::3]).max() <= 1e-7 * row[1::3].max()  # at the dent a goes as the root of the overlap
    assert np.abs(U - row[2::3]).max() <= 1e-11 * row[2::3].max()


def test_without_adhesion_an_impact_is_that_of_the_other_theory():
    """The step of parting of a contact that pulls with nothing has a force of 0."""
    c = Contact(1e9 / 2.8, Gamma=0.0, cavity=True)
    for V in (0.1, 1.0, 10.0):
        exact = restitution.impact(Cavity(E_star=E_STEEL, R_star=R_FINE, Y=c.p_y), m_star=c.m_star, speed=V)
        ((rebound, *_),) = ask([c.line(V, float(exact.contact_time) / 400, 0.3, 800)])
        assert rebound / V == pytest.approx(float(exact.e_n), abs=5e-5)


@settings(max_examples=200)
@given(
    st.lists(st.floats(-1e100, 1e100), min_size=1, max_size=20), st.sampled_from([*CONTACTS.values()]), st.booleans()
)
def test_force_is_never_nan_for_any_finite_overlap(overlaps, c, adheres):
    F, a, U = replace(c, Gamma=c.Gamma if adheres else 0.0).path(overlaps)
    assert not np.isnan([F, a, U]).any()
    assert np.all(a >= 0)


NEAR_THE_LIMIT = Contact(1e9 / 2.8, Gamma=0.999 * 0.2155120, cavity=True)
SOFT = Contact(0.02 * E_STEEL, Gamma=0.999 * 5.953794 * 0.02**3 * E_STEEL * R_FINE, cavity=True, c_strain=0.82)


@pytest.mark.parametrize("c", [*CONTACTS.values(), NEAR_THE_LIMIT, SOFT])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_random_walk_takes_no_energy_out_of_a_contact_and_the_books_close(c, seed):
    """Work of the force by trapezoids = stored + yield + adhesion at each step; the steps in which the force jumps are
    left out of both, for they count as adhesion's. Half of the walk stays where the contact touches and parts."""
    rng, unit = np.random.default_rng(seed), -float(c.theory.fold_overlap)
    far = np.concatenate([rng.uniform(-1.2, 6, 12), rng.uniform(-1.2, 60, 8)])
    marks = unit * np.concatenate([[-1.0], far, [-1.2]])
    overlaps = np.concatenate([np.linspace(x, y, 4001)[1:] for x, y in zip(marks[:-1], marks[1:], strict=True)])
    (row,) = ask([f"books {c.words} {len(overlaps)} {' '.join(repr(float(x)) for x in overlaps)}"])
    F, U, plastic, adhesive = np.reshape(row, (-1, 4)).T
    work = 0.5 * (F[1:] + F[:-1]) * np.diff(overlaps)
    jumps = (F[1:] == 0) != (F[:-1] == 0)
    gained = np.cumsum(np.where(jumps, 0.0, work - np.diff(U) - np.diff(plastic)))
    size = np.abs(work).sum()
    assert np.abs(gained).max() <= 1e-4 * size
    assert np.all(np.diff(adhesive) >= 0)
    assert np.all(np.diff(plastic) >= -1e-14 * size)
    missing = np.abs(np.diff(U) + np.diff(plastic) + np.diff(adhesive))[jumps]
    # beside the jump the force acts for a part of its step
    assert np.all(missing <= 1.1 * (np.abs(F[1:] + F[:-1]) * np.abs(np.diff(overlaps)))[jumps] + 1e-14 * size)


@every_contact
def test_the_same_step_taken_twice_gives_the_same_bits(c):
    unit = -c.theory.fold_overlap
    once = unit * np.array([0.3, 4, 70, 70.5, 60, 30, 80, 79])
    F, a, _ = c.path(np.repeat(once, 2))
    assert np.array_equal(F[::2], F[1::2])
    assert np.array_equal(a[::2], a[1::2])


def test_restitution_at_400_steps_over_the_whole_domain():
    """8 phases. Beyond this domain, at a_max = R* and e_n = 0.01, 1.1e-4 is reached."""
    assert e_n_errors(extremes(250, seed=5), 400).max() <= 6e-5


@every_contact
def test_restitution_converges_with_second_order(c):
    """Largest error over 16 phases and 5 speeds, 16 times less at a quarter of the step; 11 leaves room to scatter."""
    cases = [(c, factor * c.V_s) for factor in (3, 6, 20, 60, 600)]
    coarse, fine = e_n_errors(cases, 200, phases=16), e_n_errors(cases, 800, phases=16)
    assert coarse.max() >= 11 * fine.max()
    assert fine.max() <= 5e-6


def test_restitution_converges_where_the_contact_yields_in_the_moment_of_touch():
    """The jump of touch is then the plastic one; it counts close to the sticking speed and at small steps only."""
    c = Contact(0.25e9)
    assert c.theory.touch_radius > c.theory.yield_radius
    cases = [(c, 1.1 * c.V_s)]
    assert e_n_errors(cases, 800)[0] >= 8 * e_n_errors(cases, 3200)[0]


@pytest.mark.parametrize("p_y", [0.5e9, 0.25e9])
def test_a_second_impact_on_the_dent_is_that_of_an_elastic_contact_of_its_radius(p_y):
    """It is slower than the first, so that it does not yield. 8 phases by the golden ratio."""
    c, errors = Contact(p_y), []
    for steps in (400, 1600):
        for V in (3 * c.V_s, 10 * c.V_s):
            x = adhesion.impact(c.theory, m_star=c.m_star, speed=V)
            branch, _ = c.theory.branch(x.radius_max)
            out = V * float(x.e_n)
            back = out * float(adhesion.e_n(branch, m_star=c.m_star, speed=out))
            phases = (0.3 + 0.618034 * np.arange(8)) % 1
            lines = [c.line(V, float(x.contact_time) / steps, float(phase), 20 * steps) for phase in phases]
            rows = ask([line.replace("impact", "twice") for line in lines])
            errors.append(max(abs(row[0] - back) / out for row in rows))
    assert max(errors[:2]) <= 1e-4
    assert max(errors[:2]) >= 8 * max(errors[2:])


@every_contact
def test_an_impact_agrees_with_theory_in_all_that_can_be_seen_of_it(c):
    """Peaks are samples: the square of a step misses them; the last sample lies within one step of the end."""
    cases = [(c, factor * c.V_s) for factor in (3, 10, 300)]
    theory, found = impacts(cases, 400)
    for k, x in enumerate(theory):
        dt = float(x.contact_time) / 400
        V_out = float(x.e_n) * cases[k][1]
        assert found["force_max"][k] == pytest.approx(float(x.force_max), rel=2e-4)
        assert found["overlap_max"][k] == pytest.approx(float(x.overlap_max), rel=1e-4)
        pull = -found["force_min"][k] / float(c.theory.branch(x.radius_max)[0].pull_off_force)
        # the peak reached is that of theory to 1e-5; a fast contact opens in few steps
        assert np.all((pull <= 1 + 1e-5) & (pull >= (0.98 if k < 2 else 0.75)))
        assert np.all(found["last_step"][k] * dt <= float(x.contact_time) + 1.01 * dt)
        assert np.all(found["last_step"][k] * dt >= float(x.contact_time) - 1.01 * dt)
        over = found["last_overlap"][k] - float(x.residual_overlap)
        assert np.all((over >= -0.01 * V_out * dt) & (over <= 1.1 * V_out * dt))


@pytest.mark.parametrize("c", [*CONTACTS.values(), Contact(0.25e9)])
@pytest.mark.parametrize("phase", [0.1, 0.6])
def test_bodies_stick_up_to_the_sticking_speed(c, phase):
    """By bisection between V_s/2 and 2 V_s; 400 steps of the contact at 3 V_s. Seen: within 1.2e-4."""
    dt = float(adhesion.contact_time(c.theory, m_star=c.m_star, speed=3 * c.V_s)) / 400
    low, high = 0.5 * c.V_s, 2 * c.V_s
    for _ in range(13):
        V = 0.5 * (low + high)
        ((rebound, *_),) = ask([c.line(V, dt, phase, 2000)])
        low, high = (low, V) if rebound > 0 else (V, high)
    assert 0.5 * (low + high) == pytest.approx(c.V_s, rel=1e-3)


@every_contact
def test_a_sticking_pair_oscillates_and_neither_parts_nor_gains(c):
    """10,000 steps at half the sticking speed: still attached, and never deeper than the first approach."""
    V = 0.5 * c.V_s
    dt = float(adhesion.contact_time(c.theory, m_star=c.m_star, speed=3 * c.V_s)) / 400
    x = adhesion.impact(c.theory, m_star=c.m_star, speed=V)
    ((rebound, force_max, overlap_max, *_),) = ask([c.line(V, dt, 0.3, 10_000)])
    assert rebound == 0
    assert overlap_max == pytest.approx(float(x.overlap_max), rel=1e-3)
    assert force_max == pytest.approx(float(x.force_max), rel=5e-3)


def test_scaling_changes_nothing():
    """New units by powers of two: the same restitution to the last digits."""
    c = Contact(1e9)
    mass, length, time = 2.0**7, 2.0**-9, 2.0**5
    pressure = mass / (length * time**2)
    d = Contact(1e9 * pressure, 0.2 * pressure * length, R_FINE * length, E_STEEL * pressure)
    m, dt = c.m_star * mass, 1e-9
    line = f"impact {d.words} {m!r} {0.3 * length / time!r} {dt * time!r} 0.0 4000"
    (here,), (there,) = ask([c.line(0.3, dt, 0.0, 4000)])[:1], ask([line])
    assert DENSITY * there[0] * time / length == pytest.approx(DENSITY * here[0], rel=1e-11)
    assert there[5] == here[5]
