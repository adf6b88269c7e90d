# SPDX-License-Identifier: GPL-2.0-or-later
"""Option compaction of cavity in LAMMPS: forces, order, contacts alone, ranks, restart, refusals."""

import numpy as np
import pytest
from lammps_decks import lammps, needs_lammps, run
from plugin_compaction import NU, E, Y, alone, data, overlapping
from test_plugin_compaction import BACK, CLUSTER, FLOOR, HEAVY, MOVES, RADII, assert_second_order
from test_plugin_compaction import cluster as cluster_of_liggghts

from epdem.theory.cavity import FINITE_STRAIN, Cavity
from marks import thorough

pytestmark = needs_lammps

LAW = f"cavity {E!r} {NU!r} {Y!r} 1.6 2.8 {FINITE_STRAIN}"
ON = f"{LAW} compaction on"


def deck(law, runs, dt, *, floor=None, head="", skin=0.05, columns="fx fy fz", every=1):
    """Spheres of spheres.data, a floor at a height [m], and frames of all steps."""
    wall = f"fix floor all wall/ep zplane {floor!r} NULL {law}\n" if floor is not None else ""
    return f"""units si
atom_style sphere
atom_modify map array sort 0 0
boundary f f f
comm_modify vel yes
{head}
read_data spheres.data
pair_style ep energies
pair_coeff * * {law}
neighbor {skin} bin
neigh_modify delay 0
{wall}fix move all nve/sphere
timestep {dt!r}
dump d all custom {every} frames.txt id {columns}
dump_modify d sort id header no format float %.17g
{runs}"""


