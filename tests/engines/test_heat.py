# SPDX-License-Identifier: GPL-2.0-or-later
"""fix heat/ep in LAMMPS and LIGGGHTS: one contact, lattices, energy, ranks, restart, and what it refuses.

The decks are LAMMPS's; LIGGGHTS runs them in its words."""

import math
import re
from functools import partial

import numpy as np
import pytest
from lammps_decks import THORNTON, bed, column, lammps, needs_lammps, spheres
from plugin_decks import run as liggghts

HOSTS = pytest.mark.parametrize(
    "host", [pytest.param(name, marks=getattr(pytest.mark, name)) for name in ("lammps", "liggghts")]
)
SLIP = "tangential partial_slip 0.3"
WORDS = (  # of LAMMPS, of LIGGGHTS
    (r"atom_style sphere", "atom_style granular\nnewton off"),
    (r"newton off\n(?=comm_modify)", ""),
    (r"comm_modify vel yes", "communicate single vel yes"),
    (r"f_heat\b(?!\[)", "f_temperature"),
    (r"f_EP_HISTORY0\[1\] f_EP_HISTORY0\[4\]", "f_plasticWork f_frictionWork"),
    (r"pair_style ep( energies)?\n", ""),
    (r" 1234 ", " 15485863 "),
    (
        r"write_dump (all custom) (end.txt id type x y z \w+) modify.*",
        r'dump end \1 1 \2\ndump_modify end sort id format "%d %d %.17g %.17g %.17g %.17g"\nrun 0',
    ),
)
STRENGTHS = {"thornton": "yieldPressure", "cavity": "yieldStress"}
WALL = re.compile(r"fix (\w+) all wall/ep (\wplane) (\S+) (\S+) (.*)")


def contact_model(words, types, works):
    """Properties of like types and the contact model, from the words of a pair or a wall of LAMMPS."""
    law, E, nu, *others = words.split()
    properties = {"youngsModulus": E, "poissonsRatio": nu}
    if law in STRENGTHS:
        properties[STRENGTHS[law]] = others[0]
    pairs = {"coefficientFriction": "0.3", "coefficientRestitution": "0.5" if "restitution" in words else "0.9"}
    tables = {name: f"peratomtype {f'{x} ' * types}" for name, x in properties.items()}
    tables |= {name: f"peratomtypepair {types} {f'{x} ' * types**2}" for name, x in pairs.items()}
    lines = [f"fix {name} all property/global {name} {table}\n" for name, table in tables.items()]
    slip = "ep/partial_slip" if "partial_slip" in words else "off"
    return "".join(lines), f"model ep/{law} tangential {slip}" + " computePlasticWork on" * works


def in_words_of_liggghts(text):
    """A deck of LAMMPS of one material."""
    model = partial(contact_model, types=int(re.search(r"create_box (\d)", text)[1]), works="ep energies" in text)
    for word, other in WORDS:
        text = re.sub(word, other, text)

    def pair(found):
        properties, words = model(found[1])
        return f"{properties}pair_style gran {words}\npair_coeff * *\n"

    def wall(found):
        planes = [(found[1], found[3]), (found[1] + "_high" * (found[3] != "NULL"), found[4])]
        words, settings = re.fullmatch(r"(.*?)( compute.*)?", model(found[5])[1]).groups("")
        words = f"wall/gran {words} primitive type 1 {found[2]}"
        return "\n".join(f"fix {name} all {words} {at}{settings}" for name, at in planes if at != "NULL")

    return WALL.sub(wall, re.sub(r"pair_coeff \S+ \S+ (.*)\n", pair, text))


def run(host, text, folder, ranks=1):
    """Output of a deck that must run, and its last rows by atom: end.txt without the id."""
    code, out = outcome(host, text, folder, ranks)
    assert code == 0 and "ERROR" not in out and (host != "lammps" or "WARNING" not in out), out[-3000:]
    end = folder / "end.txt"
    return out, np.loadtxt(end, skiprows=9, ndmin=2)[:, 1:] if end.exists() else np.empty(0)


