# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes with one feature of each kind, drawn at random, so that every pair of features occurs.

Each number is compared with another route: amounts with the definition of mass and volume, decks with the plan, other
units, a sweep and a softened copy with the case itself.
"""

import contextlib
import math
import os
import re
import shutil
import tomllib
from itertools import pairwise, product
from typing import Literal, get_args, get_origin

import numpy as np
import pandas as pd
import pytest
import tomlkit
from features import AMOUNTS, CHOICES, DENSITY, MIXTURES, SLOTS, case_of, files
from hypothesis import Phase, assume, example, given, settings
from hypothesis import strategies as st
from other_routes import assert_coulomb, assert_forces, assert_frames, porosity
from parts_cases import mm
from pydantic import BaseModel
from scene_runs import assert_alike, restart_steps, run, write_case, write_deck

from epdem.case.keys import keys_of
from epdem.case.scene import SceneCase, load, parse
from epdem.engines import SCENES, scene_engine
from epdem.engines.frames import Frames
from epdem.engines.liggghts import deck, launcher
from epdem.engines.liggghts import tables as liggghts_tables
from epdem.errors import CaseError, EngineError
from epdem.laws.strengths import find_law
from epdem.scenes.judge import measures
from epdem.scenes.plan import filling
from epdem.scenes.plan.plan import plan
from epdem.studies.soften import soften
from epdem.studies.sweep.folder import Sweep
from epdem.theory.cavity import FINITE_STRAIN
from stored_decks import checked_deck


def with_key(key):
    """The walls of which one has this key."""
    return {"walls": {name for name, walls in SLOTS["walls"].items() if any(key in wall for wall in walls)}}


STICKY = "cavity_adhesive, compaction"
ADHESIVE, FRAMELESS = {"law": {"jkr", "thornton_ning", "cavity_adhesive", STICKY}}, {"output": {"rows alone"}}
COMPACTION = {"cavity, compaction", "cavity, bonds", STICKY}
COHESION = {"cohesion", "cohesion with friction"}
NOT_LINEAR = {
    "phases": {"wall vibrates", "wall presses", "wall turns", "wall turns, then moves", "wall moves, then tilts"}
}
OF_ROWS = {"none", "force", "side force", "torque", "whole torque"}
BOTH_MATERIALS_OF_WALLS = {
    "mixture": {"two materials"},
    "bodies": {"body", "frozen body", "late body", "bodies that overlap"},
}
WITHOUT_CONTACTS = set(SLOTS["output"]) - {"energy", "contacts"}
ACROSS = {"planes across x and y", "plates across x and y", "open box", "box with stress"}  # next to the faces
SHARED_TYPES = {"contact": set(SLOTS["contact"]) - {"wall friction", "friction of pairs"}}  # of spheres and walls
# Features that exclude each other, and the sentence that says so. A case with none of these is never refused.
EXCLUDED = [
    ({"phases": {"wall presses"}, "rows": {"rows of walls"}}, "rows do not know its place"),
    ({"law": {"johnson, one strength"}, "strength": {"hardness", "yield ratio"}}, "each the strength; keep one"),
    (ADHESIVE | {"contact": COHESION}, "has its attraction already"),
    ({"law": COMPACTION, "contact": COHESION}, "contacts with law.compaction have no cohesion"),
    ({"law": {"cavity, bonds"}, "contact": {"partial slip", "partial slip 2"}}, "'history'"),
    (ADHESIVE | {"contact": {"partial slip", "partial slip 2"}}, "laws with adhesion have 'history' only"),
    (ADHESIVE | {"measure": {"speeds of impacts"}}, "impact speeds follow from contacts without adhesion"),
    (FRAMELESS | {"measure": set(SLOTS["measure"]) - OF_ROWS}, "taken from frames"),
    (FRAMELESS | with_key("stress"), "written with the frames"),
    (FRAMELESS | with_key("wear"), "written with the frames"),
    (NOT_LINEAR | {"output": {"restarts"}}, "only walls with linear motions"),
    ({"room": {"periodic", "periodic along x", "periodic along y"}, "walls": ACROSS}, "along which the room repeats"),
    ({"mixture": {"rare component first"}}, "of one sphere of steel, so that the fill has none"),
    ({"measure": {"plastic work"}, "output": set(SLOTS["output"]) - {"energy"}}, "known with output.energy"),
    ({"measure": {"plastic work"}, "law": {"hertz", "jkr"}}, "a law that yields"),
    ({"measure": {"speeds of impacts"}, "output": WITHOUT_CONTACTS}, "give output.contacts"),
    ({"walls": {"plates of two worn materials"}} | BOTH_MATERIALS_OF_WALLS | SHARED_TYPES, "one value for each pair"),
]


def tries(few, **more):
    """So many fixed examples in the test suite, EPDEM_FUZZ random ones in `make fuzz`."""
    many = os.environ.get("EPDEM_FUZZ")
    return settings(max_examples=int(many or few), derandomize=not many, **more)


PLAIN = {slot: next(iter(options)) for slot, options in SLOTS.items()}
KINDS = "cases of kinds are drawn by tests/fuzz/test_inputs.py, their runs are those of parts"
ALONE = "judges a bed that it is made for: test_scene_checks.py"
CURRENT = "read from frames: test_heat_scene.py"
WALLS = ("Plane", "Plate", "Box", "Cylinder", "Cone", "Revolved", "Stl")
NOT_DRAWN = {
    "Keys": KINDS,
    "Parts": {"key_figure": KINDS, "highest_fall": KINDS, "highest_drive": KINDS, "places": KINDS, "check": ALONE}
    | {"stages": "of a press: test_press.py"},
    "Stages": "of a press: test_press.py",
    "Until": dict.fromkeys(("height", "density"), "of a plate that covers the room: test_ends_at_heights.py"),
    "FloorLoad": ALONE,
    "BedRebound": ALONE,
    "AtRest": ALONE,
    "MassFlow": ALONE,
    "ReboundSpeed": ALONE,
    "Unloading": ALONE,
    "TorqueOfBed": ALONE,
    "SceneCase": {"measured": "numbers beside those of a press: test_press.py"},
    "MeasuredDensities": "numbers beside those of a press: test_press.py",
    "LawMaterial": {"surface_energy": "gives the work of adhesion, which is drawn: tests/decks/test_adhesive_case.py"}
    | {"electrical_conductivity": CURRENT},
    **{f"{kind}Wall": {"potential": CURRENT} for kind in WALLS},
}
CHOOSES = ("kind", "model", "tangential")  # keys each value of which is a model of its own


def models_of(annotation):
    """The tables of a case that an annotation names."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from models_of(part)


