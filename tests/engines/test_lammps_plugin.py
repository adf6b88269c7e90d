# SPDX-License-Identifier: GPL-2.0-or-later
"""pair_style ep and its walls in LAMMPS: ranks, restart, settings of LAMMPS, energies, and wrong words."""

import math
import re

import numpy as np
import pytest
from lammps_decks import DUMP, THORNTON, bed, column, lammps, needs_lammps, run, spheres

from epdem.theory.cavity import FINITE_STRAIN

pytestmark = needs_lammps

DAMPED = "restitution 0.3 rolling epsd2 0.1"
TWO_TYPES = (
    f"1 1 thornton 1e8 0.3 4e5 tangential partial_slip 0.3 {DAMPED}",
    f"2 2 thornton 2e8 0.25 2e5 tangential partial_slip 0.5 {DAMPED}",
)
WALLS = (
    f"fix floor all wall/ep zplane 0 0.02 {THORNTON} tangential history 0.4\nfix fall all gravity 9.81 vector 0 0 -1"
)


def relative(a, b):
    return np.abs(a / b - 1).max()


def test_moving_borders_of_ranks_and_sorted_atoms_change_no_energy(tmp_path):
    """The order of sums differs; collisions amplify this, 1e-10 after 3,000 steps; here 1,500."""
    one, _ = run(bed(TWO_TYPES, types=2) + "atom_modify sort 0 0\nrun 1500\n", tmp_path / "one")
    more = "comm_style tiled\nfix borders all balance 50 0.9 rcb\natom_modify sort 50 0.002"
    two, _ = run(bed(TWO_TYPES, types=2, more=more) + "balance 0.9 rcb\nrun 1500\n", tmp_path / "two", ranks=2)
    energy = column(one, "KinEng")
    assert int(re.search(r"Neighbor list builds = (\d+)", one)[1]) >= 5 and energy[-1] < 0.95 * energy[0]
    assert relative(energy, column(two, "KinEng")) <= 1e-9
    assert relative(column(one, "Press"), column(two, "Press")) <= 1e-7


@pytest.mark.parametrize("style", ["ep", "ep energies"])
def test_a_restart_file_continues_to_the_bit(style, tmp_path):
    """Materials, histories of pairs and walls, and energies are in the file; the deck gives the walls again."""
    deck = bed(TWO_TYPES, types=2, style=style, boundary="p p f", more=WALLS)
    of_atoms = "".join(f" f_EP_HISTORY0[{k}]" for k in (1, 2, 3)) * ("energies" in style)
    dump = DUMP.replace("omegaz", "omegaz" + of_atoms)
    whole, end = run(deck + "run 1000\nwrite_restart half\nrun 1000\n" + dump, tmp_path)
    head = "comm_modify vel yes\nread_restart half\nneighbor 0.0004 bin\nneigh_modify delay 0\n"
    rest = deck[deck.index("fix floor") :]
    again, continued = run(head + rest + "run 1000\n" + dump, tmp_path)
    assert np.array_equal(end, continued) and np.all(end[:, 10:].max(axis=0) > 0)
    assert column(whole, "KinEng")[-1] == column(again, "KinEng")[-1]


def test_units_cgs_give_the_same_motion(tmp_path):
    """Without displace_atoms, whose random numbers follow from coordinates."""
    words = "1 1 thornton 1e9 0.3 4e6 tangential history 0.3"
    decks = (bed(), bed((words,), units="cgs", scale=100.0))
    si, cgs = (run(re.sub("displace_atoms.*", "", deck) + "run 300\n", tmp_path / deck[6:9])[0] for deck in decks)
    assert relative(1e7 * column(si, "KinEng"), column(cgs, "KinEng")) <= 1e-9


def test_hybrid_overlay_adds_another_style(tmp_path):
    plain, _ = run(bed() + "run 200\n", tmp_path / "plain")
    pairs = (f"1 1 ep {THORNTON} tangential history 0.3", "1 1 lj/cut 1e-30 1e-3 1e-6")
    both, _ = run(bed(pairs, style="hybrid/overlay ep lj/cut 1e-6") + "run 200\n", tmp_path / "both")
    assert relative(column(plain, "KinEng"), column(both, "KinEng")) <= 1e-12


HYBRID = """fix fall all gravity 9.81 vector 0 0 -1
fix ground hard wall/ep zplane 0 NULL hertz 1e7 0.3
fix motion all nve/sphere
timestep 1e-6
run 2000
"""


