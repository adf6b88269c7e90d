# SPDX-License-Identifier: GPL-2.0-or-later
"""Energy of beds with compaction in LAMMPS: elastic cycles, random walks of clusters, free spheres; unlike spheres."""

import lammps_lattices
import numpy as np
import pytest
from lammps_decks import column, needs_lammps, run
from lammps_walks import FLIGHT, falls, fly, nine_spheres, one_body, two_bodies, walks
from plugin_compaction import NU, E, Y, data, deck
from plugin_compaction import run as run_liggghts

from bed import Bed, Material
from epdem.theory.cavity import FINITE_STRAIN, Cavity
from marks import thorough

pytestmark = needs_lammps

HARD, SOFT, SOFTEST = (120.0, 0.34, 1.0), (30.0, 0.2, 1.0), (10.0, 0.3, 1.0)
BEDS = {
    "E/Y 120": [HARD],
    "E/Y 30": [SOFT],
    "E/Y 10": [SOFTEST],
    "unlike": [HARD, (120.0, 0.34, 1.4)],
    "hard and soft": [HARD, (60.0, 0.2, 3.0)],
}
CLUSTERS = {"one body": one_body(), "two of one size": two_bodies(1.0), "two of two sizes": two_bodies(0.5)}


@pytest.mark.parametrize("elastic", [HARD, SOFT, SOFTEST], ids=lambda m: f"{m[0]:g}")
@pytest.mark.parametrize("name", ["sc", "fcc"])
def test_elastic_cycles_lose_nothing_and_plastic_ones_some(name, elastic, tmp_path):
    """Three cycles of a lattice between touch and half, all and 1.2 of the overlap of first yield."""
    material = Material(*elastic)
    law = Cavity(E_star=material.E / (1 - material.nu**2), R_star=1.0, Y=material.Y, c_strain=FINITE_STRAIN)
    lattice, cells = lammps_lattices.CELLS[name]
    lost = {}
    for level in (0.5, 0.999, 1.2):
        text = lammps_lattices.DECK.format(lattice=lattice, cells=cells, law=lammps_lattices.dense_law(material))
        edge = cells * float(lattice.split()[1])
        waves = " ".join(f"{a} wiggle {-edge * level * law.yield_overlap!r} 0.2" for a in "xyz")
        out, _ = run(text + f"fix squeeze all deform 1 {waves} remap x units box\nrun 600\n", tmp_path)
        box = column(out, "Lz")
        of_spheres = np.append(box[0], box[:-1])  # LAMMPS moves the box after the forces
        F = column(out, "Press") * box**3 / of_spheres
        W = -np.concatenate([[0.0], np.cumsum(0.5 * (F[1:] + F[:-1]) * np.diff(of_spheres))])
        lost[level] = W[-1] / W.max()
        assert (box[0] - box.min()) / box[0] == pytest.approx(level * law.yield_overlap, rel=1e-3)
    assert abs(lost[0.5]) < 1e-12 and abs(lost[0.999]) < 1e-12 < 0.01 < lost[1.2]


@pytest.mark.parametrize(
    ("cluster", "bed"),
    [thorough(c, bed, unless=c == "two of two sizes" or bed == "E/Y 30") for c in CLUSTERS for bed in BEDS],
)
def test_walks_create_no_energy(cluster, bed, tmp_path):
    """Falls of the dissipation of the steps ten later over the work; a contact that ends may lose and regain at once.

    The error of the plastic work of the ledger is of second order.
    """
    found = []
    for steps in (500, 1000):
        work, elastic, plastic = walks(tmp_path, CLUSTERS[cluster], BEDS[bed], steps)
        ledger = np.abs(work - elastic - plastic).max(axis=0) / work.max(axis=0)
        found.append((falls(work, elastic, 10).max(), ledger.max()))
    assert found[0][0] < 1e-4 and found[1][0] < 2e-5
    assert found[0][1] < 4e-4 and found[1][1] < 0.35 * found[0][1]


