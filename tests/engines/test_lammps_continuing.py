# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in LAMMPS that goes on: atoms with new numbers, walls that move, restart files."""

import struct

import numpy as np
import pytest
from lammps_decks import DUMP, THORNTON, bed, column, lammps, needs_lammps, run, spheres

from epdem.scenes.plan.meshes import rectangle, stl_text
from marks import thorough

pytestmark = needs_lammps

HALF = "region half block 0.01 0.02 0.004 0.012 INF INF units box\ngroup half region half\n"
NUMBERS = {  # what numbers the atoms anew between two runs
    "delete_atoms": "delete_atoms group half\n",
    "reset_atoms": "delete_atoms group half compress no\nreset_atoms id\n",
    "reset_atoms sorted": "delete_atoms group half compress no\nreset_atoms id sort yes\n",
    "reset_atoms twice": "delete_atoms group half\nreset_atoms id sort yes\nrun 0\nreset_atoms id\n",
}


def in_order(rows):
    """Rows of end.txt by place, because numbers of atoms differ."""
    return rows[np.lexsort(rows[:, 1:4].T)]


@pytest.mark.parametrize(
    ("what", "ranks"),
    [thorough(what, n, unless=n == 1 or what == "reset_atoms twice") for what in NUMBERS for n in (1, 2)],
)
def test_atoms_with_new_numbers_keep_their_dents(what, ranks, tmp_path):
    """The same bed, whose atoms keep their numbers, ends with the same motion."""
    deck = bed().replace("atom_modify map array", "atom_modify map array sort 0 0") + "run 400\n" + HALF
    between = NUMBERS["reset_atoms"].splitlines()[0] + "\n" + "run 0\n" * NUMBERS[what].count("run 0")
    one, kept = run(deck + between + "run 400\n" + DUMP, tmp_path / "kept", ranks=ranks)
    two, anew = run(deck + NUMBERS[what] + "run 400\n" + DUMP, tmp_path / "anew", ranks=ranks)
    assert 100 < len(kept) == len(anew) < 1990
    assert np.abs(in_order(kept)[:, 4:] - in_order(anew)[:, 4:]).max() <= 1e-9 * np.abs(kept[:, 4:]).max()
    assert column(two, "KinEng")[-1] == pytest.approx(column(one, "KinEng")[-1], rel=1e-12)


def test_a_sphere_that_takes_the_number_of_a_deleted_one_has_no_dent(tmp_path):
    """Sphere 2 dents sphere 1 by 0.5 mm and goes; another sphere 2 comes to 0.49 mm, for the first time."""
    other = "region upper block INF INF 0.01 INF INF INF\ndelete_atoms region upper compress no\n"
    new = "create_atoms 1 single 0 0.01951 0\nset group all diameter 0.02 density 7850\nrun 0\n"
    deck = "fix hold all setforce 0 0 0\nfix motion all nve/sphere\ncompute p all stress/atom NULL pair\n"
    deck += "compute s all reduce sum c_p[2]\nthermo_style custom step c_s\nthermo_modify format float %.17g\n"
    again, _ = run(spheres((0, 0, 0), (0, 0.0195, 0), pair=THORNTON) + deck + "run 10\n" + other + new, tmp_path / "a")
    once, _ = run(spheres((0, 0, 0), (0, 0.01951, 0), pair=THORNTON) + deck + "run 0\n", tmp_path / "b")
    assert column(again, "c_s")[-1] == pytest.approx(column(once, "c_s")[-1], rel=1e-9)


LAW = "thornton 1e8 0.3 4e5 tangential history 0.5 restitution 0.3"
MOVING = {  # variables and region of a wall that spheres lie on
    "moved": "variable way equal 0.05*step*dt\nregion wall plane 0 0 0 0 0 1 move v_way NULL v_way\n",
    "vibrating": "variable way equal 2e-5*sin(2000*step*dt)\nregion wall plane 0 0 0 0 0 1 move v_way NULL v_way\n",
    "turning": "variable angle equal 5*step*dt\nregion wall plane 0 0 0 0 0 1 rotate v_angle 0.01 0 0 0 0 1\n",
    "triangles": "variable angle equal 5*step*dt\nvariable way equal 0.05*step*dt\n",
}
PLATE = "mesh ../plate.stl move v_way NULL v_way rotate v_angle 0.01 0 0 0 0 1"
STEPS = 400


