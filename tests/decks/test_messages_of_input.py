# SPDX-License-Identifier: GPL-2.0-or-later
"""The message of each mistake in a case, a scene or a file beside it, with the change that causes it."""

import copy
import sys
from pathlib import Path

import pytest

from epdem.case import impact, scene, sizes
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.impacts import plan as impacts_plan
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan as plan_impacts
from epdem.impacts.prediction import predict
from epdem.laws.library import Law
from epdem.scenes import placement
from epdem.scenes.measures import refuse_measures
from epdem.scenes.plan import plan
from epdem.verification.models.theories import Mdr
from stored_decks import checked_deck

sys.path.append(str(Path(__file__).parents[1] / "scenes"))
from parts_cases import BED, CASE, FLOOR

CASES = Path(__file__).parents[2] / "cases"
MOVE = {"wall": "floor", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "1 mm/s"]}
TURN = {"wall": "lid", "kind": "rotate", "axis": [0.0, 0.0, 1.0], "rate": "60 rpm"}
LID = {"name": "lid", "kind": "plate", "axis": "z", "center": ["0 m", "0 m", "38 mm"], "size": ["10 mm"] * 2}
LID |= {"material": "steel"}
PRESS = {"wall": "lid", "kind": "press", "force": "1 N", "direction": [0.0, 0.0, -1.0], "highest_speed": "1 m/s"}
BOX = {"name": "box", "kind": "box", "material": "steel"} | {axis: ["0 mm", "9 mm"] for axis in "xyz"}
FALL = CASE["scene"]["phase"][0]
RIGID_SPHERE = {"impact.kind": "sphere-sphere", "impact.target": {"material": "rigid", "radius": "1 m"}}
SIEVE = {"material": "glass", "radius": {"sieve": "s.csv"}}
TABLE = {"name": "a", "file": "t.csv", "material": "glass"}


def changed(base: dict, changes: dict) -> dict:
    """A copy with the value at each place "a.b.0.c" instead; None removes it."""
    data = copy.deepcopy(base)
    for place, value in changes.items():
        at, (*path, last) = data, place.split(".")
        for key in path:
            at = at[int(key)] if isinstance(at, list) else at.setdefault(key, {})
        if value is None:
            del at[last]
        else:
            at[int(last) if isinstance(at, list) else last] = value
    return data


def refused(base: str | dict, changes: dict, says: str, folder: Path) -> None:
    """Read the case, plan it and make its deck; one sentence must come of it."""
    data = changed(base if isinstance(base, dict) else read_toml(CASES / f"{base}.toml"), changes)
    with pytest.raises(CaseError) as caught:
        if "scene" in data:
            p = plan(scene.parse(data, folder / "case.toml"))
            refuse_measures(p)
            checked_deck(p)
            placement.spheres(p)
        else:
            x = experiment(impact.parse(data, "case.toml"))
            plan_impacts(x, predict(x))
    assert says in str(caught.value) and "\n" not in str(caught.value), caught.value


