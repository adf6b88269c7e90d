# SPDX-License-Identifier: GPL-2.0-or-later
"""Energy of beds with compaction in LAMMPS and YADE: elastic cycles, random walks of clusters, free spheres."""

import lammps_lattices
import numpy as np
import pytest
from dense_spheres import LIKE
from free_spheres import ELASTIC, FORCE, PLACE, PLASTIC, VELOCITY, Scene, frames
from hosts import CLASSES, LAMMPS, LIGGGHTS, on
from lammps_decks import column, needs_lammps, run
from walks import energies, falls, nine_spheres, one_body, two_bodies, walk

from bed import Bed, Material
from epdem.theory.cavity import FINITE_STRAIN, Cavity
from epdem.theory.cavity_adhesive import CavityAdhesive
from marks import thorough

HARD, SOFT, SOFTEST = (120.0, 0.34, 1.0), (30.0, 0.2, 1.0), (10.0, 0.3, 1.0)
BEDS = {
    "E/Y 120": [HARD],
    "E/Y 30": [SOFT],
    "E/Y 10": [SOFTEST],
    "unlike": [HARD, (120.0, 0.34, 1.4)],
    "hard and soft": [HARD, (60.0, 0.2, 3.0)],
}
CLUSTERS = {"one body": one_body(), "two of one size": two_bodies(1.0), "two of two sizes": two_bodies(0.5)}


def lattice_cycles(name):
    """Work of three cycles of a lattice in LAMMPS."""

    def cycles(folder, material, overlap):
        lattice, cells = lammps_lattices.CELLS[name]
        text = lammps_lattices.DECK.format(lattice=lattice, cells=cells, law=lammps_lattices.dense_law(material))
        waves = " ".join(f"{a} wiggle {-cells * float(lattice.split()[1]) * overlap!r} 0.2" for a in "xyz")
        out, _ = run(text + f"fix squeeze all deform 1 {waves} remap x units box\nrun 600\n", folder)
        box = column(out, "Lz")
        of_spheres = np.append(box[0], box[:-1])  # LAMMPS moves the box after the forces
        assert (box[0] - box.min()) / box[0] == pytest.approx(overlap, rel=1e-3)
        F = column(out, "Press") * box**3 / of_spheres
        return -np.cumsum(0.5 * (F[1:] + F[:-1]) * np.diff(of_spheres))

    return cycles


def cycles_of_seven(folder, material, overlap):
    """The same of six spheres that press a seventh in YADE: two like bodies share an overlap."""
    depth = overlap * np.sin(3 * np.pi * np.linspace(0, 1, 601)) ** 2
    way = 2.0 * one_body()[2] * (1.0 - depth[:, None, None])
    sphere = LIKE | {"E": material.E, "nu": material.nu, "yieldStress": material.Y, "density": 1000.0}
    moves = tuple((v, 1) for v in 600 * np.diff(way, axis=0))
    found = frames("yade", folder, Scene("cavity", [sphere], way[0], 0 * way[0], 1 / 600, moves=moves, compaction=True))
    return energies(found[:, None])[0][:, 0]


CYCLES = [
    *(pytest.param(lattice_cycles(name), marks=LAMMPS.marks, id=f"lammps-{name}") for name in ("sc", "fcc")),
    pytest.param(cycles_of_seven, marks=CLASSES.marks, id="yade-classes"),
]


@pytest.mark.parametrize("elastic", [HARD, SOFT, SOFTEST], ids=lambda m: f"{m[0]:g}")
@pytest.mark.parametrize("cycles", CYCLES)
def test_elastic_cycles_lose_nothing_and_plastic_ones_some(cycles, elastic, tmp_path):
    """Three cycles between touch and half, all and 1.2 of the overlap of first yield."""
    material = Material(*elastic)
    law = Cavity(E_star=material.E / (1 - material.nu**2), R_star=1.0, Y=material.Y, c_strain=FINITE_STRAIN)
    lost = {}
    for level in (0.5, 0.999, 1.2):
        work = cycles(tmp_path / str(level), material, level * law.yield_overlap)
        lost[level] = work[-1] / work.max()
    assert abs(lost[0.5]) < 1e-12 and abs(lost[0.999]) < 1e-12 < 0.01 < lost[1.2]


