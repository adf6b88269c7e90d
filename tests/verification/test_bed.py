# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts of one body that feel each other, in numpy: limits, symmetry, energy, and the elastic sphere."""

import elastic_sphere
import numpy as np
import pytest

import bed as model
from bed import PLANE, RIGID, Bed, Material
from epdem.theory.cavity import FINITE_STRAIN, Cavity

HARD, SOFT, SOFTEST = Material(120.0, 0.34, 1.0), Material(30.0, 0.2, 1.0), Material(10.0, 0.3, 1.0)


def between_planes(material, planes, spheres=1):
    return Bed(np.ones(spheres), np.repeat(np.arange(spheres), planes), np.full(spheres * planes, PLANE), material)


def falls(bed, overlaps):
    """Largest fall of the dissipation of each sphere over its largest work; overlaps: (steps, contacts)."""
    before, force = overlaps[0], bed.step(overlaps[0])
    work, found, n = np.zeros(len(force)), [], len(bed.radius)
    for now in overlaps[1:]:
        after = bed.step(now)
        work = work + 0.5 * (force + after) * (now - before)
        before, force = now, after
        found.append([np.bincount(bed.i, work, n), np.bincount(bed.i, bed.stored, n) - bed.taken()])
    total, stored = np.moveaxis(found, 1, 0)
    lost = total - stored
    return (np.maximum.accumulate(lost) - lost).max(axis=0) / total.max(axis=0), lost[-1] / total.max(axis=0)


@pytest.mark.parametrize(("n", "x"), [(6, 0.05), (6, 0.1), (12, 0.03), (12, 0.06)])
def test_grown_spheres_keep_their_volume(n, x):
    """Caps of n planes at depth x by the exact volume of a cap; what the growth leaves out is of the third order."""
    g = model.growth(np.array(n * x), np.array(n * x**2))
    R, h = 1 + g, x + g
    volume = R**3 - 0.75 * n * h**2 * (R - h / 3)  # over that of the sphere
    assert abs(volume - 1) < 0.05 * (n * x) ** 3 / n


def test_a_contact_alone_is_that_of_the_law():
    bed = between_planes(HARD, 1)
    law = Cavity(E_star=120 / (1 - 0.34**2), R_star=1.0, Y=1.0, c_strain=FINITE_STRAIN)
    way = np.concatenate([np.linspace(1e-3, 0.2, 50), np.linspace(0.2, 0.19, 20), np.linspace(0.19, 0.3, 20)])
    found = np.array([bed.step(np.array([x]))[0] for x in way])
    most = np.maximum.accumulate(way)
    assert np.array_equal(found, law.unloading_force(most - (most - way), most))
    assert not bed.screened.any() and bed.shift[0] == bed.retreat[0] == bed.grown[0] == 0.0


@pytest.mark.parametrize(
    "path", [np.linspace(0, 0.15, 60), np.concatenate([np.linspace(0, 0.1, 50), np.linspace(0.0995, 0.09, 20)])]
)
def test_like_spheres_are_mirror_images_of_a_sphere_at_a_plane(path):
    """Two spheres that touch, each with five planes, beside one sphere with six; the shared contact has 2 alpha."""
    one = between_planes(HARD, 6)
    i, j = np.array([0] * 5 + [1] * 5 + [0]), np.array([PLANE] * 10 + [1])
    two = Bed(np.ones(2), i, j, HARD)
    sides = np.outer(path, np.linspace(0.5, 1.0, 5))
    F = np.array([one.step(np.append(s, x)) for s, x in zip(sides, path, strict=True)])
    G = np.array([two.step(np.concatenate([s, s, [2 * x]])) for s, x in zip(sides, path, strict=True)])
    assert np.abs(G[:, 5:] - F).max() < 1e-11 and np.abs(G[:, :5] - F[:, :5]).max() < 1e-11 < F.max()
    assert two.stored[-1] == pytest.approx(2 * one.stored[-1], rel=1e-10)
    assert two.taken() == pytest.approx(np.repeat(one.taken(), 2), rel=1e-10)


