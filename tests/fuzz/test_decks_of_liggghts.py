# SPDX-License-Identifier: GPL-2.0-or-later
"""Drawn decks of LIGGGHTS: the plugin's own loops give each bit that LIGGGHTS's loop gives."""

import random
import re
from dataclasses import replace

import numpy as np
import pytest
from drawn_decks import ONE_BY_ONE, Deck, difference, merge, read_features, rows, run, spheres, stl
from hypothesis import assume, example, given, note
from hypothesis import strategies as st

from epdem.engines.liggghts import launcher

pytestmark = pytest.mark.liggghts

FEATURES = read_features("liggghts")
RADIUS, PITCH = 2e-3, 3.9e-3  # [m]
LAWS = {  # parameters of each type
    "hertz": [],
    "thornton": ["yieldPressure"],
    "johnson": ["yieldPressure"],
    "cavity": ["yieldStress"],
    "meyer": ["yieldPressure", "hardeningExponent"],
    "jkr": [],
    "thornton_ning": ["yieldPressure"],
}
ADHESIVE = {  # their work of adhesion
    "jkr": "workOfAdhesion",
    "thornton_ning": "workOfAdhesion",
    "cavity_adhesive": "workOfAdhesion low",
}
OF_TYPES = {
    "youngsModulus": (1e8, 2e8, 5e7),
    "poissonsRatio": (0.3, 0.25, 0.4),
    "yieldPressure": (2e6, 4e6, 1e6),
    "yieldStress": (7e5, 1.4e6, 3e5),
    "hardeningExponent": (0.1, 0.3, 0.5),
    "finiteStrain": (0.82, 0.82, 0.82),
}
OF_PAIRS = {
    "workOfAdhesion": (10.0, 2.0),
    "workOfAdhesion low": (0.02, 0.005),
    "coefficientFriction": (0.3, 0.1),
    "coefficientRestitution": (0.6, 0.05),
    "coefficientRollingFriction": (0.05, 0.03),
    "coefficientRollingViscousDamping": (0.1, 0.03),
    "cohesionEnergyDensity": (2e4, 5e3),
}
FEW = 150  # steps that amplify round-off by less than 1e6
FORMAT = '"%.17g %.17g %.17g %.17g %.17g %.17g"'
COLUMNS = "id type radius x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz"


def models(rng):
    """(law, words of the contact model, settings, parameters)."""
    law = rng.choice([*LAWS, "thornton", "cavity"])
    if law == "thornton_ning":
        law = rng.choice((law, "cavity_adhesive"))
    adheres = law in ADHESIVE
    friction = rng.choice(
        ["history"] * 4 + ["no_history", "off"] + ["ep/partial_slip", "ep/partial_slip_2"] * (not adheres)
    )
    rolling = rng.choice(["off"] * 4 + ["cdt", "epsd2", "epsd"])
    cohesion = "off" if adheres else rng.choice(["off"] * 4 + ["sjkr", "sjkr2"])
    words = f"model ep/{law} tangential {friction}"
    words += f" cohesion {cohesion}" * (cohesion != "off") + f" rolling_friction {rolling}" * (rolling != "off")
    options = ["viscous on", "computePlasticWork on", "computeContactStrain on"]
    options += ["tangential_damping off"] * (friction not in ("off", "no_history"))
    chosen = [option for option in options if rng.random() < 0.15]
    if law == "cavity" and cohesion == "off" and rng.random() < 0.4:
        chosen.append("compaction on")
    strengths = ["yieldStress"] if law == "cavity_adhesive" else LAWS[law]
    parameters = ["youngsModulus", "poissonsRatio", *strengths, "coefficientFriction", "coefficientRestitution"]
    parameters += ["finiteStrain"] * (law == "cavity" and rng.random() < 0.4)
    parameters += [ADHESIVE[law]] if adheres else []
    parameters += ["coefficientRollingFriction"] * (rolling != "off")
    parameters += ["coefficientRollingViscousDamping"] * (rolling == "epsd")
    return law, words, chosen, parameters + ["cohesionEnergyDensity"] * (cohesion != "off")


def property_lines(parameters, types):
    """Commands of the properties of types and of pairs of types."""
    for name in parameters:
        if name in OF_TYPES:
            values = " ".join(map(repr, OF_TYPES[name][:types]))
            yield f"fix {name} all property/global {name} peratomtype {values}"
        else:
            value, spread = OF_PAIRS[name]
            table = " ".join(repr(value + spread * (i + j)) for i in range(types) for j in range(types))
            word = name.split()[0]
            yield f"fix {word} all property/global {word} peratomtypepair {types} {table}"


