# SPDX-License-Identifier: GPL-2.0-or-later
"""Oblique impacts in LAMMPS that a change of the set-up must not change.

Six pairs of unequal spheres of two materials and three spheres on a wall, which drift across the border of two ranks
during contact; `epdem verify crosscheck` examines e_n of each law by swap, sort, migration and restart.
"""

import numpy as np
import pytest
from lammps_decks import DUMP, THORNTON, bed, column, lammps, needs_lammps, run, spheres

from marks import thorough

pytestmark = needs_lammps

LAWS = {  # of the two materials
    "thornton": (
        "thornton 1e8 0.3 4e5 {}",
        "thornton 2e8 0.25 2e5 {}",
        "tangential partial_slip 0.3 rolling epsd2 0.1",
    ),
    "thornton_ning": (
        "thornton_ning 1e8 0.3 0.5 4e5 {}",
        "thornton_ning 2e8 0.25 0.3 2e5 {}",
        "tangential history 0.3 rolling epsd2 0.1",
    ),
    "cavity_adhesive": (
        "cavity_adhesive 1e8 0.3 0.005 4e5 {}",
        "cavity_adhesive 2e8 0.25 0.003 3e5 {}",
        "tangential history 0.3 rolling epsd2 0.1",
    ),
}
DAMPED = "tangential history 0.3 tangential_restitution 0.6"
WORDS = LAWS | {
    "frictionless": ("thornton 1e8 0.3 4e5 {}", "thornton 2e8 0.25 2e5 {}", DAMPED.replace("0.3", "0.0")),
    "damped": ("thornton 1e8 0.3 4e5 {}", "thornton 2e8 0.25 2e5 {}", DAMPED),
}
WALL = "fix floor all wall/ep zplane -0.01 NULL WORDS_2\n"
HALF, STEPS = 0.02, 600  # [m] of the box


def scene():
    """Rows of type, diameter, density, place, velocity, spin; the bodies of a pair follow each other."""
    rng = np.random.default_rng(7)
    radius, rows = np.array([1e-3, 0.7e-3]), []
    drift = np.array([0.3, 0.1, 0.0])
    for k in range(6):
        y, axis = -0.018 + 5e-3 * k, np.array([0.02 * (k - 3), 1.0, 0.3]) + 0.1 * rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        for side, r in ((1.0, radius[0]), (-1.0, radius[1])):
            place = np.array([-2e-5 - 4e-6 * k, y, 0.0]) + side * (r + 3e-6) * axis
            velocity = drift - side * 0.5 * axis + side * 0.2 * rng.normal(size=3)
            rows.append((1 + (side < 0), 2 * r, 2500.0, *place, *velocity, *(50 * rng.normal(size=3))))
    for k in range(3):
        place = (-3e-5, 0.012 + 2.5e-3 * k, -0.01 + radius[0] + 3e-6)
        rows.append((1, 2 * radius[0], 2500.0, *place, *(drift - (0.0, 0.3, 0.5 + 0.1 * k)), 0.0, 60.0, 0.0))
    return np.array(rows)


def end_of(law, folder, rows=None, *, head="", more="", steps=f"run {STEPS}", ranks=1):
    """Velocity and spin of all bodies after the impacts, shape (n, 6)."""
    rows = scene() if rows is None else rows
    folder.mkdir(parents=True, exist_ok=True)
    limits = [f"{-HALF} {HALF} {a}lo {a}hi" for a in "xyz"]
    atoms = [f"{n} {int(row[0])} " + " ".join(map(repr, row[1:6].tolist())) for n, row in enumerate(rows, 1)]
    motion = [f"{n} " + " ".join(map(repr, row[6:].tolist())) for n, row in enumerate(rows, 1)]
    text = ["impacts", "", f"{len(rows)} atoms", "2 atom types", *limits, "", "Atoms # sphere", "", *atoms]
    (folder / "bodies.data").write_text("\n".join([*text, "", "Velocities", "", *motion, ""]))
    text = f"""units si
atom_style sphere
atom_modify map array sort 0 0
boundary p p f
comm_modify vel yes
{head}
read_data bodies.data
pair_style ep
pair_coeff 1 1 WORDS_1
pair_coeff 2 2 WORDS_2
neighbor 2e-4 bin
neigh_modify delay 0
timestep 5e-7
{more}
{WALL}fix motion all nve/sphere
{steps}
{DUMP}"""
    for k, words in enumerate(WORDS[law][:2], 1):
        text = text.replace(f"WORDS_{k}", words.format(WORDS[law][2]))
    return run(text, folder, ranks=ranks)[1][:, 4:]