def test_elastic_cycles_lose_nothing_and_plastic_ones_some():
    """Three cycles of 6 and of 12 planes, E/Y 120, 30 and 10, to just below and above the overlap of first yield."""
    materials = [HARD, SOFT, SOFTEST]
    laws = [Cavity(E_star=m.E / (1 - m.nu**2), R_star=1.0, Y=1.0, c_strain=FINITE_STRAIN) for m in materials]
    wave = np.abs(np.sin(np.linspace(1e-6, 3 * np.pi - 1e-6, 601)))
    for planes in (6, 12):
        for level in (0.5, 0.999, 1.2):
            overlaps = np.outer(wave, np.repeat([level * law.yield_overlap for law in laws], planes))
            fall, lost = falls(between_planes(materials, planes, 3), overlaps)
            if level < 1:
                assert np.abs(lost).max() < 1e-12
            else:
                assert lost.min() > 0.005 and fall.max() < 1e-4


def walks(steps, spheres, planes, largest, seed=3):
    """Overlaps of random walks of planes: sums of waves of random phases, which part and come back."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 1.0, steps + 1)[:, None]
    x = sum(rng.normal(size=spheres * planes) / k**0.7 * np.sin(2 * np.pi * (k * t + rng.random(spheres * planes)))
            for k in range(1, 7))  # fmt: skip
    return largest * np.minimum(1.0, 4 * t) * (x / 1.5 + 0.2 * np.minimum(t, 1.0)) - 1e-3


def test_random_walks_create_energy_of_second_order_only():
    """Six planes about one sphere each, E/Y 120, 30 and 10."""
    materials = [HARD, SOFT, SOFTEST]
    found = [
        falls(between_planes(materials, 6, len(materials)), walks(n, len(materials), 6, 0.12))[0].max()
        for n in (100, 200, 400)
    ]
    assert found[-1] < 6e-4 and found[0] > 3 * found[1] > 9 * found[2]


def test_a_hard_sphere_among_soft_ones_does_not_grow():
    """Four neighbors of a fifth of the strength; the soft sphere among hard ones takes all dents."""
    hard = Material(120.0, 0.34, 5.0)
    i, j = np.zeros(4, int), np.arange(1, 5)
    added = {}
    for name, materials in (("hard", [hard] + [HARD] * 4), ("soft", [HARD] + [hard] * 4), ("like", [HARD] * 5)):
        bed = Bed(np.ones(5), i, j, materials)
        for x in np.linspace(0, 0.1, 50):
            bed.step(np.full(4, x))
        added[name] = bed.grown[0]
    assert added["hard"] == 0.0 < added["like"] < added["soft"]


def test_a_rigid_neighbor_has_the_modulus_and_share_of_a_plane():
    bed = Bed(np.array([1.0, 1e9]), np.array([0, 0]), np.array([1, PLANE]), [HARD, RIGID])
    F = bed.step(np.array([0.05, 0.05]))
    assert F[0] == pytest.approx(F[1], rel=1e-8)


def test_recovery_of_an_elastic_sphere_follows_from_its_equations():
    """Displacement by r^(n+1) and r^(n-1) solutions (Lur'e), from two linear equations: no shear, unit pressure."""
    nu, G = 0.3, 1 / 2.6
    for n in (0, 2, 3, 10, 50):
        if n == 0:  # u = A r, sigma = 3 K A
            expected = (1 - 2 * nu) * 1.0
        else:
            shear = [n * n + 2 * n - 1 + 2 * nu, n - 1]
            radial = [(n + 1) * (n * n - n - 2 - 2 * nu), n * (n - 1)]
            A, B = np.linalg.solve(2 * G * np.array([shear, radial]), [0.0, 1.0])
            expected = A * (n + 1) * (n - 2 + 4 * nu) + B * n
        assert elastic_sphere.compliance(np.array(float(n)), nu) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("nu", [0.2, 0.34])
@pytest.mark.parametrize(("name", "most"), [("plates", 0.10), ("sc", 0.07), ("bcc", 0.07), ("fcc", 0.06)])
def test_gamma_is_the_recovery_of_an_elastic_sphere(name, most, nu):
    """Flat pressures on equal caps that cover 5 to 30 % of the sphere: the series over the half-space, beside gamma."""
    directions = elastic_sphere.DIRECTIONS[name]
    for share in (0.05, 0.15, 0.3):
        a = np.sqrt(4 * share / len(directions))
        alone = 16 / (3 * np.pi**2) * (1 - nu**2) / a
        series = 1 + elastic_sphere.shortening(directions, a, nu) / alone
        others = np.array((len(directions) - 1) * a * a)
        gamma = model.screening(others, np.array(a * a), np.array(1.0), np.array(nu), np.array(0.0))
        assert abs(gamma / series - 1) < most
