# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressed and released lattices of the law of dense beds in numpy, against finite elements."""

import elastic_sphere
import numpy as np
import pytest

from bed import PLANE, Bed, Material
from bed_lattices import distance_at, recovery, released, side_force_left
from dense_lattices import (
    DEVIATIONS,
    LATTICES,
    MATERIALS,
    RELEASES,
    STEPS,
    deviation,
    finite_elements,
    pressed,
    smooth,
    stands,
    table,
)
from epdem.theory import pair
from epdem.theory.cavity import FINITE_STRAIN, Cavity


@pytest.fixture(scope="module")
def curves():
    return pressed(list(DEVIATIONS))


@pytest.mark.parametrize("name", DEVIATIONS)
def test_pressure_of_lattices_against_finite_elements(name, curves):
    """The deviations were computed by another program from the same formulas; they are those of docs/press.md."""
    density, expected = DEVIATIONS[name]
    error = 100 * deviation(name, density, curves[name])
    assert np.abs(error - expected).max() < 1.0


def test_without_growth_the_pressure_of_dense_lattices_is_far_too_low():
    for name, curve in pressed(["fcc", "bcc", "sc", "hex"], grows=False).items():
        assert deviation(name, [0.95], curve)[0] < -0.2


@pytest.mark.parametrize(("name", "by_law", "by_elements"), [("die", 0.43, 0.44), ("die_soft", 0.26, 0.34)])
def test_side_stress_of_a_die(name, by_law, by_elements, curves):
    """Over the axial stress at D = 0.85; without growth there is none."""
    at, szz, sxx = finite_elements(name, np.array([0.85]))
    d, axial, lateral = curves[name]
    assert np.interp(-at, -d, lateral / axial) == pytest.approx(by_law, abs=0.01)
    assert sxx / szz == pytest.approx(by_elements, abs=0.01)
    assert not pressed([name], grows=False)[name][2].any()


@pytest.mark.parametrize(
    ("name", "E", "density", "expected"),
    [("die", 120, (0.65, 0.80, 0.90, 0.95), (1.16, 0.93, 0.84, 0.72)), ("die_soft", 30, (0.80, 0.90), (0.78, 0.79))],
)
def test_side_force_of_a_die_over_that_of_elements_that_stand(name, E, density, expected, curves):
    """Those of docs/press.md; while the elements stand they lose less than a tenth of their moving stresses."""
    rows = [row for row in stands() if row[:2] == ("die", E) and row[2] in density]
    axial, lateral = np.array([row[3:] for row in rows]).T
    at, szz, sxx = finite_elements(name, np.array(density))
    assert np.abs([axial / szz - 0.95, lateral / sxx - 0.95]).max() < 0.05
    d, _, by_law = curves[name]
    assert np.interp(-at, -d, by_law) / lateral == pytest.approx(expected, abs=0.015)


@pytest.mark.parametrize(
    ("name", "densities", "by_law", "by_elements"),
    [
        ("", (0.65, 0.80, 0.90, 0.95), (0.57, 0.39, 0.36, 0.36), (0.00, 0.29, 0.32, 0.34)),
        ("_soft", (0.80, 0.90, 0.95), (0.69, 0.59, 0.57), (0.44, 0.57, 0.61)),
    ],
)
def test_side_force_of_a_die_that_is_left_after_the_release(name, densities, by_law, by_elements):
    """Over that before; another program computed the numbers of the law from the same formulas."""
    material = MATERIALS[name]
    rows = [row for row in stands(left=True) if row[:2] == ("die", material.E) and row[2] in densities]
    assert [row[-1] for row in rows] == pytest.approx(by_elements, abs=0.01)
    assert side_force_left(material, np.array(densities)) == pytest.approx(by_law, abs=0.015)


@pytest.fixture(scope="module")
def releases():
    cases = [(LATTICES[name], Material(E, nu, 1.0), D) for name, E, nu, D, *_ in RELEASES]
    return released(cases, steps=STEPS)


def ratios(releases, shares=(0.75, 0.5, 0.25, 0.02)):
    """(row, recovery of the law over that of finite elements at shares of the force)."""
    for row, curve in zip(RELEASES, releases, strict=True):
        yield row, np.array([recovery(curve, share) / row[-1][share] for share in shares])


