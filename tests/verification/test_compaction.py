# SPDX-License-Identifier: GPL-2.0-or-later
"""The growth of spheres in dense beds: closed forms, and the pressure of lattices against finite elements."""

from pathlib import Path

import numpy as np
import pytest

from epdem.theory.cavity import FINITE_STRAIN, Cavity
from epdem.verification.theory import compaction
from epdem.verification.theory.compaction import BCC, FCC, HEXAGONAL, SC

TABLES = Path(__file__).parents[2] / "data" / "compaction"
CAVITY = Cavity(E_star=120.0 / (1 - 0.34**2), R_star=1.0, Y=1.0, c_strain=FINITE_STRAIN)  # sphere on a rigid plane
SOFT = Cavity(E_star=30.0 / (1 - 0.2**2), R_star=1.0, Y=1.0, c_strain=FINITE_STRAIN)
PER_D3 = {"sc": 8.0, "fcc": 4 * 2**0.5, "bcc": 32 / 27**0.5, "hex": 4 * 3**0.5}  # cell over distance^3, from geometry


def table(name):
    rows = np.genfromtxt(TABLES / f"{name}.csv", delimiter=",", skip_header=1)
    return rows[:, 0], rows[:, 1:]


def smooth(distance, values, at, width):
    """Local parabola, which takes out the steps of the mesh."""
    found = []
    for x in at:
        near = np.abs(distance - x) < width
        found.append(np.polyfit(distance[near] - x, values[near], 2)[-1])
    return np.array(found)


def finite_elements(name, density):
    """(distance, pressure/Y) at relative densities; the virial of the forces on all planes."""
    d, F = table(name)
    lattice = name.removesuffix("_soft")
    planes = {"sc": [(6, 1.0)], "fcc": [(12, 1.0)], "bcc": [(8, 1.0), (6, 2 / 3**0.5)], "hex": [(8, 1.0)]}[lattice]
    P = sum(n * F[:, k] * ratio * d for k, (n, ratio) in enumerate(planes)) / (3 * PER_D3[lattice] * d**3)
    at = (4 * np.pi / 3 / PER_D3[lattice] / density) ** (1 / 3)
    return at, smooth(d, P, at, 0.12 * (d.max() - d.min()))


@pytest.mark.parametrize("lattice, contacts, touching", [(SC, 6, np.pi / 6), (FCC, 12, np.pi / 18**0.5)])
def test_n_equal_contacts_have_the_closed_form(lattice, contacts, touching):
    x = np.linspace(0.0, 0.1, 11)
    by_hand = contacts * x**2 / (4 - 2 * contacts * x) - x**2 / (4 - 2 * x)
    assert np.allclose(compaction.added_overlaps(lattice.counts, x[None])[0], by_hand, rtol=1e-13)
    assert compaction.relative_density(lattice, np.ones(1), 1.0) == pytest.approx(touching)


def test_a_contact_alone_does_not_grow():
    assert not compaction.added_overlaps((1,), np.linspace(0.0, 0.9, 10)[None]).any()


@pytest.mark.parametrize("lattice, most", [(SC, 0.90), (FCC, 0.90), (BCC, 0.90)])
def test_the_grown_spheres_keep_their_volume_within_one_per_cent(lattice, most):
    """Caps cut off by the planes, from the volumes of spherical caps."""
    density = np.linspace(0.75, most, 7)
    d = (4 * np.pi / 3 / lattice.cell / density) ** (1 / 3)
    depth = np.maximum(1 - np.multiply.outer(lattice.ratios, d), 0.0)
    counts = np.array(lattice.counts)[:, None]
    growth = (counts * depth**2).sum(axis=0) / (4 - 2 * (counts * depth).sum(axis=0))
    R, h = 1 + growth, np.maximum(depth + growth, 0.0)
    volume = 4 / 3 * np.pi * R**3 - (counts * np.pi * h**2 * (R - h / 3)).sum(axis=0)
    assert np.all(np.abs(volume / (4 / 3 * np.pi) - 1) < 0.011)


@pytest.mark.parametrize("name, lattice, tolerance", [("fcc", FCC, 0.12), ("bcc", BCC, 0.16), ("sc", SC, 0.16)])
def test_pressure_of_lattices_against_finite_elements(name, lattice, tolerance):
    """D from 0.80 to 0.95; without growth the largest error is at least twice as large at 0.95."""
    density = np.linspace(0.80, 0.95, 7)
    d, P = finite_elements(name, density)
    error = compaction.isotropic_pressure(lattice, CAVITY.force, d, 1.0) / P - 1
    without = compaction.isotropic_pressure(lattice, CAVITY.force, d, 1.0, grows=False) / P - 1
    assert np.abs(error).max() < tolerance
    assert without[-1] < -0.17 and without[-1] < -2 * abs(error[-1])


@pytest.mark.parametrize(
    "name, lattice, law, least, tolerance",
    [
        ("hex", HEXAGONAL, CAVITY, 0.65, 0.165),
        ("fcc_soft", FCC, SOFT, 0.78, 0.16),
        ("bcc_soft", BCC, SOFT, 0.73, 0.16),
        ("sc_soft", SC, SOFT, 0.65, 0.16),
        ("hex_soft", HEXAGONAL, SOFT, 0.65, 0.16),
    ],
)
def test_pressure_of_other_lattices_and_softer_spheres(name, lattice, law, least, tolerance):
    """D up to 0.95; no parameter of the law was chosen with these tables."""
    d, P = finite_elements(name, np.linspace(least, 0.95, 9))
    error = compaction.isotropic_pressure(lattice, law.force, d, 1.0) / P - 1
    without = compaction.isotropic_pressure(lattice, law.force, d, 1.0, grows=False) / P - 1
    assert np.abs(error).max() < tolerance
    assert np.abs(error).max() < 0.6 * np.abs(without).max()


@pytest.mark.parametrize("name, law", [("die", CAVITY), ("die_soft", SOFT)])
def test_axial_and_side_stress_of_a_die_against_finite_elements(name, law):
    """A cell is 2 x 2 x 2 d: szz = F/4, sxx = F/(4 d)."""
    density = np.linspace(0.60, 0.95, 8)
    distance, (side, top) = table(name)[0], table(name)[1].T
    d = np.pi / 6 / density
    width = 0.12 * (distance.max() - distance.min())
    szz, sxx = smooth(distance, top / 4, d, width), smooth(distance, side / (4 * distance), d, width)
    axial, lateral = compaction.die_stresses(law.force, d, 1.0)
    assert np.abs(axial / szz - 1).max() < 0.32
    assert np.abs(lateral / axial - sxx / szz).max() < 0.15
    assert not compaction.die_stresses(law.force, d, 1.0, grows=False)[1].any()