def outcome(host, text, folder, ranks=1):
    """Exit code and output of a deck."""
    if host == "lammps":
        return lammps(text, folder, ranks=ranks)
    done = liggghts(folder, in_words_of_liggghts(text), ranks=ranks)
    return done.code, done.text


def values(host, out, name):
    """A column of the thermo tables; LIGGGHTS prints f_heat[1] as heat[1]."""
    return column(out, name[2:] if host == "liggghts" else name)


HOLD = "fix hold all setforce 0 0 0\nfix motion all nve/sphere\n"
END = "write_dump all custom end.txt id type x y z f_{} modify sort id format float %.17g\n"


def heat(text, words, *starts, walls=""):
    """A deck with heat: words of the fix; starts: first, last, temperature; walls: their fixes."""
    text = text.replace("pair_style ep\n", "pair_style ep energies\n") + f"fix heat all heat/ep {words}\n"
    return text + "".join(f"fix_modify heat temperature {s}\n" for s in starts) + walls + HOLD


@HOSTS
def test_one_contact_conducts_by_its_area(host, tmp_path):
    """2 k a dT with a = sqrt(R* delta), 2/k = 1/k1 + 1/k2; a wall of its own conductivity beside it."""
    text = spheres((0, 0, 0), (0.0199, 0, 0), pair="hertz 1e7 0.3").replace("create_box 1", "create_box 2")
    text = text.replace("set group", "set atom 2 type 2\nset group")
    words = "0.9 10 500 30 400 wall plate 350 5"
    plate = "fix plate all wall/ep xplane -0.0099 NULL hertz 1e7 0.3\n"
    text = heat(text, words, "1 1 300", "2 2 400", walls=plate) + "timestep 1e-3\nthermo_style custom step f_heat[1]"
    text += "\nthermo_modify format float %.17g\nthermo 1\nrun 1\n" + END.format("heat")
    out, end = run(host, text, tmp_path)
    mass, a, wall_radius = 7850 * math.pi / 6 * 0.02**3, math.sqrt(0.005 * 1e-4), math.sqrt(0.01 * 1e-4)
    between, into_wall = 2 * 15 * a * 100, 2 * (2 * 10 * 5 / 15) * wall_radius * (300 - 350)
    assert values(host, out, "f_heat[1]")[-1] == pytest.approx(into_wall, rel=1e-6)
    assert end[:, -1] - [300, 400] == pytest.approx(
        [1e-3 * (between - into_wall) / (mass * 500), -1e-3 * between / (mass * 400)], rel=1e-6
    )


@HOSTS
def test_a_released_contact_conducts_nothing(host, tmp_path):
    """Pressed to 0.5 mm, back to 0.25 mm, where a dent without force is left: no heat; at 0.49 mm a = a_max x^0.5."""
    start = spheres((0, 0, 0), (0, 0.0195, 0), pair=THORNTON)
    back = "group upper id 2\ndisplace_atoms upper move 0 {} 0 units box\nrun 1\n"
    text = heat(start, "0.9 10 500", "1 1 300", "2 2 400") + "timestep 1e-6\nrun 1\nfix_modify heat temperature 1 1 300"
    text += "\nfix_modify heat temperature 2 2 400\n" + back
    E_star, R_star, alpha = 1e8 / (2 * 0.91), 0.005, 5e-4
    alpha_y = (math.pi * 4e5 / (2 * E_star)) ** 2 * R_star
    most = 2 / 3 * math.pi * 4e5 * R_star * alpha_y + math.pi * 4e5 * R_star * (alpha - alpha_y)
    a_max = math.sqrt(R_star * alpha)
    x = 1 - 1e-5 * 4 * E_star * a_max / (3 * most)
    rate = 1e-6 * 2 * 10 * a_max * math.sqrt(x) * 100 / (7850 * math.pi / 6 * 0.02**3 * 500)
    _, end = run(host, text.format(1e-5) + END.format("heat"), tmp_path / "pressed")
    assert end[:, -1] - [300, 400] == pytest.approx([rate, -rate], rel=1e-5)
    _, end = run(host, text.format(2.5e-4) + END.format("heat"), tmp_path / "released")
    assert end[:, -1].tolist() == [300.0, 400.0]