def frames(folder, text, spheres, *, ranks=1):
    """Frames of a run without the ids, shape (frames, spheres, columns)."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "spheres.data").write_text(spheres)
    run(text, folder, ranks=ranks)
    table = np.loadtxt(folder / "frames.txt")
    return table[:, 1:].reshape(-1, int(table[:, 0].max()), table.shape[1] - 1)


def cluster(folder, steps, *, law=ON, runs=None, head="", ranks=1):
    """Forces of a sphere, five neighbors and a floor at `steps` loading and `steps` unloading steps; see `exact`.

    The skin is smaller than the gaps that growth closes.
    """
    spheres = data(CLUSTER, RADII, MOVES, HEAVY)
    text = deck(law, runs or f"run {steps}\n{BACK}run {steps}\n", 1.0 / steps, floor=FLOOR, head=head, skin=1e-3)
    return frames(folder, text, spheres, ranks=ranks)


@pytest.mark.thorough  # LIGGGHTS, whose forces these are, is compared in every run
def test_forces_are_those_of_grown_spheres_with_an_error_of_second_order(tmp_path):
    found = {steps: cluster(tmp_path / str(steps), steps) for steps in (200, 800)}
    assert_second_order(found)
    assert found[800][800, 5, 2] > 0 == cluster(tmp_path / "off", 400, law=LAW)[400, 5, 2]


@pytest.mark.liggghts
def test_forces_are_those_of_liggghts(tmp_path):
    found, other = cluster(tmp_path / "lammps", 200), cluster_of_liggghts(tmp_path / "liggghts", 200)
    assert np.abs(found - other).max() <= 1e-12 * np.abs(other).max()


@pytest.mark.parametrize("ranks", [1, thorough(2)])
def test_contacts_alone_keep_every_bit(ranks, tmp_path):
    """Pairs and spheres at a wall, elastic to fully plastic, with a second impact on the wall after the first."""
    spheres = data(*alone(12), 2000.0, half=64.0)
    turn = f"run 1000\nset group all vz {-0.2!r}\nrun 1000\n"
    head = "processors 2 1 1" if ranks == 2 else ""
    ends = [
        frames(
            tmp_path / law.split()[-1],
            deck(law, turn, 2e-4, floor=-1.0, head=head, columns="x y z vx vy vz f_EP_HISTORY0[1]", every=100),
            spheres,
            ranks=ranks,
        )
        for law in (LAW, ON)
    ]
    assert np.array_equal(ends[0][..., :6], ends[1][..., :6])
    works = [end[..., 6] for end in ends]  # with compaction by the forces at both ends of a step, else in closed form
    assert np.abs(works[1] - works[0]).max() <= 1e-11 * works[0].max()
    assert (ends[0][-1][1::2, 6] > 0).any() and (ends[0][-1][24:, 6] > 0).any()  # some yielded


@pytest.mark.parametrize("face", ["f", "p"])
def test_a_pair_that_overlaps_at_the_start_keeps_its_law_through_a_periodic_face_too(face, tmp_path):
    """No growth by its own dent in the first step, and none by what its two copies differ in."""
    x, radius, v = overlapping()
    if face == "f":
        x[0, 0] -= 8.0
    found = []
    for law in (LAW, ON):
        text = deck(law, "run 60\n", 2e-4, columns="fx fy fz vx vy vz").replace(
            "boundary f f f", f"boundary {face} f f"
        )
        half = 4.0 if face == "p" else 8.0
        found.append(frames(tmp_path / law.split()[-1], text, data(x, radius, v, 2000.0, half=half)))
    assert found[0][5, 0, 0] != 0
    assert (np.abs(found[1] - found[0]).max(axis=(0, 1)) <= 1e-12 * np.abs(found[0]).max(axis=(0, 1))).all()


@pytest.mark.parametrize("steps", [7, 200])
def test_plastic_work_of_the_steps_sums_up_to_that_of_the_law(steps, tmp_path):
    """A heavy pair that reaches an overlap of 0.2 R in few long steps and in short ones, without compaction."""
    v = np.array([[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]])
    text = deck(LAW, f"run {steps}\n", 1.0 / steps, columns="x f_EP_HISTORY0[1]", every=steps)
    end = frames(tmp_path, text, data(np.array([[-1.0, 0, 0], [1.0, 0, 0]]), np.ones(2), v, 1e20))[-1]
    law = Cavity(E_star=E / (1 - NU**2) / 2, R_star=0.5, Y=Y, c_strain=FINITE_STRAIN, share=0.5)
    assert end[:, 1].sum() == pytest.approx(law.plastic_work(2 + end[0, 0] - end[1, 0]), rel=1e-9)


RESTART = f"""run 150
write_restart x.restart
clear
atom_modify map array sort 0 0
comm_modify vel yes
read_restart x.restart
neighbor 1e-3 bin
neigh_modify delay 0
fix floor all wall/ep zplane {FLOOR!r} NULL {ON}
fix move all nve/sphere
timestep {1 / 300!r}
dump d all custom 1 frames.txt id fx fy fz
dump_modify d sort id header no format float %.17g append yes
run 150
"""


def test_two_runs_a_restart_and_two_ranks_give_the_forces_of_one_run(tmp_path):
    """After a restart frame 151 is the evaluation before the first step of the run."""
    once = cluster(tmp_path / "once", 300, runs="run 300\n")
    two = cluster(tmp_path / "two", 300, runs="run 150\nrun 150\n")
    again = cluster(tmp_path / "restart", 300, runs=RESTART)
    ranks = cluster(tmp_path / "ranks", 300, runs="run 300\n", head="processors 2 1 1", ranks=2)
    largest = np.abs(once).max()
    assert np.array_equal(again[150], again[151])
    assert np.array_equal(np.delete(again, 151, axis=0), two)
    assert np.abs(two - once).max() < 1e-12 * largest
    assert np.abs(ranks - once).max() < 1e-12 * largest


REFUSED = {
    "law": ("thornton 1e8 0.3 4e5 compaction on", "", "law thornton has no compaction; take law cavity"),
    "cohesion": (f"{ON} cohesion sjkr 1e3", "", "compaction beside cohesion sjkr; remove one"),
    "wall": (ON, f"fix floor all wall/ep zplane -1 NULL {LAW}", "compaction is off here and on in pair_coeff"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_has_no_compaction_is_refused(what, tmp_path):
    law, wall, said = REFUSED[what]
    (tmp_path / "spheres.data").write_text(data(CLUSTER, RADII, 0 * CLUSTER, 1000.0))
    code, out = lammps(deck(law, f"{wall}\nrun 0\n", 1e-3), tmp_path)
    assert code != 0 and said in out