@pytest.fixture(scope="module", params=LAWS)
def law(request):
    return request.param


@pytest.fixture(scope="module")
def plain(law, tmp_path_factory):
    end = end_of(law, tmp_path_factory.mktemp("plain"))
    change = np.linalg.norm(end[:, :3] - scene()[:, 6:9], axis=1)
    assert (change > 0.1).all()  # all have met
    return end


def deviation(a, b):
    """Largest difference of velocity or spin, over the largest one."""
    return max(np.abs(a[:, part] - b[:, part]).max() / np.abs(b[:, part]).max() for part in (slice(3), slice(3, 6)))


EACH_STEP = "neigh_modify every 1 delay 0 check no"
BITS = {
    "lists made each step": {"more": EACH_STEP},
    "atoms sorted each step": {"more": f"{EACH_STEP}\natom_modify sort 1 0.002"},
    "two ranks": {"head": "processors 2 1 1", "more": EACH_STEP, "ranks": 2},
    "newton off": {"head": "newton off"},
    "newton off on two ranks": {"head": "newton off\nprocessors 2 1 1", "more": EACH_STEP, "ranks": 2},
}


@pytest.mark.parametrize("what", [thorough(what, unless=what != "two ranks") for what in BITS])
def test_lists_order_ranks_and_newton_change_no_bit(what, law, plain, tmp_path):
    assert np.array_equal(end_of(law, tmp_path, **BITS[what]), plain)


def test_the_order_of_the_bodies_changes_no_bit(law, plain, tmp_path):
    assert np.array_equal(end_of(law, tmp_path, scene()[::-1])[::-1], plain)


RESTART = f"""run 250
write_restart here
clear
atom_modify map array
comm_modify vel yes
read_restart here
neighbor 2e-4 bin
neigh_modify delay 0
timestep 5e-7
{WALL}fix motion all nve/sphere
run {STEPS - 250}"""


@pytest.mark.parametrize(
    "steps",
    [f"run 250\nrun {STEPS - 250}", f"run 250\nreset_timestep 7\nrun {STEPS - 250}", RESTART],
    ids=["two runs", "reset_timestep", "restart"],
)
def test_a_stop_in_mid_contact_changes_nothing_but_rounding(steps, law, plain, tmp_path):
    assert deviation(end_of(law, tmp_path, steps=steps), plain) <= 1e-11


def heap():
    """64 spheres on the wall and on each other that slide and stick, on both sides of the border of two ranks."""
    rng = np.random.default_rng(5)
    cell = np.array(list(np.ndindex(4, 4, 4))) - (1.5, 1.5, 0.0)
    places = (0.0, 0.0, -0.009) + 1.998e-3 * cell + rng.uniform(-1e-6, 1e-6, (64, 3))
    kind, diameter = rng.integers(1, 3, (64, 1)), rng.uniform(1.999e-3, 2e-3, (64, 1))
    motion = np.hstack([rng.uniform(-0.5, 0.5, (64, 3)), np.zeros((64, 3))])
    return np.hstack([kind, diameter, np.full((64, 1), 2500.0), places, motion])


@pytest.mark.parametrize("steps", ["run 300", "run 150\nrun 150", "run 300 every 10 NULL"])
def test_rows_ranks_and_runs_change_a_heap_with_dashpots_by_round_off(steps, tmp_path):
    """The evaluation before a run takes a contact that slides as one that slides, whatever the last digit says."""
    end = end_of("damped", tmp_path / "as it is", heap(), steps=steps)
    reversed_rows = end_of("damped", tmp_path / "reversed", heap()[::-1], steps=steps)[::-1]
    ranks = end_of("damped", tmp_path / "ranks", heap(), steps=steps, head="processors 2 1 1", ranks=2)
    assert deviation(reversed_rows, end) <= 1e-12 and deviation(ranks, end) <= 1e-12


def test_a_second_run_without_friction_has_no_dashpot_beside_it(tmp_path):
    one, two = (end_of("frictionless", tmp_path / s[4:7], heap(), steps=s) for s in ("run 100", "run 50\nrun 50"))
    assert np.abs(two - one).max() <= 1e-12 and np.abs(one[:, 3:]).max() <= 1e-12