def test_recovery_of_released_lattices_against_finite_elements(releases):
    """To D = 0.95, nu = 0.2 and 0.34: at 2 % of the force 0.77 to 1.06, at 75, 50 and 25 % 0.82 to 1.18."""
    found = np.array([r for (_, _, nu, D, *_), r in ratios(releases) if nu in (0.2, 0.34) and D <= 0.95])
    assert len(found) == 22
    assert found[:, 3].min() > 0.77 and found[:, 3].max() < 1.06
    assert found[:, :3].min() > 0.82 and found[:, :3].max() < 1.185


def test_recovery_at_other_poisson_ratios_and_at_the_limit(releases):
    """Above D = 0.95 and beside nu = 0 and 0.45 the last of the force comes back up to 37 % too early."""
    found = np.array([r for (_, _, nu, D, *_), r in ratios(releases) if nu not in (0.2, 0.34) or D > 0.95])
    assert len(found) == 8
    assert found[:, :3].min() > 0.86 and found[:, :3].max() < 1.35
    assert found[:, 3].min() > 0.62 and found[:, 3].max() < 1.12


@pytest.mark.parametrize(("name", "density"), [("fcc", 0.80), ("fcc", 0.85), ("fcc", 0.95), ("sc", 0.65), ("sc", 0.90)])
def test_recovery_against_the_elastic_sphere(name, density):
    """Superposition on an elastic sphere from the peak of the law meets finite elements within 6 %."""
    lattice, material = LATTICES[name], MATERIALS[""]
    n = sum(lattice.counts)
    bed = Bed(np.ones(1), np.zeros(n, int), np.full(n, PLANE), material)
    for d in np.linspace(1.0, float(distance_at(lattice, density)), STEPS)[1:]:
        bed.step(np.full(n, 1 - d))
    law = Cavity(E_star=120 / (1 - 0.34**2), R_star=1.0, Y=1.0, c_strain=FINITE_STRAIN)
    b = bed.peak[0]
    peak = {"force": float(law.force(b)), "radius": float(law.radius(b)), "tau": float(law.flatness(b))}
    (row,) = [r for r in RELEASES if (r[0], r[1], r[2], r[3]) == (name, 120.0, 0.34, density)]
    for share in (0.75, 0.5):
        series = elastic_sphere.recovery(elastic_sphere.DIRECTIONS[name], share, **peak, E=120.0, nu=0.34)
        assert series == pytest.approx(row[-1][share], rel=0.06)


# ball over the radius of the sphere: deviation [%] of the force at OVERLAPS of one side; last by the strain w a/R*
OVERLAPS = np.array([0.02, 0.04, 0.08, 0.12, 0.16, 0.20, 0.25])
UNLIKE = {
    np.inf: ((3, 1, -8, -6, 3, 10, 16), (3, 1, -8, -6, 3, 10, 16)),
    4.0: ((7, -1, -10, -11, -7, -1, 6), (3, -7, -17, -20, -17, -13, -9)),
    1.0: ((8, -4, -10, -10, -9, -6, -2), (-5, -20, -31, -35, -37, -39, -40)),
    0.5: ((4, -3, -4, 1, 7, 14, 21), (-14, -28, -37, -41, -43, -45, -49)),
}


@pytest.mark.parametrize("ball", UNLIKE)
def test_a_soft_sphere_between_hard_ones_of_any_size_against_finite_elements(ball):
    """The pressure falls with the contact radius over the radius of the softer body, not with the strain w a/R*."""
    d, F = table("pair_plane" if ball == np.inf else f"pair_{ball:g}")
    E, nu, R_star = MATERIALS[""].E, MATERIALS[""].nu, float(pair.R_star(1.0, ball))
    reference = smooth(d, F[:, 0], 1.0 - OVERLAPS)
    for share, expected in zip((pair.curvature_share(1.0, R_star=R_star, R1=1.0), 1.0), UNLIKE[ball], strict=True):
        law = Cavity(E_star=E / (1 - nu**2), R_star=R_star, Y=1.0, c_strain=FINITE_STRAIN, share=share)
        assert np.abs(100 * (law.force(OVERLAPS) / reference - 1) - expected).max() < 1.0