@pytest.mark.parametrize(
    ("case", "changes", "says"),
    [
        (
            "two_materials",
            RIGID_SPHERE,
            "a rigid target has no mass; use kind = 'sphere-wall'",
        ),
        ("steel_wall", {"law.yield_pressure": "1 GPa", "law.yield_pressure_ratio": 2.8}, "are given; keep one"),
        ("oblique_steel", {"contact": None}, "without friction they change nothing; give contact.friction"),
        ("oblique_steel", {"viscous": {"restitution": 0.9}}, "no theory of oblique impacts with a dashpot; remove one"),
        ("oblique_steel", {"law": {"name": "jkr", "work_of_adhesion": "1 J/m^2"}}, "no theory of oblique impacts has"),
        ("steel_wall", {"contact": {"friction": 0.3}}, "nothing rubs in a normal impact; give impact.angles"),
        ("steel_wall", {"impact.speeds.count": 600}, "(speeds x phases), at most 4096; lower count or phases"),
        (
            "steel_wall",
            {"law": {"name": "jkr", "work_of_adhesion": "1 J/m^2"}, "viscous": {"restitution": 0.9}},
            "no theory of impacts has both adhesion (law jkr) and a dashpot; remove one",
        ),
        ("steel_wall", {"law": {"name": "jkr"}}, "law jkr needs law.work_of_adhesion (of all pairs), or the"),
        (
            "two_materials",
            {"law": {"name": "jkr", "work_of_adhesion": "1 J/m^2"}, "materials.hard.surface_energy": "1 J/m^2"},
            "surface_energy are given; keep one",
        ),
        ("steel_wall", {"materials.steel.surface_energy": "1 J/m^2"}, "has no adhesion"),
        ("steel_wall", {"law": {"name": "cavity", "first_yield_ratio": 3.0}}, "plastic_ratio (c_P) must exceed"),
        ("steel_wall", {"law": {"name": "cavity", "plastic_ratio": 300.0}}, "at most exp(300); lower plastic_ratio"),
        (
            "steel_wall",
            {
                "law": {"name": "cavity", "first_yield_ratio": 3.0},
                "materials.steel.yield_stress": None,
                "materials.steel.yield_ratio": 1e-6,
            },
            "law.first_yield_ratio = 3: plastic_ratio (c_P) must exceed",
        ),
        (
            "steel_wall",
            {"measured": {"source": "x", "speeds": ["1 m/s"], "e_n": [0.5, 0.6]}},
            "speeds: 1, e_n: 2; give one e_n for each speed",
        ),
        ("steel_wall", {"materials.steel.yield_stress": 3}, "expected a quantity with a unit in quotes"),
        ("steel_wall", {"materials.steel.yield_stress": "3 blah"}, "unknown unit 'blah'"),
        (
            "steel_wall",
            {"materials.steel.yield_stress": None},
            "or yield_stress = 'inf Pa' if the material never yields",
        ),
        ("steel_wall", {"numerics.step_in_contact": 5}, "unknown key; the nearest: numerics.steps_in_contact"),
        ("steel_wall", {"output": {"rows": 3}}, "output: unknown key of an impact; it belongs to scenes"),
        (
            "oblique_steel",
            {"contact.wall_friction": 0.5},
            "contact.wall_friction = 0.5, unknown key of an impact; it belongs to scenes",
        ),
    ],
)
def test_impacts(case, changes, says, tmp_path):
    refused(case, changes, says, tmp_path)