IN_YADE = [("one body", "E/Y 30"), ("two of two sizes", "unlike"), ("two of one size", "hard and soft")]


def rare(host, cluster, bed):
    return (cluster, bed) not in IN_YADE if "yade" in host else cluster != "two of two sizes" and bed != "E/Y 30"


@pytest.mark.parametrize(("name", "cluster", "bed"), on([LAMMPS, CLASSES], CLUSTERS, BEDS, rare=rare))
def test_walks_create_no_energy(name, cluster, bed, tmp_path):
    """Falls of the dissipation of the steps ten later over the work; a contact that ends may lose and regain at once.
    The error of the plastic work of the ledger is of second order."""
    (first, ledger), (second, finer) = (errors(name, tmp_path, cluster, bed, steps) for steps in (500, 1000))
    assert first < 1e-4 and second < 2e-5
    assert ledger < 4e-4 and finer < 0.35 * ledger


def errors(name, folder, cluster, bed, steps, mu=0.0):
    """Largest fall of the dissipation and largest error of the ledger, both over the largest work of a walk."""
    count = 1 if name == "yade" else 4
    found = walk(name, folder / str(steps), CLUSTERS[cluster], BEDS[bed], steps, count=count, mu=mu)
    work, elastic, lost = energies(found)
    ledger = np.abs(work - elastic - lost).max(axis=0) / work.max(axis=0)
    return falls(work, elastic, 10).max(), ledger.max()


@pytest.mark.liggghts
def test_walks_in_liggghts_create_no_energy_at_any_step(tmp_path):
    """A contact that ends takes its growth from the others, which then store up to 6e-6 of the work more."""
    fall, ledger = [], []
    for steps in (3000, 6000):
        found = walk("liggghts", tmp_path / str(steps), one_body(), [(120.0, 0.34, 1.0)], steps, count=20)
        work, elastic, lost = energies(found)
        fall.append(falls(work, elastic).max())
        ledger.append(np.abs(work - elastic - lost).max() / work.max())
    assert max(fall) < 1e-5, fall
    assert ledger[0] < 1e-5 and ledger[1] < ledger[0] / 3, ledger


@pytest.mark.parametrize("host", [LIGGGHTS, LAMMPS])
@pytest.mark.parametrize(("cluster", "bed"), [("one body", HARD), ("two of two sizes", SOFT)])
def test_walks_with_adhesion_create_no_energy(cluster, bed, host, tmp_path):
    """Contacts form, part and form again in their dents. Gamma: 0.7 of the largest one of two of the smaller spheres.
    The force of the steps in which it jumps is another one, so that the dissipation of ten steps counts."""
    R_star = 0.5 * CLUSTERS[cluster][1].min()
    law = CavityAdhesive(
        E_star=0.5 * bed[0] / (1 - bed[1] ** 2), R_star=R_star, Gamma=0.0, Y=1.0, c_strain=FINITE_STRAIN
    )
    Gamma = 0.7 * float(law.largest_adhesion)
    for steps, limit in ((500, 1e-4), (1000, 2e-5)):
        found = walk(host, tmp_path / str(steps), CLUSTERS[cluster], [bed], steps, count=4, Gamma=Gamma)
        work, elastic, _ = energies(found)
        assert (found[..., FORCE].min(), found[..., ELASTIC].min()) < (0.0, 0.0)
        assert falls(work, elastic, 10).max() < limit


LIMITS = {"lammps": (1e-5, 1e-5, 1e-3, 0.6), "yade": (1e-4, 2e-5, 4e-4, 0.35)}


@pytest.mark.parametrize(
    ("name", "bed"),
    on([LAMMPS, CLASSES], ["unlike", "E/Y 120"], rare=lambda host, bed: "yade" in host and bed != "unlike"),
)
def test_walks_with_friction_create_no_energy(name, bed, tmp_path):
    """Two bodies of two sizes, whose neighbors slide: plastic work and work of friction are what is lost."""
    (first, ledger), (second, finer) = (errors(name, tmp_path, "two of two sizes", bed, n, 0.3) for n in (500, 1000))
    most = LIMITS[name]
    assert first < most[0] and second < most[1]
    assert ledger < most[2] and finer < most[3] * ledger


