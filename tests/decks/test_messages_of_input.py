# SPDX-License-Identifier: GPL-2.0-or-later
"""The message of each mistake in a case, a scene or a file beside it, with the edits of a good case that cause it."""

import copy
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from epdem.case import impact, scene, sizes
from epdem.case.toml import read_toml
from epdem.engines import scene_engine
from epdem.errors import CaseError
from epdem.impacts import plan as impacts_plan
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan as plan_impacts
from epdem.impacts.prediction import predict
from epdem.jobs.engine import check
from epdem.laws.library import Law
from epdem.scenes.judge.measures import refuse_measures
from epdem.scenes.plan import placement
from epdem.scenes.plan.plan import plan
from epdem.verification.models.theories import Mdr

sys.path.append(str(Path(__file__).parents[1] / "scenes"))
from parts_cases import BED, CASE

CASES = Path(__file__).parents[2] / "cases"
LID = {"name": "lid", "kind": "plate", "axis": "z", "center": ["0 m", "0 m", "38 mm"], "size": ["10 mm"] * 2}
SIEVE = {"material": "glass", "radius": {"sieve": "s.csv"}}
TABLE = {"name": "a", "file": "t.csv", "material": "glass"}


def changed(base: dict, changes: dict) -> dict:
    """A copy with the value at each place "a.b.0.c" instead; None removes it, the next place of a list adds one."""
    data = copy.deepcopy(base)
    for place, value in changes.items():
        at, (*path, last) = data, place.split(".")
        for key in path:
            at = at[int(key)] if isinstance(at, list) else at.setdefault(key, {})
        if value is None:
            del at[last]
        elif isinstance(at, list):
            at[int(last) : int(last) + 1] = [value]
        else:
            at[last] = value
    return data


SCENE = changed(CASE, {"output.energy": False})
BASES = {"parts": SCENE, "lid": changed(SCENE, {"scene.wall.1": LID | {"material": "steel"}})}


def table() -> Iterator[tuple[str, dict, str]]:
    """(case, changes, words) of the rows of refused.txt."""
    case, changes = "", {}
    for line in Path(__file__).with_name("refused.txt").read_text(encoding="utf-8").splitlines():
        edit, arrow, says = line.partition("-> ")
        if line.startswith("["):
            case = line[1:-1]
        elif line and not line.startswith("#"):
            if edit.strip():
                key, _, value = edit.partition(" = ")
                changes[key] = None if value.strip() == "nothing" else tomllib.loads(f"value = {value}")["value"]
            if arrow:
                yield case, changes, says
                changes = {}


def refused(base: str | dict, changes: dict, says: str, folder: Path) -> None:
    """Read the case, plan it and make its deck; one sentence must come of it."""
    name, _, host = base.partition(" in ") if isinstance(base, str) else ("", "", "")
    good = base if isinstance(base, dict) else BASES.get(name) or read_toml(CASES / f"{name}.toml")
    data, place = changed(good, changes), (CASES if (CASES / f"{name}.toml").exists() else folder) / "case.toml"
    with pytest.raises(CaseError) as caught:
        if "scene" in data:
            p = plan(scene.parse(data, place))
            refuse_measures(p)
            tool = scene_engine(host or "liggghts")
            tool.classes = True  # of YADE, whose module a deck does not need
            check(tool, p)
            tool.files(p)
            placement.spheres(p)
        else:
            x = experiment(impact.parse(data, "case.toml"))
            plan_impacts(x, predict(x))
    words = ".*".join(map(re.escape, says.split(" ... ")))
    assert re.search(words, str(caught.value)) and "\n" not in str(caught.value), caught.value


@pytest.mark.parametrize(("case", "changes", "says"), list(table()), ids=lambda x: x if isinstance(x, str) else "")
def test_input_is_refused_in_one_sentence(case, changes, says, tmp_path):
    (tmp_path / "s.csv").write_text("x,y,z,radius\n0,0,0,0.001\n0,0,0,big\n")
    refused(case, changes, says, tmp_path)


@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        ("case.name", "n" * 1000, f"case.name = '{'n' * 76}..., must be"),
        ("materials.steel.young_modulus", "1 " + "G" * 200, "young_modulus = '1 GGG"),
        ("materials.steel.two\nlines", 1, "materials.steel.'two\\nlines' = 1, unknown key"),
    ],
    ids=["long name", "long unit", "key of two lines"],
)
def test_a_long_or_broken_value_comes_in_a_short_line(place, value, says, tmp_path):
    refused("steel_wall", {place: value}, says, tmp_path)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x,y,z,radius\n", "needs a line of heads and at least one row"),
        ("x,y,z,radius\n0,0,0.01\n", "line 2: 3 values, expected 4"),
        ("x,y,z,radius\n0,0,0.01,-1\n", "line 2: radius = -1 m, must be above 0"),
        ("x,y,z,radius,colour\n0,0,0.01,0.001,1\n", "unknown column 'colour'; there are x, y"),
        ("x,y,radius\n0,0,0.001\n", "column 'z' is missing"),
        ("x,y,z,radius [mm]\n0,0,0.01,1\n", "column 'radius [mm]': heads have no units; write 'radius' and SI numbers"),
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
        dense = {"scene.box": ["20 mm"] * 3, "scene.count": 140}
        refused("settle_glass", dense, "without overlap after 1 attempts", tmp_path)
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
    viscous = experiment(impact.parse(read_toml(CASES / "viscous_steel.toml")))
    with pytest.raises(CaseError, match="mdr is compared on walls and without a dashpot: its flats are rigid"):
        Mdr.of(viscous)
    without = {"law": {"name": "hertz"}, "materials.steel.yield_stress": None}
    elastic = experiment(impact.parse(changed(read_toml(CASES / "steel_wall.toml"), without)))
    with pytest.raises(CaseError, match="mdr needs the yield stress of both materials"):
        Mdr.of(elastic)
    with pytest.raises(CaseError, match=r"these impacts are normal; give impact.angles"):
        elastic.friction_of_oblique()