@pytest.mark.parametrize("name", ["E/Y 120", "unlike"])
def test_walks_with_friction_create_no_energy(name, tmp_path):
    """Two bodies of two sizes, whose neighbors slide: plastic work and work of friction are what is lost."""
    found = []
    for steps in (500, 1000):
        work, elastic, lost = walks(
            tmp_path, two_bodies(0.5), BEDS[name], steps, friction=" tangential partial_slip 0.3"
        )
        found.append(
            (falls(work, elastic, 10).max(), (np.abs(work - elastic - lost).max(axis=0) / work.max(axis=0)).max())
        )
    assert found[0][0] < 1e-5 and found[1][0] < 1e-5
    assert found[0][1] < 1e-3 and found[1][1] < 0.6 * found[0][1]


@pytest.mark.parametrize("materials", BEDS.values(), ids=BEDS)
def test_nine_free_spheres_gain_no_energy(materials, tmp_path):
    """Radii 1 to 4: falls of the dissipation and errors of the ledger over the energy, of second order."""
    found = []
    for steps in (500, 1000):
        _, kinetic, elastic, plastic = fly(tmp_path, materials, steps)
        lost = kinetic[0] - kinetic - elastic
        found.append(
            ((np.maximum.accumulate(lost) - lost).max() / kinetic[0], np.abs(lost - plastic).max() / kinetic[0])
        )
        assert elastic.max() > 0.2 * kinetic[0]
    assert found[0][0] < 5e-5 and found[1][0] < 0.3 * found[0][0]
    assert found[0][1] < 2e-4 and found[1][1] < 0.3 * found[0][1]


@pytest.mark.liggghts
def test_nine_free_spheres_fly_alike_in_liggghts(tmp_path):
    """Places at all steps; LAMMPS writes fifteen digits."""
    x, radius, v = nine_spheres()
    steps = 1500
    lammps, *_ = fly(tmp_path / "lammps", [(E, NU, Y)], steps, density=Y)
    text = deck("compaction on", runs=f"run {steps}\n", dt=FLIGHT / steps, columns="x y z")
    (tmp_path / "liggghts").mkdir()
    liggghts = run_liggghts(tmp_path / "liggghts", text, data(x, radius, v, Y, half=15.0))[..., 1:]
    assert np.abs(liggghts - lammps).max() < 1e-12 * np.abs(x).max()


def in_numpy(frames, radius, materials):
    """Forces of frames (x y z fx fy fz) of one cluster by the law in numpy."""
    n = len(radius)
    i, j = np.triu_indices(n, 1)
    bed = Bed(radius, i, j, [Material(*materials[k % len(materials)]) for k in range(n)])
    F = np.zeros((len(frames), n, 3))
    for t, x in enumerate(frames[..., :3]):
        d = x[i] - x[j]
        r = np.linalg.norm(d, axis=1)
        f = bed.step(radius[i] + radius[j] - r)[:, None] / r[:, None] * d
        np.add.at(F[t], i, f)
        np.add.at(F[t], j, -f)
    return F, bed


@pytest.mark.parametrize("name", [thorough("E/Y 30"), thorough("unlike"), "hard and soft"])
def test_forces_of_unlike_spheres_are_those_of_numpy(name, tmp_path):
    """Two bodies of two sizes, errors over the largest force: largest in steps where a contact begins."""
    cluster = two_bodies(0.5)
    error, _ = beside_numpy(tmp_path, cluster, BEDS[name])
    assert np.median(error) < 1e-4 and np.quantile(error, 0.99) < 1e-3 and error.max() < 0.01


def test_a_hard_sphere_among_soft_ones_does_not_grow(tmp_path):
    """Six neighbors of a third of its strength: u is 0 in numpy, whose forces are those of LAMMPS."""
    error, bed = beside_numpy(tmp_path, one_body(), [(120.0, 0.34, 3.0)] + [HARD] * 6)
    assert np.median(error) < 1e-4 and error.max() < 0.01
    assert bed.gamma.min() < 0.9 and not bed.grown.any()


def beside_numpy(folder, cluster, materials, steps=1000):
    """(difference of the forces of each step over the largest force, the contacts in numpy at the end)."""
    walks(folder, cluster, materials, steps, count=1)
    frames = np.fromstring((folder / "frames.txt").read_text(), sep=" ").reshape(steps + 1, -1, 10)
    F, bed = in_numpy(frames, cluster[1], materials)
    return np.abs(frames[..., 3:6] - F).max(axis=(1, 2)) / np.abs(F).max(), bed