def flight(materials, steps, density=1.0):
    """Nine free spheres that fly together, of radii 1 to 4."""
    x, radius, v = nine_spheres()
    kinds = [LIKE | {"E": E, "nu": nu, "yieldStress": Y, "density": density} for E, nu, Y in materials]
    return Scene(
        "cavity", kinds, x, v, 12.0 / steps, steps, radius=radius, kinds=np.arange(9) % len(kinds), compaction=True
    )


@needs_lammps
@pytest.mark.parametrize("materials", BEDS.values(), ids=BEDS)
def test_nine_free_spheres_gain_no_energy(materials, tmp_path):
    """Falls of the dissipation and errors of the ledger over the energy, of second order."""
    mass, found = 4 / 3 * np.pi * nine_spheres()[1] ** 3, []
    for steps in (500, 1000):
        rows = frames("lammps", tmp_path / str(steps), flight(materials, steps))
        kinetic = 0.5 * (mass * (rows[..., VELOCITY] ** 2).sum(axis=2)).sum(axis=1)
        plastic, elastic = rows[..., PLASTIC].sum(axis=1), rows[..., ELASTIC].sum(axis=1)
        lost = kinetic[0] - kinetic - elastic
        fall, ledger = (np.maximum.accumulate(lost) - lost).max(), np.abs(lost - plastic).max()
        found.append((fall / kinetic[0], ledger / kinetic[0]))
        assert elastic.max() > 0.2 * kinetic[0]
    assert found[0][0] < 5e-5 and found[1][0] < 0.3 * found[0][0]
    assert found[0][1] < 2e-4 and found[1][1] < 0.3 * found[0][1]


@needs_lammps
@pytest.mark.parametrize("host", [LIGGGHTS, CLASSES])
def test_nine_free_spheres_fly_as_in_lammps(host, tmp_path):
    """Places at all steps. YADE has the velocities of half steps: without forces at the start those are the same."""
    scene = flight([(LIKE["E"], LIKE["nu"], LIKE["yieldStress"])], 1500, density=LIKE["yieldStress"])
    lammps, other = (frames(name, tmp_path / name, scene)[..., PLACE] for name in ("lammps", host))
    assert np.abs(other - lammps).max() < 1e-12 * np.abs(lammps[0]).max()


def in_numpy(places, radius, materials):
    """Forces of one cluster at places (steps, n, 3) by the law in numpy."""
    n = len(radius)
    i, j = np.triu_indices(n, 1)
    bed = Bed(radius, i, j, [Material(*materials[k % len(materials)]) for k in range(n)])
    F = np.zeros(places.shape)
    for t, x in enumerate(places):
        d = x[i] - x[j]
        r = np.linalg.norm(d, axis=1)
        f = bed.step(radius[i] + radius[j] - r)[:, None] / r[:, None] * d
        np.add.at(F[t], i, f)
        np.add.at(F[t], j, -f)
    return F, bed


@needs_lammps
@pytest.mark.parametrize("name", [thorough("E/Y 30"), thorough("unlike"), "hard and soft"])
def test_forces_of_unlike_spheres_are_those_of_numpy(name, tmp_path):
    """Two bodies of two sizes, errors over the largest force: largest in steps where a contact begins."""
    cluster = two_bodies(0.5)
    error, _ = beside_numpy(tmp_path, cluster, BEDS[name])
    assert np.median(error) < 1e-4 and np.quantile(error, 0.99) < 1e-3 and error.max() < 0.01


@needs_lammps
def test_a_hard_sphere_among_soft_ones_does_not_grow(tmp_path):
    """Six neighbors of a third of its strength: u is 0 in numpy, whose forces are those of LAMMPS."""
    error, bed = beside_numpy(tmp_path, one_body(), [(120.0, 0.34, 3.0)] + [HARD] * 6)
    assert np.median(error) < 1e-4 and error.max() < 0.01
    assert bed.screened.max() > 0.1 and not bed.grown.any()


def beside_numpy(folder, cluster, materials, steps=1000):
    """(difference of the forces of every second step over the largest force, the contacts in numpy at the end)."""
    found = walk("lammps", folder, cluster, materials, steps, count=1)[::2, 0]
    F, bed = in_numpy(found[..., PLACE], cluster[1], materials)
    return np.abs(found[..., FORCE] - F).max(axis=(1, 2)) / np.abs(F).max(), bed