def values_of(annotation):
    """The words that an annotation allows."""
    if get_origin(annotation) is Literal:
        return set(get_args(annotation))
    return {word for part in get_args(annotation) for word in values_of(part)}


def features_of(model, found):
    """(table, key) of all that a case can name, and (table, key, value) of keys that choose."""
    for key, field in model.model_fields.items():
        if (model.__name__, key) not in found:
            found.add((model.__name__, key))
            found |= {(model.__name__, key, v) for v in values_of(field.annotation) if key in CHOOSES}
            for part in models_of(field.annotation):
                features_of(part, found)
    return found


def features_in(value):
    """The same of what a case names."""
    if isinstance(value, BaseModel):
        for key in value.model_fields_set & set(type(value).model_fields):
            named = getattr(value, key)
            yield from ((type(value).__name__, key), (type(value).__name__, key, str(named)))
            yield from features_in(named)
    elif isinstance(value, list | tuple | dict):
        for part in value.values() if isinstance(value, dict) else value:
            yield from features_in(part)


def test_all_that_a_case_can_name_is_drawn(folder):
    drawn = set()
    for slot, options in SLOTS.items():
        for option, heat in product(options, SLOTS["heat"]):
            plainly = PLAIN | {"heat": heat, slot: option}
            drawn |= set(features_in(parse(case_of(plainly), folder / "case.toml")))
    left_out = features_of(SceneCase, set()) - drawn
    reasons = [(t, k) for t, keys in NOT_DRAWN.items() if isinstance(keys, dict) for k in keys]
    assert {f for f in left_out if f[:2] not in reasons and not isinstance(NOT_DRAWN.get(f[0]), str)} == set()
    assert set(reasons) <= left_out and {t for t, _ in reasons} | {f[0] for f in left_out} == set(NOT_DRAWN)