@pytest.mark.parametrize(("late", "sentence"), [("", ""), ("set atom 2 type 2", "spheres of type 2 have no material")])
def test_beside_another_style_a_wall_needs_the_materials_of_its_group(late, sentence, tmp_path):
    """Spheres of type 2 have a pair style of another law, and are not in the group."""
    deck = spheres((-0.05, 0, 0.0099), (0.05, 0, 0.0099), (0, 0.05, 0.0099), pair="ep hertz 1e7 0.3")
    deck = deck.replace("create_box 1", "create_box 2").replace("pair_style ep", "pair_style hybrid ep lj/cut 1e-6")
    deck = deck.replace("pair_coeff * *", "pair_coeff 1 1").replace(
        "neighbor", "pair_coeff 2 2 lj/cut 0 1e-6\nneighbor"
    )
    deck = deck.replace("pair_style", "set atom 3 type 2\ngroup hard id 1 2\npair_style")
    code, out = lammps(deck + "pair_coeff 1 2 lj/cut 0 1e-6\n" + late + "\n" + HYBRID + DUMP, tmp_path)
    assert (code != 0) == bool(sentence) and sentence in out, out[-2000:]
    if not sentence:
        z = np.loadtxt(tmp_path / "end.txt", skiprows=9)[:, 4]
        assert z[0] == z[1] > 0.0099 > z[2]


def test_a_region_that_moves_takes_a_sphere_along(tmp_path):
    """A plane that rises at 1 m/s hits a sphere at rest: elastic, so the sphere leaves at 2 m/s."""
    deck = """
variable rise equal ramp(0,1e-3)
region plate plane 0 0 0 0 0 1 move NULL NULL v_rise
fix plate all wall/ep/region plate hertz 1e9 0.3
fix motion all nve/sphere
timestep 1e-7
run 10000
variable v equal vz[1]
print "speed $v"
"""
    out, _ = run(spheres((0, 0, 0.01001), pair="hertz 1e9 0.3") + deck, tmp_path)
    assert float(re.search(r"^speed (\S+)", out, re.MULTILINE)[1]) == pytest.approx(2.0, rel=1e-4)


def test_a_run_in_pieces_is_the_whole_run(tmp_path):
    """Forces before the first step of a run equal the forces of the last step, with partial slip in a bed."""
    friction = TWO_TYPES[0].replace(DAMPED, "")
    deck = bed((friction,), boundary="p p f", more=WALLS.replace("history", "partial_slip"))
    _, whole = run(deck + "run 300\n" + DUMP, tmp_path / "whole")
    _, parts = run(deck + "run 10\n" * 30 + DUMP, tmp_path / "pieces")
    assert np.abs(whole - parts).max() <= 1e-10 * np.abs(whole[:, 4:]).max()


def test_energies_of_atoms_close_the_balance(tmp_path):
    """What loose spheres lose of their kinetic energy is plastic, elastic, or lost and stored by friction."""
    words = f"{THORNTON} tangential partial_slip 0.3"
    more = f"""fix walls all wall/ep zplane 0 0.02 {words}
compute spin all erotate/sphere
compute sums all reduce sum f_EP_HISTORY0[1] f_EP_HISTORY0[2] f_EP_HISTORY0[3] f_EP_HISTORY0[4] f_EP_HISTORY0[5]"""
    deck = bed((f"1 1 {words}",), style="ep energies", boundary="p p f", more=more).replace("0.00192", "0.0022")
    deck = deck.replace("timestep 2e-6", "timestep 1e-6").replace("step atoms ke press", "step ke c_spin c_sums[*]")
    out, _ = run(deck + "run 20000\n", tmp_path)
    names = ("KinEng", "c_spin", *(f"c_sums[{k}]" for k in range(1, 6)))
    ke, rotation, plastic, elastic, contacts, lost, stored = (column(out, name) for name in names)
    total = ke + rotation + plastic + elastic + lost + stored
    assert plastic[-1] > 0.05 * ke[0] and lost[-1] > 0.02 * ke[0] and contacts.max() > 100
    assert np.abs(total / total[0] - 1).max() < 1e-5


def test_works_alone_change_no_bit(tmp_path):
    """pair_style ep works: motion and plastic work equal a run with energies, columns 2 and 3 stay 0."""
    words = "cavity 1e8 0.3 4e5 tangential history 0.3 compaction on"
    dump = DUMP.replace("omegaz", "omegaz f_EP_HISTORY0[1] f_EP_HISTORY0[2] f_EP_HISTORY0[3]")
    more = f"fix floor all wall/ep zplane 0 0.02 {words}"
    decks = {w: bed((f"1 1 {words}",), style=f"ep {w}", boundary="p p f", more=more) for w in ("energies", "works")}
    whole, works = (run(deck + "run 300\n" + dump, tmp_path / name)[1] for name, deck in decks.items())
    assert np.all(whole[:, -3:].max(axis=0) > 0) and not works[:, -2:].any()
    assert np.array_equal(whole[:, :-2], works[:, :-2])


