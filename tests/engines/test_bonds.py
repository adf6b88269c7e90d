# SPDX-License-Identifier: GPL-2.0-or-later
"""Cohesion bond beside compaction: two spheres in every host, lattices under tension in LAMMPS, refusals."""

from dataclasses import replace

import lammps_lattices
import numpy as np
import pytest
from free_spheres import ELASTIC, FORCE, HOSTS, PLACE, PLASTIC, VELOCITY, Scene, frames
from lammps_decks import needs_lammps
from lammps_decks import run as run_lammps

from bed import PLANE, Bed, Material
from bed_lattices import distance_at, isotropic_pressure
from dense_lattices import LATTICES
from epdem.theory.cavity import Cavity
from epdem.theory.pair import E_star
from marks import thorough

R, SPEED, STRENGTH = 1e-3, 3.0, 20e6
POWDER = {"E": 10e9, "nu": 0.3, "density": 8000.0, "yieldStress": 50e6}
LAW = Cavity(E_star=E_star(10e9, 0.3, 10e9, 0.3), R_star=R / 2, Y=50e6, c_Y=1.6, c_P=2.8)
GENERIC = pytest.param("generic", marks=pytest.mark.liggghts)  # LIGGGHTS's own loop
MASS = 8000.0 * 4 / 3 * np.pi * R**3


def pair(strength, *, speed=SPEED, dt=1e-8, steps=3200, **more):
    """Two spheres that meet with `speed` along an oblique line; a bond of `strength` [Pa]."""
    n = np.array([0.6, 0.48, 0.64])
    x, v = np.array([R * n, -R * n]) * (1 + 1e-6), np.array([-0.5 * speed * n, 0.5 * speed * n])
    return Scene("cavity", [POWDER], x, v, dt, steps, radius=R, compaction=True, cohesion=("bond", strength), **more)


def along(found):
    """(overlap, force) of all frames, positive in compression."""
    apart = found[:, 0, PLACE] - found[:, 1, PLACE]
    distance = np.linalg.norm(apart, axis=1)
    return 2 * R - distance, (found[:, 0, FORCE] * apart).sum(axis=1) / distance


@pytest.mark.parametrize("host", HOSTS)
def test_a_bond_breaks_at_its_strength_times_the_area_of_the_dent_and_stays_broken(host, tmp_path):
    """Force, energy and speed after the impact; the steps resolve the pull to 1 %, the energy to 1e-3."""
    found = frames(host, tmp_path, pair(STRENGTH))
    overlap, force = along(found)
    top = overlap.max()
    a, dent = float(LAW.radius(top)), float(LAW.residual_overlap(top))
    most, k = STRENGTH * np.pi * a**2, 2 * LAW.E_star * a
    assert -force.min() == pytest.approx(most, rel=0.01) and -force.min() <= most * (1 + 1e-9)
    pulled = (force < 0) & (overlap < dent)
    assert force[pulled] == pytest.approx(-k * (dent - overlap[pulled]), rel=1e-6)
    broken = np.arange(len(force)) > np.flatnonzero(pulled)[-1]
    assert overlap[broken].max() > 0.9 * dent and not force[broken].any()
    energy = 0.5 * MASS * (found[:, :, VELOCITY] ** 2).sum(axis=(1, 2))
    lost = float(LAW.plastic_work(top)) + 0.5 * most**2 / k
    assert energy[-1] == pytest.approx(energy[0] - lost, abs=1e-3 * energy[0])
    whole = energy + found[:, :, PLASTIC].sum(axis=1) + found[:, :, ELASTIC].sum(axis=1)
    assert whole[1:] == pytest.approx(energy[0], abs=2e-3 * energy[0])
    assert 0.5 * most**2 / k > 6e-3 * energy[0]


@pytest.mark.parametrize("host", HOSTS)
def test_a_broken_bond_does_not_heal(host, tmp_path):
    """Heavy spheres on a path: into each other, apart until the bond breaks, half of the way back, and apart again."""
    n = np.array([0.6, 0.48, 0.64])
    v = SPEED * np.stack([-n, n])
    moves = tuple((sign * v, steps) for sign, steps in ((1, 400), (-1, 240), (1, 110), (-1, 110)))
    heavy = POWDER | {"density": 1e18}
    x = np.array([R * n, -R * n])
    bond = ("bond", STRENGTH)
    found = frames(
        host, tmp_path, Scene("cavity", [heavy], x, v, 1e-8, radius=R, moves=moves, compaction=True, cohesion=bond)
    )
    overlap, force = along(found)
    first, second = force[:640], force[645:]
    assert first.min() < -0.5 * STRENGTH * np.pi * float(LAW.radius(overlap.max())) ** 2
    assert second.min() == 0.0 and second.max() > 0.0  # pressed again, but never pulled