def sentences_against(chosen):
    return [words for rule, words in EXCLUDED if all(chosen[slot] in options for slot, options in rule.items())]


def planned(chosen, folder):
    """The plan and the files for LIGGGHTS, as `run` makes them."""
    p = plan(parse(case_of(chosen), folder / "case.toml"))
    measures.refuse_measures(p)
    return p, checked_deck(p)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("pairs")
    files(path)
    return path


def ball(material, radius):
    return DENSITY[material] * 4 / 3 * math.pi * radius**3


def requested(chosen):
    """(mass, share) of each component of the fill [kg]; mass is None where the fill has a number of spheres."""
    mass = {"mass": 0.9e-3}.get(chosen["amount"])
    found = {part["material"]: part.get("share", 1.0) for part in MIXTURES[chosen["mixture"]]}
    if chosen["amount"] == "fraction":
        volume = 0.06 * 13e-3 * 13e-3 * 28e-3
        mass = volume / sum(share / DENSITY[m] for m, share in found.items())
    return mass, found


def masses(p):
    """Mass [kg] of each material that the fills of a plan put in; of random draws the mean."""
    found = {}
    for f in p.insertions:
        sizes = [(part.material, r, share) for part in f.particles for r, share in part.sizes()]
        number = f.count / sum(share / ball(m, r) for m, r, share in sizes)
        for m, _, share in sizes:
            found[m] = found.get(m, 0.0) + share * number
    return found


def matrices(text):
    """The properties of pairs of types in a deck, by name."""
    found = re.findall(r"property/global (\w+) peratomtypepair (\d+) ([-+.e\d ]+)", text)
    return {name: np.array(values.split(), float).reshape(int(n), int(n)) for name, n, values in found}


@tries(80)
@example(chosen=PLAIN | {"room": "periodic", "walls": "planes across x and y"})
@given(chosen=CHOICES)
def test_the_plan_and_the_deck_have_what_the_case_requests(chosen, folder):
    against = sentences_against(chosen)
    try:
        p, decks = planned(chosen, folder)
    except CaseError as error:
        assert any(words in str(error) for words in against), error
        assert "\n" not in str(error)
        return
    assert not against
    mass, parts = requested(chosen)
    got = masses(p)
    if "count" in AMOUNTS[chosen["amount"]]:
        assert sum(f.count for f in p.insertions) == 60
        mass = sum(got.values())
    off = [m for m, share in parts.items() if abs(got[m] - share * mass) > 0.0101 * mass]
    assert bool(off) == any("whole spheres of" in said for said in filling.warnings(p.case))
    text = decks["in.scene"] + decks["setup.in"]
    inserted = re.findall(r"nparticles (\d+)|particles_in_region (\d+)", text)
    alone = len(p.scene.table) + len(p.scene.later)
    assert sum(int(a or b) for a, b in inserted) + alone == p.count
    assert all(np.array_equal(m, m.T) for m in matrices(text).values())
    n_types = re.search(r"create_box (\d+)|(\d+) atom types", text + decks.get("spheres.data", ""))
    assert int(n_types[1] or n_types[2]) == len(p.model.types)
    assert {len(m) for m in matrices(text).values()} <= {len(p.model.types)}
    assert len(re.findall(r"mesh/surface", text)) == len(p.triangles)
    assert not re.search(r"(?<![\w.])(nan|inf|None)(?![\w.])", text)
    ends = [0, *(phase.end for phase in p.phases)]
    assert all(a < b and (b - a) % p.every == 0 for a, b in pairwise(ends)) and ends[-1] == p.steps
    given = chosen["numerics"] != "error" or chosen["phases"] == "own step"  # then a row ends next to the duration
    off = np.abs(p.phase_table["end_time"] - p.phase_table["begin_time"] - [phase.seconds for phase in p.scene.phase])
    assert (off <= [0.501 * p.every * phase.time_step if given else 1e-12 for phase in p.phases]).all()