def test_a_frozen_group_is_a_heavy_body(tmp_path):
    """fix freeze: the sphere bounces from a frozen one as the theory of a fixed target says, for restitution 0.5."""
    deck = """
group bottom id 1
group top id 2
velocity top set 0 0 -0.1
fix ice bottom freeze
fix motion top nve/sphere
timestep 2e-7
run 5000
variable v equal vz[2]
print "speed $v"
"""
    out, _ = run(spheres((0, 0, 0), (0, 0, 0.020001), pair="hertz 1e9 0.3 restitution 0.5") + deck, tmp_path)
    assert float(re.search(r"^speed (\S+)", out, re.MULTILINE)[1]) == pytest.approx(0.05, rel=2e-3)


def test_virial_is_that_of_the_forces(tmp_path):
    """Two spheres pressed together along x: p_xx V = F times the distance."""
    deck = """
fix motion all nve/sphere
compute stress all stress/atom NULL
compute total all reduce sum c_stress[1]
compute pairs all pair/local force eng p1 p2 p3 p4
compute values all reduce sum c_pairs[*] inputs local
thermo_style custom step pxx c_total c_values[1]
variable f equal fx[2]
run 0
print "force ${f} $(pxx) $(c_total)"
print "pair $(c_values[1]) $(c_values[2]) $(c_values[3]) $(c_values[4]) $(c_values[5]) $(c_values[6])"
"""
    pair = spheres((0, 0, 0), (0.0198, 0, 0), pair=THORNTON)
    out, _ = run(pair + deck, tmp_path)
    alone, _ = run(pair + 'fix motion all nve/sphere\nthermo_style custom pxx\nrun 0\nprint "alone $(pxx)"\n', tmp_path)
    force, pressure, stress = map(float, re.search(r"^force (.*)", out, re.MULTILINE)[1].split())
    E_star, R_star, alpha = 1e8 / (2 * 0.91), 0.005, 2e-4
    alpha_y = (math.pi * 4e5 / (2 * E_star)) ** 2 * R_star
    yielded = 2 / 3 * math.pi * 4e5 * R_star * alpha_y + math.pi * 4e5 * R_star * (alpha - alpha_y)
    assert force == pytest.approx(yielded, rel=1e-9)
    assert pressure * 8e-3 == pytest.approx(force * 0.0198, rel=1e-9)
    assert -stress == pytest.approx(force * 0.0198, rel=1e-9)
    assert float(re.search(r"^alone (.*)", alone, re.MULTILINE)[1]) == pytest.approx(pressure, rel=1e-9)
    # unloading with the radius R_p = 4 E* a^3/(3 F): the force is that of Hertz for it
    a = math.sqrt(R_star * alpha)
    elastic = 2 / 5 * force * (3 * force / (4 * E_star * a))
    pair = [float(x) for x in re.search(r"^pair (.*)", out, re.MULTILINE)[1].split()]
    assert pair == pytest.approx([force, elastic, alpha, alpha, a, 1.0], rel=1e-6)