def draw(seed, more=(), steps=None):
    """The deck of a seed; `more`: commands before the last run, `steps`: of each of the two runs."""
    rng = random.Random(seed)
    names = tuple(rng.sample(sorted(FEATURES), rng.choice((2, 3, 3, 4))))
    types, cells = rng.choice((1, 2, 3)), rng.choice((4, 5, 6))
    law, model, options, parameters = models(rng)
    at = {
        "boundary": rng.choice(("f f f", "f f f", "p p f", "p p p", "s s s", "m m m", "p f f", "fm s ms")),
        "walls": rng.choice(("planes", "mesh", "mesh", "both")),
        "integrate": "fix integr all nve/sphere",
        "mesh_style": "mesh/surface",
        "ranks": rng.choice((1, 1, 1, 2)),
        "triclinic": False,
        "inserts": False,
        "run_first": "run <STEPS>",
        "run_second": "run <STEPS>",
    } | merge(rng, [FEATURES[name] for name in names])
    if at["triclinic"]:
        at |= {"boundary": "p p p", "walls": "planes"}
    half = cells * PITCH / 2 + 1e-4
    periodic = [b == "p" for b in at["boundary"].split()]
    box = [(-half, half) if p else (-half - 6e-3, half + 6e-3) for p in periodic]
    size = rng.choice(("one", "types", "random"))

    def diameter(rng, kind):
        return 2 * RADIUS * {"one": 1.0, "types": (1, 0.95, 0.9)[kind - 1], "random": rng.uniform(0.88, 1.0)}[size]

    tilt = f"{0.15 * half!r} 0 0 xy xz yz\n" if at["triclinic"] else ""
    files = {"box.data": spheres(rng, cells, PITCH, box, types, diameter, tilt)}
    files["box.stl"] = stl(half + 2e-5, rng.choice((1, 2, 5)), "xXyYzZ")
    files |= {name: stl(*shape) for name, shape in at["stl"].items()}
    settings_of = "".join(f" {option}" for option in options)
    skin = rng.choice((2e-4, 5e-4, 1e-3, 2e-3))
    neighbor = rng.choice(("delay 0", "delay 0 every 1", "every 5 delay 10", "delay 0 every 7 check no"))
    head = [
        "atom_style granular",
        "atom_modify map array" + rng.choice(("", " sort 0 0", " sort 20 0.004", " sort 100 0")),
    ]
    head += [f"boundary {at['boundary']}", "newton off", "communicate single vel yes", "units si"]
    if at["ranks"] == 2:
        head.append("processors " + rng.choice(("2 1 1", "1 2 1", "1 1 2")))
    begin = [f"neighbor {skin} bin", f"neigh_modify {neighbor}", *at["head"], *property_lines(parameters, types)]
    begin += [*at["materials"], f"pair_style gran {model}{settings_of}", "pair_coeff * *"]
    begin += walls(at, periodic, half, types, f"wall/gran {model}", settings_of)
    begin.append("fix g all gravity 981 vector 0.3 0.1 -1")
    if at["inserts"]:
        small = RADIUS * rng.choice((0.9, 0.6))
        template = "fix pts{} all particletemplate/sphere {} atom_type {} density constant 2500 radius constant {!r}"
        begin += [template.format(1, 10487, 1, 0.9 * RADIUS), template.format(2, 11887, types, small)]
        begin.append("fix pdd1 all particledistribution/discrete 32452843 2 pts1 0.5 pts2 0.5")
    begin += [*at["fixes"], *at["integrate"].splitlines(), f"timestep {rng.choice((5e-7, 1e-6, 2e-6))}"]
    columns = COLUMNS + at["columns"]
    if "computePlasticWork on" in options:
        columns += " f_plasticWork f_elasticEnergy f_loadedContacts"
    thermo = "step atoms ke" + at["thermo"]
    if "computeContactStrain on" in options:
        begin.append("compute strain all reduce max f_contactStrain[1] f_contactStrain[2]")
        thermo += " c_strain[1] c_strain[2]"
    begin += [line for line in at["output"] if not line.startswith("dump")]
    begin += [f"thermo_style custom {thermo}", "thermo 20", "thermo_modify lost ignore norm no format float %.17g"]
    begin += [f"dump d all custom {rng.choice((10, 50))} out.bin {columns}"]
    begin += [line for line in at["output"] if line.startswith("dump")]
    begin += ["run 0"]
    between = at["between"]
    if "<RESTART>" in between:  # the deck once more, without the runs before
        again = [line.replace("out.bin", "out2.bin") for line in begin]
        between = [line for line in between if line != "<RESTART>"]
        between += ["write_restart r.restart", "clear", *head, "read_restart r.restart", *again]
    lines = [*head, "read_data box.data", *begin, at["run_first"], *between, *more, at["run_second"]]
    text = "\n".join(lines) + "\n"
    words = {"MODEL": model, "SET": settings_of, "STEPS": str(steps or rng.choice((150, 400, 900))), "SKIN": str(skin)}
    for word, value in (words | {"TYPES": str(types), "PAIRS 1e-9": " ".join(["1e-9"] * types**2)}).items():
        text = text.replace(f"<{word}>", value)
    for values in ("100 200 50", "10 20 5"):
        text = text.replace(f"<VALUES {values}>", " ".join(f"{v}.0" for v in values.split()[:types]))
    return Deck(text, files, at["ranks"], names)