SMALLER = {"mm": 1e3, "m/s": 1e3, "ms": 1e3, "MPa": 1e3, "kg/m^3": 1e3, "g": 1e3, "mN": 1e3, "s": 1e3, "m^2/N": 1e6}
SMALLER |= {"Hz": 1e3, "kHz": 1e3, "J/m^2": 1e3, "J/m^3": 1e3, "nJ": 1e-3, "mm^2/N": 1e6}
NAMES = {"mm": "um", "m/s": "mm/s", "ms": "us", "MPa": "kPa", "kg/m^3": "g/m^3", "g": "mg", "mN": "uN", "s": "ms"}
NAMES |= {"Hz": "mHz", "kHz": "Hz", "J/m^2": "mJ/m^2", "J/m^3": "mJ/m^3", "nJ": "uJ", "mm^2/N": "um^2/N"}
NAMES |= {"m^2/N": "mm^2/N"}


def in_other_units(value):
    """A value of a case with every quantity in another unit."""
    if isinstance(value, dict):
        return {key: in_other_units(v) for key, v in value.items()}
    if isinstance(value, list):
        return [in_other_units(v) for v in value]
    number, _, unit = value.partition(" ") if isinstance(value, str) else ("", "", "")
    return f"{float(number) * SMALLER[unit]!r} {NAMES[unit]}" if unit in NAMES else value


def numbers_in(files):
    """(texts between numbers, numbers) of the files of a deck."""
    text = "\n".join(files.values())
    number = r"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?"
    return re.sub(number, "#", text), np.array(re.findall(number, text), float)


@tries(8)
@given(chosen=CHOICES)
def test_other_units_make_the_same_deck(chosen, folder):
    assume(not sentences_against(chosen))
    data = case_of(chosen)
    other = in_other_units(data)
    assert other["materials"]["glass"] != data["materials"]["glass"]
    decks = [checked_deck(plan(parse(x, folder / "case.toml"))) for x in (data, other)]
    (text, values), (again, found) = map(numbers_in, decks)
    assert again == text
    assert np.allclose(found, values, rtol=1e-9, atol=1e-300)


@tries(25)
@given(chosen=CHOICES, other=CHOICES)
def test_a_point_of_a_sweep_is_the_case_that_it_says(chosen, other, folder):
    """The tables of one case, set as the values of a sweep over another one, give the one."""
    assume(not sentences_against(chosen))
    base, wanted = case_of(chosen), case_of(other | {slot: chosen[slot] for slot in ("room", "rows", "heat")})
    wanted = {key: wanted[key] if key == "scene" else table for key, table in base.items()}
    wanted["scene"].setdefault("measure", [])
    keys = [f"scene.{key}" for key in ("wall", "fill", "body", "phase", "measure")]
    point = {key: wanted["scene"][key.removeprefix("scene.")] for key in keys}
    assert set(keys) <= set(keys_of(base))
    sweep = Sweep("pairs", tomlkit.dumps(base), (point,), ("liggghts",))
    expected = parse(wanted, folder / "case.toml")
    assert parse(sweep.data(1), folder / "case.toml") == expected
    assert parse(tomllib.loads(sweep.text(1)), folder / "case.toml") == expected