SAME, MIRROR = np.eye(3), np.diag([-1.0, 1.0, 1.0])
TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
CHANGES = {  # of places and velocities, of spins, shift, velocity; bodies that are compared
    "mirror": (MIRROR, -MIRROR, 0.0, 0.0, 15),
    "quarter turn": (TURN, TURN, 0.0, 0.0, 15),
    "periodic face": (SAME, SAME, (HALF, 0.0, 0.0), 0.0, 15),
    "moving frame": (SAME, SAME, 0.0, (-3.0, 2.0, 0.0), 12),  # the wall stays behind
}


@pytest.mark.parametrize("what", CHANGES)
def test_reflection_rotation_and_frame_change_nothing_but_rounding(what, law, plain, tmp_path):
    of_vectors, of_spins, shift, drift, compared = CHANGES[what]
    rows = scene()
    rows[:, 3:6] = rows[:, 3:6] @ of_vectors.T + shift
    rows[:, 6:9] = rows[:, 6:9] @ of_vectors.T + drift
    rows[:, 9:] = rows[:, 9:] @ of_spins.T
    end = end_of(law, tmp_path, rows)
    back = np.hstack([(end[:, :3] - drift) @ of_vectors, end[:, 3:] @ of_spins])
    assert deviation(back[:compared], plain[:compared]) <= 1e-9


def test_momentum_of_each_pair_stays(plain):
    rows = scene()[:12]
    mass = (np.pi / 6 * rows[:, 1] ** 3 * rows[:, 2])[:, None]
    change = (mass * (plain[:12, :3] - rows[:, 6:9])).reshape(6, 2, 3)
    assert np.abs(change.sum(axis=1)).max() <= 1e-12 * np.abs(change).max()


def test_a_contact_that_ends_begins_anew_in_the_same_list(tmp_path):
    """A sphere bounces on a frozen one; with a list made each step, a contact that has ended has no history."""
    bounces = """group bottom id 1
fix ice bottom freeze
group top id 2
fix fall top gravity 9.81 vector 0 0 -1
fix motion top nve/sphere
timestep 2e-5
variable v equal vz[2]
thermo 1
thermo_style custom step v_v
thermo_modify format float %.17g
MORE
run 1500
"""
    text = spheres((0, 0, 0), (0, 0, 0.02002), pair=THORNTON) + bounces
    one, each = (run(text.replace("MORE", more), tmp_path / more[:3])[0] for more in ("", EACH_STEP))
    speed = column(one, "v_v")
    rises = np.flatnonzero((speed[1:] > 0) & (speed[:-1] <= 0))
    assert len(rises) >= 3 and "Neighbor list builds = 0" in one
    assert np.array_equal(speed, column(each, "v_v"))


@pytest.mark.parametrize("group", ["all", "some", "first"])
def test_motion_and_gravity_have_the_bits_of_lammps_own(group, tmp_path):
    """Of all spheres, of every third one, and of those of atom_modify first."""
    groups = {"all": "", "some": "group some id 1:2000:3\n", "first": "group first id 1:700\natom_modify first first\n"}
    deck = bed(more=groups[group]).replace("fix motion all", f"<GRAVITY>fix motion {group}")
    own = f"fix fall {group} gravity 9.81 vector 0 0 -1\nfix slip {group} gravity 3 vector 1 0 0\n"
    _, theirs = run(deck.replace("<GRAVITY>", own) + "run 300\n" + DUMP, tmp_path / "theirs")
    deck = deck.replace("<GRAVITY>", f"fix fall {group} gravity/ep 3 0 -9.81\n").replace("nve/sphere", "nve/sphere/ep")
    _, ours = run(deck + "run 300\n" + DUMP, tmp_path / "ours")
    assert (ours == theirs).all() and np.abs(ours[:, 7:]).max() > 1.0