THEIRS = """fix k all property/global thermalConductivity peratomtype 10
fix c all property/global thermalCapacity peratomtype 500
fix theirs all heat/gran initial_temperature 300
timestep 1e-6
run 0
set atom 2 property/atom Temp 400
fix_modify heat temperature 1 1 300
fix_modify heat temperature 2 2 400
run 1
"""


@pytest.mark.liggghts
@pytest.mark.parametrize(
    ("pair", "factor"),
    [("hertz 1e7 0.3", math.sqrt(2 * math.pi)), ("cavity 1e9 0.3 1e4", math.sqrt(math.pi))],
    ids=["hertz", "plastic"],
)
def test_liggghts_conducts_more_through_the_lens(pair, factor, tmp_path):
    """Its own fix heat/gran over ours, at an overlap of 1e-3 radii."""
    text = heat(spheres((0, 0, 0), (0.01999, 0, 0), pair=pair), "0 10 500", "1 1 300", "2 2 400") + THEIRS
    _, ours = run("liggghts", text + END.format("heat"), tmp_path / "ours")
    _, lens = run("liggghts", text + END.format("heatFlux"), tmp_path / "lens")
    flow = (ours[0, -1] - 300) / 1e-6 * 7850 * math.pi / 6 * 0.02**3 * 500
    assert lens[0, -1] / flow == pytest.approx(factor, rel=2e-3)


LATTICES = {
    # spheres of a layer of a cell; contacts of a sphere with the next layer; layers of a cell; diameters of the cell;
    # conductivity times diameter over the conductance of a contact
    "sc": (1, 1, 1, 1.0, 1.0),
    "bcc": (1, 4, 2, 2 / math.sqrt(3), math.sqrt(3)),
    "fcc": (2, 4, 2, math.sqrt(2), 2 * math.sqrt(2)),
}


@HOSTS
@pytest.mark.parametrize("kind", LATTICES)
def test_a_lattice_conducts_by_its_closed_form(host, kind, tmp_path):
    """Flow between a hot and a cold wall through layers in series, and the conductivity of the layers."""
    of_layer, bonds, layers, cell, factor = LATTICES[kind]
    d, delta, k = 0.01, 2e-5, 20.0
    distance, height = d - delta, 4
    side = distance * cell
    count = height * layers
    text = f"""units si
atom_style sphere
atom_modify map array
comm_modify vel yes
boundary p p f
region box block 0 {2 * side!r} 0 {2 * side!r} {-side!r} {(height + 1) * side!r} units box
create_box 1 box
lattice {kind} {side!r}
region spheres block INF INF INF INF 0 {(height - 0.1) * side!r} units box
create_atoms 1 region spheres
set group all diameter {d} density 2000
pair_style ep
pair_coeff * * hertz 1e8 0.3
neighbor 0.0005 bin
"""
    top = (count - 1) * side / layers
    places = ("hot", f"{delta / 2 - d / 2!r} NULL"), ("cold", f"NULL {top + d / 2 - delta / 2!r}")
    walls = "".join(f"fix {name} all wall/ep zplane {words} hertz 1e8 0.3\n" for name, words in places)
    text = heat(text, f"0.9 {k} 1 wall hot 400 {k} wall cold 300 {k}", "1 1000 350", walls=walls)
    a, at_wall = math.sqrt(d / 4 * delta), math.sqrt(d / 2 * delta / 2)
    G, wall = 2 * k * a, 2 * k * at_wall
    step = 0.4 * 2000 * math.pi / 6 * d**3 / (12 * G)
    text += f"timestep {step!r}\nthermo_style custom step f_heat[1] f_heat[2]\nthermo 6000\n"
    text += "thermo_modify format float %.17g\nrun 6000\n"
    out, end = run(host, text + END.format("heat"), tmp_path)
    n = 4 * of_layer
    flow = 100 / (2 / (n * wall) + (count - 1) / (n * bonds * G))
    assert values(host, out, "f_heat[2]")[-1] == pytest.approx(flow, rel=1e-4)
    assert values(host, out, "f_heat[1]")[-1] == pytest.approx(-flow, rel=1e-4)
    slope = np.polyfit(end[:, 3], end[:, -1], 1)[0]
    assert -flow / (2 * side) ** 2 / slope == pytest.approx(factor * G / distance, rel=1e-4)