@tries(15)
@example(chosen=PLAIN | {"phases": "until a lower force"}, factor=4.0)
@given(chosen=CHOICES, factor=st.sampled_from([4.0, 100.0]))
def test_a_softened_copy_scales_every_quantity_by_its_unit(chosen, factor, folder):
    """Moduli by 1/k, strengths by k^-0.8, forces and works of adhesion by k^-0.4; finite strain by k^0.14; the overlap
    at first yield by k^0.4, which also takes the place of a hardness."""
    assume(not sentences_against(chosen))
    data = case_of(chosen)
    twin = tomllib.loads(soften(write_case(data, folder, "soft.toml"), factor).text)
    powers = {"Pa": {-1.0, -0.8}, "N": {-0.4}, "J/m^2": {-0.4}}
    for key, about in keys_of(data).items():
        before, after = value_of(data, key), value_of(twin, key)
        if key.endswith("yield_ratio"):
            hard = value_of(data, key.replace("yield_ratio", "hardness")) and find_law(data["law"]["name"]).strength
            assert after == (pytest.approx(before * factor**0.4, rel=1e-12) if before else after if hard else None)
            assert not hard or after > 0
        elif before is None or key == "case.name":
            assert after is None or key == "case.name"
        elif key.endswith("hardness"):
            assert after == (None if find_law(data["law"]["name"]).strength else before)
        elif about.unit in powers:
            ratio = float(after.split()[0]) / float(before.split()[0])
            assert any(math.isclose(ratio, factor**power, rel_tol=1e-12) for power in powers[about.unit])
        elif key == "law.finite_strain" and before:
            assert after == pytest.approx(FINITE_STRAIN * factor**0.14, rel=1e-12)
        elif not isinstance(before, dict | list):
            assert after == before, key


def value_of(data, key):
    """The value of a dotted key; None: absent."""
    for name in key.split("."):
        if isinstance(data, list):
            data = dict(zip(map(str, range(len(data))), data, strict=True))
        data = data.get(name) if isinstance(data, dict) else None
    return data


RANKS = st.sampled_from([1, 2])
RUBBED = {"contact": "tangential dashpot", "dashpot": "dashpot of a pair", "bodies": "bodies that overlap"}
RUBBED |= {"phases": "wall moves, then tilts", "output": "contacts", "amount": "poured"}
THROUGH_FACES = {"room": "periodic", "bodies": "table", "measure": "porosity", "output": "contacts"}


@pytest.mark.liggghts
@tries(3, phases=[Phase.explicit, Phase.generate])
@example(chosen=PLAIN | {"contact": "cohesion"}, ranks=1)  # of all models cohesion alone has a history
@example(chosen=PLAIN | {"output": "rows alone", "measure": "force", "phases": "own step"}, ranks=1)
@example(chosen=PLAIN | THROUGH_FACES, ranks=2)
@example(chosen=PLAIN | {"amount": "thrown later", "phases": "until rest"}, ranks=1)
@example(chosen=PLAIN | RUBBED | {"heat": "heat"}, ranks=2)
@example(chosen=PLAIN | {"mixture": "log-normal", "bodies": "bodies that overlap", "numerics": "ranks"}, ranks=2)
@given(chosen=CHOICES, ranks=RANKS)
def test_liggghts_runs_what_is_drawn(chosen, ranks, folder):
    assume(not sentences_against(chosen))
    assert_runs("liggghts", chosen, folder, ranks)


@pytest.mark.yade("module")
@tries(4, phases=[Phase.explicit, Phase.generate])
@example(chosen=PLAIN | {"walls": "cone that turns", "bodies": "late body", "phases": "until rest"})
@example(chosen=PLAIN | {"walls": "gate", "output": "loads", "phases": "wall moves, then tilts", "measure": "torque"})
@example(chosen=PLAIN | RUBBED)
@given(chosen=CHOICES)
def test_yade_runs_what_is_drawn(chosen, folder):
    assume(not sentences_against(chosen))
    assert_runs_or_names_others("yade", chosen, folder)


@pytest.mark.lammps
@tries(3, phases=[Phase.explicit, Phase.generate])
@example(chosen=PLAIN | THROUGH_FACES, ranks=2)
@example(chosen=PLAIN | {"room": "periodic along y", "bodies": "bodies that overlap", "output": "energy"}, ranks=2)
@example(chosen=PLAIN | RUBBED | {"heat": "heat"}, ranks=1)
@given(chosen=CHOICES, ranks=RANKS)
def test_lammps_runs_what_is_drawn(chosen, ranks, folder):
    assume(not sentences_against(chosen))
    assert_runs_or_names_others("lammps", chosen, folder, ranks)