DENSE = f"cavity 1e8 0.3 4e5 1.6 2.8 {FINITE_STRAIN} compaction on"
WRONG = {
    "ep fast": ("pair_style ep", "pair_style ep fast", "pair_style ep: fast is no setting of the style"),
    "law": ("thornton", "tornton", "pair_coeff 1 1: law = tornton, must be hertz, thornton"),
    "modulus": ("1e8", "-1e8", "Young's modulus E = -1e8, must be > 0"),
    "modulus as a word": ("1e8", "steel", "Young's modulus E = steel, must be a number"),
    "Poisson": ("1e8 0.3", "1e8 30", "Poisson's ratio nu = 30, must lie in (-1, 0.5]"),
    "no strength": ("4e5 tangential", "tangential", "p_y [Pa] of thornton E nu p_y = tangential, must be a number"),
    "strength": ("4e5", "0", "p_y [Pa] of thornton E nu p_y = 0, must be > 0"),
    "too short": ("1e8 0.3 4e5 tangential history 0.3", "1e8", "ends before Poisson's ratio nu"),
    "tangential": ("history", "mindlin", "tangential = mindlin, must be none, no_history, history"),
    "no friction": ("history 0.3", "history", "ends before friction mu"),
    "friction": ("history 0.3", "history -0.3", "friction mu = -0.3, must be >= 0"),
    "option": ("history 0.3", "history 0.3 damping tsuji", "option = damping, must be tangential, restitution"),
    "twice": ("history 0.3", "history 0.3 tangential none", "option tangential stands twice"),
    "restitution": ("history 0.3", "history 0.3 restitution 0.1", "restitution e = 0.1, must lie in [0.14, 1]"),
    "rolling": ("history 0.3", "history 0.3 rolling sds 0.1", "rolling = sds, must be none, cdt or epsd2"),
    "cohesion": ("history 0.3", "history 0.3 cohesion jkr 1", "cohesion = jkr, must be none, sjkr, sjkr2 or bond"),
    "both attract": (
        f"{THORNTON} tangential history 0.3",
        "jkr 1e8 0.3 0.1 cohesion sjkr 1e3",
        "cohesion sjkr beside jkr, which attracts by itself",
    ),
    "adhesion and partial slip": (
        f"{THORNTON} tangential history 0.3",
        "jkr 1e8 0.3 0.1 tangential partial_slip 0.3",
        "tangential partial_slip does not exist beside law jkr",
    ),
    "compaction": ("history 0.3", "history 0.3 compaction on", "law thornton has no compaction; take law cavity"),
    "compaction and cohesion": (
        f"{THORNTON} tangential history 0.3",
        f"{DENSE} cohesion sjkr 1e3",
        "compaction beside cohesion sjkr; remove one",
    ),
    "compaction of pairs alone": (
        f"{THORNTON} tangential history 0.3",
        f"{DENSE}\nfix w all wall/ep zplane -1 NULL {DENSE.removesuffix(' compaction on')}",
        "compaction is off here and on in pair_coeff",
    ),
    "gap": (f"{THORNTON} tangential history 0.3", "jkr 1e4 0.3 10", "pulls across gaps up to"),
    "cavity": (THORNTON, "cavity 1e8 0.3 1e5 3 1", "the parameters of cavity do not go together"),
    "no ghost velocity": ("comm_modify vel yes", "", "add comm_modify vel yes"),
    "units": ("units si", "units real", "units real measure pressure by other units"),
    "atom style": ("atom_style sphere", "atom_style hybrid sphere ellipsoid", "holds other bodies than spheres"),
    "respa": ("run 1", "run_style respa 2 2\nrun 1", "run_style respa has steps of several lengths"),
    "minimize": ("run 1", "minimize 0 0 10 10", "minimization has no steps in time"),
    "no pair_coeff": ("pair_coeff", "#", "All pair coeffs are not set"),
    "wall of another law": (
        "run 1",
        "fix w all wall/ep zplane 0 NULL hertz 1e8 0.3\nrun 1",
        "fix w wall/ep zplane: the material of the spheres comes from a pair_style ep of law hertz",
    ),
    "wall upside down": ("run 1", f"fix w all wall/ep zplane 1 0 {THORNTON}", "lo = 1 must lie below hi = 0"),
    "wall across a periodic direction": (
        "run 1",
        f"fix w all wall/ep yplane NULL 0.02 {THORNTON}\nrun 1",
        "fix w wall/ep yplane: the box is periodic along y; give boundary f, s or m, or another plane",
    ),
    "wall without place": ("run 1", f"fix w all wall/ep zcylinder 1 0 {THORNTON}", "must be xplane, yplane or zplane"),
    "gap at a wall": (
        f"{THORNTON} tangential history 0.3",
        "jkr 1e8 0.3 0.1\nfix w all wall/ep zplane 0 NULL jkr 1e8 0.3 1e10",
        "fix w wall/ep zplane: law jkr pulls across gaps up to",
    ),
    "no region": ("run 1", f"fix w all wall/ep/region bin {THORNTON}", "there is no region bin"),
    "rigid bodies at a wall": (
        "history 0.3",
        f"history 0.3\nfix body all rigid single\nfix w all wall/ep zplane 0 NULL {THORNTON} restitution 0.5",
        "fix w wall/ep zplane: restitution needs the mass of the body of fix rigid body",
    ),
    "rigid bodies": (
        "history 0.3",
        "history 0.3 restitution 0.5\nfix body all rigid single",
        "pair_style ep: restitution needs the mass of the body of fix rigid body",
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_wrong_words_end_with_one_sentence(what, tmp_path):
    old, new, sentence = WRONG[what]
    text = bed() + "run 1\n"
    assert old in text
    code, out = lammps(text.replace(old, new), tmp_path)
    errors = [line for line in out.splitlines() if line.startswith("ERROR")]
    assert code != 0 and len(errors) == 1 and sentence in errors[0], out[-2000:]
    assert len(errors[0]) < 330 and "Segmentation" not in out


def test_types_in_the_wrong_order_end_with_one_sentence(tmp_path):
    """LAMMPS itself exchanges two numbers, and no ranges."""
    code, out = lammps(
        bed(TWO_TYPES, types=2).replace("pair_coeff 2 2", "pair_coeff 2*2 1 hertz 1 0\npair_coeff 2 2"), tmp_path
    )
    assert code != 0 and "pair_coeff 2*2 1: the first type is above the second; exchange them" in out


def test_a_rank_without_spheres_of_a_type_has_their_cutoff(tmp_path):
    """Each of two spheres in contact is the only one of its type and of its rank."""
    deck = "processors {} 1 1\n" + spheres((-0.0099, 0, 0), (0.0099, 0, 0), pair=THORNTON)
    deck = deck.replace("create_box 1", "create_box 2") + "set atom 2 type 2\nfix motion all nve/sphere\n"
    one, two = (run(f"{deck.format(n)}timestep 1e-6\nrun 20\n{DUMP}", tmp_path / str(n), ranks=n)[1] for n in (1, 2))
    assert np.array_equal(one, two) and one[1, 4] > 0


def test_unlike_types_have_the_lower_strength_and_the_mean_of_the_coefficients(tmp_path):
    """Given by hand, the same numbers of the pair give the same bits."""
    alike = bed(TWO_TYPES, types=2)
    E = 2 / ((1 - 0.09) / 1e8 + (1 - 0.0625) / 2e8)  # the modulus of two equal bodies without lateral strain
    out, a = run(alike + "run 300\n" + DUMP, tmp_path / "mixed")
    frictionless = tuple(re.sub(" tangential .*", "", words) for words in TWO_TYPES)
    _, b = run(bed(frictionless, types=2) + "run 300\n" + DUMP, tmp_path / "frictionless")
    _, c = run(bed((*frictionless, f"1 2 thornton {E!r} 0 2e5"), types=2) + "run 300\n" + DUMP, tmp_path / "given")
    assert np.abs(b - c).max() <= 1e-9 * np.abs(b).max()
    assert np.abs(a - b).max() > 1e-3 * np.abs(b).max()
    rubbing = (*TWO_TYPES, f"1 2 mixed tangential partial_slip {math.sqrt(0.3 * 0.5)!r} {DAMPED}")
    _, d = run(bed(rubbing, types=2) + "run 300\n" + DUMP, tmp_path / "rubbing")
    assert np.abs(a - d).max() <= 1e-9 * np.abs(a).max()


TURN = """units lj
atom_style sphere
newton on
comm_modify vel yes
boundary f f f
region room block -9 9 -9 9 -9 9 units box
create_box 1 room
PAIR
region cup block -5 5 -4 4 -5 5 units box
WALL
neighbor 0.4 bin
neigh_modify delay 0
region drop block -3 3 -3 3 -2 4 units box
fix rain all pour 120 1 9182 vol 0.3 20 diam range 0.8 1.1 dens 1 1 region drop
fix fall all gravity 1 vector 0 0 -1
fix motion all nve/sphere
timestep 0.002
compute height all reduce ave z
compute_modify thermo_temp dynamic/dof yes
thermo 500
thermo_style custom step atoms ke c_height
run 6000
unfix rain
region cup delete
variable angle equal (step-6000)*PI/6000
region cup block -5 5 -4 4 -5 5 rotate v_angle 0 0 0 0 1 0 units box
run 6000
"""


def test_a_box_that_is_defined_anew_turns_its_spheres_over_as_with_granular(tmp_path):
    """Two lines change: units lj, newton on, a region that is deleted and comes back with a rotation."""
    words = "thornton 5e3 0.3 100 tangential history 0.5 restitution 0.5"
    deck = TURN.replace("PAIR", f"pair_style ep\npair_coeff * * {words}")
    granular = "hertz/material 5e3 0.5 0.3 tangential mindlin NULL 1.0 0.5 damping tsuji"
    before = TURN.replace("PAIR", f"pair_style granular\npair_coeff * * {granular}")
    ours, _ = run(deck.replace("WALL", f"fix cup all wall/ep/region cup {words}"), tmp_path)
    theirs, _ = run(before.replace("WALL", f"fix cup all wall/gran/region granular {granular} region cup"), tmp_path)
    height, other = column(ours, "c_height"), column(theirs, "c_height")
    assert column(ours, "Atoms")[-1] == column(theirs, "Atoms")[-1] == 120
    half = len(height) // 2
    assert height[half - 1] < -3 and height[half:].max() > -1  # on the floor; lifted
    assert np.abs(height - other).mean() < 0.6
