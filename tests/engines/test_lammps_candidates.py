# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls in LAMMPS look only at spheres that can touch them: forces have the bits of walls that look at all spheres.

With `neigh_modify delay 1`, LAMMPS does not test in each step whether new neighbor lists are due, and walls look at all
spheres.
"""

import os
import subprocess

import numpy as np
import pytest
from lammps_decks import column, needs_lammps, run
from triangles import cube, written

from epdem.engines.lammps import launcher

pytestmark = needs_lammps

LAW = "thornton 1e8 0.3 4e5 tangential history 0.5"
UNION = "region a cone z 0 0 0.004 0.018 -0.02 0 open 1 open 2\nregion b cylinder z 0 0 0.018 0 0.02 open 1 open 2\n"
WALLS = {
    "planes": f"fix w all wall/ep zplane -0.019 0.019 {LAW}\n",
    "two sides": f"fix w all wall/ep xplane 0 0 {LAW}\n",
    "sphere": f"region r sphere 0 0 0 0.018\nfix w all wall/ep/region r {LAW}\n",
    "union": f"{UNION}region r union 2 a b\nfix w all wall/ep/region r {LAW}\n",
    "outside": f"region r block -0.006 0.006 -0.006 0.006 -0.006 0.006 side out\nfix w all wall/ep/region r {LAW}\n",
    "open": "region r block INF INF INF INF INF 0.0025 open 1 open 2 open 3 open 4 open 5 units box\n"
    f"fix w all wall/ep/region r {LAW}\n",
    "moved": f"variable z equal 2.0*step*dt\nregion r plane 0 0 -0.019 0 0 1 move NULL NULL v_z\n"
    f"fix w all wall/ep/region r {LAW}\n",
    "vibrating": f"variable z equal 0.004*sin(800*step*dt)\nregion r block -0.03 0.03 -0.03 0.03 -0.014 0.014 "
    f"move NULL NULL v_z\nfix w all wall/ep/region r {LAW}\n",
    "as fast as the spheres": "variable z equal 0.002*sin(6000*step*dt)\n"
    f"region r block -0.03 0.03 -0.03 0.03 -0.016 0.016 move NULL NULL v_z\nfix w all wall/ep/region r {LAW}\n",
    "turning": f"variable t equal 60*step*dt\nregion r block -0.014 0.014 -0.014 0.014 -0.014 0.014 "
    f"rotate v_t 0.002 0 0 0 0 1\nfix w all wall/ep/region r {LAW}\n",
    "triangles": f"fix w all wall/ep mesh box.stl {LAW}\n",
    "triangles that move": "variable z equal 0.004*sin(800*step*dt)\nvariable t equal 60*step*dt\n"
    f"fix w all wall/ep mesh box.stl move NULL NULL v_z rotate v_t 0.002 0 0 0 0 1 {LAW}\n",
    "growing": f"variable R equal 0.019-0.8*step*dt\nregion r sphere 0 0 0 v_R\nfix w all wall/ep/region r {LAW}\n",
}


def deck(wall, delay):
    """27 fast spheres that meet walls alone, because pairs are excluded."""
    return f"""units si
atom_style sphere
atom_modify map array sort 0 0
comm_modify vel yes
boundary f f f
region box block -0.1 0.1 -0.1 0.1 -0.1 0.1 units box
create_box 1 box
region inner block -0.009 0.009 -0.009 0.009 -0.009 0.009 units box
lattice sc 0.006 origin 0.5 0.5 0.5
create_atoms 1 region inner
lattice none 1.0
set group all diameter 0.002 density 2500
velocity all create 1 4711 dist gaussian loop geom
velocity all scale 3e19
pair_style ep
pair_coeff * * {LAW}
neighbor 0.001 bin
neigh_modify delay {delay} every 1 check yes exclude group all all
{wall}fix motion all nve/sphere
timestep 2e-6
thermo_style custom step atoms ke f_w[1] f_w[2] f_w[3]
thermo_modify lost ignore format float %.17g
thermo 1
run 2000
"""


@pytest.mark.parametrize("what", WALLS)
def test_candidates_give_the_bits_of_all_spheres(what, tmp_path):
    some, every = (run(deck(WALLS[what], k), written(tmp_path / str(k), cube(0.014, 1), "box"))[0] for k in (0, 1))
    forces = np.array([column(every, f"f_w[{axis}]") for axis in (1, 2, 3)])
    assert np.count_nonzero(np.abs(forces).max(axis=0)) > 10, "too few impacts"
    for value in ("f_w[1]", "f_w[2]", "f_w[3]", "KinEng"):
        assert np.array_equal(column(some, value), column(every, value)), value


def test_triangles_that_move_give_the_same_forces_on_two_ranks(tmp_path):
    found = []
    for ranks in (1, 2):
        text = deck(WALLS["triangles that move"], 0).replace("run 2000", "run 800")
        found.append(run(text, written(tmp_path / str(ranks), cube(0.014, 1), "box"), ranks=ranks)[0])
    for value in ("f_w[1]", "f_w[2]", "f_w[3]", "KinEng"):
        one, two = (column(out, value) for out in found)
        assert np.abs(one - two).max() <= 1e-9 * np.abs(one).max() > 0, value


def peak_memory(walls, folder):
    """Peak memory [byte] of a run of 200,000 spheres above planes that no sphere touches."""
    law = f"{LAW.replace('thornton', 'cavity')} compaction on"
    planes = "".join(f"fix w{k} all wall/ep zplane {-1 - k} NULL {law}\n" for k in range(walls))
    folder.mkdir()
    (folder / "in.deck").write_text(f"""units si
atom_style sphere
comm_modify vel yes
newton off
boundary f f f
region box block -1 100 -1 100 -10 20 units box
create_box 1 box
region inner block 0 99.5 0 99.5 0 19.5 units box
lattice sc 1.0
create_atoms 1 region inner
set group all diameter 0.4 density 2500
pair_style ep
pair_coeff 1 1 {law}
neighbor 0.1 bin
{planes}timestep 1e-6
run 1
""")
    command = [str(launcher.program()), "-in", "in.deck", "-log", "none", "-screen", "none"]
    run = subprocess.Popen(command, cwd=folder, env=launcher.environment())
    _, status, usage = os.wait4(run.pid, 0)
    assert status == 0
    return 1024 * usage.ru_maxrss


def test_a_wall_without_contacts_takes_less_than_40_bytes_of_a_sphere(tmp_path):
    four_walls = peak_memory(5, tmp_path / "5") - peak_memory(1, tmp_path / "1")
    assert four_walls < 4 * 40 * 200_000