# left out: round walls, which are triangles in LIGGGHTS
ALIKE = SLOTS | {
    "walls": {"planes", "planes across x and y", "plates across x and y", "gate", "open box"},
    "phases": set(SLOTS["phases"]) - {"until rest", "until few are left"},
    "measure": {"none"},
    "output": {"frames"},
}
NEAR = {"lid": {"center": mm(0, 0, -0.7)}, "left": {"at": "-3.4 mm"}}  # next to the heap
BETWEEN = PLAIN | {"walls": "planes across x and y", "phases": "wall moves"}


@pytest.mark.lammps
@pytest.mark.liggghts
@tries(3, phases=[Phase.explicit, Phase.generate])
@example(chosen=PLAIN | {"dashpot": "dashpot", "walls": "open box", "phases": "wall turns", "heat": "heat"})
@example(chosen=BETWEEN | {"contact": "tangential dashpot"})
@example(chosen=BETWEEN | {"contact": "partial slip"})
@example(chosen=BETWEEN | {"contact": "rolling"})
@example(chosen=BETWEEN | {"law": "thornton_ning"})
@given(chosen=st.fixed_dictionaries({slot: st.sampled_from(sorted(options)) for slot, options in ALIKE.items()}))
def test_lammps_and_liggghts_move_the_spheres_of_a_heap_alike(chosen, folder):
    """Spheres, rows without torques, which are about a point that LIGGGHTS moves with a plate, and contacts."""
    assume(not sentences_against(chosen))
    data = case_of(chosen)
    warm = {key: data["scene"]["fill"][0][key] for key in ("temperature",) if chosen["heat"] == "heat"}
    data["scene"]["fill"] = [{"name": "heap", "file": "heap.csv"} | warm]
    data["output"] |= {"energy": True, "loads": True}
    between = chosen == chosen | {slot: BETWEEN[slot] for slot in ("walls", "phases")}
    for wall in data["scene"]["wall"]:
        wall |= NEAR.get(wall["name"], {}) if between else {}
    found = []
    for tool in ("lammps", "liggghts"):
        try:
            more = {"ranks": 1 + (between and tool == "lammps" and chosen["contact"] == "rolling"), "fresh": True}
            outcome = run(write_case(data, folder, "heap.toml"), tool, out=folder / f"heap_{tool}", **more)
        except CaseError as error:
            assert_names_who_takes_it(tool, folder / "heap.toml", error)
            return
        found.append(outcome.results)
    lammps, liggghts = found
    # m and m/s. A sphere that moves by 0.5 % of its radius in the step in which it parts has no last pull in LIGGGHTS
    limit = 1e-4 if chosen["law"] in ADHESIVE["law"] else 1e-6
    places = [r.particles.set_index(["step", "id"]).sort_index() for r in found]
    assert places[0].index.equals(places[1].index)
    names = ["x", "y", "z", "vx", "vy", "vz", *warm]
    assert np.abs(places[0][names] - places[1][names]).to_numpy().max() < limit
    names = [n for n in ("omega_x", "plastic_work") if n in liggghts.particles]
    assert_alike(*places, names, 1e-5 if "rolling" in chosen["contact"] else limit)
    assert {*lammps.rows} == {*liggghts.rows}
    columns = [n for n in liggghts.rows if "torque" not in n]
    rows = [r.rows[columns][1:] for r in found]  # LIGGGHTS's first row has no overlaps
    assert (np.abs(rows[0] - rows[1]).max() <= limit * np.abs(rows[1]).max().clip(lower=1e-9)).all()
    keys = ["step", "wall", "i", "j"]
    assert lammps.contacts[keys].equals(liggghts.contacts[keys])
    if between:
        assert all(liggghts.rows[n].any() for n in ("lid_force_z", "left_force_x", "floor_force_z"))