@pytest.mark.parametrize(
    ("style", "words", "sentence"),
    [
        ("sphere", "nve/sphere/ep disc", "fix nve/sphere/ep: disc is not known; it has no words"),
        ("atomic", "nve/sphere/ep", "fix nve/sphere/ep needs atom_style sphere"),
        ("sphere", "gravity/ep 9.81", "fix gravity/ep: the words are ID group gravity/ep gx gy gz"),
        ("atomic", "gravity/ep 0 0 -9.81", "fix gravity/ep needs atom_style sphere"),
        ("sphere", "travel/ep v", "fix travel/ep: the words are ID group travel/ep SPEED TRAVEL"),
        ("sphere", "slowing/ep f_w sinks 1 0.1 20 1", "fix slowing/ep: the words are ID group slowing/ep FORCE"),
        ("sphere", "slowing/ep w rises 1 0.1 20 1", "FORCE is the f_ID or c_ID of a force, or its component"),
        ("sphere", "slowing/ep f_w rises 1N 0.1 20 1", "fix slowing/ep: the words are ID group slowing/ep FORCE"),
        ("sphere", "slowing/ep f_w[12 rises 1 0.1 20 1", "FORCE is the f_ID or c_ID of a force, or its component"),
        ("sphere", "slowing/ep f_w[0] rises 1 0.1 20 1", "FORCE is the f_ID or c_ID of a force, or its component"),
        ("sphere", "slowing/ep f_w falls 0 0.1 20 1", "LIMIT and NEAR are above 0, LAG is at least 1"),
        ("sphere", "slowing/ep f_w rises 1 0 20 1", "LIMIT and NEAR are above 0, LAG is at least 1"),
        ("sphere", "slowing/ep f_w rises 1 0.1 0 1", "LIMIT and NEAR are above 0, LAG is at least 1"),
    ],
)
def test_the_motion_refuses_words_and_points(style, words, sentence, tmp_path):
    code, said = lammps(
        f"atom_style {style}\nregion b block 0 1 0 1 0 1\ncreate_box 1 b\nfix m all {words}\n", tmp_path
    )
    assert code == 1 and sentence in said


@pytest.mark.parametrize(
    ("force", "words", "wanted"),
    [
        ("f_w", "rises 8", 1.0),  # of 5 N: far
        ("f_w", "rises 5.2", 0.2 / 5.2 / 0.1),
        ("f_w", "rises 4.8", -0.1 * 0.2 / 4.8 / 0.1),  # beyond, back
        ("f_w", "rises 1", -0.1),
        ("f_w", "falls 4.8", 0.2 / 4.8 / 0.1),
        ("f_w[2]", "rises 3.1", 0.1 / 3.1 / 0.1),  # of 3 N
        ("f_w[3]", "falls 4.1", -0.1 * 0.1 / 4.1 / 0.1),
    ],
)
def test_the_share_of_a_wall_follows_a_constant_force(force, words, wanted, tmp_path):
    """Exponentially, within 20 steps, from the share that the deck gives."""
    deck = "atom_style sphere\nregion b block 0 1 0 1 0 1\ncreate_box 1 b\n"
    deck += "variable x equal 0\nvariable y equal -3\nvariable z equal 4\nfix w all ave/time 1 1 1 v_x v_y v_z\n"
    deck += f"fix s all slowing/ep {force} {words} 0.1 20 0.7\nrun 30\nprint SHARE=$(f_s:%.15g)\n"
    code, said = lammps(deck, tmp_path)
    assert code == 0, said
    share = float(said.split("SHARE=")[-1].split()[0])
    assert share == pytest.approx(wanted + (0.7 - wanted) * (1 - 1 / 20) ** 30, rel=1e-12)


def test_a_sphere_of_many_contacts_crosses_two_faces_of_ranks_at_once(tmp_path):
    """The rank between has no sphere of many contacts, and room in its buffer for this one."""
    k = np.arange(4000)
    height, angle = 1 - (2 * k + 1) / len(k), np.pi * (3 - 5**0.5) * k
    level = np.sqrt(1 - height**2)
    around = np.column_stack([level * np.cos(angle), level * np.sin(angle), height])
    places = [np.zeros(3), *8.196e-3 * around[(around[:, :2] < -0.05).all(axis=1)]]
    rows = [(1, 4e-4 if k else 0.016, 2500.0, *(x - [1e-5, 1e-5, 0]), *[0.0] * 6) for k, x in enumerate(places)]
    steps = f"run 8{RESTART.removeprefix('run 250').rpartition('run')[0]}set atom 1 x 1e-6 y 1e-6\nrun 10"
    one = end_of("thornton", tmp_path / "1", np.array(rows), steps=steps)
    head = "processors 2 2 1"
    more = {"steps": steps.replace("clear", f"clear\n{head}"), "head": head, "ranks": 4}
    four = end_of("thornton", tmp_path / "4", np.array(rows), **more)
    assert len(rows) > 600 and (np.linalg.norm(one[1:, :3], axis=1) > 1e-3).all()  # all have met
    assert deviation(four, one) < 1e-9