BED = bed((f"1 1 {THORNTON} {SLIP} restitution 0.5",), style="ep energies", boundary="p p f", more="{}")
HOT = f"""fix floor all wall/ep zplane 0 0.02 {THORNTON} {SLIP}
fix heat all heat/ep 0.8 {{}} 900 wall floor 30 1
"""
SUMS = """variable heat atom mass*900*f_heat
compute heat all reduce sum v_heat
compute works all reduce sum f_EP_HISTORY0[1] f_EP_HISTORY0[4]
variable flow equal f_heat[1]
fix flow all ave/time 1 400 400 v_flow
variable into equal f_flow*400*2e-6
thermo_style custom step atoms ke c_heat c_works[1] c_works[2] v_into
thermo_modify format float %.17g
"""


@HOSTS
def test_heat_of_a_bed_is_its_work_and_the_flow_from_the_walls(host, tmp_path):
    """0.8 of the plastic and frictional work, in a bed that conducts, on one rank and on two."""
    text = BED.format(HOT.format(50)).split("thermo_style")[0] + "fix_modify heat temperature 1 9999 0\n" + SUMS
    found = []
    for ranks in (1, 2):
        out, end = run(host, text + "run 400\n" + END.format("heat"), tmp_path / str(ranks), ranks=ranks)
        heat_of_spheres, plastic, friction, into = (
            values(host, out, name)[-1] for name in ("c_heat", "c_works[1]", "c_works[2]", "v_into")
        )
        assert min(plastic, friction) > 0 and abs(into) > 1e-3 * plastic
        assert heat_of_spheres + into == pytest.approx(0.8 * (plastic + friction), rel=1e-6)
        found.append(np.sort(end[:, -1]))  # ranks give other numbers
    assert found[0] == pytest.approx(found[1], rel=1e-6)


@needs_lammps
def test_a_restart_file_continues_temperatures_to_the_bit(tmp_path):
    text = BED.format(HOT.format(50))
    whole = text + "fix_modify heat temperature 1 9999 0\nrun 200\nwrite_restart half\nrun 200\n" + END.format("heat")
    _, end = run("lammps", whole, tmp_path)
    head = "comm_modify vel yes\nread_restart half\nneighbor 0.0004 bin\nneigh_modify delay 0\n"
    _, again = run("lammps", head + text[text.index("fix floor") :] + "run 200\n" + END.format("heat"), tmp_path)
    assert np.array_equal(end, again) and end[:, -1].max() > 0


PAIR = spheres((0, 0, 0), (0.0199, 0, 0), pair="hertz 1e7 0.3")


@HOSTS
@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (heat(PAIR, "0.9 10 500", "1 2 300") + "timestep 1e5\nrun 1\n", "is too long for the heat of atom 1, which"),
        (heat(PAIR, "0.9 10 500", "1 1 300") + "run 1\n", "atom 1 or a neighbour has no temperature"),
        (heat(PAIR, "0.9 10 0"), "specific heat 0 must be above 0"),
        (heat(PAIR, "1.9 10 500"), "share 1.9 must lie in"),
        (heat(PAIR, "0.9 10"), "k c of each of the 1 types"),
        (heat(PAIR, "0.9 10 500 floor 1 2 3"), "floor is not known; there is wall"),
        (heat(PAIR, "0.9 10 500", "1 300"), "the words are temperature FROM TO T"),
        (
            heat(PAIR, "0.9 10 500", "1 2 300").replace("ep energies", "ep") + "run 1\n",
            "the area of the contacts comes from",
        ),
    ],
)
def test_wrong_words_end_the_run_in_a_sentence(host, text, sentence, tmp_path):
    code, out = outcome(host, text, tmp_path)
    assert code != 0 and sentence in out.replace("\n", " "), out[-800:]