def assert_names_who_takes_it(tool, path, error):
    """A refusal names each other engine that takes the scene, and no engine else."""
    p, takers = plan(load(path)), []
    for name in SCENES.keys() - {tool}:
        with contextlib.suppress(CaseError):
            scene_engine(name).check(p)
            takers.append(name)
    named = str(error).partition("--engine ")[2]
    assert set(re.findall(r"\w+", named)) - {"or"} == set(takers), error


def assert_runs_or_names_others(tool, chosen, folder, ranks=1):
    """What an engine lacks is refused before the run, in a sentence that names the engines that have it."""
    try:
        assert_runs(tool, chosen, folder, ranks)
    except CaseError as error:
        assert_names_who_takes_it(tool, folder / "run.toml", error)
    except EngineError as error:  # a fill of a later phase, known in the run alone
        assert "use --engine liggghts" in str(error)


def assert_runs(tool, chosen, folder, ranks=1):
    """The frames have the planned spheres of each material, the rows finite numbers and the measured curve."""
    outcome = run(
        write_case(case_of(chosen), folder, "run.toml"), tool, out=folder / f"out_{tool}", ranks=ranks, fresh=True
    )
    p, tables = outcome.plan, outcome.results.tables
    assert outcome.passed, tables["checks"]
    assert tables["rows"]["particles"].max() == p.count
    assert np.isfinite(tables["rows"].to_numpy(float)).all()
    if p.frames:
        last = tables["particles"].query("step == step.max()")
        materials = [p.model.types[int(n) - 1].material for n in last["type"]]
        alone = [*p.scene.table, *(b.sphere for b in p.scene.later)]
        expected = {m: sum(ball(m, s.radius) for s in alone if s.material == m) for m in DENSITY}
        if chosen["amount"] != "poured":  # its spheres are drawn at random
            expected = {m: mass + masses(p).get(m, 0.0) for m, mass in expected.items()}
            assert last["mass"].groupby(materials).sum().to_dict() == pytest.approx(
                {m: mass for m, mass in expected.items() if mass}, rel=1e-6
            )
        assert_frames(p, tables)
        assert_coulomb(p, tables.get("contacts", pd.DataFrame()), tables["particles"])
        if len(tables.get("contacts", [])) and chosen["dashpot"] == "no dashpot" and chosen["contact"] not in COHESION:
            assert_forces(p, tables["contacts"], tables["particles"])
    kind = SLOTS["measure"][chosen["measure"]] or {}
    if kind.get("kind") in ("force", "torque"):
        assert len(tables["rows"]["measured"]) == len(tables["rows"])
    elif "bins" not in kind and kind:
        measured = tables["measures"]["measured"].iloc[-1]
        assert np.isfinite(measured)
        if kind["kind"] == "porosity":
            assert measured == pytest.approx(porosity(p, last), abs=0.01)


@pytest.mark.liggghts
@tries(3, phases=[Phase.explicit, Phase.generate])
@example(chosen=PLAIN | {"output": "restarts", "phases": "wall moves", "law": "cavity", "room": "periodic"}, ranks=2)
@example(chosen=PLAIN | {"output": "restarts", "amount": "thrown later", "numerics": "lists"}, ranks=1)
@given(chosen=CHOICES, ranks=RANKS)
def test_a_drawn_scene_goes_on_from_a_restart_file_to_the_same_bits(chosen, ranks, folder):
    chosen = chosen | {"output": "restarts"}
    assume(not sentences_against(chosen))
    place = folder / "continued"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    p = write_deck(parse(case_of(chosen), folder / "case.toml"), place)
    assume(not p.ends_early)
    launcher.run("in.scene", place, ranks=ranks)
    last = Frames(p, place, liggghts_tables.kinds(p), p.frame_steps(p.frames)[:-1])
    whole = last.spheres()
    *steps, _ = restart_steps(place)
    for step in steps[-2:]:
        (place / f"particles.{p.steps}.bin").unlink()
        deck.write_resume(p, place, step)
        launcher.run("in.resume", place, ranks=ranks, append=True)
        assert last.spheres().equals(whole)