@pytest.mark.parametrize(
    ("case", "changes", "says"),
    [
        (
            "settle_glass",
            {"contact.rolling": {"model": "cdt", "coefficient": 0.1, "damping": 0.1}},
            "'damping' belongs to model = 'epsd' and only to it",
        ),
        ("settle_glass", {"contact.pairs": [{"between": ["glass", "wall"]}]}, "give friction, restitution or both"),
        (
            "settle_glass",
            {"contact.pairs": [{"between": ["glass", "wood"], "friction": 0.1}]},
            "contact.pairs: 'wood' is neither a material nor 'wall'",
        ),
        (
            "settle_glass",
            {"contact.pairs": [{"between": ["glass", "wall"], "restitution": 0.5}]},
            "there is no dashpot; add [viscous], for all other pairs",
        ),
        ("settle_glass", {"viscous": {"restitution": 0.9}}, "LIGGGHTS has one restitution for both dashpots"),
        (
            "settle_glass",
            {"materials.glass.yield_stress": None},
            "(or law.yield_pressure, the same for all); add it",
        ),
        (
            "settle_glass",
            {"materials.glass.colour": "red"},
            "materials.glass.colour = 'red', unknown key with law ",
        ),
        ("settle_glass", {"contact": {"tangential": "partial_slip"}}, "there is no friction; give"),
        ("settle_glass", {"contact.friction": 0.0}, "there is no friction, so no tangential dashpot; remove it"),
        (
            "adhesive_powder",
            {"contact.cohesion": "1 J/m^3"},
            "has its attraction already; remove one of them",
        ),
        ("adhesive_powder", {"contact.tangential": "partial_slip"}, "laws with adhesion have 'history' only; take it"),
        ("settle_glass", {"check": {"e_n": 1e-3}}, "check: unknown key of a scene; it belongs to impacts"),
        ("settle_glass", {"scene.rate": 600}, 'in quotes, as "600 Hz", got 600'),
        ("settle_glass", {"numerics.time_step": "10 ms"}, "impact at the scene's highest speed is stable up to"),
        ("settle_glass", {"numerics.cut": "x"}, "numerics.cut = 'x', unknown key; the nearest: numerics."),
        ("compaction_powder", {"scene.height": "4 mm"}, "must be below the box's height (0.0032 m)"),
        (
            "compaction_powder",
            {"scene.settle_time": "1 ms", "scene.gravity": "0 m/s^2"},
            "spheres fall under gravity; give",
        ),
        (
            "compaction_powder",
            {"scene.duration": "1 s"},
            "loading and unloading follow from height, unload_stroke and speed",
        ),
        ("peening_steel", {"scene.bed": [{"material": "shot", "radius": "1 mm"}]}, "give all three or none"),
        (
            "peening_steel",
            {
                "scene.bed": [{"material": "shot", "radius": "1 mm"}],
                "scene.bed_count": 9,
                "scene.bed_settle_time": "1 ms",
            },
            "a bed settles under gravity; give gravity",
        ),
        ("settle_glass", {"output.contacts": 3}, "needs particles and contacts at the same steps; give the same"),
        ("settle_glass", {"materials.glass.poisson_ratio": "0.3"}, "expected a plain number, got '0.3'"),
        ("settle_glass", {"output.rows": 10_000, "scene.duration": "0.1 ms"}, "rows (a multiple of output.particles)"),
        ("settle_glass", {"scene.gravity": "0 m/s^2"}, "so no time step follows; give gravity, or"),
    ],
)
def test_scenes(case, changes, says, tmp_path):
    refused(case, changes, says, tmp_path)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"phase": [FALL | {"move": [TURN | {"rate": "0 rpm"}]}]}, "rate is zero, so nothing turns"),
        ({"phase": [FALL | {"move": [MOVE, MOVE]}]}, "two motions of wall 'floor'; give one"),
        ({"phase": [FALL | {"until": {"after": "1 s", "count": 1}}]}, "until.after must be below duration"),
        (
            {
                "wall": [FLOOR, LID],
                "phase": [
                    FALL | {"move": [TURN]},
                    FALL | {"name": "b", "move": [TURN | {"origin": ["1 mm", "0 mm", "0 mm"]}]},
                ],
            },
            "it rotates about several origins, torques are about one",
        ),
        (
            {
                "wall": [FLOOR, LID],
                "phase": [FALL | {"move": [PRESS]}, FALL | {"name": "b", "move": [MOVE | {"wall": "lid"}]}],
            },
            "a wall that a force drives has no other motion; take a second wall",
        ),
        ({"fill": [{k: v for k, v in BED.items() if k != "count"} | {"mass": "1e-9 g"}]}, "not one sphere; give more"),
        ({"fill": [BED | {"rate": "1e6 Hz", "count": 4000}]}, "of the layer that they are poured into, at most"),
        ({"fill": [TABLE | {"file": 3}]}, "must be the name of a file in quotes"),
        (
            {"wall": [BOX | {"open": ["-x", "+x", "-y", "+y", "-z", "+z"]}]},
            "all six faces are open, so nothing",
        ),
        ({"measure": [{"name": "h", "kind": "height"}] * 2}, "two measures have this name; give each its own"),
        ({"measure": [{"name": "t", "kind": "torque", "wall": "floor"}]}, "a plane has no torque; name a wall of"),
        ({"measure": [{"name": "t", "kind": "force", "wall": "roof"}]}, "walls whose forces are known"),
    ],
)
def test_parts(changes, says, tmp_path):
    energy = {"output.energy": False}
    refused(CASE, {f"scene.{key}": value for key, value in changes.items()} | energy, says, tmp_path)


