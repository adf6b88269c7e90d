# SPDX-License-Identifier: GPL-2.0-or-later
"""Energy of beds with compaction in LAMMPS and YADE: elastic cycles, random walks of clusters, free spheres."""

import lammps_lattices
import numpy as np
import pytest
import yade_walks
from hosts import CLASSES, LAMMPS, on
from lammps_decks import column, needs_lammps, run
from lammps_walks import FLIGHT, falls, fly, nine_spheres, one_body, paths, two_bodies, walks
from plugin_compaction import NU, E, Y, data, deck
from plugin_compaction import run as run_liggghts

from bed import Bed, Material
from epdem.theory.cavity import FINITE_STRAIN, Cavity
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
    x, radii, ways = one_body()
    depth = overlap * np.sin(3 * np.pi * np.linspace(0, 1, 601)) ** 2
    way = 2.0 * ways * (1.0 - depth[:, None, None])
    return yade_walks.energies(folder, way, radii, [(material.E, material.nu, material.Y)])[0][:, 0]


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


def walks_of_lammps(folder, cluster, materials, steps, mu):
    return walks(folder, cluster, materials, steps, friction=f" tangential partial_slip {mu}" if mu else "")


def walks_of_yade(folder, cluster, materials, steps, mu):
    way, radii = paths(cluster, steps, count=1)
    return yade_walks.energies(folder / str(steps), way, radii, materials, mu=mu)


WALKS = {"lammps": walks_of_lammps, "yade": walks_of_yade}
IN_YADE = [("one body", "E/Y 30"), ("two of two sizes", "unlike"), ("two of one size", "hard and soft")]


def rare(host, cluster, bed):
    return (cluster, bed) not in IN_YADE if "yade" in host else cluster != "two of two sizes" and bed != "E/Y 30"


@pytest.mark.parametrize(("name", "cluster", "bed"), on([LAMMPS, CLASSES], CLUSTERS, BEDS, rare=rare))
def test_walks_create_no_energy(name, cluster, bed, tmp_path):
    """Falls of the dissipation of the steps ten later over the work; a contact that ends may lose and regain at once.

    The error of the plastic work of the ledger is of second order.
    """
    (first, ledger), (second, finer) = (errors(name, tmp_path, cluster, bed, steps) for steps in (500, 1000))
    assert first < 1e-4 and second < 2e-5
    assert ledger < 4e-4 and finer < 0.35 * ledger


def errors(name, folder, cluster, bed, steps, mu=0.0):
    """Largest fall of the dissipation and largest error of the ledger, both over the largest work of a walk."""
    work, elastic, lost = WALKS[name](folder, CLUSTERS[cluster], BEDS[bed], steps, mu)
    ledger = np.abs(work - elastic - lost).max(axis=0) / work.max(axis=0)
    return falls(work, elastic, 10).max(), ledger.max()


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


@needs_lammps
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


def flight_in_liggghts(folder, x, v, radius, steps):
    folder.mkdir()
    text = deck("compaction on", runs=f"run {steps}\n", dt=FLIGHT / steps, columns="x y z")
    return run_liggghts(folder, text, data(x, radius, v, Y, half=15.0))[..., 1:]


def flight_in_yade(folder, x, v, radius, steps):
    """YADE has the velocities of half steps: without forces at the start those are the same."""
    return yade_walks.flight(folder, x, v, radius, (E, NU, Y), density=Y, dt=FLIGHT / steps, steps=steps)


@needs_lammps
@pytest.mark.parametrize(
    "flight",
    [
        pytest.param(flight_in_liggghts, marks=pytest.mark.liggghts, id="liggghts"),
        pytest.param(flight_in_yade, marks=CLASSES.marks, id="yade-classes"),
    ],
)
def test_nine_free_spheres_fly_as_in_lammps(flight, tmp_path):
    """Places at all steps; LAMMPS writes fifteen digits."""
    x, radius, v = nine_spheres()
    steps = 1500
    lammps, *_ = fly(tmp_path / "lammps", [(E, NU, Y)], steps, density=Y)
    assert np.abs(flight(tmp_path / "other", x, v, radius, steps) - lammps).max() < 1e-12 * np.abs(x).max()


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
    assert bed.gamma.min() < 0.9 and not bed.grown.any()


def beside_numpy(folder, cluster, materials, steps=1000):
    """(difference of the forces of each step over the largest force, the contacts in numpy at the end)."""
    walks(folder, cluster, materials, steps, count=1)
    frames = np.fromstring((folder / "frames.txt").read_text(), sep=" ").reshape(steps + 1, -1, 10)
    F, bed = in_numpy(frames, cluster[1], materials)
    return np.abs(frames[..., 3:6] - F).max(axis=(1, 2)) / np.abs(F).max(), bed