def walls(at, periodic, half, types, wall, options):
    """Commands of the walls at the faces that are not periodic."""
    names = [line.split()[1] for line in at["meshes"] if "flow" not in line]
    options = at["wall_words"] + options
    gap = 3e-3 if at["walls"] == "both" else 3e-5
    if at["walls"] in ("planes", "both"):
        for axis in (a for a, p in zip("xyz", periodic, strict=True) if not p):
            for name, sign in (("lo", -1), ("hi", 1)):
                place = f"primitive type {types} {axis}plane {sign * (half + gap)!r}"
                yield f"fix w{axis}{name} all {wall} {place}{options}"
    if at["walls"] in ("mesh", "both"):
        scale = " scale 0.9" * periodic[0]
        yield f"fix cad all {at['mesh_style']} file box.stl type 1{scale}{at['mesh_words']}"
        names = ["cad", *names]
    yield from at["meshes"]
    if names:
        yield f"fix wm all {wall} mesh n_meshes {len(names)} meshes {' '.join(names)}{options}"


def end(deck, folder):
    """Velocities and spins at the end; None: LIGGGHTS refused the deck or died."""
    columns = "vx vy vz omegax omegay omegaz"
    text = f"{deck.text}dump end all custom 1 end.txt {columns}\ndump_modify end format {FORMAT}\nrun 0\n"
    command, environment = launcher.command("in.deck", ranks=deck.ranks), launcher.environment(deck.ranks)
    code, _, files = run(replace(deck, text=text), command, folder, environment)
    assume(code != 124)
    return None if code else np.loadtxt(files["end.txt"].decode().splitlines()[9:], ndmin=2)


@example(seed=25380)  # contacts slide where the second run begins
@ONE_BY_ONE
@given(seed=st.integers(0, 10**9))
def test_order_and_numbers_of_spheres_change_no_motion(seed, tmp_path_factory):
    """Rows of the data file reversed; delete_atoms without a sphere to delete gives new numbers between the runs."""
    folder, deck = tmp_path_factory.mktemp("deck"), draw(seed, steps=FEW)
    note(f"{deck.ranks} ranks, {', '.join(deck.features)}")
    parts = deck.files["box.data"].split("\n\n")
    parts[3] = "\n".join(reversed(parts[3].splitlines()))
    anew = draw(seed, ["group none id 999999", "delete_atoms group none compress yes"], steps=FEW)
    other = replace(anew, files=deck.files | {"box.data": "\n\n".join(parts)})
    one, two = end(deck, folder / "one"), end(other, folder / "two")
    assert (one is None) == (two is None)
    assume(one is not None)
    for columns in (slice(0, 3), slice(3, 6)):
        assert difference(one[:, columns], two[:, columns]) <= 1e-6


def strains(deck, words):
    """Largest strains so far, of every row of the run; none, if the deck does not ask for them."""
    columns = re.search(r"^thermo_style custom (.*c_strain.*)$", deck, re.MULTILINE)
    found = [line.split() for line in words.splitlines() if re.match(r" *\d+ +[-\d]", line)]
    return np.array([row[-2:] for row in found if columns and len(row) == len(columns[1].split())], float)


@ONE_BY_ONE
@given(seed=st.integers(0, 10**9))
def test_both_loops_give_the_same_bits(seed, tmp_path_factory):
    """Frames, files of computes, rows, errors and numbers of neighbours."""
    deck = draw(seed)
    note(f"{deck.ranks} ranks, {', '.join(deck.features)}")
    folder = tmp_path_factory.mktemp("deck")
    command, environment = launcher.command("in.deck", ranks=deck.ranks), launcher.environment(deck.ranks)
    theirs = run(deck, command, folder / "generic", environment | {"EPDEM_LOOP": "generic"})
    assume(theirs[0] != 124)  # LIGGGHTS itself hangs with some features on two ranks
    ours = run(deck, command, folder / "ours", environment)
    assert (ours[0], rows(ours[1])) == (theirs[0], rows(theirs[1]))
    assert ours[2].keys() == theirs[2].keys()
    assert (np.diff(strains(deck.text, ours[1]), axis=0) >= 0).all()
    different = [name for name in ours[2] if ours[2][name] != theirs[2][name]]
    assert not [name for name in different if not name.startswith("log") and not name.endswith(".restart")]
