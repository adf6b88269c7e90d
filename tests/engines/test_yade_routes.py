# SPDX-License-Identifier: GPL-2.0-or-later
"""Engine `yade` with the classes of epdem_yade: the numbers of the C library in a deck and of LIGGGHTS."""

import json

import numpy as np
import pytest
from hosts import CASES

from epdem.case.scene import parse
from epdem.engines import doctor, engine
from epdem.engines.yade import deck as scene_deck
from epdem.engines.yade import launcher
from epdem.errors import CaseError
from epdem.impacts.run import run as run_impacts
from epdem.scenes.plan.plan import plan
from scenes.parts_cases import FLOOR, parts
from scenes.scene_runs import run as run_scene
from scenes.scene_runs import write_case

pytestmark = pytest.mark.yade("module")

HERE = launcher.module


@pytest.mark.parametrize("case", ["viscous_steel", "adhesion_thornton_1998"])
def test_a_case_that_needs_the_classes_passes_its_checks(case, tmp_path):
    outcome = run_impacts(CASES / f"{case}.toml", engines=[engine("yade")], out=tmp_path)
    assert outcome.passed and [*tmp_path.rglob(launcher.MODULE)]  # the deck brings the module


def test_doctor_and_results_say_which_laws_yade_runs(tmp_path, monkeypatch):
    (found,) = (f for f in doctor.examine() if f.part == "engine yade")
    assert "epdem_yade, epdem " in found.detail
    monkeypatch.setattr(launcher, "module", lambda: None)
    (found,) = (f for f in doctor.examine() if f.part == "engine yade")
    assert "C library" in found.detail and "make yade" in found.detail


def test_the_rolling_model_that_the_classes_lack_is_refused():
    data = parts() | {"contact": {"friction": 0.4, "rolling": {"model": "epsd", "coefficient": 0.1, "damping": 0.3}}}
    with pytest.raises(CaseError, match=r"contact\.rolling = 'epsd': YADE's laws have cdt and epsd2; remove it"):
        scene_deck.deck(plan(parse(data)))


GRANULAR = {
    "friction": ({"friction": 0.4, "tangential": "partial_slip"}, None, "thornton"),
    "dashpot, rolling, cohesion": (
        {"friction": 0.4, "rolling": {"coefficient": 0.1}, "cohesion": "2e4 J/m^3"},
        {"restitution": 0.7},
        "thornton",
    ),
    "adhesion": ({"friction": 0.4}, None, "thornton_ning"),
}


@pytest.mark.liggghts
@pytest.mark.parametrize("name", GRANULAR)
def test_spheres_that_fall_from_the_same_places_have_the_energies_of_liggghts(name, tmp_path):
    contact, viscous, law = GRANULAR[name]
    draw = np.random.default_rng(1)
    places = [(4.2 * i, 4.2 * j, 2.2 + 4.2 * k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in range(3)]
    lines = [
        ",".join(f"{1e-3 * (x + 0.2 * draw.random())!r}" for x in place)
        + f",{1.5e-3 + 4e-4 * draw.random()!r},0,0,-0.5"
        for place in places
    ]
    (tmp_path / "spheres.csv").write_text("\n".join(["x,y,z,radius,vx,vy,vz", *lines, ""]))
    sides = (("left", "x", -6.5), ("right", "x", 6.5), ("front", "y", -6.5), ("back", "y", 6.5))
    walls = [{"name": n, "kind": "plane", "axis": a, "at": f"{x} mm", "material": "steel"} for n, a, x in sides]
    table = {"name": "table", "file": str(tmp_path / "spheres.csv"), "material": "glass"}
    data = parts(wall=[FLOOR, *walls], fill=[table], phase=[{"name": "fall", "duration": "40 ms"}])
    data |= {"contact": contact, "law": {"name": law}} | ({"viscous": viscous} if viscous else {})
    for material in data["materials"].values():
        material |= {"surface_energy": "0.1 J/m^2"} if law == "thornton_ning" else {}
    data["numerics"] = {"time_step": "1e-5 s"}
    found = {}
    for tool in ("yade", "liggghts"):
        found[tool] = run_scene(write_case(data, tmp_path), tool, out=tmp_path / tool).results.energy_balance
    yade, liggghts = found["yade"], found["liggghts"]
    assert [*yade] == [*liggghts] and ("plastic" in yade) and (name != "friction" or "springs" in yade)
    scale = liggghts["kinetic"].max() + np.ptp(liggghts["gravity"])
    for column in set(yade) - {"step", "time"}:
        off = np.abs(yade[column] - liggghts[column]).max()
        assert off <= 0.01 * scale, (column, json.dumps([off, scale]))