@pytest.mark.parametrize("host", HOSTS)
def test_a_strong_bond_holds_the_spheres_together(host, tmp_path):
    found = frames(host, tmp_path, pair(20 * STRENGTH, steps=5000))
    overlap, force = along(found)
    late = slice(2000, None)
    assert overlap[late].min() > 0 and force[late].min() < 0 < force[late].max()
    energy = 0.5 * MASS * (found[:, :, VELOCITY] ** 2).sum(axis=(1, 2)) + found[:, :, ELASTIC].sum(axis=1)
    assert energy[2000:] == pytest.approx(energy[2000], rel=3e-3)


@needs_lammps
@pytest.mark.parametrize("other", [h for h in HOSTS if h.values[0] != "lammps"] + [GENERIC])
def test_the_hosts_and_both_loops_of_liggghts_agree(other, tmp_path):
    """With friction and spin, whose limit the bond raises, until the bond breaks: to 1e-9 of the largest force."""
    spin = np.array([[2e3, -1e3, 5e2], [1e3, 3e3, -2e3]])
    scene = pair(STRENGTH, w=spin, tangential="history", friction=0.2, restitution=0.9)
    first = frames("lammps", tmp_path / "lammps", scene)
    host, loop = ("liggghts", "generic") if other == "generic" else (other, scene.loop)
    found = frames(host, tmp_path / "other", replace(scene, loop=loop))
    end = int(np.flatnonzero(along(first)[1] < 0)[-1])
    assert found[:end, :, FORCE] == pytest.approx(first[:end, :, FORCE], abs=1e-9 * np.abs(first[:, :, FORCE]).max())
    load = along(first)[1]
    normal = first[:, 0, PLACE] - first[:, 1, PLACE]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    shear = first[:, 0, FORCE] - (first[:, 0, FORCE] * normal).sum(axis=1, keepdims=True) * normal
    pulled = np.flatnonzero(load < 0)[:-1]
    shear = np.linalg.norm(shear[pulled], axis=1)
    assert shear.min() > 0 and (shear > 1.1 * 0.2 * -load[pulled]).any()  # a bond under tension resists shear


@needs_lammps
@pytest.mark.parametrize(
    ("name", "density"), [("sc", 0.6), thorough("sc", 0.8), thorough("fcc", 0.85), ("fcc", 0.92), thorough("hex", 0.7)]
)
def test_a_lattice_breaks_on_the_line_of_rumpf(name, density, tmp_path):
    """Pressed, released and pulled on all sides: z F d/(6 V) of F = strength pi a^2 of every contact (Rumpf 1970); a of
    the same lattice in numpy, growth in."""
    material, strength, steps = Material(120.0, 0.34, 1.0), 0.5, 4000

    def law(m):
        return f"{lammps_lattices.dense_law(m)} cohesion bond {strength!r}"

    d, P = lammps_lattices.press(tmp_path, name, material, density, steps=steps, back=0.012, law=law)
    lattice = LATTICES[name]
    planes = sum(lattice.counts)
    bed = Bed(np.ones(1), np.zeros(planes, int), np.full(planes, PLANE), material)
    for distance in np.linspace(1.0, float(distance_at(lattice, density)), 401)[1:]:
        bed.step(np.full(planes, 1.0 - distance))
    a = bed._law_of(np.arange(planes)).radius(bed.peak)[0]
    at = int(np.argmin(P))
    pull = np.full((1, 1), strength * np.pi * a**2)
    expected = -isotropic_pressure(lattice, pull, d[at : at + 1])[0]
    one_step = P[at - 1] - P[at]
    assert expected * (1 + 1e-3) < P[at] < (expected + one_step) * (1 - 1e-3)
    assert one_step < 5e-3 * abs(expected)
    assert np.abs(P[at + 3 :]).max() < 1e-30  # all contacts break at once


def test_what_bonds_need_is_said(tmp_path):
    words = "cavity 1e8 0.3 4e5 1.6 2.8 1e6 cohesion bond 1e5"
    head = "units si\ncomm_modify vel yes\natom_style sphere\nregion b block 0 1 0 1 0 1\ncreate_box 1 b\n"
    text = f"{head}fix move all nve/sphere\npair_style ep\npair_coeff * * {words}\n"
    with pytest.raises(AssertionError, match="cohesion bond needs compaction on"):
        run_lammps(text + "run 0\n", tmp_path)