def test_outputs_that_a_scene_of_parts_does_not_have(tmp_path):
    turned = {"scene.wall": [FLOOR, LID], "scene.phase": [FALL | {"move": [TURN]}], "output.restarts": 2}
    refused(CASE, turned, "only walls with linear motions go on where they were", tmp_path)
    height = {"scene.measure": [{"name": "h", "kind": "height"}], "output": {"particles": 0}}
    refused(CASE, height, "measures are taken from frames; give output.particles", tmp_path)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x,y,z,radius\n", "needs a line of heads and at least one row"),
        ("x,y,z,radius\n0,0,0.01\n", "line 2: 3 values, expected 4"),
        ("x,y,z,radius\n0,0,0.01,-1\n", "line 2: radius = -1 m, must be above 0"),
        ("x,y,z,radius,colour\n0,0,0.01,0.001,1\n", "unknown column 'colour'; there are x, y"),
        ("x,y,radius\n0,0,0.001\n", "column 'z' is missing"),
        (
            "x,y,z,radius [mm]\n0,0,0.01,1\n",
            "column 'radius [mm]': heads have no units; write 'radius' and SI numbers",
        ),
        ("x,y,z,z\n0,0,0.01,1\n", "two columns have the same head; keep one"),
        ("x,y,z,radius,material\n0,0,0.01,0.001,glass\n", "give the material in the file or in the case"),
        (b"x,y,z,r\xe4dius\n0,0,0,1\n", "t.csv: not UTF-8 at byte 7; save the file as UTF-8"),
    ],
)
def test_files_of_spheres(text, says, tmp_path):
    (tmp_path / "t.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    refused(CASE, {"scene.fill": [TABLE]}, says, tmp_path)


def test_limits_of_size_place_and_steps(tmp_path, monkeypatch):
    (tmp_path / "t.csv").write_text("x,y,z,radius\n0,0,0.01,0.001\n")
    with monkeypatch.context() as small:
        small.setattr(sizes, "LARGEST_FILE", 0)
        refused(CASE, {"scene.fill": [TABLE]}, "0 MB; name another file", tmp_path)
    with monkeypatch.context() as few:
        few.setattr(placement, "ATTEMPTS", 1)
        refused(
            "settle_glass",
            {"scene.box": ["20 mm"] * 3, "scene.count": 140},
            "without overlap after 1 attempts",
            tmp_path,
        )
    monkeypatch.setattr(impacts_plan, "MOST_STEPS", 10)
    refused("settle_glass", {}, "give a larger one, or numerics.time_step", tmp_path)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("opening,retained\n1,2\n", "needs two columns with units, as 'opening [mm],retained [%]'"),
        ("opening [mm];retained [%]\n3;0\n2;100\n", "(divided by a comma); it has"),
        ("opening [mm],passing [%]\n3,80\n2,20\n1,0\n", "the column 'passing' is a running sum; give what each"),
        ("opening [mm],retained [g]\n1,2\n", "the mass retained is in [%] or [1], not in [g]"),
        ("opening [mm],retained [%]\n1\n", "line 2: 1 values, expected 2"),
        ("opening [kg],retained [%]\n1,100\n", "line 2: opening = '1.0 kg', the unit 'kg' has the wrong dimension"),
        ("opening [mm],retained [%]\n-1,100\n", "openings and shares must be at least 0"),
        ("opening [mm],retained [%]\n1,100\n", "different openings are needed, there are 1"),
        ("opening [mm],retained [%]\n2,0\n1,50\n", "the shares add up to 50, must be 100 within 2 %"),
        ("opening [mm],retained [%]\n2,50\n1,50\n", "nothing may be retained on the largest opening"),
    ],
)
def test_sieve_tables(text, says, tmp_path):
    (tmp_path / "s.csv").write_text(text)
    refused(CASE, {"scene.fill": [BED | {"particles": [SIEVE]}]}, says, tmp_path)


def test_laws_and_models_of_other_programs():
    with pytest.raises(CaseError, match="law thornton has no parameter 'Y'; it has yield_pressure"):
        Law("thornton", E_star=1e9, Y=1.0)
    with pytest.raises(CaseError, match=r"law thornton: yield_pressure = -1.0, must be a finite number in \(0, inf\)"):
        Law("thornton", E_star=1e9, yield_pressure=-1.0)
    for x in ("1", "-0.1"):
        hard = changed(read_toml(CASES / "steel_wall.toml"), {"law": {"name": "meyer", "hardening_exponent": float(x)}})
        with pytest.raises(CaseError, match=rf"law.hardening_exponent = {float(x)}, must lie in \[0, 1\); correct it"):
            experiment(impact.parse(hard))
    viscous = experiment(impact.parse(read_toml(CASES / "viscous_steel.toml")))
    with pytest.raises(CaseError, match="mdr is compared on walls and without a dashpot: its flats are rigid"):
        Mdr.of(viscous)
    without = {"law": {"name": "hertz"}, "materials.steel.yield_stress": None}
    elastic = experiment(impact.parse(changed(read_toml(CASES / "steel_wall.toml"), without)))
    with pytest.raises(CaseError, match="mdr needs the yield stress of both materials"):
        Mdr.of(elastic)
    with pytest.raises(CaseError, match=r"these impacts are normal; give impact.angles"):
        elastic.friction_of_oblique()