def moving_wall(what):
    """Head of the deck, and what a deck behind read_restart repeats."""
    head = spheres((-0.02, 0, 0.00999), (0.02, 0, 0.00998), (0.03, 0.05, 0.00997), pair=LAW)
    words = f"wall/ep {PLATE}" if what == "triangles" else "wall/ep/region wall"
    wall = MOVING[what] + f"fix wall all {words} {LAW}\nfix fall all gravity 9.81 vector 0 0 -1\n"
    wall += "fix motion all nve/sphere\ntimestep 2e-6\nthermo_style custom step f_wall[1] f_wall[3] f_wall[7]\n"
    return head, wall + "thermo_modify format float %.17g\nthermo 1\n"


@pytest.mark.parametrize(
    ("what", "ranks"), [thorough(what, n, unless=n == 1 or what == "moved") for what in MOVING for n in (1, 2)]
)
def test_a_wall_that_moves_goes_on_after_a_restart_to_the_bit(what, ranks, tmp_path):
    """With restitution: force, power and motion are those of a second run."""
    (tmp_path / "plate.stl").write_text(stl_text("plate", rectangle(2, [0, 0, 0], (0.15, 0.15))))
    head, wall = moving_wall(what)
    more = "clear\natom_modify map array\ncomm_modify vel yes\nread_restart here\nneighbor 0.002 bin\n"
    deck = head + wall + f"run {STEPS}\n"
    one, plain = run(f"{deck}run {STEPS}\n{DUMP}", tmp_path / "plain", ranks=ranks)
    two, again = run(f"{deck}write_restart here\n{more}{wall}run {STEPS}\n{DUMP}", tmp_path / "again", ranks=ranks)
    assert np.abs(column(one, "f_wall[7]")).max() > 0
    for value in ("f_wall[1]", "f_wall[3]", "f_wall[7]"):
        assert np.array_equal(column(one, value), column(two, value)), value
    assert np.array_equal(plain, again)


@pytest.mark.parametrize("law", ["hertz 1e8 0.3 restitution 0.3", f"{THORNTON} restitution 0.3"])
@pytest.mark.parametrize("what", ["moved", "vibrating"])
def test_a_wall_that_moves_goes_on_in_runs_of_one_step(what, law, tmp_path):
    """A dashpot sees velocities of the full step before the first step of a run, of the half step else: first order."""
    head, wall = (text.replace(LAW, law) for text in moving_wall(what))
    _, whole = run(head + wall + f"run {STEPS}\n" + DUMP, tmp_path / "whole")
    pieces = f"variable k loop {STEPS}\nlabel again\nrun 1 post no\nnext k\njump SELF again\n"
    _, parts = run(head + wall + pieces + DUMP, tmp_path / "parts")
    assert np.abs(whole - parts).max() <= 5e-3 * np.abs(whole[:, 4:]).max()


AGAIN = "clear\natom_modify map array\ncomm_modify vel yes\nread_restart here\nneighbor 0.002 bin\n"
STRAIN = """fix motion all nve/sphere
timestep 2e-6
thermo 100
thermo_style custom step f_EP_HISTORY0[1] f_EP_HISTORY0[2]
thermo_modify format float %.17g
"""


@pytest.mark.parametrize(
    "law",
    [
        ("cavity 1e8 0.3", "7e5", "4e5"),
        ("thornton_ning 1e8 0.3", "5 2e6", "3 1e6"),
        ("cavity_adhesive 1e8 0.3", "0.05 7e5", "0.03 4e5"),
    ],
)
def test_round_off_in_positions_between_two_runs_changes_no_force_of_new_types(law, tmp_path):
    """A contact that grows is at its largest overlap then; below, it keeps the force of its former types."""
    words, *strengths = law
    pairs = [f"{k} {k} {words} {strength} tangential history 0.3" for k, strength in enumerate(strengths, 1)]
    deck = bed(pairs, types=2) + "run 100\n"
    new = "set group all type 2\nrun 1\n" + DUMP
    _, rows = run(deck + new, tmp_path / "as it is")
    for seed in (1, 2):
        moves = f"displace_atoms all random 1e-17 1e-17 1e-17 {seed} units box\n"
        _, moved = run(deck + moves + new, tmp_path / f"moved{seed}")
        assert np.abs(rows - moved)[:, 4:].max() < 1e-9 * np.abs(rows[:, 4:]).max()


def test_a_restart_file_holds_all_contacts_of_the_rank_that_has_more(tmp_path):
    """Seven spheres pressed together on the second rank, two on the first."""
    cross = 0.0195 * np.vstack([np.zeros(3), np.eye(3), -np.eye(3)]) + [0.05, 0, 0]
    head = "processors 2 1 1\n" + spheres((-0.05, 0, 0), (-0.0305, 0, 0), *cross.tolist(), pair=LAW)
    motion = f"fix motion all nve/sphere\ntimestep 2e-6\nrun {STEPS}\n"
    _, plain = run(f"{head}{motion}run {STEPS}\n{DUMP}", tmp_path / "plain", ranks=2)
    _, again = run(f"{head}{motion}write_restart here\n{AGAIN}{motion}{DUMP}", tmp_path / "again", ranks=2)
    assert np.abs(plain[:, 5:8]).max() > 0
    assert np.array_equal(plain, again)


def test_a_contact_that_ends_where_a_restart_goes_on_begins_anew(tmp_path):
    """A sphere jumps off a spring of friction in the first step and falls back within the same lists."""
    motion = "fix motion top nve/sphere\ntimestep 2e-6\n"
    press = spheres((0, 0, 0), (0, 0, 0.0199), pair=f"{THORNTON} tangential history 0.3")
    press += f"group top id 2\nvelocity top set 0.3 0 0\n{motion}run 60\n"
    jump = f"fix fall top gravity 2.5e6 vector 0 0 -1\nvelocity top set 0 0 60\nrun 30\n{DUMP}"
    _, plain = run(press + jump, tmp_path / "plain")
    out, again = run(press + "write_restart here\n" + AGAIN + motion + jump, tmp_path / "again")
    assert np.array_equal(plain, again) and "Neighbor list builds = 0" in out


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_restart_file_holds_the_strain_so_far(ranks, tmp_path):
    """Two spheres have met and parted."""
    head = spheres((-0.01, 0, 0), (0.0099, 0, 0), pair=f"{THORNTON} tangential history 0.3")
    head = head.replace("pair_style ep", "pair_style ep strain") + STRAIN + "run 3000\nwrite_restart here\n"
    out, rows = run(
        head + AGAIN + "fix motion all nve/sphere\nrun 0\nunfix motion\n" + STRAIN + "run 100\n" + DUMP,
        tmp_path,
        ranks=ranks,
    )
    assert rows[1, 1] - rows[0, 1] > 0.02
    for value in ("f_EP_HISTORY0[1]", "f_EP_HISTORY0[2]"):
        strain = column(out, value)
        assert strain.max() > 5e-3 and np.all(strain[-2:] == strain.max())


def test_a_restart_file_names_models_by_their_ids_and_a_former_one_is_refused(tmp_path):
    """Ids of restart files: law thornton 41; tangential history 2 and no rolling friction 0, as in LIGGGHTS."""
    head = spheres((-0.01, 0, 0), (0.0099, 0, 0), pair=f"{THORNTON} tangential history 0.3")
    run(head + "fix motion all nve/sphere\nrun 10\nwrite_restart here\n", tmp_path)
    file = tmp_path / "here"
    stored, numbers = file.read_bytes(), struct.pack("4d", -5.0, 41.0, 2.0, 0.0)
    assert stored.count(numbers) == 1
    file.write_bytes(stored.replace(numbers, struct.pack("4d", 1.0, 2.0, 0.0, 7.0)))
    code, out = lammps("atom_modify map array\ncomm_modify vel yes\nread_restart here\nrun 0\n", tmp_path)
    errors = [line for line in out.splitlines() if line.startswith("ERROR")]
    assert code != 0 and len(errors) == 1
    assert "pair_style ep: the restart file comes from a former version of epdem; run its deck again" in errors[0]


WALL_LATER = {
    "its ID": ("fix wall", "", ""),
    "another ID": ("fix floor", "", "holds contacts of walls with the IDs wall, and none of a wall with this ID"),
    "a run before": ("fix wall", "run 0\n", "its contacts of the restart file ended with the first run"),
    "a new wall later": ("fix floor", "run 0\n", ""),
}


@pytest.mark.parametrize("what", WALL_LATER)
def test_a_wall_that_would_lose_its_dents_after_a_restart_is_refused(what, tmp_path):
    fix, before, wrong = WALL_LATER[what]
    head, wall = moving_wall("moved")
    again = wall.replace("fix motion all nve/sphere", "").replace("fix wall", fix).replace("f_wall", f"f_{fix[4:]}")
    deck = f"{head}{wall}run 10\nwrite_restart here\n{AGAIN}fix motion all nve/sphere\n{before}{again}run 10\n"
    code, out = lammps(deck, tmp_path)
    assert (code != 0) == bool(wrong) and wrong in out, out[-2000:]
